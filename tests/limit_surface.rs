//! measure
mod common;
use ash_subdiv::limit::LimitSurface;
use common::limit::mesh_and_limit;
use std::time::Instant;

#[test]
fn measure() {
    let mut names: Vec<_> = std::fs::read_dir(common::shared().join("limit"))
        .unwrap()
        .map(|e| e.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
        .filter(|n| n != "catmark_fan")
        .collect();
    names.sort();
    for name in names {
        let (mesh, limit) = mesh_and_limit(&name);
        let start = Instant::now();
        let surface = LimitSurface::new(&mesh).unwrap();
        let (mut pos, mut nor, mut der) = (vec![], vec![], vec![]);
        for r in &limit.records {
            for (i, s) in r.samples.iter().enumerate() {
                let (iu, iv) = (i % limit.side, i / limit.side);
                let at = |i: usize| i as f64 / (limit.side - 1) as f64;
                let ours = surface.evaluate(r.face, r.sub, at(iu), at(iv));
                let w = (r.face, r.sub, iu, iv);
                pos.push(((ours.position - s.position).length() / mesh.diagonal(), w));
                nor.push(((ours.normal - s.normal()).length(), w));
                let corner = (iu == 0 || iu + 1 == limit.side) && (iv == 0 || iv + 1 == limit.side);
                if !corner {
                    let len = s.du.length().max(s.dv.length());
                    der.push((((ours.du - s.du).length().max((ours.dv - s.dv).length())) / len, w));
                }
            }
        }
        let show = |mut v: Vec<(f64, (u32, i32, usize, usize))>, limit: f64| {
            v.sort_by(|a, b| b.0.total_cmp(&a.0));
            let bad = v.iter().filter(|e| e.0 > limit).count();
            format!("{:.1e} {:?} bad {bad}/{}", v[0].0, v[0].1, v.len())
        };
        println!(
            "{name:26} pos {:48} nor {:48} der {:48} {:?}",
            show(pos, 1e-9),
            show(nor, 1e-3),
            show(der, 1e-3),
            start.elapsed()
        );
    }
}

//! Times of the limit surface as a mesh: `cargo run --release --example tessellate_times -- model.obj creature`.
//!
//! For each mesh, a file or the name of a built-in shape, at each depth from 2 to 6: plan, arrays and the first filling; then
//! positions and normals filled again for vertices that moved.

use ash_subdiv::dice::{DiceOptions, Tessellation};
use ash_subdiv::mesh::{ReadOptions, read};
use ash_subdiv::shape;
use ash_subdiv::topology::Topology;
use std::time::Instant;

/// How often arrays are filled again.
const TIMES: usize = 31;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("depth   vertices  set-up, ms  moved, ms: median     best  million vertices a second");
    for name in std::env::args().skip(1) {
        let mesh = match shape(&name) {
            Ok(mesh) => mesh,
            Err(_) => read(&name, &ReadOptions::default())?,
        };
        println!("{name}");
        let control = mesh.positions_f32();
        for depth in 2..=6 {
            let start = Instant::now();
            let mut tessellation = Tessellation::<f32>::new(&Topology::new(&mesh), &DiceOptions::fixed(depth))?;
            let setup = 1e3 * start.elapsed().as_secs_f64();
            let mut times = Vec::with_capacity(TIMES);
            for _ in 0..TIMES {
                let start = Instant::now();
                tessellation.update(&control)?;
                times.push(1e3 * start.elapsed().as_secs_f64());
            }
            times.sort_by(f64::total_cmp);
            let (count, median) = (tessellation.positions().len(), times[TIMES / 2]);
            let rate = count as f64 / median / 1e3;
            println!("{depth:5}{count:11}{setup:12.1}{median:19.2}{:9.2}{rate:27.1}", times[0]);
        }
    }
    Ok(())
}

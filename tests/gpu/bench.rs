//! The bench draws what it says it draws.
#![cfg(feature = "measure")]

use crate::common::headless;
use ash_subdiv::bench::{
    Bench, BenchOptions, Camera, Contestant, Crowd, CullBy, Event, Motion, Normals, Path, Row, Subject, Subset,
};
use ash_subdiv::headless::Headless;
use ash_subdiv::renderer::Cull;
use ash_subdiv::topology::PatchKind;
use ash_subdiv::{Construction, ControlMesh, MeshData, Scheme, Spacing, shape};

const GREGORY: Contestant = Contestant::new(Path::Tessellation, Some((Scheme::Gregory, Construction::TwoStage)));

fn floor(path: Path) -> Contestant {
    Contestant::new(path, None)
}

fn options() -> BenchOptions {
    BenchOptions { factors: vec![1.0, 3.0], size: [128, 128], frames: 6, warm_up: 0, ..BenchOptions::default() }
}

fn subject(name: &str) -> Subject {
    Subject::new(name, shape(name).unwrap(), 0, Subset::All).unwrap()
}

fn race(headless: &Headless, options: BenchOptions, name: &str, contestants: &[Contestant]) -> Vec<Row> {
    let mut rows = Vec::new();
    let bench = Bench::new(headless, options).unwrap();
    let mut frames = 0;
    bench
        .race(&subject(name), contestants, |event| match event {
            Event::Rows(more) => rows.extend(more),
            Event::Frames(more) => frames += more,
            Event::LeftOut(..) => {}
        })
        .unwrap();
    assert_eq!(frames, bench.frames(contestants.len()));
    rows
}

/// Pixels that differ by more than rounding makes them.
fn different(a: &[u8], b: &[u8]) -> usize {
    a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 12)).count()
}

fn covered(pixels: &[u8]) -> usize {
    pixels.chunks(4).filter(|pixel| pixel[3] > 0).count()
}

#[test]
fn a_vertex_buffer_is_the_same_surface() {
    let headless = headless();
    // At 16 its indices are those of a strip.
    for (name, spacing, factor) in [
        ("creature", Spacing::Equal, 4.0),
        ("cloth", Spacing::FractionalEven, 4.0),
        ("creature", Spacing::Equal, 16.0),
        ("creature-mixed", Spacing::Equal, 16.0),
    ] {
        let bench = Bench::new(&headless, BenchOptions { spacing, ..options() }).unwrap();
        let subject = subject(name);
        let [drawn, before] = [GREGORY, floor(Path::VertexBuffer)].map(|c| bench.picture(&subject, c, factor).unwrap());
        let (pixels, other) = (covered(&drawn), different(&drawn, &before));
        // Rounding moves the silhouette by a pixel here and there.
        assert!(pixels > 1500 && other * 100 <= pixels, "{name}: {other} of {pixels}");
    }
    headless.finish_silent();
}

#[test]
fn vertices_of_the_cpu_are_the_same_surface() {
    let headless = headless();
    let cpu = floor(Path::Cpu);
    // All regular, so that patches have no error.
    for factor in [2.0, 8.0] {
        let bench = Bench::new(&headless, options()).unwrap();
        let [drawn, other] = [GREGORY, cpu].map(|c| bench.picture(&subject("torus"), c, factor).unwrap());
        let (pixels, other) = (covered(&drawn), different(&drawn, &other));
        assert!(pixels > 1500 && other * 100 <= pixels, "{factor}: {other} of {pixels}");
    }
    let moving = BenchOptions { factors: vec![2.0, 4.0], instances: 3, passes: 2, ..options() };
    let rows = race(&headless, moving, "cube", &[GREGORY, cpu]);
    assert_eq!(rows.len(), 4);
    for row in rows.iter().filter(|row| row.contestant == cpu) {
        let n = row.factor as u64;
        assert_eq!((row.triangles, row.evaluations), (Some(36 * 2 * n * n), Some(0)));
        // A closed surface of four-sided faces: each vertex once.
        assert_eq!([bytes(row, "vertices"), bytes(row, "indices")], [24 * (6 * n * n + 2), 12 * 12 * n * n]);
        assert!(row.setup.tables > 0.0 && row.gpu.host.iter().zip(&row.gpu.device).all(|(host, device)| host > device));
    }
    // Not a power of two: the next.
    let rows = race(&headless, BenchOptions { factors: vec![3.0], ..options() }, "cube", &[cpu]);
    assert_eq!(rows[0].triangles, Some(6 * 2 * 16));
    headless.finish_silent();
}

#[test]
fn acc_as_published_is_the_same_surface() {
    let headless = headless();
    let acc = |(path, construction)| Contestant::new(path, Some((Scheme::Acc, construction)));
    let tessellated = [Path::Tessellation, Path::AccPublished].map(|path| (path, Construction::TwoStage));
    let instanced = [Path::Instanced, Path::AccPublishedInstanced].map(|path| (path, Construction::Cached));
    let bench = Bench::new(&headless, options()).unwrap();
    for (name, pair) in
        ["creature", "valences", "cloth"].into_iter().flat_map(|name| [(name, tessellated), (name, instanced)])
    {
        let subject = subject(name);
        let [ours, published] = pair.map(|way| {
            let pixels = bench.picture(&subject, acc(way), 4.0).unwrap();
            assert!(covered(&pixels) > 1500, "{name}");
            pixels
        });
        // Rounding of the normals only.
        let most = ours.iter().zip(&published).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(1), "{name}: {most:?}");
    }
    drop(bench);
    headless.finish_silent();
}

#[test]
fn the_bilinear_floor_is_the_control_mesh() {
    let headless = headless();
    let bench = Bench::new(&headless, options()).unwrap();
    for name in ["cube", "tetrahedron"] {
        let subject = subject(name);
        let [flat, finer] = [1.0, 5.0].map(|f| bench.picture(&subject, floor(Path::Bilinear), f).unwrap());
        // Flat faces stay flat; the surface shrinks from them.
        assert!(different(&flat, &finer) <= 8, "{name}: {}", different(&flat, &finer));
        assert!(covered(&bench.picture(&subject, GREGORY, 5.0).unwrap()) < covered(&flat) * 9 / 10);
    }
    drop(bench);
    headless.finish_silent();
}

#[test]
fn what_faces_away_is_left_out_if_asked_for() {
    let headless = headless();
    let picture = |mesh: &ControlMesh, single_sided, contestant| {
        let subject = Subject::new("square", mesh.clone(), 0, Subset::All).unwrap();
        let bench = Bench::new(&headless, BenchOptions { single_sided, ..options() }).unwrap();
        covered(&bench.picture(&subject, contestant, 2.0).unwrap())
    };
    let instanced = Contestant::new(Path::Instanced, Some((Scheme::Gregory, Construction::Cached)));
    let front = shape("single-quad").unwrap();
    let turned =
        MeshData { face_vertices: front.data().face_vertices.iter().rev().copied().collect(), ..front.data().clone() };
    let turned = ControlMesh::new(turned).unwrap();
    for contestant in [GREGORY, instanced, floor(Path::Bilinear), floor(Path::VertexBuffer)] {
        let of = |single_sided| [&front, &turned].map(|mesh| picture(mesh, single_sided, contestant));
        let ([seen, away], both) = (of(true), of(false));
        assert!(seen > 1500 && away == 0 && both == [seen; 2], "{contestant:?}: {seen} {away} {both:?}");
    }
    headless.finish_silent();
}

/// Of what drawing reads, by name.
fn bytes(row: &Row, name: &str) -> u64 {
    row.bytes.iter().find(|(of, _)| *of == name).map_or(0, |(_, bytes)| *bytes)
}

#[test]
fn a_race_counts_what_was_drawn() {
    let headless = headless();
    // All but the CPU's, which begins with two segments.
    let mut all = Contestant::all(&Path::ALL, &Scheme::ALL, &Construction::ALL);
    all.retain(|contestant| contestant.path != Path::Cpu);
    // Levels of subdivision, too.
    let factors = vec![1.0, 2.0, 4.0];
    let rows = race(&headless, BenchOptions { instances: 3, passes: 2, factors, ..options() }, "cube", &all);
    assert_eq!(rows.len(), 3 * all.len());
    for (row, contestant) in rows.iter().zip(all.iter().cycle()) {
        let n = row.factor as u64;
        assert_eq!((row.contestant, row.patches), (*contestant, 36));
        assert_eq!(row.triangles, Some(36 * 2 * n * n));
        let tessellated = matches!(contestant.path, Path::Tessellation | Path::AccPublished | Path::Bilinear);
        let evaluations = if tessellated { 36 * (n + 1) * (n + 1) } else { 0 };
        assert_eq!(row.evaluations, Some(evaluations));
        let vertices = match contestant.path {
            Path::Geometry | Path::Subdivision => 36 * 2 * n * n,
            // And a point for each corner, once.
            Path::GeometryTwoPass => 36 * (n + 1) * (n + 1) + 24,
            _ => 36 * (n + 1) * (n + 1),
        };
        assert_eq!(row.traffic.vertices, 40 * vertices);
        let points = contestant.patches.map(|(scheme, _)| scheme.owned(ash_subdiv::topology::PatchKind::IrregularQuad));
        let points = if tessellated { points.unwrap_or(1) as u64 } else { 0 };
        let vertices = bytes(row, "vertices");
        let indices = 4 * 6 * n * n;
        match contestant.path {
            // Six patches once, with their indices.
            Path::Compute => assert_eq!([vertices, bytes(row, "indices")], [6 * 24 * (n + 1) * (n + 1), 6 * indices]),
            Path::Instanced | Path::AccPublishedInstanced | Path::GeometryTwoPass => {
                assert_eq!([vertices, bytes(row, "indices")], [0, indices]);
            }
            _ => {}
        }
        // Six vectors of each corner, and its cosine.
        let of_corner = if contestant.path == Path::AccPublished { 6 * 12 + 4 } else { 12 * points };
        assert_eq!(row.traffic.control_points, 4 * of_corner * 36);
        assert_eq!(row.construction.is_some(), tessellated && !contestant.path.is_floor());
        for series in [&row.gpu, &row.geometry] {
            assert!(series.device.len() == 6 && series.device.iter().all(|&ms| ms > 0.0));
            assert!(series.host.iter().zip(&series.device).all(|(host, device)| host >= device));
        }
        assert!(row.setup.tables > 0.0 && row.setup.upload > 0.0 && row.setup.first_use() > 0.0);
    }
    headless.finish_silent();
}

#[test]
fn contestants_that_cannot_are_left_out() {
    let headless = headless();
    let bench = Bench::new(&headless, options()).unwrap();
    let all = Contestant::all(&[Path::Tessellation], &[Scheme::Gregory, Scheme::Acc], &[Construction::Stencil]);
    let mut left = Vec::new();
    let mut rows = 0;
    bench
        .race(&subject("tetrahedron"), &all, |event| match event {
            Event::LeftOut(contestant, None, why) => left.push((contestant.scheme_name(), why.to_string())),
            Event::Rows(more) => rows += more.len(),
            _ => {}
        })
        .unwrap();
    assert_eq!((left.len(), rows), (1, 2));
    assert!(left[0].0 == "acc" && left[0].1.contains("no patches for triangles"), "{left:?}");
    let error = bench.picture(&subject("tetrahedron"), all[1], 1.0).unwrap_err().to_string();
    assert!(error.contains("no patches for triangles"));
    let subdivision = [Contestant::new(Path::Subdivision, None)];
    let mut left = Vec::new();
    let tell = |event| {
        if let Event::LeftOut(_, factor, why) = event {
            left.push((factor, why.to_string()));
        }
    };
    bench.race(&subject("cube"), &subdivision, tell).unwrap();
    let why = "model 0: Uniform(3.0): subdivision has uniform factors of 1, 2, 4 and 8, for levels 0 to 3";
    assert_eq!(left, [(Some(3.0), why.to_owned())]);
    let few = Bench::new(&headless, BenchOptions { frames: 5, ..options() }).map(drop).unwrap_err();
    assert_eq!(few.to_string(), "BenchOptions::frames is 5: it must be at least 6");
    drop(bench);
    headless.finish_silent();
}

#[test]
fn cached_control_points_are_made_in_every_frame_in_which_vertices_move() {
    let headless = headless();
    let cached = Contestant { patches: Some((Scheme::Gregory, Construction::Cached)), ..GREGORY };
    let rows = race(&headless, BenchOptions { passes: 3, ..options() }, "creature-mixed", &[GREGORY, cached]);
    let points = |row: &Row| row.bytes.iter().find(|(name, _)| *name == "control_points").map(|(_, bytes)| *bytes);
    assert_eq!(points(&rows[0]), None);
    let subject = subject("creature-mixed");
    let patches = PatchKind::ALL.map(|kind| u64::from(subject.patch_count(kind)));
    let corners: u64 = patches.iter().zip(PatchKind::ALL).map(|(count, kind)| count * kind.corners() as u64).sum();
    assert_eq!(points(&rows[1]), Some(16 * 4 * corners));
    // Every ring and every patch of three kinds once a frame, whatever the number of passes: 64 invocations a group.
    let things = shape("creature-mixed").unwrap().vertex_count() as u64 + patches.iter().sum::<u64>();
    let counted = rows[1].computed.expect("lavapipe counts");
    assert!(counted >= things && counted < things + 4 * 64, "{counted} for {things}");
    assert_eq!(rows[0].computed, Some(0));
    let still = BenchOptions { motion: Motion::Still, ..options() };
    let compute = Contestant { path: Path::Compute, ..cached };
    let rows = race(&headless, still, "creature-mixed", &[cached, compute]);
    assert!(rows.iter().all(|row| row.computed == Some(0) && row.triangles > Some(0)), "{rows:?}");
    // Nothing is made, and each draw reads what is kept.
    for row in &rows {
        let read = if row.contestant == compute { "vertices" } else { "control_points" };
        assert_eq!(row.traffic.tables, bytes(row, read) + bytes(row, "indices"));
    }
    let moving = race(&headless, options(), "creature-mixed", &[cached, compute]);
    for (row, still) in moving.iter().zip(&rows) {
        let all: u64 = row.bytes.iter().map(|(_, bytes)| bytes).sum();
        // The points besides are read to evaluate them.
        let evaluated = if row.contestant == compute { bytes(row, "control_points") } else { 0 };
        let made = all - bytes(row, "indices") + bytes(row, "frames") + evaluated;
        assert_eq!(row.traffic.tables - still.traffic.tables, made);
    }
    headless.finish_silent();
}

#[test]
fn variants_are_of_what_can_be_combined() {
    let all = Contestant::all(&Path::ALL, &[Scheme::Gregory, Scheme::Acc], &[Construction::Cached]);
    let variants = |normals: &[Normals], culls: &[Cull]| -> Vec<Contestant> {
        all.iter().flat_map(|contestant| contestant.variants(normals, culls, &[])).collect()
    };
    assert_eq!(variants(&[Normals::Own], &[Cull::NONE]), all);
    let acc_published = [Path::AccPublished, Path::AccPublishedInstanced];
    let published = Contestant::all(&acc_published, &Scheme::ALL, &Construction::ALL);
    let constructions = [Construction::TwoStage, Construction::Cached];
    let of_acc = |i: usize| Contestant::new(acc_published[i], Some((Scheme::Acc, constructions[i])));
    assert_eq!(published, [0, 1].map(of_acc));
    let of = |variants: &[Contestant], path, scheme| {
        let is = |c: &&Contestant| c.path == path && c.patches.is_none_or(|(s, _)| s == scheme);
        variants.iter().filter(is).count()
    };
    let every = variants(&Normals::ALL, &[Cull::NONE, Cull::ALL]);
    for path in Path::ALL.into_iter().filter(|path| !acc_published.contains(path)) {
        let [gregory, acc] = match path {
            Path::Tessellation | Path::Instanced => [4, 2],
            Path::Compute | Path::Geometry => [2, 1],
            _ => [1, 1],
        };
        assert_eq!(of(&every, path, Scheme::Gregory), gregory, "{path:?}");
        assert_eq!(of(&every, path, Scheme::Acc), acc, "{path:?}");
    }
    // Floors are there in any case: what others cannot get below; and the CPU's vertices, which have one normal each.
    let shared = variants(&[Normals::Shared], &[Cull::NONE]);
    let is_alone = |path: Path| path.is_floor() || path == Path::Cpu;
    assert!(shared.iter().all(|c| is_alone(c.path) || c.normals == Normals::Shared) && shared.len() == 7);
    // Instances are culled by compute only; what is not culled is there once.
    let way = |path, construction| Contestant::new(path, Some((Scheme::Gregory, construction)));
    let ways = [way(Path::Tessellation, Construction::TwoStage), way(Path::Instanced, Construction::Cached)];
    assert_eq!(ways.map(|way| way.cull_by), CullBy::ALL);
    for (contestant, by) in ways.into_iter().zip([&CullBy::ALL[..], &[CullBy::Compute]]) {
        let culled = by.iter().map(|&cull_by| Contestant { cull: Cull::ALL, cull_by, ..contestant });
        let expected: Vec<_> = [contestant].into_iter().chain(culled).collect();
        assert_eq!(contestant.variants(&[Normals::Own], &[Cull::NONE, Cull::ALL], &CullBy::ALL), expected);
    }
}

#[test]
fn normals_and_culling_are_those_of_the_row() {
    let headless = headless();
    let with = |normals, cull| Contestant { normals, cull, ..GREGORY };
    let rows = race(
        &headless,
        options(),
        "creature",
        &[
            GREGORY,
            with(Normals::Shared, Cull::NONE),
            with(Normals::Own, Cull { back: true, ..Cull::NONE }),
            with(Normals::Shared, Cull { back: true, ..Cull::NONE }),
            Contestant { cull_by: CullBy::Compute, ..with(Normals::Own, Cull { back: true, ..Cull::NONE }) },
        ],
    );
    let bytes = |row: &Row| row.bytes.iter().map(|(_, bytes)| bytes).sum::<u64>();
    for rows in rows.chunks(5) {
        let triangles: Vec<u64> = rows.iter().map(|row| row.triangles.expect("lavapipe counts")).collect();
        assert!(triangles[0] == triangles[1] && triangles[2] == triangles[3]);
        assert!(triangles[2] < triangles[0] * 19 / 20 && triangles[4] == triangles[2], "{triangles:?}");
        assert!(bytes(&rows[1]) > bytes(&rows[0]) && bytes(&rows[2]) == bytes(&rows[0]));
        // Lists; and compute reads the tables, too.
        let [control, compute] = [&rows[2], &rows[4]];
        let lists = bytes(compute) - bytes(control);
        assert!(lists > 4 * compute.patches && compute.computed > Some(0) && control.computed == Some(0));
        assert_eq!(compute.traffic.tables, 2 * control.traffic.tables + lists);
    }
    let bench = Bench::new(&headless, options()).unwrap();
    let subject = subject("creature");
    let [plain, culled] = [GREGORY, with(Normals::Own, Cull::ALL)].map(|c| bench.picture(&subject, c, 4.0).unwrap());
    assert_eq!(different(&plain, &culled), 0);
    drop(bench);
    headless.finish_silent();
}

#[test]
fn cameras_are_raced_in_turns() {
    let headless = headless();
    let cameras = vec![Camera::Fit, Camera::Clipped];
    let culled = Contestant { cull: Cull { frustum: true, ..Cull::NONE }, ..GREGORY };
    let all = [GREGORY, culled, floor(Path::Bilinear)];
    let rows = race(&headless, BenchOptions { cameras, ..options() }, "creature", &all);
    for rows in rows.chunks(6) {
        for (row, (camera, contestant)) in
            rows.iter().zip(Camera::ALL.iter().flat_map(|camera| all.iter().map(move |c| (camera, c))))
        {
            assert_eq!((row.camera, row.contestant, row.factor), (*camera, *contestant, rows[0].factor));
        }
        let counts = |row: &Row| (row.triangles.expect("lavapipe counts"), row.visible.expect("lavapipe counts"));
        let (made, visible) = counts(&rows[0]);
        assert_eq!(made, visible);
        assert_eq!(counts(&rows[1]), (made, made));
        let (clipped_made, clipped) = counts(&rows[3]);
        assert!(clipped_made == made && clipped > made / 10 && clipped < made * 3 / 4, "{clipped} of {made}");
        // Culling leaves out what is not seen, and nothing else.
        let (culled_made, culled) = counts(&rows[4]);
        assert!(culled == clipped && culled_made < made * 4 / 5, "{culled} of {culled_made}, {clipped} of {made}");
    }
    let none = Bench::new(&headless, BenchOptions { cameras: vec![], ..options() }).map(drop).unwrap_err();
    assert_eq!(none.to_string(), "BenchOptions::cameras is 0: it must be at least 1");
    headless.finish_silent();
}

#[test]
fn recording_is_timed_frame_by_frame() {
    let headless = headless();
    let bench = Bench::new(&headless, options()).unwrap();
    let subject = subject("creature");
    let of = |path, construction| Contestant::new(path, Some((Scheme::Gregory, construction)));
    for contestant in [
        GREGORY,
        of(Path::Tessellation, Construction::Cached),
        of(Path::Compute, Construction::Cached),
        of(Path::Instanced, Construction::Cached),
        Contestant { cull: Cull::ALL, ..of(Path::Instanced, Construction::Cached) },
        of(Path::Geometry, Construction::Stencil),
        of(Path::GeometryTwoPass, Construction::Cached),
        Contestant::new(Path::Subdivision, None),
    ] {
        let recordings = bench.recording(&subject, contestant, 3).unwrap();
        let crowds: Vec<Crowd> = recordings.iter().map(|recording| recording.crowd).collect();
        assert_eq!(crowds, [Crowd::Instances, Crowd::Models, Crowd::Moving]);
        for recording in &recordings {
            assert_eq!((recording.prepare.len(), recording.draw.len()), (6, 6));
            assert!(recording.draw.iter().all(|&ms| ms > 0.0));
        }
    }
    let error = |contestant, models| bench.recording(&subject, contestant, models).unwrap_err().to_string();
    assert_eq!(error(GREGORY, 0), "models is 0: it must be at least 1");
    assert_eq!(
        error(floor(Path::Bilinear), 1),
        "the path bilinear is not recorded by the renderer alone: measure one that is, such as tessellation or compute"
    );
    drop(bench);
    headless.finish_silent();
}

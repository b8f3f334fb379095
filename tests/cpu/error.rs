//! How far schemes are from the limit surface.
#![cfg(feature = "measure")]

use crate::common;
use ash_subdiv::measure::{ErrorOptions, FaceErrors, surface_errors};
use ash_subdiv::mesh::{ReadOptions, read};
use ash_subdiv::{ControlMesh, Scheme, shape};

fn errors(mesh: &ControlMesh, schemes: &[Scheme], options: &ErrorOptions) -> Vec<FaceErrors> {
    let report = surface_errors(mesh, schemes, options).unwrap();
    report.schemes.iter().map(|(_, result)| result.as_ref().unwrap().all).collect()
}

/// `../shared/reference/peers.md`, "One patch a face": root mean squares over all faces.
#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn reproduces_the_reference_table() {
    type Row = [(Scheme, f64, f64, f64); 3];
    const TABLE: [(&str, Row); 2] = [
        (
            "monsterfrog",
            [
                (Scheme::Acc, 0.390e-3, 0.0690e-3, 0.0131),
                (Scheme::Pm, 0.243e-3, 0.0336e-3, 0.0097),
                (Scheme::Gregory, 0.292e-3, 0.0360e-3, 0.0092),
            ],
        ),
        (
            "bigguy",
            [
                (Scheme::Acc, 0.297e-3, 0.0291e-3, 0.0095),
                (Scheme::Pm, 0.188e-3, 0.0223e-3, 0.0071),
                (Scheme::Gregory, 0.227e-3, 0.0235e-3, 0.0064),
            ],
        ),
    ];
    for (name, rows) in TABLE {
        let path = common::shared().join("meshes").join(name).with_extension("obj");
        let mesh = read(&path, &ReadOptions::default()).unwrap();
        let measured = errors(&mesh, &rows.map(|row| row.0), &ErrorOptions::default());
        for (errors, (scheme, position, nearest, normal)) in measured.into_iter().zip(rows) {
            let pairs = [
                ("position", errors.position.rms, position),
                ("nearest", errors.nearest.unwrap().rms, nearest),
                ("normal", errors.normal.rms, normal),
            ];
            for (what, measured, reference) in pairs {
                let ratio = measured / reference;
                assert!((ratio - 1.0).abs() < 0.05, "{name}, {scheme:?}, {what}: {measured} for {reference}");
            }
        }
    }
}

#[test]
fn regular_faces_are_exact() {
    let mesh = shape("torus").unwrap();
    let report = surface_errors(&mesh, &Scheme::ALL, &ErrorOptions { nearest: 2000, ..Default::default() }).unwrap();
    assert_eq!(report.irregular_patches, 0);
    for (scheme, result) in &report.schemes {
        let error = result.as_ref().unwrap();
        assert!(error.irregular.is_none(), "{scheme:?}");
        assert!(error.all.position.max < 1e-12 && error.all.normal.max < 1e-12, "{scheme:?}: {error:?}");
        // Both surfaces as triangles: half way between the corners of one there are chords.
        let nearest = error.all.nearest.unwrap();
        assert!(nearest.max < 1e-4 && nearest.rms > 0.0, "{scheme:?}: {nearest:?}");
        // That is what is measured of the limit surface itself.
        let floor = report.nearest_floor.unwrap();
        assert!((nearest.rms / floor.rms - 1.0).abs() < 1e-6, "{scheme:?}: {nearest:?} {floor:?}");
    }
}

/// Corners of patches are on the limit surface: the closer samples are to them, the smaller the error there.
#[test]
fn patches_meet_the_surface_at_corners() {
    for name in ["cube", "tetrahedron", "polygons"] {
        let mesh = shape(name).unwrap();
        let surface = ash_subdiv::limit::LimitSurface::new(&mesh).unwrap();
        let patches = ash_subdiv::table::CpuSurface::new(&mesh, Scheme::Gregory, 0).unwrap();
        let samples = patches.grid(&patches.control_points(|p| p), 2);
        for (origin, corners) in patches.origins().iter().zip(samples) {
            // A whole face, or the part around a corner.
            let vertex = mesh.face(origin.face)[origin.path().next().unwrap_or(0) as usize];
            let first = corners[0];
            let limit = surface.limit_vertex(vertex);
            assert!(first.position.distance(limit.position) < 1e-12, "{name}: {origin:?}");
            assert!(first.normal.distance(limit.normal) < 1e-9, "{name}: {origin:?}");
        }
    }
}

/// Parameters of a triangle's parts run to its own corners: mirrored or turned ones would give errors as large as faces.
#[test]
fn triangles_are_compared_where_they_are() {
    let mesh = shape("tetrahedron").unwrap();
    let error = errors(&mesh, &[Scheme::Gregory, Scheme::Pm], &ErrorOptions { nearest: 20_000, ..Default::default() });
    for error in error {
        let nearest = error.nearest.unwrap();
        assert!(error.position.max < 0.03 && nearest.rms < error.position.rms, "{error:?}");
    }
}

#[test]
fn is_the_same_on_any_number_of_threads() {
    let mesh = shape("cube").unwrap();
    let options = ErrorOptions { samples: 5, nearest: 500, ..ErrorOptions::default() };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| surface_errors(&mesh, &[Scheme::Gregory], &options).unwrap())
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn a_scheme_without_patches_says_so() {
    let mesh = shape("tetrahedron").unwrap();
    let options = ErrorOptions { samples: 2, nearest: 0, ..ErrorOptions::default() };
    let report = surface_errors(&mesh, &[Scheme::Acc, Scheme::Gregory], &options).unwrap();
    let error = report.schemes[0].1.as_ref().unwrap_err();
    assert_eq!((error.scheme, error.face, error.what), (Scheme::Acc, 0, "triangles"));
    assert!(report.schemes[1].1.as_ref().unwrap().all.position.rms > 0.0);
}

//! `subdiv watertight`, displacement and factors from the view.

use super::{fails, folder, json, keys, run};

#[test]
fn watertight_compares_every_way_to_draw() {
    let result = json("watertight --shape tetrahedron --side 64 --validation");
    assert_eq!(
        keys(&result),
        [
            "configurations",
            "device",
            "edges",
            "leaked_pixels",
            "mesh",
            "normal_mismatches",
            "position_mismatches",
            "samples"
        ]
    );
    assert_eq!((&result["edges"], &result["leaked_pixels"]), (&6.into(), &0.into()));
    assert_eq!((&result["position_mismatches"], &result["normal_mismatches"]), (&0.into(), &0.into()));
    let configurations = result["configurations"].as_array().expect("an array");
    let sum: u64 = configurations.iter().map(|c| c["samples"].as_u64().expect("a number")).sum();
    assert_eq!(result["samples"], sum);
    for (key, value) in [("displaced", true), ("culled", true), ("shared_normals", false)] {
        assert!(configurations.iter().any(|c| c[key] == value), "{key}");
    }
    // An open mesh has no inside to leak from.
    let open = json("watertight --shape fan --side 16 --samples 2e3");
    assert!(open["leaked_pixels"].is_null() && open["samples"].as_u64() >= Some(2000));
    fails(
        "watertight --shape cube --samples 1.5",
        2,
        "invalid value '1.5' for '--samples <PAIRS>': it must be a whole number, such as 1000000 or 1e6",
    );
}

// Longer than a screen: pictures that are compared with each other.
#[test]
fn pictures_are_displaced_and_cut_as_asked() {
    let folder = folder("displaced");
    let to = |name: &str| format!("-o {}", folder.join(name).display());
    let common = "render --shape creature --size 64x64 --samples 1";
    let plain = json(&format!("{common} {}", to("plain.png")));
    assert!(plain["statistics"].is_null() && plain["factor"] == 8.0, "{plain}");
    let adaptive = json(&format!(
        "{common} --pixels 2 --cull back,frustum,small --spacing odd --displacement scales {}",
        to("adaptive.png")
    ));
    let statistics = &adaptive["statistics"];
    assert_eq!(keys(statistics), ["factors_clamped", "largest_factor", "patches_culled", "patches_drawn"]);
    assert_eq!((&adaptive["factor"], &adaptive["pixels"]), (&serde_json::Value::Null, &2.0.into()));
    assert_eq!(statistics["factors_clamped"], false);
    // So near that edges want more segments than there are, and much is out of the picture.
    let near = json(&format!(
        "render --shape cube --size 512x512 --bend 0.0001 --cull frustum --eye 0.1,0.2,1.4 --target 0,0,0 {}",
        to("near.png")
    ));
    assert_eq!(near["statistics"]["factors_clamped"], true, "{near}");
    assert_ne!(std::fs::read(folder.join("plain.png")).unwrap(), std::fs::read(folder.join("adaptive.png")).unwrap());
    // Left out before the draws, for the same picture.
    let uniform_grid = |cull: &str, name: &str| json(&format!("{common} --evaluation instanced {cull} {}", to(name)));
    assert!(uniform_grid("", "all.png")["statistics"].is_null());
    let culled = uniform_grid("--cull back,frustum", "culled.png");
    assert!(culled["statistics"]["patches_culled"].as_u64() > Some(0), "{culled}");
    assert_eq!(std::fs::read(folder.join("all.png")).unwrap(), std::fs::read(folder.join("culled.png")).unwrap());

    let cases = [
        ("--shape creature --displacement missing.png", 1, "--displacement missing.png: No such file or directory"),
        (
            "--shape creature --displacement scales --displacement-scale much",
            2,
            "invalid value 'much' for '--displacement-scale <PART>': invalid float literal",
        ),
        (
            "--shape creature --displacement scales --displacement-scale nan",
            2,
            "--displacement-scale NaN: give a number",
        ),
        (
            "--shape creature --displacement scales --displacement-bias=-inf",
            2,
            "--displacement-bias -inf: give a number",
        ),
        ("--shape cube --displacement scales", 1, "the mesh has no texture coordinates"),
        ("--shape creature --scheme acc --displacement scales", 1, "choose gregory"),
        ("--shape creature --pixels 3 --factor 4", 2, "cannot be used with"),
        ("--shape creature --pixels 0", 2, "it must be a number above 0"),
        ("--shape creature --cull sides", 2, "[possible values: back, frustum, small]"),
        (
            "--shape creature --displacement scales --shading error-normal",
            2,
            "the error of a displaced surface is not known",
        ),
    ];
    for (arguments, code, message) in cases {
        let output = run(&format!("render {arguments} {}", to("no.png")));
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(stderr.starts_with("error: ") && stderr.contains(message), "{arguments}: {stderr}");
        assert_eq!((output.status.code(), stderr.lines().count()), (Some(code), 1), "{arguments}: {stderr}");
    }
    assert!(!folder.join("no.png").exists());
}

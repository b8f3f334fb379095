fn main() {
    println!("cargo:rustc-check-cfg=cfg(shared)");
    if std::path::Path::new("../shared/meshes").exists() {
        println!("cargo:rustc-cfg=shared");
    }
}

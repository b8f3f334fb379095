//! Compiles every shader below `glsl/` (and `src/cli/glsl/`, `tests/glsl/`) to SPIR-V with glslang, and writes the Rust
//! files that embed them: `shaders.rs` (included by `src/gpu/shaders.rs`), `cli_shaders.rs` (by the program) and
//! `test_shaders.rs` (by tests).
//!
//! A shader `evaluate/gregory_quad.tese` becomes the constant `EVALUATE_GREGORY_QUAD_TESE`. A line such as
//!
//! ```glsl
//! // variants: CAPTURE, CAPTURE+TEXCOORD, RINGS=2
//! ```
//!
//! among the first lines of a shader asks for further compiles with those macros defined, embedded as
//! `EVALUATE_GREGORY_QUAD_TESE_CAPTURE`, `..._CAPTURE_TEXCOORD` and `..._RINGS_2`. `each+FAST` asks for each variant that was named
//! before once more, with `FAST` besides.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

const STAGES: [&str; 6] = ["vert", "tesc", "tese", "geom", "frag", "comp"];
/// How many lines at the top of a shader are searched for `// variants:`.
const HEADER_LINES: usize = 24;

/// One compile: a shader file with a set of macros.
struct Job {
    source: PathBuf,
    defines: Vec<String>,
    /// The Rust constant; in lower case also the name of the SPIR-V file.
    constant: String,
}

fn main() {
    if let Err(message) = build() {
        eprintln!("\n{message}\n");
        exit(1);
    }
}

fn build() -> Result<(), String> {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-env-changed=GLSLANG");
    println!("cargo:rustc-check-cfg=cfg(shared)");
    // Test data beside the repository; tests that need it are ignored where it is absent.
    if Path::new("../shared/meshes").is_dir() {
        println!("cargo:rustc-cfg=shared");
        println!("cargo:rerun-if-changed=../shared/README.md");
    }

    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: run this through cargo")?);
    embed(Path::new("glsl"), &out, "shaders.rs")?;
    embed(Path::new("src/cli/glsl"), &out, "cli_shaders.rs")?;
    embed(Path::new("tests/glsl"), &out, "test_shaders.rs")
}

/// Compiles all shaders below `root` and writes the Rust file that embeds them.
fn embed(root: &Path, out: &Path, rust_file: &str) -> Result<(), String> {
    let mut jobs = Vec::new();
    if root.is_dir() {
        // The directory itself, so that a new file is seen; the files named by the depfiles follow below.
        println!("cargo:rerun-if-changed={}", root.display());
        collect(root, root, &mut jobs)?;
    }
    jobs.sort_by(|a, b| a.constant.cmp(&b.constant));
    if let Some(pair) = jobs.windows(2).find(|pair| pair[0].constant == pair[1].constant) {
        let [a, b] = [&pair[0], &pair[1]].map(|job| job.source.display());
        return Err(format!("{a} and {b} would both be embedded as {}: rename one", pair[0].constant));
    }

    // docs.rs has no shader compiler, and documentation needs none. Nor do lints, for which Cargo keeps a folder of its own.
    let lints = env::var("RUSTC_WORKSPACE_WRAPPER").is_ok_and(|wrapper| wrapper.contains("clippy-driver"));
    let compiled = env::var_os("DOCS_RS").is_none() && !lints;
    let spirv = out.join(rust_file.trim_end_matches(".rs"));
    fs::create_dir_all(&spirv).map_err(|error| format!("{}: {error}", spirv.display()))?;
    if compiled && !jobs.is_empty() {
        compile_all(&jobs, &spirv)?;
    }

    let mut rust = String::from("// Written by build.rs.\n");
    for Job { source, constant, defines } in &jobs {
        let with = if defines.is_empty() { String::new() } else { format!(" with {}", defines.join(", ")) };
        let value = if compiled {
            let path = spirv.join(file_name(constant));
            let bytes = fs::metadata(&path).map_err(|error| format!("{}: {error}", path.display()))?.len();
            // By value, so the alignment of the bytes does not matter.
            format!(
                "&unsafe {{ core::mem::transmute::<[u8; {bytes}], [u32; {}]>(*include_bytes!({path:?})) }}",
                bytes / 4
            )
        } else {
            "&[]".to_owned()
        };
        let _ = writeln!(rust, "/// SPIR-V of `{}`{with}.\npub static {constant}: &[u32] = {value};", source.display());
    }
    // The jobs are sorted by their constants, so these can be searched.
    let names: String = jobs.iter().map(|job| format!("({:?}, {}), ", job.constant, job.constant)).collect();
    let _ = writeln!(rust, "/// All of them by name, in order.\npub static ALL: &[(&str, &[u32])] = &[{names}];");
    let path = out.join(rust_file);
    fs::write(&path, rust).map_err(|error| format!("{}: {error}", path.display()))
}

/// Finds the shaders below `directory` and the variants they ask for.
fn collect(root: &Path, directory: &Path, jobs: &mut Vec<Job>) -> Result<(), String> {
    let error = |error| format!("{}: {error}", directory.display());
    for entry in fs::read_dir(directory).map_err(error)? {
        let path = entry.map_err(error)?.path();
        if path.is_dir() {
            collect(root, &path, jobs)?;
            continue;
        }
        if !path.extension().is_some_and(|extension| STAGES.iter().any(|stage| extension == *stage)) {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = constant_name(&path.strip_prefix(root).unwrap_or(&path).to_string_lossy());
        jobs.push(Job { source: path.clone(), defines: Vec::new(), constant: name.clone() });
        for variant in variants(&text) {
            jobs.push(Job {
                source: path.clone(),
                defines: variant.split('+').map(|define| define.trim().to_owned()).collect(),
                constant: format!("{name}_{}", constant_name(&variant)),
            });
        }
    }
    Ok(())
}

fn variants(text: &str) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    let lists = text.lines().take(HEADER_LINES).filter_map(|line| line.trim().strip_prefix("// variants:"));
    for variant in lists.flat_map(|list| list.split(',').map(str::trim).filter(|variant| !variant.is_empty())) {
        match variant.strip_prefix("each+") {
            Some(more) => all.extend(all.iter().map(|before| format!("{before}+{more}")).collect::<Vec<_>>()),
            None => all.push(variant.to_owned()),
        }
    }
    all
}

fn constant_name(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' }).collect()
}

fn file_name(constant: &str) -> String {
    format!("{}.spv", constant.to_ascii_lowercase())
}

/// Runs the jobs on all cores; reports every shader that fails, not only the first.
fn compile_all(jobs: &[Job], spirv: &Path) -> Result<(), String> {
    let compiler = find_compiler()?;
    let validate = runs("spirv-val");
    let next = AtomicUsize::new(0);
    let errors = Mutex::new(Vec::new());
    let dependencies = Mutex::new(BTreeSet::new());
    let threads = thread::available_parallelism().map_or(1, usize::from).min(jobs.len());
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match compile(&compiler, validate, job, spirv) {
                        Ok(found) => dependencies.lock().unwrap().extend(found),
                        Err(error) => errors.lock().unwrap().push(error),
                    }
                }
            });
        }
    });
    for path in dependencies.into_inner().unwrap() {
        println!("cargo:rerun-if-changed={path}");
    }
    let mut errors = errors.into_inner().unwrap();
    errors.sort();
    if errors.is_empty() { Ok(()) } else { Err(errors.join("\n\n")) }
}

/// Compiles one shader; returns the files it was made from.
fn compile(compiler: &str, validate: bool, job: &Job, spirv: &Path) -> Result<Vec<String>, String> {
    let output = spirv.join(file_name(&job.constant));
    let depfile = output.with_extension("d");
    let defines: Vec<String> = job.defines.iter().map(|define| format!("-D{define}")).collect();
    let what = [vec![job.source.display().to_string()], defines.clone()].concat().join(" ");

    let mut glslang = Command::new(compiler);
    // SPIR-V 1.5: 1.6 would have compute shaders need the feature maintenance4.
    glslang.args(["-V", "--target-env", "vulkan1.2", "--quiet", "-Iglsl/lib", "--depfile"]).arg(&depfile);
    glslang.args(&defines).arg("-o").arg(&output).arg(&job.source);
    run(&mut glslang).map_err(|error| format!("{what}: does not compile\n{error}"))?;
    if validate {
        let mut spirv_val = Command::new("spirv-val");
        run(spirv_val.args(["--target-env", "vulkan1.2"]).arg(&output))
            .map_err(|error| format!("{what}: compiles to invalid SPIR-V\n{error}"))?;
    }

    // "output: file file ..."
    let rule = fs::read_to_string(&depfile).map_err(|error| format!("{}: {error}", depfile.display()))?;
    let files = rule.split_once(": ").map_or("", |(_, files)| files);
    Ok(files.split_whitespace().map(str::to_owned).collect())
}

fn run(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|error| format!("{:?}: {error}", command.get_program()))?;
    if output.status.success() {
        return Ok(());
    }
    Err([output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).trim().to_owned()).join("\n"))
}

fn find_compiler() -> Result<String, String> {
    if let Ok(compiler) = env::var("GLSLANG") {
        return match runs(&compiler) {
            true => Ok(compiler),
            false => Err(format!("GLSLANG is {compiler:?}, which does not run: set it to a glslang binary")),
        };
    }
    let known = ["glslangValidator", "glslang"];
    known.into_iter().find(|name| runs(name)).map(str::to_owned).ok_or_else(|| {
        "ash-subdiv compiles its shaders with glslang, and found neither glslangValidator nor glslang: \
         install it (Debian and Ubuntu: apt install glslang-tools), or name the binary in GLSLANG"
            .to_owned()
    })
}

fn runs(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok_and(|output| output.status.success())
}

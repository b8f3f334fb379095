//! Compiles the shaders below `glsl/` to SPIR-V with glslang, and writes the Rust files that embed them.
//!
//! * The renderer's: one for each combination that `src/renderer/shader/axes.rs` names, as the enum `ShaderId` (`shaders.rs`).
//! * Those of tools and tests, in folders of their own (`bench_shaders.rs`, `measure_shaders.rs`, `cli_shaders.rs`,
//!   `test_shaders.rs`): `quad_patch.tese` becomes the constant `QUAD_PATCH_TESE`, and a line such as `// variants: ODD, EVEN` among
//!   its first ones asks for further compiles with those macros defined, embedded as `QUAD_PATCH_TESE_ODD` and so on.

use axes::ShaderKey;
use form::PatchForm;
use sharing::Sharing;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, exit};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, thread};

#[allow(dead_code, reason = "what is left is for the renderer")]
#[path = "src/renderer/shader/axes.rs"]
mod axes;
#[path = "src/patch/form.rs"]
mod form;
#[path = "src/named.rs"]
mod named;
#[allow(dead_code, reason = "what is left is for tables")]
#[path = "src/table/sharing.rs"]
mod sharing;

const STAGES: [&str; 6] = ["vert", "tesc", "tese", "geom", "frag", "comp"];
/// Lines at the top of a shader that are searched for `// variants:`.
const HEADER_LINES: usize = 24;

/// One compile of a shader file.
struct Job {
    source: PathBuf,
    arguments: Vec<String>,
    /// Of the SPIR-V file; in upper case the constant of shaders that are none of the renderer's.
    name: String,
}

fn main() {
    if let Err(message) = build() {
        eprintln!("\n{message}\n");
        exit(1);
    }
}

fn build() -> Result<(), String> {
    println!("cargo:rerun-if-changed=build.rs");
    for source in ["named.rs", "patch/form.rs", "renderer/shader/axes.rs", "table/sharing.rs"] {
        println!("cargo:rerun-if-changed=src/{source}");
    }
    println!("cargo:rerun-if-env-changed=GLSLANG");
    println!("cargo:rustc-check-cfg=cfg(shared)");
    // Test data beside the repository; tests that need it are ignored where it is absent.
    if Path::new("../shared/meshes").is_dir() {
        println!("cargo:rustc-cfg=shared");
        println!("cargo:rerun-if-changed=../shared/README.md");
    }

    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: run this through cargo")?);
    let has = |feature: &str| env::var_os(format!("CARGO_FEATURE_{feature}")).is_some();
    println!("cargo:rerun-if-changed=glsl");
    write(&out.join("constants.rs"), &constants("glsl/lib/constants.glsl")?)?;
    let keys: Vec<_> = ShaderKey::all().into_iter().filter(|key| has("HEADLESS") || !key.is_for_tools()).collect();
    let jobs: Vec<Job> = keys.iter().map(|&key| job(key)).collect();
    let spirv = compile_all(&jobs, &out.join("shaders"))?;
    write(&out.join("shaders.rs"), &shader_ids(&keys, &jobs, spirv.as_deref())?)?;

    let bench = ["-Iglsl/lib", "-Iglsl/schemes/acc"];
    let measures = has("MEASURE") && has("HEADLESS");
    for (wanted, root, rust_file, arguments) in [
        (measures, "glsl/bench", "bench_shaders.rs", &bench[..]),
        (measures, "glsl/measure", "measure_shaders.rs", &bench[..1]),
        (has("CLI"), "src/cli/glsl", "cli_shaders.rs", &bench[..1]),
        (has("HEADLESS"), "tests/glsl", "test_shaders.rs", &bench[..1]),
    ] {
        if wanted {
            embed(Path::new(root), &out, rust_file, arguments)?;
        }
    }
    Ok(())
}

/// The Rust file of the numbers that a GLSL file defines, each in a line such as `#define REGION 128u`.
fn constants(path: &str) -> Result<String, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let mut rust = String::from("// Written by build.rs.\n");
    for line in text.lines() {
        let Some((name, value)) = line.strip_prefix("#define ").and_then(|rest| rest.split_once(' ')) else { continue };
        let value = value.strip_suffix('u').ok_or_else(|| format!("{path}: {name} is no unsigned number"))?;
        let _ = writeln!(rust, "pub const {name}: u32 = {value};");
    }
    Ok(rust)
}

/// The compile of one of the renderer's shaders.
fn job(key: ShaderKey) -> Job {
    let source = key.source.name();
    let words = [vec![source.to_owned()], key.words()].concat().join("_");
    let name = words.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    Job { source: Path::new("glsl").join(source), arguments: key.arguments(), name }
}

/// The Rust file of the renderer's shaders.
fn shader_ids(keys: &[ShaderKey], jobs: &[Job], spirv: Option<&Path>) -> Result<String, String> {
    let (mut variants, mut ids, mut codes, mut names) = Default::default();
    let (mut sources, mut arguments) = (String::new(), String::new());
    let line = |text: &mut String, line: std::fmt::Arguments| writeln!(text, "{line}").map_err(|e| e.to_string());
    let mut all = String::new();
    for (key, job) in keys.iter().zip(jobs) {
        let variant = variant_name(&job.name);
        let ShaderKey { source, patch, sharing, output, attributes, level } = key;
        let with = job.arguments.join(" ");
        line(&mut variants, format_args!("/// `{}` with `{with}`.\n{variant},", job.source.display()))?;
        let key = format!(
            "ShaderKey {{ source: Source::{source:?}, patch: PatchForm::{patch:?}, sharing: Sharing::{sharing:?}, \
             output: Output::{output:?}, attributes: {attributes}, level: {level} }}"
        );
        line(&mut ids, format_args!("{key} => ShaderId::{variant},"))?;
        line(&mut codes, format_args!("Self::{variant} => {},", words_of(spirv, &job.name)?))?;
        line(&mut names, format_args!("Self::{variant} => {:?},", job.name))?;
        line(&mut sources, format_args!("Self::{variant} => {:?},", job.source.display().to_string()))?;
        line(&mut arguments, format_args!("Self::{variant} => &{:?},", job.arguments))?;
        line(&mut all, format_args!("Self::{variant},"))?;
    }
    Ok(format!(
        "// Written by build.rs.
/// A shader of the renderer, by its source and what that is compiled with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ShaderId {{\n{variants}}}
impl ShaderId {{
    /// All shaders, in order.
    pub const ALL: &'static [Self] = &[{all}];
    /// The SPIR-V.
    pub fn code(self) -> &'static [u32] {{ match self {{\n{codes}}} }}
    /// The name in messages.
    pub const fn name(self) -> &'static str {{ match self {{\n{names}}} }}
    /// The source, in the crate's folder.
    pub const fn source(self) -> &'static str {{ match self {{\n{sources}}} }}
    /// What glslang is told to compile it, besides `-V --target-env vulkan1.2`, in the crate's folder.
    pub const fn arguments(self) -> &'static [&'static str] {{ match self {{\n{arguments}}} }}
}}
impl ShaderKey {{
    /// The shader with this key, if there is one.
    pub(crate) const fn id(self) -> Option<ShaderId> {{
        Some(match self {{\n{ids}_ => return None }})
    }}
}}\n"
    ))
}

/// `evaluate_uniform_grid_vert` as the name of an enum's variant.
fn variant_name(name: &str) -> String {
    let capital = |word: &str| word[..1].to_ascii_uppercase() + &word[1..];
    name.split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

/// Compiles all shaders below `root`, and writes the Rust file that embeds them.
fn embed(root: &Path, out: &Path, rust_file: &str, arguments: &[&str]) -> Result<(), String> {
    let mut jobs = Vec::new();
    if root.is_dir() {
        println!("cargo:rerun-if-changed={}", root.display());
        collect(root, root, arguments, &mut jobs)?;
    }
    jobs.sort_by(|a, b| a.name.cmp(&b.name));
    if let Some(pair) = jobs.windows(2).find(|pair| pair[0].name == pair[1].name) {
        let [a, b] = [&pair[0], &pair[1]].map(|job| job.source.display());
        return Err(format!("{a} and {b} would both be embedded as {}: rename one", pair[0].name));
    }
    let spirv = compile_all(&jobs, &out.join(rust_file.trim_end_matches(".rs")))?;
    let mut rust = String::from("// Written by build.rs.\n");
    for Job { source, arguments, name } in &jobs {
        let (constant, value) = (name.to_ascii_uppercase(), words_of(spirv.as_deref(), name)?);
        let with = arguments.join(" ");
        let source = source.display();
        let _ = writeln!(rust, "/// SPIR-V of `{source}` with `{with}`.\npub static {constant}: &[u32] = {value};");
    }
    write(&out.join(rust_file), &rust)
}

/// The Rust expression of the words of a compiled shader.
fn words_of(spirv: Option<&Path>, name: &str) -> Result<String, String> {
    let Some(folder) = spirv else { return Ok("&[]".to_owned()) };
    let path = folder.join(format!("{name}.spv"));
    let bytes = fs::metadata(&path).map_err(|error| format!("{}: {error}", path.display()))?.len();
    // By value, so the alignment of the bytes does not matter.
    let words = bytes / 4;
    Ok(format!(
        "{{ static CODE: [u32; {words}] = unsafe {{ core::mem::transmute::<[u8; {bytes}], [u32; {words}]>(*include_bytes!({path:?})) }}; &CODE }}"
    ))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Finds the shaders below `directory` and the variants that they ask for.
fn collect(root: &Path, directory: &Path, arguments: &[&str], jobs: &mut Vec<Job>) -> Result<(), String> {
    let error = |error| format!("{}: {error}", directory.display());
    for entry in fs::read_dir(directory).map_err(error)? {
        let path = entry.map_err(error)?.path();
        if path.is_dir() {
            collect(root, &path, arguments, jobs)?;
            continue;
        }
        if !path.extension().is_some_and(|extension| STAGES.iter().any(|stage| extension == *stage)) {
            continue;
        }
        let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let name = file_name(&path.strip_prefix(root).unwrap_or(&path).to_string_lossy());
        let mut add = |name: String, defines: &[&str]| {
            let defines = defines.iter().map(|define| format!("-D{define}"));
            let arguments = arguments.iter().map(|&argument| argument.to_owned()).chain(defines).collect();
            jobs.push(Job { source: path.clone(), arguments, name });
        };
        add(name.clone(), &[]);
        for variant in variants(&text) {
            add(format!("{name}_{}", file_name(variant)), &variant.split('+').map(str::trim).collect::<Vec<_>>());
        }
    }
    Ok(())
}

fn variants(text: &str) -> Vec<&str> {
    let lists = text.lines().take(HEADER_LINES).filter_map(|line| line.trim().strip_prefix("// variants:"));
    lists.flat_map(|list| list.split(',').map(str::trim).filter(|variant| !variant.is_empty())).collect()
}

fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect()
}

/// Runs the jobs on all cores; reports every shader that fails, not only the first. Gives the folder of the SPIR-V, or none where
/// none is needed: docs.rs has no shader compiler, and documentation needs none; nor do lints, for which Cargo keeps a folder of
/// its own.
fn compile_all(jobs: &[Job], spirv: &Path) -> Result<Option<PathBuf>, String> {
    let lints = env::var("RUSTC_WORKSPACE_WRAPPER").is_ok_and(|wrapper| wrapper.contains("clippy-driver"));
    if env::var_os("DOCS_RS").is_some() || lints || jobs.is_empty() {
        return Ok(None);
    }
    fs::create_dir_all(spirv).map_err(|error| format!("{}: {error}", spirv.display()))?;
    let compiler = find_compiler()?;
    let next = AtomicUsize::new(0);
    let errors = Mutex::new(Vec::new());
    let dependencies = Mutex::new(BTreeSet::new());
    let threads = thread::available_parallelism().map_or(1, usize::from).min(jobs.len());
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    match compile(&compiler, job, spirv) {
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
    if errors.is_empty() { Ok(Some(spirv.to_owned())) } else { Err(errors.join("\n\n")) }
}

/// Compiles one shader; returns the files it was made from.
fn compile(compiler: &str, job: &Job, spirv: &Path) -> Result<Vec<String>, String> {
    let output = spirv.join(format!("{}.spv", job.name));
    let depfile = output.with_extension("d");
    let what = format!("{} {}", job.source.display(), job.arguments.join(" "));

    let mut glslang = Command::new(compiler);
    // SPIR-V 1.5: 1.6 would have compute shaders need the feature maintenance4.
    glslang.args(["-V", "--target-env", "vulkan1.2", "--quiet", "--depfile"]).arg(&depfile);
    let release = env::var("PROFILE").is_ok_and(|profile| profile == "release");
    if release && env::var_os("CARGO_FEATURE_HEADLESS").is_none() {
        // Without the names that debuggers and tests look at.
        glslang.arg("-g0");
    }
    glslang.args(&job.arguments).arg("-o").arg(&output).arg(&job.source);
    run(&mut glslang).map_err(|error| format!("{what}: does not compile\n{error}"))?;

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

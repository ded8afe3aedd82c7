//! Compiles texts into one program and runs it.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// A text with the name of its program.
pub struct Program {
    /// The name.
    pub name: String,
    /// The text.
    pub text: String,
}

/// Programs that the graphs of a batch are divided among.
const PARTS: usize = 2;

const MANIFEST: &str = r#"[package]
name = "apex-oracle-run"
version = "0.0.0"
edition = "2024"

[workspace]

[profile.dev]
debug = false
incremental = false

[profile.dev.build-override]
opt-level = 2
debug = false

[profile.dev.package.apex-dsl]
opt-level = 2

[dependencies]
apex-rt = { path = "ROOT/apex-rt", features = ["std"] }
apex-tests = { path = "ROOT/tests" }
"#;

const MAIN: &str = r#"use apex_rt::prelude::*;
use apex_tests::oracle::{note, take_notes};

GRAPHS

struct Recorder;

impl Observer for Recorder {
    fn fired(&mut self, node: usize) {
        note(format_args!("F {node}"));
    }
    fn handled(&mut self, connection: usize) {
        note(format_args!("H {connection}"));
    }
    fn activity(&mut self, node: usize, active: bool) {
        note(format_args!("A {node} {}", u8::from(active)));
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        note(format_args!("endless: {nodes:?} {counts:?}"));
    }
}

#[allow(dead_code, reason = "a part may have no graph")]
fn record<P: Program>(mut program: P, threads: bool) {
    for reaction in 0..10 {
        let now = Time::from_nanos(reaction * 1_000_000);
        note(format_args!("R {}", now.as_nanos()));
        if threads {
            apex_rt::threads::react_on_threads(&mut program, now, |_| Recorder);
        } else {
            program.react_with(now, &mut Recorder);
        }
        note(format_args!("E"));
    }
    println!("{}# end", take_notes());
}

fn main() {
    let threads = std::env::args().nth(1).is_some();
    RUNS
}
"#;

/// How a program with several thread groups runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// One group after the other, on one thread.
    InTurn,
    /// Each on a thread of its own.
    OnThreads,
}

/// The record of each program.
///
/// # Errors
/// If they cannot be compiled, or if one of them does not come to its end.
pub fn run(folder: &str, programs: &[Program], how: How) -> Result<Vec<String>, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    let target = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("oracle");
    // Programs of several folders lie side by side in one target folder.
    let part_name = |part: usize| format!("{folder}-{part}");
    let folder = target.join(folder);
    fs::create_dir_all(folder.join("src/bin")).map_err(|e| e.to_string())?;
    let write = |path: PathBuf, text: &str| match fs::read_to_string(&path) {
        Ok(old) if old == text => Ok(()),
        _ => fs::write(&path, text).map_err(|e| format!("cannot write `{}`: {e}", path.display())),
    };
    // Cargo compiles the parts side by side.
    let size = programs.len().div_ceil(PARTS).max(1);
    for part in 0..PARTS {
        let (mut graphs, mut runs) = (String::new(), String::new());
        for program in programs.iter().skip(part * size).take(size) {
            let file = folder.join(format!("{}.afg", program.name));
            write(file.clone(), &program.text)?;
            let module = program.name.to_lowercase();
            graphs.push_str(&format!("mod {module} {{\n    use apex_rt::prelude::*;\n    graph!({file:?});\n}}\n"));
            runs.push_str(&format!("record({module}::{}::new(), threads);\n    ", program.name));
        }
        let main = MAIN.replace("GRAPHS", &graphs).replace("RUNS", &runs);
        write(folder.join(format!("src/bin/{}.rs", part_name(part))), &main)?;
    }
    write(folder.join("Cargo.toml"), &MANIFEST.replace("ROOT", &root.display().to_string()))?;
    if !folder.join("Cargo.lock").exists() {
        fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).map_err(|e| e.to_string())?;
    }
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--offline", "--quiet", "--manifest-path"])
        .arg(folder.join("Cargo.toml"))
        .arg("--target-dir")
        .arg(target.join("target"))
        .env_remove("RUSTFLAGS")
        .output()
        .map_err(|e| format!("cannot run cargo: {e}"))?;
    if !built.status.success() {
        return Err(format!("it does not compile:\n{}", String::from_utf8_lossy(&built.stderr)));
    }
    let mut traces: Vec<String> = vec![];
    for part in 0..PARTS {
        let ran = Command::new(target.join(format!("target/debug/{}", part_name(part))))
            .args((how == How::OnThreads).then_some("threads"))
            .output()
            .map_err(|e| format!("cannot run the program: {e}"))?;
        if !ran.status.success() {
            return Err(format!("it does not run to its end: {}", String::from_utf8_lossy(&ran.stderr)));
        }
        let text = String::from_utf8_lossy(&ran.stdout);
        traces.extend(text.split_inclusive("# end\n").map(|t| t.replace("# end\n", "")));
    }
    match traces.len() == programs.len() {
        true => Ok(traces),
        false => Err("it does not run to its end".to_owned()),
    }
}

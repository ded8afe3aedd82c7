//! Costs of compilation: checks, a rebuild after an edit, large graphs of one kind.

mod commands;
mod edited;
mod growth;

use crate::report::met;
use commands::{cargo, cpu_seconds, output};
use edited::Edited;
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
    time::{Duration, Instant},
};

/// Goal: time of a check of 1000 nodes with the cache of the previous check.
const CHECK: Duration = Duration::from_millis(100);
/// Goal: CPU time in s of a rebuild of 50 nodes in a debug build.
const REBUILD: f64 = 2.0;

/// Measures and prints all costs.
pub fn run() -> Result<ExitCode, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("the package has no workspace")?;
    cargo(root, &["build", "--quiet", "--release", "-p", "apex-cli"])?;
    let apex = env::current_exe().map_err(|e| e.to_string())?.with_file_name("apex");
    check(&apex, root)?;
    rebuild(root)?;
    growth::run(&apex, root)?;
    Ok(ExitCode::SUCCESS)
}

fn check(apex: &Path, root: &Path) -> Result<(), String> {
    let graph = graph("chain1000.afg");
    let timed = || {
        let start = Instant::now();
        output(Command::new(apex).arg("check").arg(&graph)).map(|_| start.elapsed())
    };
    // The folder is only a cache, which is created again when needed.
    let _ = fs::remove_dir_all(root.join("target/apex"));
    let cold = timed()?;
    let mut warm = (0..11).map(|_| timed()).collect::<Result<Vec<_>, _>>()?;
    warm.sort();
    let warm = warm[warm.len() / 2];
    println!("check of chain1000, cold: {:.0} ms", cold.as_secs_f64() * 1e3);
    println!(
        "check of chain1000, warm: {:.0} ms (goal {} ms): {}",
        warm.as_secs_f64() * 1e3,
        CHECK.as_millis(),
        met(warm <= CHECK)
    );
    Ok(())
}

/// Builds the robot, changes one number in its source file, builds it again, and restores the source file.
fn rebuild(root: &Path) -> Result<(), String> {
    const BUILD: [&str; 6] = ["build", "--quiet", "-p", "apex-bench", "--example", "robot50"];
    cargo(root, &BUILD)?;
    let mut seconds = vec![];
    for edit in 0..3 {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/robot50.afg");
        let edited = Edited::new(path, |text| text.replace("op(k = 4)", &format!("op(k = {})", 1000 + edit)))?;
        let before = cpu_seconds()?;
        cargo(root, &BUILD)?;
        seconds.push(cpu_seconds()? - before);
        drop(edited);
    }
    seconds.sort_by(f64::total_cmp);
    let median = seconds[seconds.len() / 2];
    println!("rebuild of robot50 after an edit: {median:.2} CPU s (goal {REBUILD} s): {}", met(median <= REBUILD));
    Ok(())
}

fn graph(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs").join(name)
}

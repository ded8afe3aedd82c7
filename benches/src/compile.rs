//! Costs of compilation: checks, a rebuild after an edit, large graphs of one kind.

mod growth;

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode, Stdio},
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

/// A file with a change, which is undone when the value is dropped.
struct Edited {
    path: PathBuf,
    original: String,
}

impl Edited {
    fn new(path: PathBuf, edit: impl Fn(&str) -> String) -> Result<Self, String> {
        let failed = |e| format!("cannot edit `{}`: {e}", path.display());
        let original = fs::read_to_string(&path).map_err(failed)?;
        fs::write(&path, edit(&original)).map_err(failed)?;
        Ok(Self { path, original })
    }
}

impl Drop for Edited {
    fn drop(&mut self) {
        if let Err(e) = fs::write(&self.path, &self.original) {
            eprintln!("error: cannot restore `{}`: {e}", self.path.display());
        }
    }
}

/// User and system time in s of all children that have ended (Linux).
fn cpu_seconds() -> Result<f64, String> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").map_err(|e| format!("CPU time needs Linux: {e}"))?;
    // Fields 16 and 17; the name in field 2 may contain blanks.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks: f64 = fields.get(13..15).unwrap_or_default().iter().filter_map(|f| f.parse::<f64>().ok()).sum();
    Ok(ticks / TICKS_PER_SECOND)
}

fn graph(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs").join(name)
}

fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    output(Command::new(env!("CARGO")).args(arguments).current_dir(root)).map(|_| ())
}

fn output(command: &mut Command) -> Result<String, String> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|e| format!("cannot run {command:?}: {e}"))?;
    if !output.status.success() {
        return Err(format!("{command:?} failed"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn met(yes: bool) -> &'static str {
    if yes { "met" } else { "missed" }
}

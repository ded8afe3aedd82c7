//! Commands, and the time that they take.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

/// Runs Cargo in a folder.
pub fn cargo(root: &Path, arguments: &[&str]) -> Result<(), String> {
    output(Command::new(env!("CARGO")).args(arguments).current_dir(root)).map(|_| ())
}

/// Runs a command, and returns what it has written.
pub fn output(command: &mut Command) -> Result<String, String> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|e| format!("cannot run {command:?}: {e}"))?;
    if !output.status.success() {
        return Err(format!("{command:?} failed"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// User and system time in s of all children that have ended (Linux).
pub fn cpu_seconds() -> Result<f64, String> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = fs::read_to_string("/proc/self/stat").map_err(|e| format!("CPU time needs Linux: {e}"))?;
    // Fields 16 and 17; the name in field 2 may contain blanks.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
    let ticks: f64 = fields.get(13..15).unwrap_or_default().iter().filter_map(|f| f.parse::<f64>().ok()).sum();
    Ok(ticks / TICKS_PER_SECOND)
}

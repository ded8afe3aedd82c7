//! `apex completions`: scripts by which a shell completes the command.

use crate::{Arguments, project};
use clap::CommandFactory as _;
use clap_complete::{Shell, generate};
use std::process::ExitCode;

/// Prints the script for `shell`.
pub fn run(shell: Shell) -> Result<ExitCode, String> {
    let mut script = vec![];
    generate(shell, &mut Arguments::command(), "apex", &mut script);
    let script = String::from_utf8(script).map_err(|e| format!("the script is not UTF-8: {e}"))?;
    project::print(script.trim_end())?;
    Ok(ExitCode::SUCCESS)
}

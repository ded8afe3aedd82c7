//! Runs PATSY in search of containers: in a simulated room, or on recorded scans. Sub-commands measure its parts.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    apex_sim::experiment::run_commands(&command::COMMANDS)
}

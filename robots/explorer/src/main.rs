//! Runs the robot that explores a field, and tells what it found.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    apex_sim::experiment::run_commands(&command::COMMANDS)
}

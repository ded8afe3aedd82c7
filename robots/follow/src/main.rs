//! Runs the robot that follows a runner, and tells what became of it.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    apex_sim::experiment::run_commands(&command::COMMANDS)
}

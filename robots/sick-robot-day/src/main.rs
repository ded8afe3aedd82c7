//! Runs and evaluates the robot of the SICK Robot Day in the simulated competition.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    apex_sim::experiment::run_commands(&command::COMMANDS)
}

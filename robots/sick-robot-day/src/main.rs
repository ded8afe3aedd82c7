//! Runs and evaluates the robot of the SICK Robot Day in the simulated competition.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    command::Command::read(std::env::args_os().skip(1)).and_then(command::Command::run).unwrap_or_else(|message| {
        eprintln!("error: {message}");
        ExitCode::from(2)
    })
}

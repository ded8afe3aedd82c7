//! Runs the robot that follows a runner, and tells what became of it.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    command::run().unwrap_or_else(|message| {
        eprintln!("error: {message}");
        ExitCode::from(2)
    })
}

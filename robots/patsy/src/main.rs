//! Runs PATSY in search of containers: in a simulated room, or on recorded scans. Sub-commands measure its parts.

mod command;

use std::process::ExitCode;

fn main() -> ExitCode {
    command::run().unwrap_or_else(|message| {
        eprintln!("error: {message}");
        ExitCode::from(2)
    })
}

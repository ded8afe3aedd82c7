//! Measures the robot of the SICK Robot Day.

use sick_robot_day::{
    Eyes,
    measure::{Album, Progress, cubes, signs, targets},
};
use std::{
    io::{self, Write as _},
    path::PathBuf,
    process::ExitCode,
};

const HELP: &str = "\
The robot of the SICK Robot Day 2014, in simulation.

Usage: sick-robot-day perception [--seeds N] [--out FOLDER]

`perception` measures how well the robot finds targets, reads number signs and sees cubes, on rendered images.

  --seeds N     so many arenas, of the seeds 1 to N (default 50)
  --out FOLDER  a new or empty folder for pictures of what was seen with seed 1
  --help        this text

Exit codes: 0 fine, 2 it could not be done.
";

enum Command {
    Help,
    Perception { seeds: u64, out: Option<PathBuf> },
}

fn main() -> ExitCode {
    match command().and_then(run) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn command() -> Result<Command, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_env();
    let (mut named, mut seeds, mut out) = (false, 50, None);
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("help") | Short('h') => return Ok(Command::Help),
            Value(name) if !named && name == "perception" => named = true,
            Long("seeds") => {
                let value = parser.value().map_err(|e| e.to_string())?;
                let count = value.to_str().and_then(|text| text.parse().ok()).filter(|count| *count > 0);
                seeds =
                    count.ok_or_else(|| format!("`--seeds` is a whole number from 1, not `{}`", value.display()))?;
            }
            Long("out") => out = Some(parser.value().map_err(|e| e.to_string())?.into()),
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        }
    }
    if named { Ok(Command::Perception { seeds, out }) } else { Err("no command; `--help` lists them".to_owned()) }
}

fn run(command: Command) -> Result<(), String> {
    match command {
        Command::Help => say(HELP),
        Command::Perception { seeds, out } => perception(seeds, out),
    }
}

fn perception(seeds: u64, out: Option<PathBuf>) -> Result<(), String> {
    let album = out.as_deref().map(Album::new).transpose()?.unwrap_or_default();
    let mut eyes = Eyes::new().map_err(|e| e.to_string())?;
    let progress = Progress::default();
    let tell = |table: String| {
        progress.clear();
        say(&table)
    };
    tell(format!("{}\n\n", targets(seeds, &mut eyes, &album, &progress)?))?;
    tell(format!("{}\n\n", signs(seeds, &mut eyes, &album, &progress)?))?;
    tell(format!("{}\n\n", cubes(seeds, &album, &progress)?))?;
    say(&format!("seeds 1 to {seeds}\n"))?;
    out.map_or(Ok(()), |folder| say(&format!("pictures: {}\n", folder.display())))
}

/// Prints; a reader that has seen enough is no error.
fn say(text: &str) -> Result<(), String> {
    let mut output = io::stdout();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write the output: {e}")),
        _ => Ok(()),
    }
}

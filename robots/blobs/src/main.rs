//! Makes the recording `belt.mcap`, or finds the parts in it, again and again.

use apex_rt::prelude::*;
use blobs::{Prototype, film};
use std::{env, path::Path, process::ExitCode};

const RECORDING: &str = "belt.mcap";

const HELP: &str = "\
Finds parts on a conveyor belt in a recording, as figure 9.1 of the thesis does.

Usage: blobs film     makes the recording, `belt.mcap`, of 10 s
       blobs          finds the parts in it, again and again, until Ctrl-C

What is found is seen in the studio, with sliders: `apex studio robots/blobs/blobs.afg`.
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => {
            run(Prototype::new(), WallClock::new());
            ExitCode::SUCCESS
        }
        ["film"] => match film(Path::new(RECORDING), 10.0) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => fails(&format!("cannot write `{RECORDING}`: {error}")),
        },
        ["-h" | "--help"] => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        _ => fails("the only argument is `film`; `--help` tells more"),
    }
}

fn fails(why: &str) -> ExitCode {
    eprintln!("error: {why}");
    ExitCode::from(2)
}

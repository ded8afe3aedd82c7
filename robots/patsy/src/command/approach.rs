use super::args::{Seeds, next, path, seeds_option};
use apex_sim::say;
use lexopt::{Parser, prelude::Long};
use patsy::approach::{approaches, picture, table};
use std::{fs, path::PathBuf, process::ExitCode};

/// Drives beneath a container from all start poses, and draws from where it works.
pub fn approach(parser: &mut Parser) -> Result<ExitCode, String> {
    let (mut seeds, mut out) = (Seeds::new(1), PathBuf::from("out/patsy/approach.svg"));
    while let Some(arg) = next(parser)? {
        if arg == Long("out") {
            out = path(parser)?;
        } else {
            let (option, message) = seeds_option(arg);
            seeds.read(parser, option, message)?;
        }
    }
    let all = seeds.all();
    let approaches = approaches(&all, seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&approaches))?;
    out.parent()
        .map_or(Ok(()), fs::create_dir_all)
        .and_then(|()| fs::write(&out, picture(&approaches)))
        .map_err(|e| format!("cannot write {}: {e}", out.display()))?;
    say(&format!("seeds {} to {}; picture: {}\n", all[0], all[all.len() - 1], out.display()))?;
    Ok(ExitCode::SUCCESS)
}

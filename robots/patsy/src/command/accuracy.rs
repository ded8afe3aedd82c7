use super::args::{Seeds, next, path, seeds_option};
use apex_sim::say;
use lexopt::{Parser, prelude::Long};
use patsy::{
    accuracy::{accuracy as errors, figure, table},
    chart,
};
use std::{path::PathBuf, process::ExitCode};

/// Measures the errors of the pose by the distance, in the scan alone and with the camera, and draws them.
pub fn accuracy(parser: &mut Parser) -> Result<ExitCode, String> {
    let (mut seeds, mut out) = (Seeds::new(200), PathBuf::from("out/patsy/accuracy.svg"));
    while let Some(arg) = next(parser)? {
        if arg == Long("out") {
            out = path(parser)?;
        } else {
            let (option, message) = seeds_option(arg);
            seeds.read(parser, option, message)?;
        }
    }
    let all = seeds.all();
    let rows = errors(&all, seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&rows))?;
    chart::write(&figure(&rows), &out)?;
    say(&format!("seeds {} to {}; picture: {}\n", all[0], all[all.len() - 1], out.display()))?;
    Ok(ExitCode::SUCCESS)
}

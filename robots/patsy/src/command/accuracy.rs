use super::args::{Seeds, seeds_and_out};
use apex_sim::say;
use lexopt::Parser;
use patsy::{
    accuracy::{accuracy as errors, figure, table},
    chart,
};
use std::process::ExitCode;

/// Measures the errors of the pose by the distance, in the scan alone and with the camera, and draws them.
pub fn accuracy(parser: &mut Parser) -> Result<ExitCode, String> {
    let (seeds, out) = seeds_and_out(parser, Seeds::new(200), "out/patsy/accuracy.svg")?;
    let all = seeds.all();
    let rows = errors(&all, seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&rows))?;
    chart::write(&figure(&rows), &out)?;
    say(&format!("seeds {} to {}; picture: {}\n", all[0], all[all.len() - 1], out.display()))?;
    Ok(ExitCode::SUCCESS)
}

use super::options::seeds_and_out;
use apex_sim::{
    experiment::{Options, Seeds},
    say,
};
use patsy::experiments::{
    accuracy::{accuracy as errors, figure, table},
    chart,
};
use std::process::ExitCode;

/// Measures the errors of the pose by the distance, in the scan alone and with the camera, and draws them.
pub fn accuracy(options: &mut Options) -> Result<ExitCode, String> {
    let (seeds, out) = seeds_and_out(options, Seeds::new(200), "out/patsy/accuracy.svg")?;
    let rows = errors(&seeds.all(), seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&rows))?;
    chart::write(&figure(&rows), &out)?;
    say(&format!("{seeds}; picture: {}\n", out.display()))?;
    Ok(ExitCode::SUCCESS)
}

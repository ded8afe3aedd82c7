use super::args::{Seeds, next, seeds_option};
use lexopt::Parser;
use patsy::accuracy::{accuracy as errors, table};
use std::process::ExitCode;

/// Measures the errors of the pose by the distance, in the scan alone and with the camera.
pub fn accuracy(parser: &mut Parser) -> Result<ExitCode, String> {
    let mut seeds = Seeds::new(200);
    while let Some(arg) = next(parser)? {
        let (option, message) = seeds_option(arg);
        seeds.read(parser, option, message)?;
    }
    let all = seeds.all();
    print!("{}", table(&errors(&all, seeds.jobs).map_err(|e| e.to_string())?));
    println!("seeds {} to {}", all[0], all[all.len() - 1]);
    Ok(ExitCode::SUCCESS)
}

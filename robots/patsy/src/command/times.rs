use super::args::{Seeds, next, seeds_option};
use apex_sim::say;
use lexopt::Parser;
use patsy::times::Times;
use std::process::ExitCode;

/// Measures the computing time of the detection (thesis table 6.3).
pub fn times(parser: &mut Parser) -> Result<ExitCode, String> {
    let mut seeds = Seeds::new(3);
    while let Some(arg) = next(parser)? {
        let (option, message) = seeds_option(arg);
        seeds.read(parser, option.filter(|option| *option != "jobs"), message)?;
    }
    let all = seeds.all();
    say(&format!("{}\n", Times::measure(&all)?))?;
    say(&format!("seeds {} to {}\n", all[0], all[all.len() - 1]))?;
    Ok(ExitCode::SUCCESS)
}

use apex_sim::{
    experiment::{Options, Seeds},
    say,
};
use patsy::experiments::times::Times;
use std::process::ExitCode;

/// Measures the computing time of the detection (thesis table 6.3).
pub fn times(options: &mut Options) -> Result<ExitCode, String> {
    let mut seeds = Seeds::new(3);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "jobs" => return Err(Options::unknown(&name)),
            _ => seeds.read(&name, options)?,
        }
    }
    say(&format!("{}\n{seeds}\n", Times::measure(&seeds.all())?))?;
    Ok(ExitCode::SUCCESS)
}

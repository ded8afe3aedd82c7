use crate::{MotionWatch, Outage, say};
use std::process::ExitCode;

/// Prints the outages in which a robot moved longer than it promises, in the runs of some seeds. If there are any, the
/// exit code is 1. `fault` is the text of an outage.
///
/// # Errors
/// If the output cannot be written.
pub fn broken_promises(
    seeds: &[u64],
    watches: &[MotionWatch],
    fault: impl Fn(&Outage) -> String,
) -> Result<ExitCode, String> {
    let mut code = ExitCode::SUCCESS;
    for (seed, watch) in seeds.iter().zip(watches) {
        for (outage, time) in watch.broken() {
            code = ExitCode::from(1);
            say(&format!("seed {seed}: {}: moves for {:.2} s\n", fault(&outage), time.as_secs_f64()))?;
        }
    }
    Ok(code)
}

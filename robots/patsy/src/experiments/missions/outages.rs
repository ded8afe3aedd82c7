//! Sensors that fail one after the other, and how long the vehicle moves without them.

use super::run::run_seen;
use crate::world::clinic::{Fault, FaultKind, Options};
use apex_rt::Time;
use apex_sim::{MotionWatch, outages};
use std::time::Duration;

/// Runs the vehicle with the outages that the seed draws. Its motors keep the last twist.
///
/// # Errors
/// If the plan of the building cannot be read.
pub fn run_with_outages(options: &Options, duration: Duration) -> Result<MotionWatch, String> {
    let end = Time::ZERO + duration;
    let outages = outages(options.seed, FaultKind::OF_SENSORS.len(), [Time::ZERO, end]);
    let faults = outages.iter().map(|outage| Fault::of(outage, &FaultKind::OF_SENSORS)).collect();
    let mut watch = MotionWatch::new(&FaultKind::promises(), outages);
    let options = Options { faults, command_timeout: None, ..options.clone() };
    run_seen(&options, duration, None, |now, clinic| watch.see(now, &clinic.twist()))?;
    Ok(watch)
}

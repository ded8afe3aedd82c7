use crate::{
    experiments::run::{Setup, StepView, Watch},
    world::contest::{Fault, FaultKind, START},
};
use apex_sim::{MotionWatch, outages};

/// Sensors that fail one after the other in a run: how long the robot moves without them.
#[derive(Debug)]
pub struct Outages(MotionWatch);

impl Outages {
    /// Runs the robot with the outages that the seed draws. Its motors keep the last twist.
    ///
    /// # Errors
    /// If the run cannot be recorded.
    pub fn run(setup: &Setup, seed: u64) -> Result<MotionWatch, String> {
        let outages = outages(seed, FaultKind::ALL.len(), [START, setup.end()]);
        let faults = outages.iter().map(|outage| Fault::of(outage, &FaultKind::ALL)).collect();
        let mut watch = Self(MotionWatch::new(&FaultKind::promises(), outages));
        Setup { seed, faults, keeps_twist: true, ..setup.clone() }.run(&mut watch, None)?;
        Ok(watch.0)
    }
}

impl Watch for Outages {
    fn reacted(&mut self, moment: &StepView<'_>) {
        self.0.see(moment.now, &moment.hall.robots()[0].twist);
    }
}

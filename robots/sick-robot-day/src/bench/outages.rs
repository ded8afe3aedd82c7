use crate::{
    contest::{Fault, FaultKind, START},
    run::{Setup, StepView, Watch},
};
use apex_sim::{MotionWatch, Outage, outages};

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
        let faults = outages.iter().map(Self::fault).collect();
        let mut watch = Self(MotionWatch::new(&FaultKind::promises(), outages));
        Setup { seed, faults, keeps_twist: true, ..setup.clone() }.run(&mut watch, None)?;
        Ok(watch.0)
    }

    /// Fault of an outage.
    pub fn fault(outage: &Outage) -> Fault {
        Fault { kind: FaultKind::ALL[outage.kind], from: outage.from, until: outage.until }
    }
}

impl Watch for Outages {
    fn reacted(&mut self, moment: &StepView<'_>) {
        self.0.see(moment.now, &moment.hall.robots()[0].twist);
    }
}

use crate::{FloorPlan, Laser, PlanError, Random};
use apex_nodes::scan::{Pose2, Scan};
use apex_rt::{Ctx, Out, node};
use core::f32::consts::PI;

/// Simulated plane laser scanner in a drawn world ([`FloorPlan`](crate::FloorPlan)). Measures at each received pose;
/// the scan is in the frame of the scanner. The defaults are those of a SICK TiM551.
#[node]
#[derive(Debug, Clone)]
pub struct LaserScanner {
    /// Drawing of the world.
    #[param]
    world: &'static str,
    /// Angle between the first and the last beam, centred about straight ahead.
    #[param(unit = "rad", default = 1.5 * PI, range = 0.0..=6.3)]
    field_of_view: f32,
    /// Angle between consecutive beams.
    #[param(unit = "rad", default = PI / 180.0, range = 0.001..=1.0)]
    resolution: f32,
    /// Minimum range.
    #[param(unit = "m", default = 0.05, range = 0.0..=10.0)]
    range_min: f32,
    /// Maximum range.
    #[param(unit = "m", default = 10.0, range = 0.1..=1000.0)]
    range_max: f32,
    /// Standard deviation of a range.
    #[param(unit = "m", default = 0.02, range = 0.0..=1.0)]
    noise: f32,
    /// Probability that a beam measures nothing.
    #[param(default = 0.005, range = 0.0..=1.0)]
    dropout: f32,
    /// Seed of noise and dropouts.
    #[param(default = 1)]
    seed: u64,
    measuring: Option<(FloorPlan, Random)>,
    failed: bool,
}

#[node]
impl LaserScanner {
    fn process(&mut self, ctx: &Ctx, pose: &Pose2, scan: &mut Out<Scan>) -> Result<(), PlanError> {
        if self.failed {
            return Ok(());
        }
        if self.measuring.is_none() {
            let plan = FloorPlan::parse(self.world).inspect_err(|_| self.failed = true)?;
            self.measuring = Some((plan, Random::new(self.seed)));
        }
        let laser = self.laser();
        if let Some((plan, random)) = &mut self.measuring {
            let measured = scan.get_mut();
            measured.stamp = ctx.now();
            laser.measure(&plan.world, pose, random, measured);
        }
        Ok(())
    }

    const fn laser(&self) -> Laser {
        Laser {
            field_of_view: self.field_of_view,
            resolution: self.resolution,
            range_min: self.range_min,
            range_max: self.range_max,
            noise: self.noise,
            dropout: self.dropout,
            turn: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    #[test]
    fn it_measures_the_drawing() {
        let construct = |world| LaserScanner::construct((world, PI, PI / 2.0, 0.05, 10.0, 0.0, 0.0, 1));
        let mut node = construct("########\n# >    #\n#      #\n########");
        let mut scan = Out::new();
        node.process(&Ctx::new(Time::from_millis(7)), &Pose2::new(0.5, 1.0, 0.0), &mut scan).expect("a room");
        let scan = scan.get().expect("it was sent");
        assert_eq!((scan.stamp, scan.ranges.len()), (Time::from_millis(7), 3));
        let right = scan.ranges.iter().zip([0.5, 1.25, 0.5]).all(|(range, expected)| (range - expected).abs() < 1e-5);
        assert!(right, "{:?}", scan.ranges);

        let (mut node, mut scan) = (construct("?"), Out::new());
        let mut fire = || node.process(&Ctx::new(Time::ZERO), &Pose2::default(), &mut scan);
        assert_eq!((fire(), fire()), (Err(PlanError::Character('?', 1, 1)), Ok(())));
    }
}

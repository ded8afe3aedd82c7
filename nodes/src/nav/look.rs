use super::{
    Twist,
    latest::{any_far, fresh},
    twist::Halt,
};
use crate::scan::{FarFromOrigin, Point2, Pose2, wrap_angle};
use apex_rt::{Ctx, node};

/// Angular velocity per error of the direction, in 1/s.
const GAIN: f32 = 2.0;

/// Turns a robot on the spot while it is active, to look for something: first towards the last place where it was
/// seen, which comes to the slot `place`, then round and round to the same side.
///
/// The pose and the place are in one fixed frame. Without a place it turns to the left. Without a pose that is younger
/// than `max_age`, the robot stands still. When the activity leaves, it sends a twist of zero. Stops and fails while
/// the pose is more than 100 km from the origin.
#[node]
#[derive(Debug, Clone)]
pub struct LookAround {
    /// Angular velocity.
    #[param(unit = "rad/s", default = 0.8, range = 0.0..=10.0)]
    rotation: f32,
    /// Angle from the place at which it has been looked at.
    #[param(unit = "rad", default = 0.2, range = 0.01..=3.0)]
    tolerance: f32,
    /// Maximum age of a pose.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: Option<Point2>,
    has_looked: bool,
    side: f32,
    halt: Halt,
}

#[node]
impl LookAround {
    fn process(&mut self, ctx: &Ctx, pose: Option<&Pose2>) -> Result<Option<Twist>, FarFromOrigin> {
        if !ctx.active() {
            return Ok(self.halt.rest());
        }
        if any_far([pose]) {
            return self.halt.far();
        }
        Ok(self.look(fresh(ctx, pose, self.max_age)))
    }

    fn look(&mut self, pose: Option<&Pose2>) -> Option<Twist> {
        let Some(pose) = pose else { return self.halt.drive(Twist::ZERO) };
        let error = self.last.map(|place| wrap_angle((place - pose.position()).angle() - pose.theta));
        let Some(error) = error.filter(|error| error.is_finite() && !self.has_looked) else {
            let side = if self.side == 0.0 { 1.0 } else { self.side };
            return self.halt.drive(Twist::new(0.0, 0.0, side * self.rotation));
        };
        self.side = error.signum();
        self.has_looked = error.abs() <= self.tolerance;
        let turn = (GAIN * error).clamp(-self.rotation, self.rotation);
        self.halt.drive(Twist::new(0.0, 0.0, turn))
    }

    /// Sets the place.
    #[slot]
    fn place(&mut self, place: &Point2) {
        self.last = Some(*place);
    }

    /// Receives activity with a token, without any other effect.
    #[slot]
    fn activate(&mut self) {}

    /// Begins with the last place again.
    #[on_activate]
    fn begin(&mut self) {
        (self.has_looked, self.side) = (false, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    #[test]
    fn it_turns_towards_the_place_and_then_on() {
        let mut node = LookAround::construct((0.8, 0.2, 0.5));
        node.begin();
        node.place(&Point2::new(0.0, -5.0));
        let (mut pose, mut turned) = (Pose2::default(), 0.0);
        for i in 0..400 {
            let ctx = Ctx::new(Time::from_millis(50 * i)).of_node(true);
            let twist = node.process(&ctx, Some(&pose)).unwrap().expect("it turns");
            assert!(twist.x == 0.0 && twist.omega < 0.0, "to the right, as the place is there");
            pose.theta += 0.05 * twist.omega;
            turned += 0.05 * twist.omega;
        }
        assert!(turned < -core::f32::consts::TAU, "{turned}");
        let late = Ctx::new(Time::from_millis(60_000));
        assert_eq!(node.process(&late, Some(&pose)).unwrap(), Some(Twist::ZERO), "the activity has left");
        assert_eq!(node.process(&late, Some(&pose)).unwrap(), None);
        let blind = late.of_node(true);
        assert_eq!(node.process(&blind, None).unwrap(), Some(Twist::ZERO));
    }
}

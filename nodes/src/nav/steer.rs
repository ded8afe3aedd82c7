use super::{Twist, twist::Command};
use apex_rt::{Ctx, node};
use libm::{cosf, fmaxf};

/// Least part of the speed with which a base drives on while it turns to a direction beside or behind it.
const CRAWL: f32 = 0.35;

/// Turns the velocity of an omnidirectional robot into a twist of a base with two driven wheels: it drives in a curve
/// towards the direction of the velocity, the slower the farther it has to turn.
///
/// So `PathFollower` and `MoveRobot` steer a base that cannot drive sideways, also a tractor whose trailer allows no
/// turn on the spot. The angular velocity of the input is ignored. Without a twist for `max_age`, the base stops.
#[node]
#[derive(Debug, Clone)]
pub struct Steer {
    /// Angular velocity per angle between the velocity and straight ahead.
    #[param(unit = "1/s", default = 2.5, range = 0.0..=100.0)]
    gain: f32,
    /// Smallest radius of a curve.
    #[param(unit = "m", default = 0.7, range = 0.0..=100.0)]
    radius: f32,
    /// Maximum age of a twist.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    command: Command,
}

#[node]
impl Steer {
    fn process(&mut self, ctx: &Ctx, twist: Option<&Twist>) -> Option<Twist> {
        let twist = self.command.update(ctx, twist, self.max_age);
        self.command.send(self.steered(&twist))
    }

    fn steered(&self, twist: &Twist) -> Twist {
        let velocity = twist.velocity();
        let speed = velocity.norm();
        if !(speed > 0.0 && speed.is_finite()) {
            return Twist::ZERO;
        }
        let angle = velocity.angle();
        let ahead = speed * fmaxf(cosf(angle), CRAWL);
        let most = ahead / fmaxf(self.radius, 1e-3);
        Twist::new(ahead, 0.0, (self.gain * angle).clamp(-most, most))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn it_drives_in_curves_towards_the_velocity() {
        let node = Steer::construct((2.0, 0.5, 0.5));
        assert_eq!(node.steered(&Twist::new(0.8, 0.0, 3.0)), Twist::new(0.8, 0.0, 0.0));
        let left = node.steered(&Twist::new(0.5, 0.5, 0.0));
        assert!(left.y == 0.0 && (left.x - 0.5).abs() < 1e-6 && (left.omega - 1.0).abs() < 1e-6, "{left:?}");
        let back = node.steered(&Twist::new(-1.0, -0.01, 0.0));
        assert!(back.x > 0.0 && (back.omega + back.x / 0.5).abs() < 1e-6, "{back:?}");
        for stop in [Twist::ZERO, Twist::new(f32::NAN, 0.0, 0.0), Twist::new(f32::INFINITY, 0.0, 0.0)] {
            assert_eq!(node.steered(&stop), Twist::ZERO);
        }
    }
}

use super::{Twist, latest::fresh, twist::Command};
use crate::scan::Pose2;
use apex_rt::{Ctx, Time, node};

/// Stops a robot whose odometry does not change while the robot is commanded to move: the odometry is frozen, or the
/// wheels do not turn. Such a robot would no longer know its position. It stops at once if there is no odometry, or if
/// that is not finite or very far from the origin, and if the last twist is older than `max_age`.
///
/// After a pause the robot may move again for a short time. It goes on if the odometry changes.
#[node]
#[derive(Debug, Clone)]
pub struct OdometryGuard {
    /// Time that the odometry may stay unchanged while the robot is commanded to move.
    #[param(unit = "s", default = 0.4, range = 0.0..=60.0)]
    start_timeout: f32,
    /// Length of a stop, after which the robot tries again.
    #[param(unit = "s", default = 1.0, range = 0.0..=600.0)]
    pause: f32,
    /// Commanded speed up to which the robot counts as standing.
    #[param(unit = "m/s", default = 0.05, range = 0.0..=10.0)]
    min_speed: f32,
    /// Commanded angular velocity up to which the robot counts as not turning.
    #[param(unit = "rad/s", default = 0.1, range = 0.0..=20.0)]
    min_rotation: f32,
    /// Maximum age of a twist and of the odometry.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    command: Command,
    /// Last odometry, and the time since which it has not changed while the robot was commanded to move.
    frozen: Option<(Pose2, Time)>,
}

#[node]
impl OdometryGuard {
    fn process(&mut self, ctx: &Ctx, twist: Option<&Twist>, odometry: Option<&Pose2>) -> Option<Twist> {
        let twist = self.command.update(ctx, twist, self.max_age);
        let limited = match fresh(ctx, odometry, self.max_age) {
            Some(odometry) if !self.is_frozen(ctx.now(), &twist, odometry) => twist,
            _ => Twist::ZERO,
        };
        self.command.send(limited)
    }

    /// Returns `true` if the odometry has not changed for too long. After the pause, the time begins again.
    fn is_frozen(&mut self, now: Time, twist: &Twist, odometry: &Pose2) -> bool {
        let is_moving = twist.velocity().norm() > self.min_speed || twist.omega.abs() > self.min_rotation;
        let since = match self.frozen {
            Some((last, since)) if last == *odometry => since,
            _ => now,
        };
        let waited = now.since(since).as_secs_f32();
        let is_over = !is_moving && waited <= self.start_timeout || waited > self.start_timeout + self.pause;
        self.frozen = (!is_over).then_some((*odometry, since));
        !is_over && waited > self.start_timeout
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    const AHEAD: Twist = Twist::new(1.0, 0.0, 0.0);

    /// For each of these positions, 100 ms apart: `true` if the robot may move.
    fn moves(places: impl IntoIterator<Item = f32>, twist: Twist) -> Vec<bool> {
        let mut node = OdometryGuard::construct((0.4, 1.0, 0.05, 0.1, 0.5));
        let step = |(i, x): (usize, f32)| {
            let ctx = Ctx::new(Time::from_millis(100 * i as i64));
            node.process(&ctx, Some(&twist), Some(&Pose2::new(x, 0.0, 0.0))) == Some(twist)
        };
        places.into_iter().enumerate().map(step).collect()
    }

    #[test]
    fn a_robot_that_moves_or_stands_is_left_alone() {
        assert!(moves((0..50).map(|i| 0.1 * i as f32), AHEAD).iter().all(|m| *m));
        assert!(moves([1.0; 50], Twist::ZERO).iter().all(|m| *m));
        assert!(moves([1.0; 50], Twist::new(0.04, 0.0, 0.05)).iter().all(|m| *m), "it hardly moves");
    }

    #[test]
    fn frozen_odometry_stops_it_until_it_tries_again() {
        for twist in [AHEAD, Twist::new(0.0, 0.0, -1.0)] {
            let seen = moves([1.0; 40], twist);
            assert_eq!(seen.iter().position(|m| !m), Some(5));
            assert!(seen[5..15].iter().all(|m| !m) && seen[15..20].iter().all(|m| *m), "{seen:?}");
        }
    }

    #[test]
    fn it_goes_on_when_the_odometry_does() {
        let places = [1.0; 8].into_iter().chain((0..10).map(|i| 2.0 + 0.1 * i as f32));
        let seen = moves(places, AHEAD);
        assert!(!seen[7] && seen[8..].iter().all(|m| *m), "{seen:?}");
    }

    #[test]
    fn without_odometry_it_stops() {
        let nan = Pose2 { theta: f32::NAN, ..Pose2::default() };
        for odd in [None, Some(nan), Some(Pose2::new(0.0, 5e6, 0.0))] {
            let mut node = OdometryGuard::construct((0.4, 1.0, 0.05, 0.1, 0.5));
            assert_eq!(node.process(&Ctx::new(Time::ZERO), Some(&AHEAD), odd.as_ref()), Some(Twist::ZERO));
        }
    }
}

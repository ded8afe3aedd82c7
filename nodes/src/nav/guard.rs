use super::{Twist, latest::fresh, twist::Command};
use crate::scan::Pose2;
use apex_rt::{Ctx, Time, node};

/// Stops a robot whose odometry does not change while the robot is commanded to move: the odometry is frozen, or the
/// wheels do not turn. Such a robot would no longer know its position. That is seen after `start_timeout`, or later if
/// the robot creeps. It stops at once if there is no odometry, or if that is not finite or very far from the origin. It
/// stops, too, if the last twist is older than `max_age`.
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
    /// Commanded speed from which on the time counts in full: at half of it, the odometry may stay unchanged for twice
    /// as long.
    #[param(unit = "m/s", default = 0.05, range = 0.0..=10.0)]
    min_speed: f32,
    /// Commanded angular velocity from which on the time counts in full.
    #[param(unit = "rad/s", default = 0.1, range = 0.0..=20.0)]
    min_rotation: f32,
    /// Maximum age of a twist and of the odometry.
    #[param(unit = "s", default = 0.5, range = 0.01..=60.0, silence)]
    max_age: f32,
    command: Command,
    last: Option<Unchanged>,
}

/// Odometry that has not changed since it came.
#[derive(Debug, Clone, Copy)]
struct Unchanged {
    odometry: Pose2,
    /// Time in s for which the robot was commanded to move since then. A stop in between does not end it.
    driven: f32,
    /// Time of the last firing, and the share of the time after it that counts, from 0 (commanded to stand) to 1.
    now: Time,
    share: f32,
    /// Start of the present pause.
    paused: Option<Time>,
}

#[node]
impl OdometryGuard {
    fn process(&mut self, ctx: &Ctx, twist: Option<&Twist>, odometry: Option<&Pose2>) -> Option<Twist> {
        let twist = self.command.update(ctx, twist, self.max_age);
        let Some(odometry) = fresh(ctx, odometry, self.max_age) else {
            self.last.iter_mut().for_each(|last| last.share = 0.0);
            return self.command.send(Twist::ZERO);
        };
        let is_frozen = self.is_frozen(ctx.now(), &twist, odometry);
        self.command.send(if is_frozen { Twist::ZERO } else { twist })
    }

    /// Returns `true` if the odometry has not changed for too long. After the pause, the time begins again.
    fn is_frozen(&mut self, now: Time, twist: &Twist, odometry: &Pose2) -> bool {
        let seconds = |since| now.since(since).as_secs_f32();
        let unchanged = self.last.filter(|last| last.odometry == *odometry);
        let driven = unchanged.map_or(0.0, |last| last.driven + last.share * seconds(last.now));
        let paused = unchanged.and_then(|last| last.paused);
        let is_over = paused.is_some_and(|since| seconds(since) >= self.pause);
        let driven = if is_over { 0.0 } else { driven };
        // Sums of times are not exact.
        let is_frozen = driven > self.start_timeout + 1e-4;
        let paused = is_frozen.then_some(paused.unwrap_or(now));
        let share = self.share(twist);
        self.last = Some(Unchanged { odometry: *odometry, driven, now, share, paused });
        is_frozen
    }

    /// Share of the time that counts at a commanded twist: a robot that creeps needs longer until its odometry changes.
    fn share(&self, twist: &Twist) -> f32 {
        let of = |value: f32, full: f32| if value < full { value / full } else { f32::from(value > 0.0) };
        of(twist.velocity().norm(), self.min_speed).max(of(twist.omega.abs(), self.min_rotation))
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
    fn a_robot_that_creeps_has_more_time() {
        for (twist, time) in [(Twist::new(0.02, 0.0, 0.0), 11), (Twist::new(0.0, 0.0, 0.01), 41)] {
            assert_eq!(moves([1.0; 50], twist).iter().position(|m| !m), Some(time), "{twist:?}");
        }
    }

    #[test]
    fn a_stop_in_between_does_not_hide_that_the_odometry_is_frozen() {
        let mut node = OdometryGuard::construct((0.4, 1.0, 0.05, 0.1, 0.5));
        let moves = (0..30).filter(|i| {
            let twist = if i % 3 == 2 { Twist::ZERO } else { AHEAD };
            let ctx = Ctx::new(Time::from_millis(100 * i));
            node.process(&ctx, Some(&twist), Some(&Pose2::default())) == Some(AHEAD)
        });
        assert_eq!(moves.collect::<Vec<_>>(), [0, 1, 3, 4, 6, 18, 19, 21, 22, 24]);
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

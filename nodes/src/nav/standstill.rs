use super::Twist;
use crate::{math::angle_difference, scan::Pose2};
use apex_rt::{Ctx, Event, Time, node};

/// Longest pause between commands that does not end an attempt to drive, in s.
const PAUSE: f32 = 1.5;

/// Reports a robot that is told to move and stands: `stuck` comes when it has moved by less than `distance` and turned
/// by less than `angle` within `timeout`, for example because a safety field holds it, and again after each further
/// `timeout`.
///
/// `twist` is the command, ⊥ if there is none. Every twist but zero tells the robot to move, also one that turns it on
/// the spot. A pause of more than 1.5 s between commands begins a new attempt.
#[node]
#[derive(Debug, Clone)]
pub struct Standstill {
    /// Distance that a robot that drives moves within `timeout`.
    #[param(unit = "m", default = 0.1, range = 0.0..=10.0)]
    distance: f32,
    /// Angle by which a robot that turns on the spot turns within `timeout`.
    #[param(unit = "rad", default = 0.1, range = 0.0..=3.1)]
    angle: f32,
    /// Time that the robot may stand.
    #[param(unit = "s", default = 3.0, range = 0.1..=600.0)]
    timeout: f32,
    /// Pose and time from which on the motion counts.
    since: Option<(Pose2, Time)>,
    /// Time of the last command.
    commanded: Option<Time>,
}

#[node]
impl Standstill {
    fn process(&mut self, ctx: &Ctx, odometry: &Pose2, twist: Option<&Twist>, stuck: Event<()>) {
        let now = ctx.now();
        if twist.is_some_and(|twist| *twist != Twist::ZERO) {
            if self.commanded.is_none_or(|last| now.since(last).as_secs_f32() > PAUSE) {
                self.since = None;
            }
            self.commanded = Some(now);
        }
        let here = *odometry;
        let (from, at) = *self.since.get_or_insert((here, now));
        let moves = (here.position() - from.position()).norm() >= self.distance;
        let turns = angle_difference(&from.theta, &here.theta).abs() >= self.angle;
        let is_commanded = self.commanded.is_some_and(|last| now.since(last).as_secs_f32() <= PAUSE);
        if !is_commanded || moves || turns {
            self.since = Some((here, now));
        } else if now.since(at).as_secs_f32() >= self.timeout {
            self.since = Some((here, now));
            stuck.emit(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    /// Times in s at which the robot is stuck, for its x and its command every 100 ms.
    fn stuck(x: impl Fn(i64) -> f32, commanded: impl Fn(i64) -> bool) -> std::vec::Vec<i64> {
        stuck_at(|step| Pose2::new(x(step), 0.0, 0.0), Twist::new(0.5, 0.0, 0.0), commanded)
    }

    /// The same for a pose and a twist.
    fn stuck_at(pose: impl Fn(i64) -> Pose2, twist: Twist, commanded: impl Fn(i64) -> bool) -> std::vec::Vec<i64> {
        let mut node = Standstill::construct((0.1, 0.1, 2.0));
        (0..100)
            .filter(|step| {
                let (ctx, mut event) = (Ctx::new(Time::from_millis(100 * step)), None);
                node.process(&ctx, &pose(*step), commanded(*step).then_some(&twist), apex_rt::event(&mut event));
                event.is_some()
            })
            .map(|step| step / 10)
            .collect()
    }

    #[test]
    fn only_a_robot_that_should_drive_is_stuck() {
        assert_eq!(stuck(|_| 0.0, |_| true), [2, 4, 6, 8]);
        assert_eq!(stuck(|_| 0.0, |_| false), []);
        assert_eq!(stuck(|step| 0.02 * step as f32, |_| true), []);
        assert_eq!(stuck(|step| if step < 50 { 0.1 * step as f32 } else { 5.0 }, |_| true), [6, 8]);
    }

    #[test]
    fn a_robot_that_turns_on_the_spot_moves() {
        let turn = Twist::new(0.0, 0.0, 0.5);
        // Several turns, so that the heading wraps around; and a turn of less than the angle.
        let heading = |step: i64| libm::remainderf(0.1 * step as f32, core::f32::consts::TAU);
        assert_eq!(stuck_at(|step| Pose2::new(1.0, 2.0, heading(step)), turn, |_| true), []);
        assert_eq!(stuck_at(|_| Pose2::new(1.0, 2.0, 3.0), turn, |_| true), [2, 4, 6, 8]);
        assert_eq!(stuck_at(|step| Pose2::new(1.0, 2.0, 0.002 * step as f32), turn, |_| true), [2, 4, 6, 8]);
        assert_eq!(stuck_at(|_| Pose2::new(f32::NAN, 0.0, 0.0), turn, |_| true), [2, 4, 6, 8]);
    }

    #[test]
    fn short_pauses_do_not_count() {
        assert_eq!(stuck(|_| 0.0, |step| step % 10 == 0), [2, 4, 6, 8]);
        assert_eq!(stuck(|_| 0.0, |step| step % 30 == 0), []);
    }
}

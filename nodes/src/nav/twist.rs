use super::latest::is_young;
use crate::scan::{FarFromOrigin, Point2};
use apex_rt::{Ctx, Time, Units};
#[cfg(feature = "std")]
use libm::fmaxf;
use libm::sqrtf;

/// Velocity of a robot in the plane, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Twist {
    /// Forward velocity, in m/s.
    #[unit("m/s")]
    pub x: f32,
    /// Velocity to the left, in m/s.
    #[unit("m/s")]
    pub y: f32,
    /// Angular velocity, counter-clockwise, in rad/s.
    #[unit("rad/s")]
    pub omega: f32,
}

impl Twist {
    /// Zero velocity.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    /// Creates the twist (`x`, `y`, `omega`).
    pub const fn new(x: f32, y: f32, omega: f32) -> Self {
        Self { x, y, omega }
    }

    /// Creates a twist from a `velocity` in m/s and an angular velocity `omega` in rad/s.
    pub const fn of(velocity: Point2, omega: f32) -> Self {
        Self::new(velocity.x, velocity.y, omega)
    }

    /// Translational velocity, in m/s.
    pub const fn velocity(&self) -> Point2 {
        Point2::new(self.x, self.y)
    }

    /// The twist on the same curve, at `max_speed` in m/s at most.
    #[cfg(feature = "std")]
    pub(super) fn slowed_to(&self, max_speed: f32) -> Self {
        let speed = self.velocity().norm();
        // NaN if a parameter is NaN: the robot then stands still.
        let share = if speed <= max_speed { 1.0 } else { fmaxf(max_speed / speed, 0.0) };
        Self::of(self.velocity().scaled(share), self.omega * share)
    }

    /// The twist on the same curve, slowed down so far that it can be stopped within `gap` m with a `deceleration` in
    /// m/s², after a `latency` in s.
    #[cfg(feature = "std")]
    pub(super) fn stoppable(&self, gap: f32, deceleration: f32, latency: f32) -> Self {
        self.slowed_to(braking_speed(gap.max(0.0), deceleration, latency))
    }

    /// The twist, or zero if it is not finite.
    fn finite(self) -> Self {
        if self.is_finite() { self } else { Self::ZERO }
    }

    /// Returns `true` if all components are finite.
    pub const fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.omega.is_finite()
    }
}

/// Maximum speed from which a robot stops within `gap` m, if it begins to brake after `latency` s: the solution of
/// v²/2a + v·t = gap.
pub(super) fn braking_speed(gap: f32, deceleration: f32, latency: f32) -> f32 {
    let (a, t) = (deceleration, latency);
    a * (sqrtf(t * t + 2.0 * gap / a) - t)
}

/// Stop of a node that drives: when it is interrupted, it sends a twist of zero before it is silent.
#[derive(Debug, Clone, Default)]
pub(super) struct Halt {
    is_moving: bool,
}

impl Halt {
    /// Returns `twist`, which the node sends while it drives: zero if it is not finite.
    pub(super) fn drive(&mut self, twist: Twist) -> Option<Twist> {
        let twist = twist.finite();
        self.is_moving = twist != Twist::ZERO;
        Some(twist)
    }

    /// Returns the result of a node that cannot compute with a pose: a twist of zero if the last one was not, then an
    /// error.
    pub(super) fn far(&mut self) -> Result<Option<Twist>, FarFromOrigin> {
        self.rest().map(Some).ok_or(FarFromOrigin)
    }

    /// Returns the twist of a node that does not drive: zero if the last one was not, then none.
    pub(super) fn rest(&mut self) -> Option<Twist> {
        core::mem::take(&mut self.is_moving).then_some(Twist::ZERO)
    }
}

/// Command at the input of a node that passes it on: it counts while it is younger than a maximum age.
#[derive(Debug, Clone, Default)]
pub(super) struct Command {
    last: Option<(Twist, Time)>,
    is_new: bool,
    sent: Twist,
}

impl Command {
    /// Returns the command that counts: zero if the last one is not finite, or older than `max_age` s.
    pub(super) fn update(&mut self, ctx: &Ctx, twist: Option<&Twist>, max_age: f32) -> Twist {
        self.is_new = twist.is_some();
        if let Some(twist) = twist {
            self.last = Some((*twist, ctx.stamp()));
        }
        let young = self.last.filter(|(twist, stamp)| twist.is_finite() && is_young(ctx, *stamp, max_age));
        young.map_or(Twist::ZERO, |(twist, _)| twist)
    }

    /// Returns the twist to send for what the node makes of the command: never one that is not finite, and ⊥ if no
    /// command has come and nothing has changed.
    pub(super) fn send(&mut self, twist: Twist) -> Option<Twist> {
        let twist = twist.finite();
        let is_news = self.is_new || twist != self.sent;
        self.sent = twist;
        is_news.then_some(twist)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWIST: Twist = Twist::new(0.5, 0.0, 0.1);

    #[test]
    fn a_command_has_an_age() {
        let mut command = Command::default();
        let mut pass = |ms: i64, twist: Option<Twist>, share: f32| {
            let twist = command.update(&Ctx::new(Time::from_millis(ms)), twist.as_ref(), 0.5);
            command.send(Twist::of(twist.velocity().scaled(share), twist.omega))
        };
        assert_eq!([pass(0, None, 1.0), pass(100, Some(TWIST), 1.0)], [None, Some(TWIST)]);
        assert_eq!(
            [pass(599, None, 1.0), pass(600, None, 1.0), pass(1200, None, 1.0)],
            [None, Some(Twist::ZERO), None]
        );
        // What limits the command may change after it has come.
        let slower = Twist { x: 0.25, ..TWIST };
        assert_eq!([pass(2000, Some(TWIST), 1.0), pass(2100, None, 0.5)], [Some(TWIST), Some(slower)]);
        assert_eq!([pass(2200, None, 0.5), pass(2600, None, 0.5)], [None, Some(Twist::ZERO)]);
    }

    #[test]
    fn no_twist_that_is_not_finite_passes() {
        let (mut command, ctx) = (Command::default(), Ctx::new(Time::ZERO));
        for odd in [f32::NAN, f32::INFINITY] {
            let twist = Twist { omega: odd, ..TWIST };
            assert_eq!(command.update(&ctx, Some(&twist), 0.5), Twist::ZERO);
            assert_eq!(command.send(twist), Some(Twist::ZERO));
        }
    }
}

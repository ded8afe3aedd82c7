use apex_nodes::nav::Twist;
use apex_rt::Time;
use std::time::Duration;

/// Desired twist of motors, which they follow until it is too old.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldTwist {
    /// Time after which motors without a new twist brake. Without one they keep the last twist.
    pub timeout: Option<Duration>,
    twist: Twist,
    at: Time,
}

impl HeldTwist {
    /// Creates motors that stand.
    pub const fn new(timeout: Option<Duration>) -> Self {
        Self { timeout, twist: Twist::ZERO, at: Time::ZERO }
    }

    /// Sets the twist at a time.
    pub const fn set(&mut self, twist: Twist, now: Time) {
        (self.twist, self.at) = (twist, now);
    }

    /// Twist that the motors follow at a time.
    pub fn at(&self, now: Time) -> Twist {
        let is_over = self.timeout.is_some_and(|timeout| now.since(self.at) > timeout);
        if is_over { Twist::ZERO } else { self.twist }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twist_is_held_until_the_time_out() {
        let twist = Twist::new(1.0, 0.0, 0.5);
        let mut held = HeldTwist::new(Some(Duration::from_millis(300)));
        held.set(twist, Time::from_secs(1));
        assert_eq!([1300, 1301].map(|ms| held.at(Time::from_millis(ms))), [twist, Twist::ZERO]);
        held.timeout = None;
        assert_eq!(held.at(Time::from_secs(9)), twist);
    }
}

use apex_rt::Time;
use std::collections::VecDeque;

/// Tokens on their way from a device to the robot: each arrives at its time, in the order in which they were sent.
#[derive(Debug, Clone)]
pub struct Latency<T>(VecDeque<(Time, T)>);

impl<T> Default for Latency<T> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

impl<T> Latency<T> {
    /// Sends a token that arrives at `due`, or with the one before if that arrives later.
    pub fn send(&mut self, due: Time, token: T) {
        self.0.push_back((due, token));
    }

    /// Takes the newest token that has arrived by `now`. Those before it are lost, as in a driver that keeps one.
    pub fn receive(&mut self, now: Time) -> Option<T> {
        let mut newest = None;
        while self.0.front().is_some_and(|(due, _)| *due <= now) {
            newest = self.0.pop_front().map(|(_, token)| token);
        }
        newest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_arrives_after_its_latency_and_once() {
        let mut latency = Latency::default();
        latency.send(Time::from_millis(180), "a");
        let times = [100, 179, 180, 181].map(|ms| latency.receive(Time::from_millis(ms)));
        assert_eq!(times, [None, None, Some("a"), None]);
    }

    #[test]
    fn the_newest_of_several_tokens_counts() {
        let mut latency = Latency::default();
        for (ms, token) in [(80, 1), (160, 2), (240, 3)] {
            latency.send(Time::from_millis(ms), token);
        }
        assert_eq!(latency.receive(Time::from_millis(200)), Some(2));
        assert_eq!(latency.receive(Time::from_millis(240)), Some(3));
    }

    #[test]
    fn without_latency_a_token_is_there_at_once() {
        let mut latency = Latency::default();
        latency.send(Time::ZERO, 7);
        assert_eq!(latency.receive(Time::ZERO), Some(7));
    }
}

//! Quality of service of topics.

use std::{fmt, time::Duration};

/// Quality of service of a topic. Over Zenoh every publisher meets every subscription, whatever they ask for: there is
/// no incompatible one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Qos {
    /// Treatment of messages that are lost.
    pub reliability: Reliability,
    /// Messages for subscriptions that come later.
    pub durability: Durability,
    /// Number of messages that are kept until they are taken, and for later subscriptions; all of them if it is `None`.
    pub depth: Option<u32>,
    /// Longest time between two messages.
    pub deadline: Option<Duration>,
    /// Age from which on messages are dropped.
    pub lifespan: Option<Duration>,
    /// Time within which a publisher shows that it is alive.
    pub lease: Option<Duration>,
    /// `true` if the publisher itself shows that it is alive.
    pub is_manual: bool,
}

/// Treatment of messages that are lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reliability {
    /// They are sent again.
    Reliable,
    /// They are not sent again.
    BestEffort,
}

/// Messages for subscriptions that come later.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Durability {
    /// The last ones, as of `/map` and `/tf_static`.
    TransientLocal,
    /// None.
    Volatile,
}

/// Number of kept messages that a code without it means.
const DEPTH: u32 = 42;
/// A time without end, in the two parts of a code: i64::MAX ns.
const ENDLESS: (u64, u64) = (9_223_372_036, 854_775_807);
/// Nanoseconds in a second.
const NANOS: u64 = 1_000_000_000;

impl Qos {
    /// Reliable, and the last ten messages: what most topics of ROS 2 have.
    pub const DEFAULT: Self = Self {
        reliability: Reliability::Reliable,
        durability: Durability::Volatile,
        depth: Some(10),
        deadline: None,
        lifespan: None,
        lease: None,
        is_manual: false,
    };

    /// The same without sending messages again that are lost.
    #[must_use]
    pub fn best_effort(self) -> Self {
        Self { reliability: Reliability::BestEffort, ..self }
    }

    /// The same with this number of messages that are kept.
    #[must_use]
    pub fn depth(self, depth: u32) -> Self {
        Self { depth: Some(depth), ..self }
    }

    /// The same with the last messages for subscriptions that come later.
    #[must_use]
    pub fn transient_local(self) -> Self {
        Self { durability: Durability::TransientLocal, ..self }
    }

    /// Meaning of a code that is empty.
    #[cfg(test)]
    const EMPTY: Self = Self { depth: Some(DEPTH), ..Self::DEFAULT };

    /// Reads a code of a liveliness token. A part that cannot be read, which a later version may write, counts as
    /// empty.
    pub fn read(code: &str) -> Self {
        let mut parts = code.split(':').map(|part| part.split(',').map(|number| number.parse::<u64>().ok()));
        let mut next = || {
            let mut numbers = parts.next().into_iter().flatten();
            [(); 3].map(|()| numbers.next().flatten())
        };
        let ([reliability, ..], [durability, ..], [history, depth, _]) = (next(), next(), next());
        let (deadline, lifespan, [liveliness, seconds, nanos]) = (next(), next(), next());
        // Zero and nothing both mean the value by default.
        let depth = depth.filter(|depth| *depth > 0);
        let depth = depth.map_or(DEPTH, |depth| u32::try_from(depth).unwrap_or(u32::MAX));
        Self {
            reliability: if reliability == Some(2) { Reliability::BestEffort } else { Reliability::Reliable },
            durability: if durability == Some(1) { Durability::TransientLocal } else { Durability::Volatile },
            depth: (history != Some(2)).then_some(depth),
            deadline: duration(deadline[0], deadline[1]),
            lifespan: duration(lifespan[0], lifespan[1]),
            lease: duration(seconds, nanos),
            is_manual: liveliness == Some(3),
        }
    }

    /// Number of messages that are kept.
    pub(crate) fn kept(&self) -> usize {
        self.depth.filter(|depth| *depth > 0).unwrap_or(DEPTH) as usize
    }

    /// Returns `true` if later subscriptions get the last messages.
    #[cfg(feature = "zenoh")]
    pub(crate) fn is_kept_for_later(&self) -> bool {
        self.durability == Durability::TransientLocal
    }
}

impl Default for Qos {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Duration of the parts of a code.
fn duration(seconds: Option<u64>, nanos: Option<u64>) -> Option<Duration> {
    let parts = (seconds.unwrap_or(ENDLESS.0), nanos.unwrap_or(ENDLESS.1));
    (parts != (0, 0) && parts != ENDLESS)
        .then(|| Duration::new(parts.0.saturating_add(parts.1 / NANOS), (parts.1 % NANOS) as u32))
}

/// The code of a liveliness token. A part that is equal to its default is empty.
impl fmt::Display for Qos {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |number: Option<u64>| number.map_or_else(String::new, |number| number.to_string());
        let time = |time: Option<Duration>| match time {
            Some(time) => {
                let nanos = u64::from(time.subsec_nanos());
                let [seconds, nanos] = [(time.as_secs(), ENDLESS.0), (nanos, ENDLESS.1)]
                    .map(|(number, endless)| part((number != endless).then_some(number)));
                format!("{seconds},{nanos}")
            }
            None => ",".to_owned(),
        };
        let reliability = part((self.reliability == Reliability::BestEffort).then_some(2));
        let durability = part((self.durability == Durability::TransientLocal).then_some(1));
        let history = part(self.depth.is_none().then_some(2));
        let depth = part(self.depth.filter(|depth| *depth != DEPTH).map(u64::from));
        let liveliness = part(self.is_manual.then_some(3));
        let (deadline, lifespan, lease) = (time(self.deadline), time(self.lifespan), time(self.lease));
        write!(f, "{reliability}:{durability}:{history},{depth}:{deadline}:{lifespan}:{liveliness},{lease}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_left_out() {
        assert_eq!(Qos::EMPTY.to_string(), "::,:,:,:,,");
        assert_eq!(Qos::DEFAULT.to_string(), "::,10:,:,:,,");
        let qos = Qos {
            reliability: Reliability::BestEffort,
            durability: Durability::TransientLocal,
            depth: None,
            deadline: Some(Duration::new(1, 5)),
            lifespan: Some(Duration::from_secs(10)),
            lease: Some(Duration::from_millis(1)),
            is_manual: true,
        };
        assert_eq!(qos.to_string(), "2:1:2,:1,5:10,0:3,0,1000000");
        assert_eq!(Qos::read(&qos.to_string()), qos);
    }

    #[test]
    fn codes_of_others_are_read() {
        assert_eq!(Qos::read("::,:,:,:,,"), Qos::EMPTY);
        let full = "2:2:1,42:9223372036,854775807:9223372036,854775807:1,9223372036,854775807";
        assert_eq!(Qos::read(full), Qos { reliability: Reliability::BestEffort, ..Qos::EMPTY });
        let lasting =
            Qos { durability: Durability::TransientLocal, lifespan: Some(Duration::from_secs(10)), ..Qos::EMPTY };
        assert_eq!(Qos::read(":1:,1000:,:10,0:,,"), Qos { depth: Some(1000), ..lasting });
        assert_eq!(Qos::read("0:0:0,0:0,0:0,0:0,0,0"), Qos::EMPTY, "zero is the default, too");
    }

    #[test]
    fn odd_codes_are_read_as_far_as_they_go() {
        let odd = ["", ":", "x:y:z", "9:9:9,9:9", ":::::::::", ",,,,,", "99999999999999999999:1:1,99999999999:,:"];
        for code in odd {
            let qos = Qos::read(code);
            assert_eq!(Qos::read(&qos.to_string()), qos, "{code}");
        }
        assert_eq!(Qos::read("2").reliability, Reliability::BestEffort);
    }
}

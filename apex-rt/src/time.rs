use core::{
    fmt,
    ops::{Add, AddAssign, Sub},
    time::Duration,
};

/// A point on the program's clock: nanoseconds since the clock's zero (about ±292 years).
///
/// Sums saturate at both ends instead of wrapping.
///
/// ```
/// use apex_rt::Time;
/// use std::time::Duration;
///
/// let time = Time::from_millis(1500);
/// assert_eq!(time + Duration::from_millis(500), Time::from_secs(2));
/// assert_eq!(time.since(Time::from_secs(1)), Duration::from_millis(500));
/// assert_eq!(Time::from_secs(1).since(time), Duration::ZERO);
/// assert_eq!(time.to_string(), "1.500000 s");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Time(i64);

impl Time {
    /// The zero of the clock.
    pub const ZERO: Self = Self(0);
    /// Later than any other time.
    pub const MAX: Self = Self(i64::MAX);

    /// Returns the time `ns` nanoseconds after zero.
    pub const fn from_nanos(ns: i64) -> Self {
        Self(ns)
    }

    /// Returns the time `us` microseconds after zero.
    pub const fn from_micros(us: i64) -> Self {
        Self(us.saturating_mul(1_000))
    }

    /// Returns the time `ms` milliseconds after zero.
    pub const fn from_millis(ms: i64) -> Self {
        Self(ms.saturating_mul(1_000_000))
    }

    /// Returns the time `s` seconds after zero.
    pub const fn from_secs(s: i64) -> Self {
        Self(s.saturating_mul(1_000_000_000))
    }

    /// Returns the nanoseconds since zero.
    pub const fn as_nanos(self) -> i64 {
        self.0
    }

    /// Returns the seconds since zero.
    pub const fn as_secs_f64(self) -> f64 {
        self.0 as f64 / 1e9
    }

    /// Returns the time from `earlier` to `self`; zero if `earlier` is later.
    pub const fn since(self, earlier: Self) -> Duration {
        let ns = self.0.saturating_sub(earlier.0);
        Duration::from_nanos(if ns < 0 { 0 } else { ns as u64 })
    }
}

/// Returns the nanoseconds of a duration, at most `i64::MAX`.
pub(crate) const fn nanos(d: Duration) -> i64 {
    let ns = d.as_nanos();
    if ns > i64::MAX as u128 { i64::MAX } else { ns as i64 }
}

impl Add<Duration> for Time {
    type Output = Self;
    fn add(self, d: Duration) -> Self {
        Self(self.0.saturating_add(nanos(d)))
    }
}

impl AddAssign<Duration> for Time {
    fn add_assign(&mut self, d: Duration) {
        *self = *self + d;
    }
}

impl Sub<Duration> for Time {
    type Output = Self;
    fn sub(self, d: Duration) -> Self {
        Self(self.0.saturating_sub(nanos(d)))
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.6} s", self.as_secs_f64())
    }
}

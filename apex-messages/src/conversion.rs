//! Stamps and headers.

use crate::{
    builtin_interfaces::{Duration, Time},
    std_msgs::Header,
};
use alloc::borrow::ToOwned as _;

/// Nanoseconds in a second.
const NANOS: i64 = 1_000_000_000;

/// Seconds and the nanoseconds after them. The seconds are an `i32`: a time more than 68 years from zero becomes the
/// largest or smallest one.
fn split(nanos: i64) -> (i32, u32) {
    let (seconds, rest) = (nanos.div_euclid(NANOS), nanos.rem_euclid(NANOS));
    (i32::try_from(seconds).unwrap_or(if seconds < 0 { i32::MIN } else { i32::MAX }), rest as u32)
}

impl Time {
    /// Time of this number of ns.
    pub fn from_nanos(nanos: i64) -> Self {
        let (sec, nanosec) = split(nanos);
        Self { sec, nanosec }
    }

    /// Number of ns.
    pub fn as_nanos(&self) -> i64 {
        i64::from(self.sec) * NANOS + i64::from(self.nanosec)
    }
}

impl Duration {
    /// Duration of this number of ns.
    pub fn from_nanos(nanos: i64) -> Self {
        let (sec, nanosec) = split(nanos);
        Self { sec, nanosec }
    }

    /// Number of ns.
    pub fn as_nanos(&self) -> i64 {
        i64::from(self.sec) * NANOS + i64::from(self.nanosec)
    }
}

impl Header {
    /// Header with a stamp and a frame.
    pub fn new(stamp: impl Into<Time>, frame: &str) -> Self {
        Self { stamp: stamp.into(), frame_id: frame.to_owned() }
    }
}

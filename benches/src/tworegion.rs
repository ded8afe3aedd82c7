//! Two regions on two threads: in each tick a region reads the latest value of the other and publishes a value.

use crate::nodes::op;
use seq_macro::seq;
use std::hint::black_box;

/// Published value: 64 bytes with a checksum that reveals a mixture of two values.
pub type Value = [u64; 8];

/// One of the two regions.
#[derive(Default)]
pub struct Region {
    state: u64,
    torn: u64,
}

impl Region {
    /// Computes a tick: takes the latest value of the other region and returns its own next value.
    #[inline]
    pub fn tick(&mut self, other: &Value) -> Value {
        self.torn += u64::from(other[7] != other[0] ^ other[1]);
        let x = black_box(self.state) ^ other[0];
        seq!(K in 1..=10 { let x = op(&x, K); });
        self.state += 1;
        [x, self.state, 0, 0, 0, 0, 0, x ^ self.state]
    }

    /// Number of values that were a mixture of an old and a new one. It serves as the check of this graph, which has no
    /// other reproducible result.
    pub fn torn(&self) -> u64 {
        self.torn
    }
}

/// Both regions on one thread, alternately, as a reference for two threads. A tick is one tick of each region.
#[inline(never)]
pub fn hand(ticks: u64) -> u64 {
    let (mut left, mut right) = (Region::default(), Region::default());
    let mut from_right = Value::default();
    for _ in 0..ticks {
        let from_left = left.tick(black_box(&from_right));
        from_right = right.tick(black_box(&from_left));
    }
    left.torn() + right.torn()
}

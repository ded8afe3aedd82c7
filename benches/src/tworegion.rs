//! Two regions on two threads: in each tick a region reads the latest value of the other and publishes one of its own.

use crate::nodes::op;
use seq_macro::seq;
use std::hint::black_box;

/// What a region publishes: 64 bytes that tell whether they belong together.
pub type Value = [u64; 8];

/// One of the two.
#[derive(Default)]
pub struct Region {
    state: u64,
    torn: u64,
}

impl Region {
    /// One tick: from the latest value of the other region to the next one of this.
    #[inline]
    pub fn tick(&mut self, other: &Value) -> Value {
        self.torn += u64::from(other[7] != other[0] ^ other[1]);
        let x = black_box(self.state) ^ other[0];
        seq!(K in 1..=10 { let x = op(&x, K); });
        self.state += 1;
        [x, self.state, 0, 0, 0, 0, 0, x ^ self.state]
    }

    /// How many values it read that were half old and half new: what this graph is checked by, because it has no other
    /// result that is the same in every run.
    pub fn torn(&self) -> u64 {
        self.torn
    }
}

/// Both regions on one thread, in turn: what two threads are compared with. A tick is one of each.
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

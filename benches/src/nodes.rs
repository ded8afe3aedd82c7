//! The nodes of the graphs. Hand-written code calls the same functions, so that both sides pass the same
//! guards: only the source and the sink of a tick hide their values from the optimiser.

use apex_rt::prelude::*;
use std::hint::black_box;

/// 0, 1, 2, …
#[node]
#[derive(Default)]
pub struct Count {
    next: u64,
}

#[node]
impl Count {
    /// One number.
    pub fn process(&mut self) -> u64 {
        let t = black_box(self.next);
        self.next = t + 1;
        t
    }
}

/// A source that never has a message, which the optimiser does not know.
#[node]
#[derive(Default)]
pub struct Silent {}

#[node]
impl Silent {
    /// ⊥.
    pub fn process(&mut self) -> Option<u64> {
        black_box(None)
    }
}

/// (3·x) xor k: two instructions that do not fold into those of another `op`.
#[node]
pub fn op(x: &u64, #[param] k: u64) -> u64 {
    x.wrapping_mul(3) ^ k
}

/// a + b.
#[node]
pub fn add(a: &u64, b: &u64) -> u64 {
    a.wrapping_add(*b)
}

/// Passes every `period`-th message, beginning with the first.
#[node]
#[derive(Default)]
pub struct OneOf {
    /// How many messages make a period.
    #[param]
    period: u64,
    count: u64,
}

#[node]
impl OneOf {
    /// The same node without a graph around it.
    pub fn new(period: u64) -> Self {
        Self { period, count: 0 }
    }

    /// `x` or ⊥.
    pub fn process(&mut self, x: &u64) -> Option<u64> {
        let passes = self.count == 0;
        self.count += 1;
        if self.count == self.period {
            self.count = 0;
        }
        passes.then_some(*x)
    }
}

/// Sum of 8.
#[node]
#[allow(clippy::too_many_arguments)]
#[rustfmt::skip]
pub fn sum8(x1: &u64, x2: &u64, x3: &u64, x4: &u64, x5: &u64, x6: &u64, x7: &u64, x8: &u64) -> u64 {
    [x1, x2, x3, x4, x5, x6, x7, x8].into_iter().fold(0, |sum: u64, x| sum.wrapping_add(*x))
}

/// Sum of 64.
#[node]
#[allow(clippy::too_many_arguments)]
#[rustfmt::skip]
pub fn sum64(
    x1: &u64, x2: &u64, x3: &u64, x4: &u64, x5: &u64, x6: &u64, x7: &u64, x8: &u64,
    x9: &u64, x10: &u64, x11: &u64, x12: &u64, x13: &u64, x14: &u64, x15: &u64, x16: &u64,
    x17: &u64, x18: &u64, x19: &u64, x20: &u64, x21: &u64, x22: &u64, x23: &u64, x24: &u64,
    x25: &u64, x26: &u64, x27: &u64, x28: &u64, x29: &u64, x30: &u64, x31: &u64, x32: &u64,
    x33: &u64, x34: &u64, x35: &u64, x36: &u64, x37: &u64, x38: &u64, x39: &u64, x40: &u64,
    x41: &u64, x42: &u64, x43: &u64, x44: &u64, x45: &u64, x46: &u64, x47: &u64, x48: &u64,
    x49: &u64, x50: &u64, x51: &u64, x52: &u64, x53: &u64, x54: &u64, x55: &u64, x56: &u64,
    x57: &u64, x58: &u64, x59: &u64, x60: &u64, x61: &u64, x62: &u64, x63: &u64, x64: &u64,
) -> u64 {
    [
        x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12, x13, x14, x15, x16,
        x17, x18, x19, x20, x21, x22, x23, x24, x25, x26, x27, x28, x29, x30, x31, x32,
        x33, x34, x35, x36, x37, x38, x39, x40, x41, x42, x43, x44, x45, x46, x47, x48,
        x49, x50, x51, x52, x53, x54, x55, x56, x57, x58, x59, x60, x61, x62, x63, x64,
    ]
    .into_iter()
    .fold(0, |sum: u64, x| sum.wrapping_add(*x))
}

/// Two tokens a firing: `op` with 1 and with 2 of 0, 1, 2, …
#[node]
#[derive(Default)]
pub struct Pairs {
    count: Count,
}

#[node]
impl Pairs {
    /// Two tokens.
    pub fn process(&mut self) -> [u64; 2] {
        let n = self.count.process();
        [op(&n, 1), op(&n, 2)]
    }
}

/// One token of three.
#[node]
pub fn mix(x: &[u64; 3]) -> u64 {
    x[0].wrapping_add(x[1].rotate_left(1)).wrapping_add(x[2].rotate_left(2))
}

/// 1000·t + i for all i below 1000.
#[node]
#[derive(Default)]
pub struct Rows {
    count: Count,
}

#[node]
impl Rows {
    /// One list.
    pub fn process(&mut self, list: &mut Out<Vec<u64>>) {
        let first = self.count.process().wrapping_mul(1000);
        let list = list.get_mut();
        list.clear();
        list.extend((0..1000).map(|i| first.wrapping_add(i)));
    }
}

/// Sum of a list. Its port takes what `Rows` and `each` send: a `Vec`.
#[node]
#[allow(clippy::ptr_arg)]
pub fn sum(list: &Vec<u64>) -> u64 {
    list.iter().fold(0, |sum, x| sum.wrapping_add(*x))
}

/// Folds all it gets into a checksum.
#[node]
#[derive(Default)]
pub struct Sink {
    acc: u64,
}

#[node]
impl Sink {
    /// The checksum so far.
    pub fn checksum(&self) -> u64 {
        self.acc
    }

    /// acc ← rotl(acc, 5) xor x.
    pub fn process(&mut self, x: &u64) {
        self.acc = black_box(self.acc.rotate_left(5) ^ x);
    }
}

//! Nodes for the tests.
use apex_rt::prelude::*;

/// 0, 1, 2, …
#[node]
#[derive(Default)]
pub struct Ramp {
    next: u64,
}

#[node]
impl Ramp {
    fn process(&mut self) -> u64 {
        self.next += 1;
        self.next - 1
    }
}

/// Times `k`.
#[node]
pub fn mul(x: &u64, #[param(default = 2)] k: u64) -> u64 {
    x * k
}

/// Product.
#[node]
pub fn product(a: &u64, b: &u64) -> u64 {
    a * b
}

/// Passes even values.
#[node]
pub fn even_only(x: &u64) -> Option<u64> {
    x.is_multiple_of(2).then_some(*x)
}

/// Records.
#[node]
#[derive(Default)]
pub struct Sink {
    pub seen: Vec<u64>,
}

#[node]
impl Sink {
    fn process(&mut self, x: &u64) {
        self.seen.push(*x);
    }
}

use apex_macros::graph;
use apex_rt::prelude::*;

/// Splits values into even ones and odd ones.
#[node]
pub fn split(x: &u64) -> Split {
    let even = x.is_multiple_of(2);
    Split { even: even.then_some(*x), odd: (!even).then_some(*x) }
}

#[derive(Outputs)]
pub struct Split {
    pub even: Option<u64>,
    pub odd: Option<u64>,
}

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

/// Adds up what it gets.
#[node]
#[derive(Default)]
pub struct Total {
    pub sum: u64,
}

#[node]
impl Total {
    fn process(&mut self, x: &u64) {
        self.sum += x;
    }
}

graph! {
    graph Parity {
        node even = Total();
        node odd  = Total();
        node s    = split();
        Ramp() -> s;
        s.even -> even;
        s.odd  -> odd;
    }
}

pub fn main() {
    let mut parity = Parity::new();
    for _ in 0..10 {
        parity.react(Time::ZERO);
    }
    assert_eq!((parity.nodes().even.sum, parity.nodes().odd.sum), (20, 25));
}

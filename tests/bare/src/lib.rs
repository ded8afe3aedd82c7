//! A program without the standard library and without a heap. Its compilation is the main test; its results are
//! checked, too.
#![no_std]

use apex_macros::graph;
use apex_rt::prelude::*;
use heapless::Vec;

/// 0, 1, 2, … in groups of four.
#[node]
#[derive(Debug, Default)]
pub struct Batches {
    next: u32,
}

#[node]
impl Batches {
    fn process(&mut self, batch: &mut Out<Vec<u32, 4>>) {
        let batch = batch.get_mut();
        batch.clear();
        batch.extend(self.next..self.next + 4);
        self.next += 4;
    }
}

/// Halves even values.
#[node]
pub fn half(x: &u32) -> Option<u32> {
    x.is_multiple_of(2).then_some(x / 2)
}

/// Fails on an empty list.
#[node]
pub fn largest(list: &Vec<u32, 4>) -> Result<u32, &'static str> {
    list.iter().copied().max().ok_or("the list is empty")
}

/// Adds two numbers.
#[node]
pub fn plus(a: &u32, b: &u32) -> u32 {
    a + b
}

graph! {
    use apex_nodes::flow::Throttle;

    /// Lists, a filter inside of `each`, a loop with a delay, a timer, a port.
    graph Bare {
        out total: u32;

        node halves = half() each;
        node sum    = plus() delay 0;
        node next   = plus();

        Batches() every 10ms -> halves -> largest() -> [next.a, sum.a];
        sum  -> [next.b, sum.b];
        next -> Throttle(n = 1) -> total;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_runs() {
        let mut bare = Bare::new();
        // The largest halves are 1, 3, 5, …
        for (step, expected) in [(0, 1), (1, 4), (2, 9), (3, 16)] {
            let next = bare.react(Time::from_millis(10 * step));
            assert_eq!(bare.outputs().total, Some(expected));
            assert_eq!(next, Next::At(Time::from_millis(10 * (step + 1))));
        }
    }
}

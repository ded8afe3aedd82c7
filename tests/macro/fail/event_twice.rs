//! A firing can trigger each event at most once: it is passed by value.
use apex_rt::prelude::*;

#[node]
fn twice(x: &u64, e: Event<u64>) {
    e.emit(*x);
    e.emit(x + 1);
}

#[node]
#[derive(Default)]
struct Relay;

#[node]
impl Relay {
    #[slot]
    fn put(&mut self, token: &u64, e: Event<u64>) {
        for _ in 0..2 {
            e.emit(*token);
        }
    }
}

fn main() {}

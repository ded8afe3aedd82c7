//! Each mistake in a signature is explained at the offending argument.
use apex_rt::prelude::*;

#[node]
fn by_value(x: u64) {}

#[node]
fn mutable(x: &mut u64) {}

#[node]
async fn later(x: &u64) {}

#[node]
fn lifetime<'a>(x: &'a u64) -> u64 {
    *x
}

#[node]
fn pattern((a, b): &(u64, u64)) {}

#[node]
fn one(x: &[u64; 1]) {}

#[node]
fn a_number_of_inputs(x: [&u64; 3]) {}

#[node]
fn unknown_number(x: [Option<&u64>; N]) {}

#[node]
fn number_used_twice<const N: usize>(x: [&u64; N], y: [&u64; N]) {}

#[node]
fn number_in_a_type<const N: usize>(x: [&u64; N]) -> Sized<N> {
    Sized
}

#[node]
fn returns(x: &u64) -> &u64 {
    x
}

#[node]
fn nameless() -> impl Fn() -> u64 {
    || 3
}

#[node]
fn nameless_input(x: &impl Fn() -> u64) {}

#[node]
fn unknown_key(x: &u64, #[param(defualt = 3)] k: u64) {}

#[node]
fn no_range(x: &u64, #[param(range = 3)] k: u64) {}

#[node(fast)]
fn arguments(x: &u64) {}

#[node]
struct Tuple(u64);

#[node]
enum Either {
    A,
}

struct Slots;

#[node]
impl Slots {
    #[slot]
    fn answer(&mut self) -> u64 {
        0
    }
}

struct Two;

#[node]
impl Two {
    #[slot]
    fn both(&mut self, a: &u64, b: &u64) {}
}

// What hooks return has no way out, and each comes once.
struct Returning;

#[node]
impl Returning {
    #[no_message]
    fn missing(&mut self) -> f32 {
        0.0
    }
}

struct Twice;

#[node]
impl Twice {
    #[on_stop]
    fn halt(&mut self) {}

    #[on_stop]
    fn brake(&mut self) {}
}

struct Hook;

#[node]
impl Hook {
    #[no_message]
    fn missing(&mut self, x: &u64) {}
}

struct Trait;

#[node]
impl Default for Trait {
    fn default() -> Self {
        Self
    }
}

fn main() {}

//! The cart without the standard library, without libc and without a heap, for x86-64 Linux: a machine that stands
//! wherever the tests run.
//!
//! Eight seconds of made-up time go by at once. On a microcontroller a timer wakes the loop, and the interrupts are
//! real; the rest is the same.
#![no_std]
#![no_main]

mod interrupts;
mod machine;
mod text;

use apex_rt::prelude::*;
use firmware::Cart;
use interrupts::{BUMPER, BUTTON};
use text::Line;

const END: Time = Time::from_secs(8);

extern "C" fn main() -> ! {
    let mut cart = Cart::new();
    let mut now = Time::ZERO;
    while now < END {
        interrupts::happen(now);
        // A full mailbox gives the token back: nothing is lost, since the one in it says the same.
        if BUTTON.take() {
            let _ = cart.inputs().button.put(());
        }
        if BUMPER.take() {
            let _ = cart.inputs().bumper.put(());
        }
        let next = cart.react(now);
        tell(&mut cart, now);
        match next {
            Next::At(time) => now = time,
            Next::Now | Next::Input | Next::Exit(_) => break,
        }
    }
    Line::new().number(size_of::<Cart>() as u32).text(" bytes of RAM").write();
    machine::exit(0)
}

/// Writes what happened, and twice a second how fast the cart is.
fn tell(cart: &mut Cart, now: Time) {
    let line = || Line::new().number(milli(now.as_secs_f64())).text(" ms: ");
    if cart.events().starts.take().is_some() {
        line().text("starts").write();
    }
    if cart.events().stops.take().is_some() {
        line().text("stops").write();
    }
    if now.as_nanos() % 500_000_000 == 0
        && let Some(speed) = cart.outputs().measured
    {
        line().number(milli(speed)).text(" mm/s").write();
    }
}

/// A number in thousandths, for those that are not negative.
fn milli(number: f64) -> u32 {
    (number * 1000.0 + 0.5) as u32
}

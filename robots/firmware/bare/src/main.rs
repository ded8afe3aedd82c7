//! The cart without the standard library, libc and a heap, for x86-64 Linux: a machine that is available wherever the
//! tests run.
//!
//! Eight seconds of simulated time pass at once. On a microcontroller, a timer wakes the loop and the interrupts are
//! real; the rest is the same.
#![no_std]
#![no_main]

mod interrupts;
mod machine;

use apex_rt::prelude::*;
use firmware::{Cart, Line, tell};
use interrupts::{BUMPER, BUTTON};

const END: Time = Time::from_secs(8);

extern "C" fn main() -> ! {
    let mut cart = Cart::new();
    let mut now = Time::ZERO;
    while now < END {
        interrupts::happen(now);
        // A full mailbox returns the token. Nothing is lost, as the token in it has the same meaning.
        if BUTTON.take() {
            let _ = cart.inputs().button.put(());
        }
        if BUMPER.take() {
            let _ = cart.inputs().bumper.put(());
        }
        let next = cart.react(now);
        tell(&mut cart, now, machine::write);
        match next {
            Next::At(time) => now = time,
            Next::Now | Next::Input | Next::Exit(_) => break,
        }
    }
    Line::new().number(size_of::<Cart>() as u32).text(" bytes of RAM").write(machine::write);
    machine::exit(0)
}

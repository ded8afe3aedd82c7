//! The program between analysis and Rust: what a graph does when it runs, as data. It is lowered from graph and
//! analysis; the code generator writes it down, and the listing prints it.
//!
//! A program consists of *rows* (nodes, ports, slots, timers, timeouts: [`Wiring`]), of the *conditions* that its
//! dispatcher looks at ([`Bits`]), and of *operations*.

mod activity;
mod bits;
mod carries;
mod claims;
mod clusters;
mod fire;
mod interrupt;
mod lower;
mod op;
mod plan;
mod print;
mod reaction;
mod slots;
mod verify;
mod wiring;

pub use bits::{Bits, ClusterRow, MissingRow};
pub use carries::Carries;
pub use claims::{Broken, ClaimCheck, Spot};
pub use fire::{Arg, Call, CallResult, Deadline, Failing, Fire, ParamOutput, SlotCall};
pub use lower::Lower;
pub use op::{Cancel, Op, Ops, Served, Taken};
pub use plan::{BlockId, Plan, Storage, is_buffer, storage};
pub use print::{Lines, numbers};
pub use reaction::{After, Entering, Firing, Poll, Reaction, Receiver, Sender};
pub use wiring::{Entry, Flag, Port, Send, Silence, Slot, Timeout, Wiring};

/// A program, or the part of one that a thread runs.
pub struct Program<'a> {
    /// Input of the lowering.
    pub lower: Lower<'a>,
    /// Its rows.
    pub wiring: Wiring,
}

impl<'a> Program<'a> {
    /// Lowers a program.
    pub fn new(lower: Lower<'a>) -> Self {
        Self { lower, wiring: Wiring::new(lower) }
    }
}

//! The program between analysis and Rust: what a graph does when it runs, as data. It is lowered from graph and
//! analysis; the code generator writes it down, and the listing prints it.
//!
//! A program consists of *rows* (nodes, ports, slots, timers, timeouts: [`Wiring`]), of the *conditions* that its
//! dispatcher looks at ([`Bits`]), and of *operations*.

mod bits;
mod carries;
mod lower;
mod plan;
mod wiring;

pub use bits::{Bits, ClusterRow, MissingRow};
pub use carries::Carries;
pub use lower::Lower;
pub use plan::{BlockId, Plan, Storage, is_buffer, storage};
pub use wiring::{Entry, Flag, Port, Send, Silence, Slot, Timeout, Wiring};

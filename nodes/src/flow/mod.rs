//! Where tokens go and when: branching, filtering, counting and buffering (thesis 3.6).
//!
//! Nodes without memory are functions, the others are structs.

mod batch;
mod buffer;
mod pace;
mod route;

pub use batch::{Collect, Delay, MAX_BATCH};
pub use buffer::{Hold, Latch, Latest};
pub use pace::{Changed, Count, Edge, Throttle};
pub use route::{Branches, gate, merge, select, switch};

//! Compiled graphs and the same work written by hand: same node functions, same optimisation barriers, same checksums.

mod cases;
pub mod frames;
pub mod graphs;
pub mod hand;
pub mod image;
mod memory;
pub mod nodes;
pub mod threads;
pub mod tworegion;

pub use cases::{CASES, Case, Run, SKIPPED, SYNCHRONOUS, allocations};
pub use memory::print_memory;

//! Random texts with the Rust that they use: plausible programs with one or two hostile features each. A text that the
//! compiler accepts must compile; one that it refuses must have its first error in the text.

mod case;
mod graph;
mod kinds;
mod machine;
mod maker;
mod names;
mod nodes;
mod script;
mod steps;
mod types;
mod values;

pub use case::{Call, Case, Item, Shape, Text};
pub use kinds::Kind;
pub use maker::generate;

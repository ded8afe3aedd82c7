//! Random source files with their Rust code: plausible programs with one or two hostile features each. If the compiler
//! accepts a source file, rustc must accept it. If the compiler rejects it, its first error must be in the source file.

mod case;
mod extra;
mod generate;
mod graph;
mod interface;
mod kinds;
mod machine;
mod maker;
mod names;
mod nodes;
mod script;
mod sheet;
mod steps;
mod types;
mod values;
mod variant;

pub use case::{Call, Case, Item, Shape, Text};
pub use generate::generate;
pub use kinds::Kind;

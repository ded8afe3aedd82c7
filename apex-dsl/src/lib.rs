//! The Apex compiler: sources and node signatures in; diagnostics, an analysed graph and Rust tokens out.
//!
//! It is pure: all input comes through [`source::World`], nothing depends on clocks, environment or the order of a hash map.
//! The passes stand in order in [`passes`].

// The parser that pest makes for `no_std` names it.
extern crate alloc;

pub mod analyse;
pub mod catalog;
pub mod check;
pub mod claims;
pub mod codegen;
pub mod explain;
pub mod fix;
pub mod format;
pub mod graph;
pub mod ide;
pub mod machine;
pub mod passes;
pub mod petri;
pub mod program;
pub mod report;
pub mod resolve;
pub mod script;
pub mod source;
pub mod syntax;
pub mod threads;
pub mod units;

pub use format::format;

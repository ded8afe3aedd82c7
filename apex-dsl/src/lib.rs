//! The Apex compiler: turns source files and signatures of nodes into diagnostics, an analysed graph and Rust tokens.
//!
//! The compiler is pure: all input comes through [`source::World`], and nothing depends on clocks, the environment or
//! the order of a hash map. [`passes`] lists the passes in order.

// The parser that pest generates for `no_std` refers to `alloc`.
extern crate alloc;

pub mod analyse;
pub mod catalog;
pub mod check;
pub mod checked;
pub mod claims;
pub mod codegen;
pub mod graph;
pub mod index;
pub mod machine;
pub mod passes;
pub mod program;
pub mod report;
pub mod resolve;
pub mod script;
pub mod source;
pub mod syntax;
pub mod threads;

pub use apex_signature::{fraction, units};

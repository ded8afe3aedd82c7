//! Interpreter of Apex programs: it executes the operations that the generated code is written from, over boxed nodes
//! and tokens of any type. It is slow and simple; its firings, activity and times are those of the compiled program.
//!
//! Thread groups run in turn.

mod call;
mod cells;
mod claims;
mod cluster;
mod code;
mod compiled;
mod condition;
mod conditions;
mod delay;
mod each;
mod exchange;
pub mod glue;
mod interpreter;
mod local;
mod machine;
mod node;
mod ops;
mod react;
mod run;
mod serve;
mod source;
mod state;
mod states;
mod test;

pub use interpreter::Interpreter;
pub use node::{Args, Library, Node, Outcome, Value};
pub use serve::{MARK, run_tests, serve};
pub use source::Source;

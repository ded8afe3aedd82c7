//! Utilities of the tests of all crates: scripted nodes, a log of firings, and the compiler as a library.
//!
//! All tokens are `i64` unless a test is about types. A negative number in a script stands for ⊥.

mod compile;
mod dice;
mod libraries;
mod log;
mod machines;
pub mod oracle;
mod python;
mod random;
pub mod texts;

pub mod nodes {
    //! Nodes for the source files of the tests.
    mod active;
    mod control;
    mod events;
    mod figures;
    mod generic;
    mod lists;
    mod ops;
    mod params;
    mod rates;
    mod recorded;
    mod scripted;
    mod sinks;
    mod sources;
    mod streamed;
    mod tapes;

    pub use active::*;
    pub use control::*;
    pub use events::*;
    pub use figures::*;
    pub use generic::*;
    pub use lists::*;
    pub use ops::*;
    pub use params::*;
    pub use rates::*;
    pub use recorded::*;
    pub use scripted::*;
    pub use sinks::*;
    pub use sources::*;
    pub use streamed::*;
    pub use tapes::*;
}

pub use compile::{Compiler, Found, check, error, expand};
pub use dice::Dice;
pub use libraries::{Libraries, root};
pub use log::{Log, active, active_after_each, react, simulate};
pub use machines::{LETTERS, Machine, machine, machines_text};
pub use python::python;
pub use random::{Case, SEED, Trace, cases, text};

/// A constant for source files.
pub const SEVEN: i64 = 7;

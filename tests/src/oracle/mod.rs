//! Random graphs of all kinds of connections, whose compiled programs are compared with their Petri nets.

mod case;
mod generate;
mod interpret;
mod judge;
mod machines;
mod script;
mod text;
mod walk;

pub use case::{Case, NODE_TYPES};
pub use generate::{generate, on_threads, paced, with_resets, with_timeouts};
pub use interpret::{Interpreted, interpret};
pub use judge::{Checked, Checker, Failure, Record, judge, read, script_of};
pub use machines::machine;
pub use script::{ALWAYS, Now, Parameters, call, note, origin, run_unevenly, sends, take_notes, value};
pub use walk::walk;

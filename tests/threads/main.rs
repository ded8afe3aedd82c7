//! Programs with several thread groups: in sequence on one thread, with deterministic results, and on real threads.

mod ends;
mod groups;
mod process;
mod real;
mod remote;
mod signals;
#[path = "../studio/steady.rs"]
mod steady;
mod untaken;
mod waits;

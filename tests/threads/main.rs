//! Programs with several thread groups: in sequence on one thread, with deterministic results, and on real threads.

mod groups;
mod real;
mod remote;
mod signals;
mod waits;

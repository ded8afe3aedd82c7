//! Programs on several threads: on one thread in turn, where their result is always the same, and on real ones.

mod groups;
mod real;
mod signals;
mod waits;

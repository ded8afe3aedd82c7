//! Compiled programs against the Petri nets of their graphs.

mod cargo;
mod nets;
mod pnml;
mod programs;

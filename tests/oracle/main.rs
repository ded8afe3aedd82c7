//! Compiled programs, compared with the Petri nets of their graphs.

mod compile;
mod nets;
mod pnml;
mod programs;
mod words;

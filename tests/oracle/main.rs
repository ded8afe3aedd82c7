//! Compiled programs, compared with the Petri nets of their graphs.

mod compile;
mod interpreted;
mod nets;
mod pnml;
mod programs;
mod verifier;
mod words;

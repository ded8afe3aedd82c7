//! Compiled programs, compared with the Petri nets of their graphs.

mod compile;
mod interpreted;
mod machines;
mod nets;
mod pnml;
mod programs;
mod verifier;
mod words;

/// Number in an environment variable, if there is one.
fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

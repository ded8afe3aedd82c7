//! The Apex compiler.
/// Node signatures, read from Rust.
pub mod catalog;

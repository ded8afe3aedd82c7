/// The interface of a node, out of Rust syntax.
pub mod signature;

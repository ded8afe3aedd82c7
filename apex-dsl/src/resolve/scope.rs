//! Meaning of the names in an expression.

use super::names::SourceSet;
use crate::{catalog::Catalog, graph::Value, report::Diagnostic};
use std::collections::BTreeMap;

/// Error or value; the error is boxed because it is much larger than most values.
pub type Evaluated<T> = Result<T, Box<Diagnostic>>;

/// Meaning of the names in an expression.
pub struct Scope<'a> {
    /// Parameters of the graph that contains the expression.
    pub params: &'a BTreeMap<String, Value>,
    /// Names of Rust.
    pub rust: RustNames<'a>,
}

/// Names of Rust in source files.
#[derive(Clone, Copy)]
pub struct RustNames<'a> {
    /// The source files, with their imports.
    pub texts: &'a SourceSet,
    /// The types and constants.
    pub catalog: &'a Catalog,
}

//! What the compiler has to say.

mod diagnostic;
mod explain;
mod render;

pub use diagnostic::{Diagnostic, Diagnostics, Fix, Label, MAX_ERRORS, Severity, nearest};
pub use explain::{explain, explain_json};
pub use render::{json, render};

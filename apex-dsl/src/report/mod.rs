//! What the compiler has to say.

mod diagnostic;
mod render;

pub use diagnostic::{Diagnostic, Diagnostics, Fix, Label, MAX_ERRORS, Severity, nearest};
pub use render::{json, render};

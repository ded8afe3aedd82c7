//! What the compiler has to say.

mod diagnostic;
mod explain;
mod pages;
mod render;

pub use diagnostic::{Diagnostic, Diagnostics, Fix, Label, MAX_ERRORS, Severity, nearest};
pub use explain::{explain, explain_json};
pub use pages::{PAGES, page};
pub use render::{json, render};

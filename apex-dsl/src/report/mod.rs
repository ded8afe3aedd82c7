//! Diagnostics: their collection, order and display.

mod diagnostic;
mod list;
mod nearest;
mod pages;
mod render;
mod stage;

pub use diagnostic::{Diagnostic, Fix, Label, Severity};
pub use list::{Diagnostics, MAX_ERRORS};
pub use nearest::{nearest, nearest_within};
pub use pages::{PAGES, page};
pub use render::{json, render};
pub use stage::Stage;

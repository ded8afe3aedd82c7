//! Commands that make and drive things: projects, completions.

#[path = "../common/mod.rs"]
mod common;

mod completions;
mod new;

//! Commands that make and drive things: projects, completions, programs that follow their text, imports.

#[path = "../common/mod.rs"]
mod common;

mod completions;
mod import;
mod new;
mod watch;

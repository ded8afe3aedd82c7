//! Commands that make and drive things: projects, completions, programs that follow their text.

#[path = "../common/mod.rs"]
mod common;

mod completions;
mod new;
mod watch;

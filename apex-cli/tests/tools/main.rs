//! Commands that make and drive things: projects, completions, programs that follow their text, imports.

use std::sync::Mutex;

#[path = "../common/mod.rs"]
mod common;

mod completions;
mod doc;
mod docs;
mod import;
mod memory;
mod new;
mod record;
mod times;
mod watch;

/// Where all that these tests make is built, so that what it needs is built once.
const TARGET: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/made");

/// Programs that are made for a text all have one name: only one test at a time makes some.
static MADE: Mutex<()> = Mutex::new(());

//! Commands that make and drive things: projects, completions, programs that follow their text, imports.

use std::{process::Command, sync::Mutex};

#[path = "../common/mod.rs"]
mod common;

mod completions;
mod doc;
mod docs;
mod import;
mod import_files;
mod import_runs;
mod memory;
mod new;
mod nodes;
mod record;
mod times;
mod together;
mod tour;
mod watch;

/// Where all that these tests make is built, so that what it needs is built once.
const TARGET: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/made");

/// Programs that are made for a text all have one name: only one test at a time makes some.
static MADE: Mutex<()> = Mutex::new(());

/// Cargo, which builds as the command does.
fn cargo() -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.envs(common::SETTINGS);
    cargo
}

//! Commands that create and drive things: projects, completions, programs that are rebuilt after changes, imports.

use std::{process::Command, sync::Mutex};

#[path = "../common/mod.rs"]
mod common;

mod completions;
#[cfg(unix)]
mod debugging;
mod doc;
mod docs;
mod explain;
mod import;
mod import_files;
mod import_runs;
mod memory;
mod new;
mod nodes;
mod params;
mod record;
#[cfg(unix)]
mod studio;
mod times;
mod together;
mod tour;
mod tune;
mod watch;

/// Target folder of all tests here, so that dependencies are built once.
const TARGET: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/made");

/// Lock for tests that make programs for source files: the programs have equal names.
static MADE: Mutex<()> = Mutex::new(());

/// Cargo with the settings of the command.
fn cargo() -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.envs(common::SETTINGS);
    cargo
}

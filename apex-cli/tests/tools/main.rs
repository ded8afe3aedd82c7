//! Commands that create and drive things: projects, completions, programs that are rebuilt after changes, imports.

use std::{
    process::Command,
    sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard},
};

#[path = "../common/mod.rs"]
mod common;

mod agents;
mod bag;
mod completions;
mod crates;
#[cfg(unix)]
mod debugging;
mod doc;
mod docs;
mod explain;
mod import;
mod import_files;
mod import_msg;
mod import_runs;
mod interpreted;
mod json;
mod memory;
#[path = "../../../robots/moved.rs"]
mod moved;
mod new;
mod nodes;
mod params;
mod record;
#[path = "../../../tests/studio/steady.rs"]
mod steady;
#[cfg(unix)]
mod studio;
mod supply;
mod times;
mod together;
mod tour;
mod tune;
mod watch;

/// Target folder of all tests here, so that dependencies are built once: the one in which `trybuild` builds in the
/// tests of the macros.
const TARGET: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/../tests/trybuild");

/// Locked for reading by tests that build, and for writing by those that look at messages about builds, which others
/// would delay.
static BUILDS: RwLock<()> = RwLock::new(());

/// Returns when a test may build beside others.
fn builds() -> RwLockReadGuard<'static, ()> {
    BUILDS.read().unwrap_or_else(PoisonError::into_inner)
}

/// Returns when no other test builds.
fn builds_alone() -> RwLockWriteGuard<'static, ()> {
    BUILDS.write().unwrap_or_else(PoisonError::into_inner)
}

/// Cargo with the settings of the command.
fn cargo() -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.envs(common::SETTINGS);
    cargo
}

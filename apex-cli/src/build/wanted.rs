//! The crates that cargo builds.

use std::{ffi::OsString, path::PathBuf};

/// A crate that cargo builds.
pub struct Wanted {
    /// Arguments of cargo that select the crate.
    pub select: Vec<OsString>,
    /// Folder of its package.
    pub package: PathBuf,
    /// Root of the workspace in which the command works; its cargo configuration applies.
    pub root: PathBuf,
    /// Target folder.
    pub target: PathBuf,
    /// Name of a crate whose messages are not shown: code that is made for it may be wrong, and is not the user's.
    pub hushed: Option<String>,
}

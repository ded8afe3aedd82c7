//! The robot that is started for a page.

use crate::build::How;
use std::path::PathBuf;

/// A robot that is built and started.
pub struct Launch {
    pub file: PathBuf,
    pub robot: Option<String>,
    pub replay: Option<PathBuf>,
    pub simulated: bool,
    /// `true` for a second robot that gets the inputs of the first one.
    pub shadow: bool,
    pub params: Option<PathBuf>,
    pub args: Vec<String>,
    pub how: How,
}

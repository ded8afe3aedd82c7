//! Requests of the environment variables.

use super::RecordOptions;
use crate::Program;
use std::{env, path::PathBuf};

/// Environment variable with the file to replay.
const REPLAY: &str = "APEX_REPLAY";

/// Environment variable with the file to record to.
const RECORD: &str = "APEX_RECORD";

/// Request to record a run or to replay a recording.
pub enum RunMode {
    Record(PathBuf, RecordOptions),
    Replay(PathBuf),
}

impl RunMode {
    /// Returns the request in the environment variables, or that of the program's `record` statement.
    pub fn of<P: Program>() -> Option<Self> {
        let file = |name| env::var_os(name).map(PathBuf::from);
        match (file(REPLAY), file(RECORD)) {
            (Some(path), _) => Some(Self::Replay(path)),
            // The options of the statement are those of its file.
            (None, Some(path)) => Some(Self::Record(path, RecordOptions::default())),
            (None, None) => {
                P::RECORD.map(RecordOptions::stated).map(|(path, options)| Self::Record(path.into(), options))
            }
        }
    }
}

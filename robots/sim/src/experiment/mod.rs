//! Tools of programs that measure simulated robots: runs with a log of activity and failures, recordings, commands with
//! seeds, tables with a line for each run, and drawings.

mod commands;
mod drawing;
mod file;
mod jobs;
mod options;
mod outages;
mod progress;
#[cfg(feature = "record")]
mod recording;
mod run;
mod timeline;

pub use commands::{Command, run_commands};
pub use drawing::Drawing;
pub use file::write_file;
pub use jobs::{rows, spread};
pub use options::{Options, Seeds};
pub use outages::broken_promises;
pub use progress::Progress;
#[cfg(feature = "record")]
pub use recording::Recording;
pub use run::{Failure, RunLog, Spell, activity_table, instances_of, run};
pub use timeline::timeline;

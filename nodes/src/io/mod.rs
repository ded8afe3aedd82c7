//! Readers of recorded data, and pictures (feature `std`).
//!
//! Readers stream: they hold one line in memory. Wrong data is an error with file and line, after which reading
//! goes on with the next line.

mod csv;
mod error;
mod figure;
mod lines;
mod picture;
mod scan_log;

pub use csv::{CsvLog, CsvReader};
pub use error::{ReadError, WriteError};
pub use figure::ScanFigure;
#[cfg(feature = "slam")]
pub(crate) use lines::Lines;
pub use picture::ScanPicture;
pub use scan_log::{LogEntry, LogGeometry, ScanLog, ScanLogReader};

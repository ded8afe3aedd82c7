//! Readers of recorded data and of plans (feature `std`), also of compressed files (feature `gzip`), and drawings of
//! scans (feature `figure`).
//!
//! Readers of tables and logs stream: they hold one line in memory. Invalid data gives an error with file and line, and
//! reading continues with the next line.

#[cfg(feature = "record")]
mod bag;
mod capture;
mod carmen;
mod csv;
#[cfg(feature = "dxf")]
mod dxf;
mod error;
#[cfg(feature = "figure")]
mod figure;
mod kitti;
mod lines;
mod log_entry;
mod lzf;
mod map_file;
mod pcap;
mod pcd;
#[cfg(feature = "figure")]
mod picture;
mod pixels;
mod plan;
mod plan_file;
mod plan_map;
mod scan_log;
#[cfg(feature = "dxf")]
mod spline;

#[cfg(feature = "record")]
pub use bag::{BagError, BagTopic};
pub use capture::VelodyneCapture;
pub use csv::{CsvLog, CsvReader};
pub use error::ReadError;
#[cfg(feature = "figure")]
pub use figure::{ScanFigure, WriteError};
pub use kitti::read_kitti;
#[cfg(feature = "slam")]
pub(crate) use lines::{Lines, shown};
pub use log_entry::LogEntry;
#[cfg(feature = "slam")]
pub(crate) use map_file::replace;
pub use map_file::{MapFile, SaveMap, SaveMapError, read_map_file, write_map_file};
pub use pcd::{RecordedCloud, read_cloud};
#[cfg(feature = "figure")]
pub use picture::ScanPicture;
pub use pixels::read_map;
pub use plan::{Plan, PlanOptions};
pub use plan_file::read_plan;
pub use plan_map::{PlanMap, PlanMapError, draw_plan};
pub use scan_log::{LogGeometry, ScanLog, ScanLogReader};

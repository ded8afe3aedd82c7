//! Reader of recordings: MCAP files, of Apex and of other programs, bags of ROS 1, and with the feature `sqlite` the
//! databases of rosbag2.
//!
//! A [`Recording`] is read from its beginning, one message after the other, so that it needs neither an index nor
//! statistics, and can be cut off. Chunks may be compressed (LZ4, Zstandard, bzip2) and are unpacked in Rust.
//! [`Contents`] are what a recording has: topics, types, numbers, rates, gaps. The bytes of a message are interpreted
//! elsewhere.

mod channel;
mod contents;
mod folder;
pub mod format;
mod mcap;
mod packed;
mod recording;
mod records;
mod ros1;
#[cfg(feature = "sqlite")]
mod sqlite;

pub use channel::{Channel, Message};
pub use contents::{Contents, Topic};
pub use folder::Folder;
pub use mcap::{CUT, Mcap};
pub use packed::message;
pub use recording::Recording;
pub use ros1::{ENCODING as ROS1, Ros1};
#[cfg(feature = "sqlite")]
pub use sqlite::Sqlite;

//! Recordings of any kind.

use crate::{
    channel::{Channel, Message},
    folder::{self, Folder},
    mcap::Mcap,
    packed,
    ros1::{self, Ros1},
};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, Read as _},
    path::Path,
};

#[cfg(feature = "sqlite")]
use crate::sqlite::{self, Sqlite};

/// Recording that is being read.
pub enum Recording {
    /// MCAP file.
    Mcap(Box<Mcap>),
    /// Bag of ROS 1.
    Ros1(Ros1),
    /// Database of rosbag2.
    #[cfg(feature = "sqlite")]
    Sqlite(Sqlite),
    /// Bag of rosbag2 that consists of several files.
    Folder(Folder),
}

impl Recording {
    /// Opens a recording of any kind: a file, or the folder of a bag of rosbag2.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording.
    pub fn open(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return folder::open(path);
        }
        let mut magic = vec![];
        File::open(path)?.take(16).read_to_end(&mut magic)?;
        let refuse = |why: &str| Err(io::Error::new(io::ErrorKind::InvalidData, why));
        match magic.as_slice() {
            #[cfg(feature = "sqlite")]
            magic if magic == sqlite::MAGIC => Sqlite::open(path).map(Self::Sqlite),
            #[cfg(not(feature = "sqlite"))]
            [b'S', b'Q', b'L', b'i', b't', b'e', ..] => refuse(
                "it is a database of rosbag2 (SQLite): build this program with the feature `sqlite`, or convert it with \
                 `ros2 bag convert` or `rosbags-convert`",
            ),
            magic if magic.starts_with(packed::MAGIC_OF_ZSTD) => {
                refuse("it is compressed as a whole: `zstd -d` unpacks it")
            }
            [0x1f, 0x8b, ..] => refuse("it is compressed as a whole: `gunzip` unpacks it"),
            magic if magic.starts_with(ros1::MAGIC_OF_ALL) => Ros1::open(path).map(Self::Ros1),
            _ => Mcap::open(path).map(|file| Self::Mcap(Box::new(file))),
        }
    }

    /// Channels that were read, by their number.
    pub fn channels(&self) -> &BTreeMap<u16, Channel> {
        match self {
            Self::Mcap(file) => &file.channels,
            Self::Ros1(bag) => &bag.channels,
            #[cfg(feature = "sqlite")]
            Self::Sqlite(database) => &database.channels,
            Self::Folder(folder) => &folder.channels,
        }
    }

    /// Returns the next message; `None` at the end, or where the file is cut off or damaged.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn next_message(&mut self) -> io::Result<Option<Message>> {
        match self {
            Self::Mcap(file) => file.next_message(),
            Self::Ros1(bag) => bag.next_message(),
            #[cfg(feature = "sqlite")]
            Self::Sqlite(database) => Ok(database.next_message()),
            Self::Folder(folder) => folder.next_message(),
        }
    }

    /// Reason why the file could not be read to its end.
    pub fn cut(&self) -> Option<&str> {
        match self {
            Self::Mcap(file) => file.cut.as_deref(),
            Self::Ros1(bag) => bag.cut.as_deref(),
            #[cfg(feature = "sqlite")]
            Self::Sqlite(database) => database.cut.as_deref(),
            Self::Folder(folder) => folder.cut.as_deref(),
        }
    }

    /// Name of the recorded program of Apex; `None` if another program has written the file.
    pub fn program(&self) -> Option<&str> {
        match self {
            Self::Mcap(file) => file.program.as_deref(),
            _ => None,
        }
    }

    /// Returns the time in ns from which times and the stamps of headers count. That is `first`, the time of the first
    /// message, in the recordings of other programs, which may begin in 1970, and in a later file of a recording that
    /// is divided; and zero otherwise.
    pub fn zero(&self, first: u64) -> u64 {
        match self {
            Self::Mcap(file) if file.program.is_some() && !matches!(file.files, Some((2.., _))) => 0,
            _ => first,
        }
    }
}

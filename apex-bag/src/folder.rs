//! Reader of a bag of rosbag2: a folder with its files and `metadata.yaml`, which has their names in order.

use crate::{Channel, Message, Recording};
use std::{
    collections::{BTreeMap, VecDeque},
    fs, io,
    path::{Path, PathBuf},
};

/// File with the names of the others.
const METADATA: &str = "metadata.yaml";

/// Bag that is being read, one file after the other.
pub struct Folder {
    /// Present file, and those after it.
    file: Box<Recording>,
    next: VecDeque<PathBuf>,
    /// Numbers of the channels of the present file here: each file has its own.
    numbers: BTreeMap<u16, u16>,
    /// Channels by their number.
    pub channels: BTreeMap<u16, Channel>,
    /// Reason why the bag could not be read to its end.
    pub cut: Option<String>,
}

/// Opens the bag in a folder: the file itself, if it has only one.
///
/// # Errors
/// The folder is not a bag, or its first file cannot be read.
pub fn open(folder: &Path) -> io::Result<Recording> {
    let mut files: VecDeque<PathBuf> = files(folder)?.into();
    let first = files.pop_front().ok_or_else(|| refusal(format!("its `{METADATA}` names no file")))?;
    let file = open_file(&first)?;
    if files.is_empty() {
        return Ok(file);
    }
    let mut folder =
        Folder { file: Box::new(file), next: files, numbers: BTreeMap::new(), channels: BTreeMap::new(), cut: None };
    folder.number_channels();
    Ok(Recording::Folder(folder))
}

/// Opens a file of a bag. Its name is a part of the error.
fn open_file(path: &Path) -> io::Result<Recording> {
    let named = |error: io::Error| io::Error::new(error.kind(), format!("its file `{}`: {error}", name_of(path)));
    match path.is_dir() {
        true => Err(refusal(format!("its file `{}` is a folder", name_of(path)))),
        false => Recording::open(path).map_err(named),
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn refusal(why: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why)
}

/// Paths of the files, in order.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let text = fs::read_to_string(folder.join(METADATA)).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => refusal(format!(
            "it is a folder without `{METADATA}`: name one of its files, or write it with `ros2 bag reindex`"
        )),
        kind => io::Error::new(kind, format!("its `{METADATA}`: {error}")),
    })?;
    // The names are in the folder, whatever stands before them.
    Ok(names(&text).iter().filter_map(|name| Path::new(name).file_name()).map(|name| folder.join(name)).collect())
}

/// Names of the files in `metadata.yaml`, which recorders write as a list of one name a line.
fn names(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim).skip_while(|line| *line != "relative_file_paths:").skip(1);
    let items = lines.map_while(|line| line.strip_prefix("- "));
    items.map(|name| name.trim().trim_matches(['"', '\''])).collect()
}

impl Folder {
    /// Returns the next message; `None` at the end, or where a file is cut off or damaged.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn next_message(&mut self) -> io::Result<Option<Message>> {
        loop {
            if let Some(message) = self.file.next_message()? {
                self.number_channels();
                let channel = self.numbers.get(&message.channel).copied().unwrap_or_default();
                return Ok(Some(Message { channel, ..message }));
            }
            if self.cut.is_some() {
                return Ok(None);
            }
            self.number_channels();
            // In the last file, this is the end of the bag; in another one, messages after it are missing.
            self.cut = self.file.cut().map(str::to_owned);
            let Some(next) = self.next.pop_front().filter(|_| self.cut.is_none()) else { return Ok(None) };
            *self.file = open_file(&next)?;
            self.numbers.clear();
        }
    }

    /// Gives the new channels of the present file numbers here: that of the same channel in an earlier file, or a new
    /// one.
    fn number_channels(&mut self) {
        if self.numbers.len() == self.file.channels().len() {
            return;
        }
        for (number, channel) in self.file.channels() {
            let known = self.channels.iter().find(|(_, known)| *known == channel).map(|(number, _)| *number);
            let here = known.unwrap_or_else(|| u16::try_from(self.channels.len()).unwrap_or(u16::MAX));
            self.channels.entry(here).or_insert_with(|| channel.clone());
            self.numbers.insert(*number, here);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_list() {
        let text = "rosbag2_bagfile_information:\n  version: 9\n  relative_file_paths:\n    - drive_0.mcap\n    \
                    - \"drive_1.mcap\"\n  files:\n    - path: drive_0.mcap\n";
        assert_eq!(names(text), ["drive_0.mcap", "drive_1.mcap"]);
        assert_eq!(names("version: 9\n"), [""; 0]);
        assert_eq!(names("relative_file_paths:\n- '../a b.db3'\n"), ["../a b.db3"]);
    }
}

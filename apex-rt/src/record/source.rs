//! Reads an MCAP file from its beginning, one message after the other, as far as it goes.

use super::sink::{DROPPED, PROGRAM};
use mcap::{
    McapError,
    records::Record,
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, Read as _},
    path::Path,
};

/// No message is larger: a length that says so is damage.
const LARGEST: usize = 1 << 30;

/// A channel of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct FileChannel {
    /// Its name.
    pub name: String,
    /// The name of its schema.
    pub schema: String,
    /// How its messages are written.
    pub encoding: String,
}

/// A message of a file.
#[derive(Debug)]
pub struct FileMessage {
    /// Its channel.
    pub channel: u16,
    /// Its number.
    pub sequence: u32,
    /// Its bytes.
    pub data: Vec<u8>,
}

/// A file that is read.
pub struct Source {
    file: File,
    reader: LinearReader,
    schemas: BTreeMap<u16, String>,
    /// The channels that it has named so far.
    pub channels: BTreeMap<u16, FileChannel>,
    /// The program that was recorded, as soon as it is known.
    pub program: Option<String>,
    /// What was lost, as the file says at its end.
    pub dropped: Vec<(String, u64)>,
    /// Why it could not be read to its end.
    pub cut: Option<String>,
    over: bool,
}

impl Source {
    /// Opens a file.
    ///
    /// # Errors
    /// Says why it cannot be read.
    pub fn open(path: &Path) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
        }
        let options = LinearReaderOptions::default().with_record_length_limit(LARGEST);
        Ok(Self {
            file: File::open(path)?,
            reader: LinearReader::new_with_options(options),
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            program: None,
            dropped: vec![],
            cut: None,
            over: false,
        })
    }

    /// The next message; `None` at the end, or where the file was cut.
    ///
    /// # Errors
    /// It is no recording at all, or it cannot be read.
    pub fn next(&mut self) -> io::Result<Option<FileMessage>> {
        while !self.over {
            let record = match self.reader.next_event() {
                None => None,
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => {
                    let read = self.file.read(self.reader.insert(wanted))?;
                    self.reader.notify_read(read);
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { data, opcode })) => match mcap::parse_record(opcode, data) {
                    Ok(record) => Some(record.into_owned()),
                    Err(error) => {
                        self.stop(&error);
                        continue;
                    }
                },
                Some(Err(McapError::BadMagic)) => {
                    let what = "it is no MCAP file, or its beginning is damaged";
                    return Err(io::Error::new(io::ErrorKind::InvalidData, what));
                }
                Some(Err(error)) => {
                    self.stop(&error);
                    continue;
                }
            };
            match record {
                None | Some(Record::DataEnd(_) | Record::Footer(_)) => self.over = true,
                Some(record) => {
                    if let Some(message) = self.record(record) {
                        return Ok(Some(message));
                    }
                }
            }
        }
        Ok(None)
    }

    fn stop(&mut self, error: &McapError) {
        self.over = true;
        self.cut = Some(match error {
            McapError::UnexpectedEof | McapError::UnexpectedEoc => "it was cut off".to_owned(),
            other => format!("it is damaged: {other}"),
        });
    }

    fn record(&mut self, record: Record<'static>) -> Option<FileMessage> {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
                let found = FileChannel { name: channel.topic, schema, encoding: channel.message_encoding };
                self.channels.insert(channel.id, found);
            }
            Record::Metadata(metadata) if metadata.name == PROGRAM => {
                self.program = metadata.metadata.get("name").cloned();
            }
            Record::Metadata(metadata) if metadata.name == DROPPED => {
                let counts = metadata.metadata.into_iter();
                self.dropped = counts.filter_map(|(name, count)| Some((name, count.parse().ok()?))).collect();
            }
            Record::Message { header, data } => {
                return Some(FileMessage {
                    channel: header.channel_id,
                    sequence: header.sequence,
                    data: data.into_owned(),
                });
            }
            _ => {}
        }
        None
    }
}

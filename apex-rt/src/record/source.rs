//! Reads an MCAP file from its beginning, one message after the other, as far as it goes: also a file that was cut off in
//! the middle of a chunk, or has wrong bytes in it.

use super::sink::{DROPPED, PROGRAM, THREADS};
use mcap::{MAGIC, McapError, parse_record, records::Record};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Read},
    path::Path,
};

/// No record is larger: a length that says so is damage.
const LARGEST: u64 = 1 << 30;
/// The kind of a record that holds others.
const CHUNK: u8 = 6;

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
    /// Its time, in nanoseconds.
    pub time: u64,
    /// Its number.
    pub sequence: u32,
    /// Its bytes.
    pub data: Vec<u8>,
}

/// A file that is read.
pub struct Source {
    file: BufReader<File>,
    /// The records of the chunk that is read, and how far it is.
    chunk: io::Cursor<Vec<u8>>,
    schemas: BTreeMap<u16, String>,
    /// The channels that it has named so far.
    pub channels: BTreeMap<u16, FileChannel>,
    /// The program that was recorded, as soon as it is known.
    pub program: Option<String>,
    /// The groups of threads that ran side by side, if any did.
    pub threads: Option<String>,
    /// What was lost, as the file says at its end.
    pub dropped: Vec<(String, u64)>,
    /// Why it could not be read to its end.
    pub cut: Option<String>,
    over: bool,
}

/// Why there is no next record.
enum Stop {
    /// The file ends in the middle of one.
    Cut,
    /// It makes no sense.
    Damage(String),
    /// It cannot be read.
    Io(io::Error),
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
        let mut file = BufReader::new(File::open(path)?);
        let mut magic = vec![];
        (&mut file).take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if !MAGIC.starts_with(&magic) {
            let what = "it is no MCAP file, or its beginning is damaged";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        Ok(Self {
            file,
            chunk: io::Cursor::default(),
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            program: None,
            threads: None,
            dropped: vec![],
            cut: None,
            over: false,
        })
    }

    /// The next message; `None` at the end, or where the file was cut.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn next(&mut self) -> io::Result<Option<FileMessage>> {
        while !self.over {
            match self.next_record() {
                Ok(Record::DataEnd(_) | Record::Footer(_)) => self.over = true,
                Ok(record) => {
                    if let Some(message) = self.record(record) {
                        return Ok(Some(message));
                    }
                }
                Err(Stop::Io(error)) => return Err(error),
                Err(Stop::Cut) => self.stop("it was cut off"),
                Err(Stop::Damage(what)) => self.stop(&format!("it is damaged: {what}")),
            }
        }
        Ok(None)
    }

    fn stop(&mut self, why: &str) {
        self.over = true;
        self.cut = Some(why.to_owned());
    }

    fn next_record(&mut self) -> Result<Record<'static>, Stop> {
        loop {
            if self.chunk.position() < self.chunk.get_ref().len() as u64 {
                let (kind, body) = read_record(&mut self.chunk)?;
                return parse(kind, &body);
            }
            let (kind, length) = read_head(&mut self.file)?;
            if kind != CHUNK {
                return parse(kind, &read_body(&mut self.file, length)?);
            }
            self.begin_chunk(length)?;
        }
    }

    /// Loads a chunk of so many bytes, or what is there of it.
    fn begin_chunk(&mut self, length: u64) -> Result<(), Stop> {
        let mut body = vec![];
        (&mut self.file).take(length).read_to_end(&mut body).map_err(Stop::Io)?;
        // Times, the size and the sum of what is in it, how it is compressed, and its length in the file.
        let (head, rest) = body.split_at_checked(24).ok_or(Stop::Cut)?;
        let (sum, rest) = rest.split_first_chunk::<4>().ok_or(Stop::Cut)?;
        let (name, rest) = rest.split_first_chunk::<4>().ok_or(Stop::Cut)?;
        if u32::from_le_bytes(*name) != 0 {
            return Err(Stop::Damage("or it was compressed, which recordings are not".to_owned()));
        }
        let (size, records) = rest.split_first_chunk::<8>().ok_or(Stop::Cut)?;
        if head[16..] != *size || u64::from_le_bytes(*size) < records.len() as u64 {
            return Err(Stop::Damage("a chunk has two lengths".to_owned()));
        }
        let is_whole = body.len() as u64 == length;
        let sum = u32::from_le_bytes(*sum);
        if is_whole && sum != 0 && crc32fast::hash(records) != sum {
            return Err(Stop::Damage("a chunk is not what was written".to_owned()));
        }
        self.chunk = io::Cursor::new(records.to_vec());
        if self.chunk.get_ref().is_empty() && !is_whole { Err(Stop::Cut) } else { Ok(()) }
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
                self.threads = metadata.metadata.get(THREADS).cloned();
            }
            Record::Metadata(metadata) if metadata.name == DROPPED => {
                let counts = metadata.metadata.into_iter();
                self.dropped = counts.filter_map(|(name, count)| Some((name, count.parse().ok()?))).collect();
            }
            Record::Message { header, data } => {
                return Some(FileMessage {
                    channel: header.channel_id,
                    time: header.log_time,
                    sequence: header.sequence,
                    data: data.into_owned(),
                });
            }
            _ => {}
        }
        None
    }
}

fn read_record(from: &mut impl Read) -> Result<(u8, Vec<u8>), Stop> {
    let (kind, length) = read_head(from)?;
    Ok((kind, read_body(from, length)?))
}

/// The kind of a record and the length of its body.
fn read_head(from: &mut impl Read) -> Result<(u8, u64), Stop> {
    let mut head = [0; 9];
    from.read_exact(&mut head).map_err(stop)?;
    let [kind, length @ ..] = head;
    let length = u64::from_le_bytes(length);
    if length > LARGEST {
        return Err(Stop::Damage(format!("a record says that it is {length} bytes long")));
    }
    Ok((kind, length))
}

fn read_body(from: &mut impl Read, length: u64) -> Result<Vec<u8>, Stop> {
    let mut body = vec![];
    from.take(length).read_to_end(&mut body).map_err(stop)?;
    if body.len() as u64 == length { Ok(body) } else { Err(Stop::Cut) }
}

fn parse(kind: u8, body: &[u8]) -> Result<Record<'static>, Stop> {
    let wrong = |error: McapError| Stop::Damage(error.to_string());
    parse_record(kind, body).map(Record::into_owned).map_err(wrong)
}

fn stop(error: io::Error) -> Stop {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => Stop::Cut,
        _ => Stop::Io(error),
    }
}

//! Reads an MCAP file from its beginning, one message after the other, as far as it goes: also a file that was cut off
//! in the middle of a chunk, or has wrong bytes in it. What the file says of itself at its end is compared with what
//! was read: one that is read to its end without a word is what was written.

use super::sink::{DROPPED, PROGRAM, THREADS};
use crc32fast::Hasher;
use mcap::{
    MAGIC, McapError, parse_record,
    records::{Record, Statistics, op},
};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Read},
    path::Path,
};

/// No record is larger: a length that says so is damage.
const LARGEST: u64 = 1 << 30;
/// Why a file ends where nothing is wrong before.
pub const CUT: &str = "it was cut off";
/// The bytes of a chunk before the records in it.
const CHUNK_HEAD: u64 = 40;
/// The kinds of the records that hold data, beside chunks.
const DATA: [u8; 8] =
    [op::HEADER, op::SCHEMA, op::CHANNEL, op::MESSAGE, op::METADATA, op::MESSAGE_INDEX, op::ATTACHMENT, op::DATA_END];
/// The kinds of the records in a chunk.
const IN_CHUNK: [u8; 3] = [op::SCHEMA, op::CHANNEL, op::MESSAGE];
/// The kinds of the records behind the data.
const SUMMARY: [u8; 7] = [
    op::SCHEMA,
    op::CHANNEL,
    op::STATISTICS,
    op::CHUNK_INDEX,
    op::METADATA_INDEX,
    op::ATTACHMENT_INDEX,
    op::SUMMARY_OFFSET,
];

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
    file: Summed,
    /// How many chunks were read, and messages of each channel.
    chunks: u32,
    counts: BTreeMap<u16, u64>,
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

/// A file with the checksum of what was read of it.
struct Summed {
    file: BufReader<File>,
    sum: Hasher,
}

impl Read for Summed {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(into)?;
        self.sum.update(&into[..count]);
        Ok(count)
    }
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
        let mut file = Summed { file: BufReader::new(File::open(path)?), sum: Hasher::new() };
        let mut magic = vec![];
        (&mut file).take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if !MAGIC.starts_with(&magic) {
            let what = "it is no MCAP file, or its beginning is damaged";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        Ok(Self {
            file,
            chunks: 0,
            counts: BTreeMap::new(),
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
            match self.next_record().and_then(|record| self.record(record)) {
                Ok(Some(message)) => return Ok(Some(message)),
                Ok(None) => {}
                Err(Stop::Io(error)) => return Err(error),
                Err(Stop::Cut) => self.stop(CUT),
                Err(Stop::Damage(what)) => self.stop(&format!("it is damaged: {what}")),
            }
        }
        Ok(None)
    }

    /// What is left of the file makes no sense.
    pub fn damaged(&mut self, what: &str) {
        self.stop(&format!("it is damaged: {what}"));
    }

    fn stop(&mut self, why: &str) {
        self.over = true;
        self.cut = Some(why.to_owned());
    }

    fn next_record(&mut self) -> Result<Record<'static>, Stop> {
        loop {
            if self.chunk.position() < self.chunk.get_ref().len() as u64 {
                let (kind, length) = read_head(&mut self.chunk)?;
                belongs(kind, &IN_CHUNK)?;
                return parse(kind, &read_body(&mut self.chunk, length)?);
            }
            let before = self.file.sum.clone();
            let (kind, length) = read_head(&mut self.file)?;
            if kind == op::CHUNK {
                self.begin_chunk(length)?;
                continue;
            }
            belongs(kind, &DATA)?;
            let record = parse(kind, &read_body(&mut self.file, length)?)?;
            if let Record::DataEnd(end) = &record {
                is_sum(before, end.data_section_crc, "its data")?;
            }
            return Ok(record);
        }
    }

    /// Reads what the file says of itself behind its data, and compares that with what was read.
    fn read_summary(&mut self) -> Result<(), Stop> {
        self.file.sum = Hasher::new();
        let mut statistics = None;
        loop {
            let (kind, length) = read_head(&mut self.file)?;
            if kind == op::FOOTER {
                self.read_footer(length)?;
                break;
            }
            belongs(kind, &SUMMARY)?;
            if let Record::Statistics(found) = parse(kind, &read_body(&mut self.file, length)?)? {
                statistics = Some(found);
            }
        }
        self.compare(&statistics.ok_or_else(|| Stop::Damage("it does not say how much is in it".to_owned()))?)
    }

    /// Reads the last record, whose last field is the sum of all after the data, and what ends the file.
    fn read_footer(&mut self, length: u64) -> Result<(), Stop> {
        let (mut places, mut sum, mut magic) = ([0; 16], [0; 4], [0; MAGIC.len()]);
        self.file.read_exact(&mut places).map_err(stop)?;
        let summed = self.file.sum.clone();
        self.file.read_exact(&mut sum).map_err(stop)?;
        is_sum(summed, u32::from_le_bytes(sum), "its index")?;
        self.file.read_exact(&mut magic).map_err(stop)?;
        let is_end = self.file.read(&mut [0]).map_err(Stop::Io)? == 0;
        match length as usize == places.len() + sum.len() && magic == MAGIC && is_end {
            true => Ok(()),
            false => Err(Stop::Damage("its end is not that of an MCAP file".to_owned())),
        }
    }

    /// Compares what is in the file with what it says.
    fn compare(&self, said: &Statistics) -> Result<(), Stop> {
        let count: u64 = self.counts.values().sum();
        // Channels without messages are not counted.
        let mut of_channels = said.channel_message_counts.iter().filter(|(_, count)| **count > 0);
        let is_same = count == said.message_count && said.chunk_count == self.chunks;
        match is_same && self.counts.iter().all(|found| of_channels.next() == Some(found)) {
            true => Ok(()),
            false => {
                let (chunks, messages) = (said.chunk_count, said.message_count);
                let found = self.chunks;
                let what =
                    format!("it says that it has {messages} messages in {chunks} chunks, and has {count} in {found}");
                Err(Stop::Damage(what))
            }
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
        let (is_whole, size_here) = (body.len() as u64 == length, u64::from_le_bytes(*size));
        if head[16..] != *size || size_here.checked_add(CHUNK_HEAD) != Some(length) {
            return Err(Stop::Damage("a chunk has two lengths".to_owned()));
        }
        let sum = u32::from_le_bytes(*sum);
        if is_whole && sum != 0 && crc32fast::hash(records) != sum {
            return Err(Stop::Damage("a chunk is not what was written".to_owned()));
        }
        self.chunks += 1;
        self.chunk = io::Cursor::new(records.to_vec());
        if self.chunk.get_ref().is_empty() && !is_whole { Err(Stop::Cut) } else { Ok(()) }
    }

    fn record(&mut self, record: Record<'static>) -> Result<Option<FileMessage>, Stop> {
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
            Record::Message { header, .. } if !self.channels.contains_key(&header.channel_id) => {
                return Err(Stop::Damage("a message is of a channel that it has not named".to_owned()));
            }
            Record::Message { header, data } => {
                *self.counts.entry(header.channel_id).or_default() += 1;
                return Ok(Some(FileMessage {
                    channel: header.channel_id,
                    time: header.log_time,
                    sequence: header.sequence,
                    data: data.into_owned(),
                }));
            }
            Record::DataEnd(_) => {
                self.read_summary()?;
                self.over = true;
            }
            _ => {}
        }
        Ok(None)
    }
}

/// Whether a record of this kind may stand here.
fn belongs(kind: u8, kinds: &[u8]) -> Result<(), Stop> {
    match kinds.contains(&kind) {
        true => Ok(()),
        false => Err(Stop::Damage(format!("a record of kind {kind} stands where none belongs"))),
    }
}

/// Whether `sum` is what was written; 0 says that there is none.
fn is_sum(sum: Hasher, written: u32, of: &str) -> Result<(), Stop> {
    match written == 0 || sum.finalize() == written {
        true => Ok(()),
        false => Err(Stop::Damage(format!("the checksum of {of} is another one"))),
    }
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

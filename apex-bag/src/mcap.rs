//! Reader of an MCAP file from its beginning, one message after the other. It also reads a file that was cut off in the
//! middle of a chunk, or has wrong bytes, up to that place, and goes on in the next file of a divided recording.
//! Checksums and the statistics at the end of the file are compared with what was read, so that a file without an error
//! is complete and unchanged.

use crate::{
    Channel, Message,
    format::{
        CHANNEL_NAME, DROPPED, GOES_ON, LZ4, MAGIC, MESSAGES, MESSAGES_OF_ROS1, NEXT, NUMBER, PROGRAM, SHAPE, THREADS,
        ZSTD, op,
    },
    packed::{Packing, unpack},
    records::{Record, Statistics},
};
use crc32fast::Hasher;
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufReader, Read},
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

/// Interval at which a file that is still being written is looked at.
const LOOK: Duration = Duration::from_millis(5);

/// Maximum length of a record, in bytes. A larger length is damage.
const LARGEST: u64 = 1 << 30;
/// The message without a field.
const EMPTY: &str = "std_msgs/msg/Empty";
/// Reason for the end of a file that ends in the middle of a record.
pub const CUT: &str = "it was cut off";
/// Length of a chunk before its records, in bytes.
const CHUNK_HEAD: u64 = 40;
/// Kinds of records with data, except chunks.
const DATA: [u8; 8] =
    [op::HEADER, op::SCHEMA, op::CHANNEL, op::MESSAGE, op::METADATA, op::MESSAGE_INDEX, op::ATTACHMENT, op::DATA_END];
/// Kinds of records in a chunk.
const IN_CHUNK: [u8; 3] = [op::SCHEMA, op::CHANNEL, op::MESSAGE];
/// Kinds of records after the data.
const SUMMARY: [u8; 7] = [
    op::SCHEMA,
    op::CHANNEL,
    op::STATISTICS,
    op::CHUNK_INDEX,
    op::METADATA_INDEX,
    op::ATTACHMENT_INDEX,
    op::SUMMARY_OFFSET,
];

/// MCAP file that is being read.
pub struct Mcap {
    path: PathBuf,
    /// The process for which the ends of files are waited for.
    follows: Option<u32>,
    file: Summed,
    /// Number of chunks and of messages in each channel that were read.
    chunks: u32,
    counts: BTreeMap<u16, u64>,
    /// Records of the current chunk, with the position in them.
    chunk: io::Cursor<Vec<u8>>,
    /// Name and shape of each schema.
    schemas: BTreeMap<u16, (String, Option<String>)>,
    /// Channels that were read, by their number.
    pub channels: BTreeMap<u16, Channel>,
    /// Name of the recorded program, once it was read.
    pub program: Option<String>,
    /// Number of the first file that was read in a recording that is divided, and of the present one.
    pub files: Option<(u64, u64)>,
    /// Name of the file in which the recording goes on.
    next_file: Option<String>,
    /// Names of the thread groups that ran in parallel, if any did.
    pub threads: Option<String>,
    /// Numbers of lost messages by channel, from the end of the file.
    pub dropped: Vec<(String, u64)>,
    /// Reason why the file could not be read to its end.
    pub cut: Option<String>,
    over: bool,
}

/// File with a position of its own: a checkpoint of the process (feature `studio`) has another one.
struct Positioned {
    file: File,
    at: u64,
    /// The process for which the end of the file is waited for, as long as it is.
    follows: Option<u32>,
}

impl Positioned {
    fn open(path: &Path, follows: Option<u32>) -> io::Result<Self> {
        Ok(Self { file: File::open(path)?, at: 0, follows })
    }

    fn read_some(&mut self, into: &mut [u8]) -> io::Result<usize> {
        #[cfg(unix)]
        let count = std::os::unix::fs::FileExt::read_at(&self.file, into, self.at)?;
        #[cfg(not(unix))]
        let count = self.file.read(into)?;
        self.at += count as u64;
        Ok(count)
    }
}

impl Read for Positioned {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            let count = self.read_some(into)?;
            if count > 0 || into.is_empty() || self.follows != Some(parent()) {
                return Ok(count);
            }
            thread::sleep(LOOK);
        }
    }
}

/// Number of the process that has started this one; another one after its end.
fn parent() -> u32 {
    #[cfg(unix)]
    return std::os::unix::process::parent_id();
    #[cfg(not(unix))]
    0
}

/// File with the checksum of the bytes that were read.
struct Summed {
    file: BufReader<Positioned>,
    sum: Hasher,
}

impl Summed {
    fn open(path: &Path, follows: Option<u32>) -> io::Result<Self> {
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
        }
        let mut file = Self { file: BufReader::new(Positioned::open(path, follows)?), sum: Hasher::new() };
        let mut magic = vec![];
        (&mut file).take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if !MAGIC.starts_with(&magic) {
            let what = "it is not an MCAP file, or its beginning is damaged";
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        Ok(file)
    }
}

impl Read for Summed {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(into)?;
        self.sum.update(&into[..count]);
        Ok(count)
    }
}

/// Reason why there is no next record.
enum Stop {
    /// The file ends in the middle of a record.
    Cut,
    /// The file is damaged.
    Damage(String),
    /// The file has something that is not supported.
    Unsupported(String),
    /// The file cannot be read.
    Io(io::Error),
}

impl Mcap {
    /// Opens a file.
    ///
    /// # Errors
    /// The file cannot be read, or is not an MCAP file.
    pub fn open(path: &Path) -> io::Result<Self> {
        Self::of(path, None)
    }

    /// Opens a file that the parent of this process writes: its end is waited for as long as that process runs.
    ///
    /// # Errors
    /// The file cannot be read, or is not an MCAP file.
    pub fn follow(path: &Path) -> io::Result<Self> {
        Self::of(path, Some(parent()))
    }

    fn of(path: &Path, follows: Option<u32>) -> io::Result<Self> {
        Ok(Self {
            path: path.to_owned(),
            follows,
            file: Summed::open(path, follows)?,
            chunks: 0,
            counts: BTreeMap::new(),
            chunk: io::Cursor::default(),
            schemas: BTreeMap::new(),
            channels: BTreeMap::new(),
            program: None,
            files: None,
            next_file: None,
            threads: None,
            dropped: vec![],
            cut: None,
            over: false,
        })
    }

    /// Returns the next message; `None` at the end, or where the file is cut off or damaged.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn next_message(&mut self) -> io::Result<Option<Message>> {
        while !self.over {
            match self.next_record().and_then(|record| self.record(record)) {
                Ok(Some(message)) => return Ok(Some(message)),
                Ok(None) => {}
                Err(Stop::Io(error)) => return Err(error),
                Err(Stop::Cut) => self.stop(CUT),
                Err(Stop::Damage(what)) => self.stop(&format!("it is damaged: {what}")),
                Err(Stop::Unsupported(what)) => self.stop(&what),
            }
        }
        Ok(None)
    }

    /// Reports that the rest of the file is damaged.
    pub fn damaged(&mut self, what: &str) {
        self.stop(&format!("it is damaged: {what}"));
    }

    /// Reads the metadata on the program, at the beginning of each file.
    fn begin_program(&mut self, about: &BTreeMap<String, String>) -> Result<(), Stop> {
        let name = about.get("name").cloned();
        let number: Option<u64> = about.get(NUMBER).and_then(|number| number.parse().ok());
        if let Some((_, before)) = self.files
            && (name != self.program || number != Some(before + 1))
        {
            return Err(Stop::Damage(format!("`{}` is not the next file of the recording", self.path.display())));
        }
        self.files = number.map(|number| (self.files.map_or(number, |(first, _)| first), number));
        self.threads = about.get(THREADS).cloned();
        self.program = name;
        Ok(())
    }

    /// Goes on in the next file of a recording that is divided.
    fn go_on(&mut self, name: &str) {
        // A name with a folder in it is not one of a recording.
        let path = self.path.with_file_name(Path::new(name).file_name().unwrap_or_default());
        match Summed::open(&path, self.follows) {
            Ok(file) => {
                (self.path, self.file, self.over) = (path, file, false);
                self.chunks = 0;
                self.counts.clear();
                self.schemas.clear();
                self.chunk = io::Cursor::default();
            }
            Err(error) => self.stop(&format!("it goes on in `{}`, which cannot be read: {error}", path.display())),
        }
    }

    fn stop(&mut self, why: &str) {
        self.over = true;
        self.cut = Some(why.to_owned());
    }

    fn next_record(&mut self) -> Result<Record, Stop> {
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
            if let Record::DataEnd(sum) = &record {
                is_sum(before, *sum, "its data")?;
            }
            return Ok(record);
        }
    }

    /// Reads the summary after the data, and compares its statistics with what was read.
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
        match statistics {
            Some(statistics) => self.compare(&statistics),
            // Other programs need not write any.
            None if self.program.is_none() => Ok(()),
            None => Err(Stop::Damage("it has no statistics".to_owned())),
        }
    }

    /// Reads the last record, whose last field is the checksum of everything after the data, and the end of the file.
    fn read_footer(&mut self, length: u64) -> Result<(), Stop> {
        let (mut places, mut sum, mut magic) = ([0; 16], [0; 4], [0; MAGIC.len()]);
        self.file.read_exact(&mut places).map_err(stop)?;
        let summed = self.file.sum.clone();
        self.file.read_exact(&mut sum).map_err(stop)?;
        is_sum(summed, u32::from_le_bytes(sum), "its index")?;
        self.file.read_exact(&mut magic).map_err(stop)?;
        self.file.file.get_mut().follows = None;
        let is_end = self.file.read(&mut [0]).map_err(Stop::Io)? == 0;
        match length as usize == places.len() + sum.len() && magic == *MAGIC && is_end {
            true => Ok(()),
            false => Err(Stop::Damage("its end is not that of an MCAP file".to_owned())),
        }
    }

    /// Compares the statistics of the file with what was read.
    fn compare(&self, said: &Statistics) -> Result<(), Stop> {
        let count: u64 = self.counts.values().sum();
        // Channels without messages are not counted.
        let mut of_channels = said.counts.iter().filter(|(_, count)| **count > 0);
        let is_same = count == said.messages && said.chunks == self.chunks;
        match is_same && self.counts.iter().all(|found| of_channels.next() == Some(found)) {
            true => Ok(()),
            false => {
                let (chunks, messages) = (said.chunks, said.messages);
                let found = self.chunks;
                let what = format!(
                    "its statistics count {messages} messages in {chunks} chunks, but it has {count} in {found}"
                );
                Err(Stop::Damage(what))
            }
        }
    }

    /// Loads a chunk of `length` bytes, or the part of it that is in the file.
    fn begin_chunk(&mut self, length: u64) -> Result<(), Stop> {
        let mut body = vec![];
        (&mut self.file).take(length).read_to_end(&mut body).map_err(Stop::Io)?;
        // Start and end time, uncompressed size, checksum, compression, and size in the file.
        let (head, rest) = body.split_at_checked(24).ok_or(Stop::Cut)?;
        let (sum, rest) = rest.split_first_chunk::<4>().ok_or(Stop::Cut)?;
        let (name, rest) = rest.split_first_chunk::<4>().ok_or(Stop::Cut)?;
        let name_length = u32::from_le_bytes(*name) as usize;
        let (name, rest) = rest.split_at_checked(name_length).ok_or(Stop::Cut)?;
        let packing = match name {
            [] => Packing::None,
            name if name == LZ4.as_bytes() => Packing::Lz4,
            name if name == ZSTD.as_bytes() => Packing::Zstd,
            name => {
                let name = String::from_utf8_lossy(&name[..name.len().min(20)]);
                let why = "which is not supported: write it again with `mcap compress --compression lz4`";
                return Err(Stop::Unsupported(format!("it is compressed with `{name}`, {why}")));
            }
        };
        let (size, records) = rest.split_first_chunk::<8>().ok_or(Stop::Cut)?;
        let (is_whole, size_here) = (body.len() as u64 == length, u64::from_le_bytes(*size));
        let (plain_size, head_size) = (number(&head[16..]), CHUNK_HEAD + name_length as u64);
        if packing == Packing::None && plain_size != size_here || size_here.checked_add(head_size) != Some(length) {
            return Err(Stop::Damage("a chunk has two different lengths".to_owned()));
        }
        let records = unpack(packing, records, plain_size, is_whole).map_err(Stop::Damage)?;
        let sum = u32::from_le_bytes(*sum);
        if is_whole && sum != 0 && crc32fast::hash(&records) != sum {
            return Err(Stop::Damage("the checksum of a chunk is wrong".to_owned()));
        }
        self.chunks += 1;
        self.chunk = io::Cursor::new(records);
        if self.chunk.get_ref().is_empty() && !is_whole { Err(Stop::Cut) } else { Ok(()) }
    }

    fn record(&mut self, record: Record) -> Result<Option<Message>, Stop> {
        match record {
            Record::Schema { id, name, encoding, data } => {
                // Earlier versions wrote nothing for types that are not messages. Other programs may write none for
                // messages, or write them in another language.
                let text = String::from_utf8_lossy(&data).into_owned();
                let is_empty = text.is_empty() && name != EMPTY;
                let shape =
                    Some(text).filter(|_| !is_empty && [MESSAGES, MESSAGES_OF_ROS1, SHAPE].contains(&&*encoding));
                self.schemas.insert(id, (name, shape));
            }
            Record::Channel { id, schema, topic, encoding, mut metadata } => {
                let (schema, shape) = self.schemas.get(&schema).cloned().unwrap_or_default();
                // Earlier versions wrote the name as the topic.
                let name = metadata.remove(CHANNEL_NAME).unwrap_or_else(|| topic.clone());
                let before = self.channels.insert(id, Channel { name, topic, schema, shape, encoding });
                if before.is_some_and(|before| Some(&before) != self.channels.get(&id)) {
                    return Err(Stop::Damage("its channels are not those of the file before".to_owned()));
                }
            }
            Record::Metadata { name, entries } if name == PROGRAM => self.begin_program(&entries)?,
            Record::Metadata { name, entries } if name == GOES_ON => self.next_file = entries.get(NEXT).cloned(),
            Record::Metadata { name, entries } if name == DROPPED => {
                let counts = entries.into_iter();
                self.dropped = counts.filter_map(|(name, count)| Some((name, count.parse().ok()?))).collect();
            }
            Record::Message { channel, .. } if !self.channels.contains_key(&channel) => {
                return Err(Stop::Damage("a message belongs to an unknown channel".to_owned()));
            }
            Record::Message { channel, sequence, time, data } => {
                *self.counts.entry(channel).or_default() += 1;
                return Ok(Some(Message { channel, time, sequence, data }));
            }
            Record::DataEnd(_) => {
                self.read_summary()?;
                self.over = true;
                if let Some(name) = self.next_file.take() {
                    self.go_on(&name);
                }
            }
            _ => {}
        }
        Ok(None)
    }
}

/// A number in a file.
fn number(bytes: &[u8]) -> u64 {
    bytes.try_into().map_or(0, u64::from_le_bytes)
}

/// Checks that a record of this kind may be at this place.
fn belongs(kind: u8, kinds: &[u8]) -> Result<(), Stop> {
    match kinds.contains(&kind) {
        true => Ok(()),
        false => Err(Stop::Damage(format!("unexpected record of kind {kind}"))),
    }
}

/// Checks that `sum` is the checksum that was `written`; 0 stands for no checksum.
fn is_sum(sum: Hasher, written: u32, of: &str) -> Result<(), Stop> {
    match written == 0 || sum.finalize() == written {
        true => Ok(()),
        false => Err(Stop::Damage(format!("the checksum of {of} is wrong"))),
    }
}

/// Reads the kind of a record and the length of its body.
fn read_head(from: &mut impl Read) -> Result<(u8, u64), Stop> {
    let mut head = [0; 9];
    from.read_exact(&mut head).map_err(stop)?;
    let [kind, length @ ..] = head;
    let length = u64::from_le_bytes(length);
    if length > LARGEST {
        return Err(Stop::Damage(format!("a record claims a length of {length} bytes")));
    }
    Ok((kind, length))
}

fn read_body(from: &mut impl Read, length: u64) -> Result<Vec<u8>, Stop> {
    let mut body = vec![];
    from.take(length).read_to_end(&mut body).map_err(stop)?;
    if body.len() as u64 == length { Ok(body) } else { Err(Stop::Cut) }
}

fn parse(kind: u8, body: &[u8]) -> Result<Record, Stop> {
    Record::read(kind, body).map_err(Stop::Damage)
}

fn stop(error: io::Error) -> Stop {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => Stop::Cut,
        _ => Stop::Io(error),
    }
}

//! Writer of an MCAP file: messages in chunks, which may be compressed, and the index at the end.
//!
//! Chunks are compressed by a library without C, in the frame format of LZ4, which every reader of MCAP knows.

use apex_bag::format::{LZ4, MAGIC, op};
use crc32fast::Hasher;
use lz4_flex::frame::{BlockMode, BlockSize, FrameEncoder, FrameInfo};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufWriter, Write as _},
};

/// Length of the record of a chunk besides its messages and the name of its compression, and of what the index at the
/// end has on a chunk or a channel in it, in bytes.
const OF_CHUNK: usize = 256;
/// Length of the record of an index in a chunk besides its entries, and of its place in the index at the end, in bytes.
const OF_INDEX: usize = 32;
/// Length of an entry for a message, in bytes.
const OF_MESSAGE: usize = 16;

/// A message, without its bytes.
pub struct Head {
    /// Number of the channel.
    pub channel: u16,
    /// Sequence number.
    pub sequence: u32,
    /// Time in ns.
    pub time: u64,
}

/// Beginning of a record whose length is not known yet.
fn begin(kind: u8, out: &mut Vec<u8>) -> usize {
    out.push(kind);
    out.extend_from_slice(&[0; 8]);
    out.len()
}

/// Writes the length of the record whose body begins at `start`.
fn end(start: usize, out: &mut [u8]) {
    let length = (out.len() - start) as u64;
    out[start - 8..start].copy_from_slice(&length.to_le_bytes());
}

fn text(text: &str, out: &mut Vec<u8>) {
    out.extend_from_slice(&(text.len() as u32).to_le_bytes());
    out.extend_from_slice(text.as_bytes());
}

/// Writes a table with the length of its entries before it.
fn table<T>(entries: impl IntoIterator<Item = T>, out: &mut Vec<u8>, write: impl Fn(T, &mut Vec<u8>)) {
    let start = out.len();
    out.extend_from_slice(&[0; 4]);
    entries.into_iter().for_each(|entry| write(entry, out));
    let length = (out.len() - start - 4) as u32;
    out[start..start + 4].copy_from_slice(&length.to_le_bytes());
}

fn counts(map: &BTreeMap<u16, u64>, out: &mut Vec<u8>) {
    table(map, out, |(channel, count), out| {
        out.extend_from_slice(&channel.to_le_bytes());
        out.extend_from_slice(&count.to_le_bytes());
    });
}

/// The chunk that is being filled.
#[derive(Default)]
struct Chunk {
    records: Vec<u8>,
    first: u64,
    last: u64,
    /// Time and place of each message, by channel.
    messages: BTreeMap<u16, Vec<(u64, u64)>>,
    count: usize,
}

/// The file that is being written.
pub struct Out {
    file: BufWriter<File>,
    /// Number of bytes that were written.
    size: u64,
    sum: Hasher,
    compress: bool,
    chunk: Chunk,
    /// Records of the index at the end: schemas, channels, chunks, metadata.
    schemas: Vec<u8>,
    channels: Vec<u8>,
    chunks: Vec<u8>,
    metadata: Vec<u8>,
    schema_count: u16,
    channel_count: u32,
    chunk_count: u32,
    metadata_count: u32,
    counts: BTreeMap<u16, u64>,
    /// Times of the first and the last message.
    times: Option<(u64, u64)>,
}

impl Out {
    /// Begins a file.
    ///
    /// # Errors
    /// It cannot be written, as with all other methods.
    pub fn new(file: File, compress: bool) -> io::Result<Self> {
        let mut out = Self {
            file: BufWriter::new(file),
            size: 0,
            sum: Hasher::new(),
            compress,
            chunk: Chunk::default(),
            schemas: vec![],
            channels: vec![],
            chunks: vec![],
            metadata: vec![],
            schema_count: 0,
            channel_count: 0,
            chunk_count: 0,
            metadata_count: 0,
            counts: BTreeMap::new(),
            times: None,
        };
        out.put(MAGIC)?;
        out.whole(op::HEADER, |record| {
            text("ros2", record);
            text(concat!("apex ", env!("CARGO_PKG_VERSION")), record);
        })?;
        Ok(out)
    }

    /// Adds a channel with an entry of metadata and a schema of its own.
    pub fn channel(
        &mut self,
        id: u16,
        topic: &str,
        metadata: (&str, &str),
        encoding: &str,
        schema: (&str, &str, &str),
    ) -> io::Result<()> {
        self.schema_count += 1;
        self.channel_count += 1;
        let (schema_id, (schema_name, schema_encoding, data)) = (self.schema_count, schema);
        let written = self.whole(op::SCHEMA, |record| {
            record.extend_from_slice(&schema_id.to_le_bytes());
            text(schema_name, record);
            text(schema_encoding, record);
            text(data, record);
        })?;
        self.schemas.extend_from_slice(&written);
        let written = self.whole(op::CHANNEL, |record| {
            record.extend_from_slice(&id.to_le_bytes());
            record.extend_from_slice(&schema_id.to_le_bytes());
            text(topic, record);
            text(encoding, record);
            table([metadata], record, |(key, value), record| {
                text(key, record);
                text(value, record);
            });
        })?;
        self.channels.extend_from_slice(&written);
        Ok(())
    }

    /// Adds metadata. The chunk ends before it.
    pub fn metadata(&mut self, name: &str, entries: &BTreeMap<String, String>) -> io::Result<()> {
        self.end_chunk()?;
        let at = self.size;
        let written = self.whole(op::METADATA, |record| {
            text(name, record);
            table(entries, record, |(key, value), record| {
                text(key, record);
                text(value, record);
            });
        })?;
        self.metadata_count += 1;
        let start = begin(op::METADATA_INDEX, &mut self.metadata);
        self.metadata.extend_from_slice(&at.to_le_bytes());
        self.metadata.extend_from_slice(&(written.len() as u64).to_le_bytes());
        text(name, &mut self.metadata);
        end(start, &mut self.metadata);
        Ok(())
    }

    /// Adds a message to the chunk.
    pub fn message(&mut self, head: &Head, data: &[u8]) {
        let Head { channel, sequence, time } = *head;
        let chunk = &mut self.chunk;
        let at = chunk.records.len() as u64;
        let start = begin(op::MESSAGE, &mut chunk.records);
        chunk.records.extend_from_slice(&channel.to_le_bytes());
        chunk.records.extend_from_slice(&sequence.to_le_bytes());
        chunk.records.extend_from_slice(&time.to_le_bytes());
        chunk.records.extend_from_slice(&time.to_le_bytes());
        chunk.records.extend_from_slice(data);
        end(start, &mut chunk.records);
        let (first, last) = if at == 0 { (time, time) } else { (chunk.first, chunk.last) };
        (chunk.first, chunk.last) = (first.min(time), last.max(time));
        chunk.messages.entry(channel).or_default().push((time, at));
        chunk.count += 1;
        *self.counts.entry(channel).or_default() += 1;
        let (first, last) = self.times.unwrap_or((time, time));
        self.times = Some((first.min(time), last.max(time)));
    }

    /// Number of bytes in the chunk that is being filled.
    pub fn chunk_len(&self) -> usize {
        self.chunk.records.len()
    }

    /// Number of bytes that the end of the file takes now, with that of the chunk: an upper limit.
    pub fn rest(&self) -> u64 {
        let chunk = &self.chunk;
        let index = chunk.messages.len() * OF_INDEX + chunk.count * OF_MESSAGE;
        // What cannot be compressed gets a little longer.
        let records = chunk.records.len() + chunk.records.len() / 256;
        let summary = [&self.schemas, &self.channels, &self.chunks, &self.metadata].map(Vec::len).iter().sum::<usize>();
        (records + index + summary + self.counts.len() * OF_MESSAGE + 4 * OF_CHUNK) as u64
    }

    /// Number of bytes that were written.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Time of the last message, in ns.
    pub fn last(&self) -> u64 {
        self.times.map_or(0, |(_, last)| last)
    }

    /// Writes the chunk, if there is something in it, with the index of its messages.
    pub fn end_chunk(&mut self) -> io::Result<()> {
        if self.chunk.records.is_empty() {
            return Ok(());
        }
        let chunk = std::mem::take(&mut self.chunk);
        let (plain, sum) = (chunk.records.len() as u64, crc32fast::hash(&chunk.records));
        let (name, records) = if self.compress { (LZ4, compressed(&chunk.records)?) } else { ("", chunk.records) };
        let (at, times) = (self.size, [chunk.first, chunk.last]);
        self.whole(op::CHUNK, |record| {
            times.iter().for_each(|time| record.extend_from_slice(&time.to_le_bytes()));
            record.extend_from_slice(&plain.to_le_bytes());
            record.extend_from_slice(&sum.to_le_bytes());
            text(name, record);
            record.extend_from_slice(&(records.len() as u64).to_le_bytes());
            record.extend_from_slice(&records);
        })?;
        let (length, mut places) = (self.size - at, BTreeMap::new());
        let index_at = self.size;
        for (channel, messages) in &chunk.messages {
            places.insert(*channel, self.size);
            self.whole(op::MESSAGE_INDEX, |record| {
                record.extend_from_slice(&channel.to_le_bytes());
                table(messages, record, |(time, at), record| {
                    record.extend_from_slice(&time.to_le_bytes());
                    record.extend_from_slice(&at.to_le_bytes());
                });
            })?;
        }
        self.chunk_count += 1;
        let (start, index) = (begin(op::CHUNK_INDEX, &mut self.chunks), self.size - index_at);
        let out = &mut self.chunks;
        [times[0], times[1], at, length].iter().for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
        counts(&places, out);
        out.extend_from_slice(&index.to_le_bytes());
        text(name, out);
        [records.len() as u64, plain].iter().for_each(|number| out.extend_from_slice(&number.to_le_bytes()));
        end(start, out);
        Ok(())
    }

    /// Writes everything to the file, so that a reader finds all messages until now.
    pub fn flush(&mut self) -> io::Result<()> {
        self.end_chunk()?;
        self.file.flush()
    }

    /// Ends the file with its index.
    pub fn finish(mut self) -> io::Result<()> {
        self.end_chunk()?;
        let sum = self.sum.clone().finalize();
        self.whole(op::DATA_END, |record| record.extend_from_slice(&sum.to_le_bytes()))?;
        self.sum = Hasher::new();
        let summary_at = self.size;
        let mut statistics = vec![];
        let start = begin(op::STATISTICS, &mut statistics);
        self.statistics(&mut statistics);
        end(start, &mut statistics);
        let groups = [
            (op::SCHEMA, std::mem::take(&mut self.schemas)),
            (op::CHANNEL, std::mem::take(&mut self.channels)),
            (op::STATISTICS, statistics),
            (op::CHUNK_INDEX, std::mem::take(&mut self.chunks)),
            (op::METADATA_INDEX, std::mem::take(&mut self.metadata)),
        ];
        let mut places = vec![];
        for (kind, records) in groups.iter().filter(|(_, records)| !records.is_empty()) {
            places.push((*kind, self.size, records.len() as u64));
            self.put(records)?;
        }
        let offsets_at = self.size;
        for (kind, at, length) in places {
            self.whole(op::SUMMARY_OFFSET, |record| {
                record.push(kind);
                record.extend_from_slice(&at.to_le_bytes());
                record.extend_from_slice(&length.to_le_bytes());
            })?;
        }
        // The checksum in the last record covers the record up to it.
        let mut footer = vec![];
        let start = begin(op::FOOTER, &mut footer);
        footer.extend_from_slice(&summary_at.to_le_bytes());
        footer.extend_from_slice(&offsets_at.to_le_bytes());
        footer.extend_from_slice(&[0; 4]);
        end(start, &mut footer);
        let before = footer.len() - 4;
        self.sum.update(&footer[..before]);
        let sum = self.sum.clone().finalize();
        footer[before..].copy_from_slice(&sum.to_le_bytes());
        self.put(&footer)?;
        self.put(MAGIC)?;
        self.file.flush()?;
        self.file.get_ref().sync_data()
    }

    fn statistics(&self, out: &mut Vec<u8>) {
        let messages: u64 = self.counts.values().sum();
        let (first, last) = self.times.unwrap_or_default();
        out.extend_from_slice(&messages.to_le_bytes());
        out.extend_from_slice(&self.schema_count.to_le_bytes());
        // No attachments.
        for count in [self.channel_count, 0, self.metadata_count, self.chunk_count] {
            out.extend_from_slice(&count.to_le_bytes());
        }
        out.extend_from_slice(&first.to_le_bytes());
        out.extend_from_slice(&last.to_le_bytes());
        counts(&self.counts, out);
    }

    /// Writes a record, and returns its bytes.
    fn whole(&mut self, kind: u8, write: impl FnOnce(&mut Vec<u8>)) -> io::Result<Vec<u8>> {
        let mut record = vec![];
        let start = begin(kind, &mut record);
        write(&mut record);
        end(start, &mut record);
        self.put(&record)?;
        Ok(record)
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        self.sum.update(bytes);
        self.size += bytes.len() as u64;
        Ok(())
    }
}

/// Returns a frame of LZ4. Its blocks are small: of a frame that is cut off, those before can be read.
fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let info = FrameInfo::new().block_size(BlockSize::Max64KB).block_mode(BlockMode::Linked);
    let mut encoder = FrameEncoder::with_frame_info(info, Vec::with_capacity(bytes.len() / 4));
    encoder.write_all(bytes)?;
    encoder.finish().map_err(io::Error::other)
}

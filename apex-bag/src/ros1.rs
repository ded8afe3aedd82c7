//! Reader of a bag of ROS 1 (version 2.0) from its beginning, one message after the other. A bag that was not closed is
//! read up to its end; it needs no index.

use crate::{
    Channel, Message,
    mcap::CUT,
    packed::{LARGEST, Packing, unpack},
};
use std::{
    collections::{BTreeMap, HashMap},
    fs::File,
    io::{self, BufReader, Cursor, Read},
    path::Path,
};

/// First line of a bag.
pub const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// Beginning of the first line of all versions.
pub const MAGIC_OF_ALL: &[u8] = b"#ROSBAG V";
/// Encoding of the messages.
pub const ENCODING: &str = "ros1";
/// Codes of records.
const MESSAGE: u8 = 2;
const HEAD: u8 = 3;
const CHUNK: u8 = 5;
const CONNECTION: u8 = 7;

/// Bag that is being read.
pub struct Ros1 {
    file: BufReader<File>,
    /// Number of bytes that were read.
    at: u64,
    /// Records of the current chunk, with the position in them.
    chunk: Cursor<Vec<u8>>,
    /// Number of the channel of each connection.
    numbers: HashMap<u32, u16>,
    /// Channels that were read, by their number.
    pub channels: BTreeMap<u16, Channel>,
    /// Place of the index; 0 in a bag that was not closed.
    index: u64,
    /// Reason why the bag could not be read to its end.
    pub cut: Option<String>,
    over: bool,
}

/// Reason for the end of the records.
enum Stop {
    End,
    Cut,
    Damage(String),
    Io(io::Error),
}

const fn damage(what: String) -> Stop {
    Stop::Damage(what)
}

impl Ros1 {
    /// Opens a bag.
    ///
    /// # Errors
    /// The file cannot be read, or is not a bag of version 2.0.
    pub fn open(path: &Path) -> io::Result<Self> {
        let mut file = BufReader::new(File::open(path)?);
        let mut magic = vec![];
        (&mut file).take(MAGIC.len() as u64).read_to_end(&mut magic)?;
        if magic != MAGIC {
            let what = if magic.starts_with(MAGIC_OF_ALL) {
                "it is a bag of an earlier version: migrate it with `rosbag fix`"
            } else {
                "it is not a bag of ROS 1"
            };
            return Err(io::Error::new(io::ErrorKind::InvalidData, what));
        }
        let (chunk, numbers, channels) = (Cursor::default(), HashMap::new(), BTreeMap::new());
        Ok(Self { file, at: MAGIC.len() as u64, chunk, numbers, channels, index: 0, cut: None, over: false })
    }

    /// Returns the next message; `None` at the end, or where the bag is cut off or damaged.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn next_message(&mut self) -> io::Result<Option<Message>> {
        while !self.over {
            match self.record() {
                Ok(Some(message)) => return Ok(Some(message)),
                Ok(None) => {}
                Err(Stop::Io(error)) => return Err(error),
                Err(stop) => {
                    self.over = true;
                    self.cut = match stop {
                        Stop::End if self.index != 0 && self.at >= self.index => None,
                        Stop::Damage(what) => Some(format!("it is damaged: {what}")),
                        _ => Some(CUT.to_owned()),
                    };
                }
            }
        }
        Ok(None)
    }

    fn record(&mut self) -> Result<Option<Message>, Stop> {
        let is_in_chunk = self.chunk.position() < self.chunk.get_ref().len() as u64;
        let (header, data) = if is_in_chunk {
            let records = &mut self.chunk;
            (block(records, &mut 0)?.ok_or(Stop::Cut)?, block(records, &mut 0)?.ok_or(Stop::Cut)?)
        } else {
            let header = block(&mut self.file, &mut self.at)?.ok_or(Stop::End)?;
            (header, block(&mut self.file, &mut self.at)?.ok_or(Stop::Cut)?)
        };
        match field(&header, b"op") {
            Some([HEAD]) => {
                let index = field(&header, b"index_pos").and_then(<[u8]>::first_chunk);
                self.index = u64::from_le_bytes(*index.ok_or_else(|| missing("index_pos"))?);
            }
            // Chunks of chunks without end would overflow the stack.
            Some([CHUNK]) if is_in_chunk => return Err(damage("a chunk contains another one".to_owned())),
            Some([CHUNK]) => self.begin_chunk(&header, &data)?,
            Some([CONNECTION]) => self.connect(&header, &data)?,
            Some([MESSAGE]) => return self.message(&header, data).map(Some),
            _ => {}
        }
        Ok(None)
    }

    fn begin_chunk(&mut self, header: &[u8], data: &[u8]) -> Result<(), Stop> {
        let size = field(header, b"size").and_then(<[u8]>::first_chunk);
        let size = u32::from_le_bytes(*size.ok_or_else(|| missing("size"))?);
        let packing = match field(header, b"compression") {
            Some(b"none") => Packing::None,
            Some(b"lz4") => Packing::Lz4,
            Some(b"bz2") => Packing::Bzip2,
            other => {
                let name = String::from_utf8_lossy(other.unwrap_or_default()).into_owned();
                return Err(damage(format!("a chunk is compressed with `{name}`")));
            }
        };
        self.chunk = Cursor::new(unpack(packing, data, size.into(), true).map_err(damage)?);
        Ok(())
    }

    fn connect(&mut self, header: &[u8], data: &[u8]) -> Result<(), Stop> {
        let text = |name: &str, of| {
            let bytes = field(of, name.as_bytes()).ok_or_else(|| missing(name))?;
            Ok(String::from_utf8_lossy(bytes).into_owned())
        };
        let connection = number(header, "conn")?;
        let (topic, ty) = (text("topic", header)?, text("type", data)?);
        let shape = text("message_definition", data).ok().filter(|text| !text.is_empty());
        let next = u16::try_from(self.numbers.len()).map_err(|_| damage("it has too many connections".to_owned()))?;
        let id = *self.numbers.entry(connection).or_insert(next);
        let schema = ty.replacen('/', "/msg/", 1);
        let channel = Channel { name: topic.clone(), topic, schema, shape, encoding: ENCODING.to_owned() };
        self.channels.entry(id).or_insert(channel);
        Ok(())
    }

    fn message(&self, header: &[u8], data: Vec<u8>) -> Result<Message, Stop> {
        let connection = number(header, "conn")?;
        let unknown = || damage("a message belongs to an unknown connection".to_owned());
        let channel = *self.numbers.get(&connection).ok_or_else(unknown)?;
        let time = field(header, b"time").and_then(<[u8]>::first_chunk).ok_or_else(|| missing("time"))?;
        let time = u64::from_le_bytes(*time);
        let (seconds, nanos) = (time & u64::from(u32::MAX), time >> 32);
        Ok(Message { channel, time: seconds * 1_000_000_000 + nanos, sequence: 0, data })
    }
}

fn missing(name: &str) -> Stop {
    Stop::Damage(format!("a record has no field `{name}`"))
}

fn number(header: &[u8], name: &str) -> Result<u32, Stop> {
    let bytes = field(header, name.as_bytes()).and_then(<[u8]>::first_chunk).ok_or_else(|| missing(name))?;
    Ok(u32::from_le_bytes(*bytes))
}

/// Reads bytes whose number precedes them; `None` where there is nothing.
fn block(from: &mut impl Read, at: &mut u64) -> Result<Option<Vec<u8>>, Stop> {
    let mut head = vec![];
    from.take(4).read_to_end(&mut head).map_err(Stop::Io)?;
    let Some(length) = head.first_chunk() else {
        return if head.is_empty() { Ok(None) } else { Err(Stop::Cut) };
    };
    let length = u64::from(u32::from_le_bytes(*length));
    if length > LARGEST {
        return Err(damage(format!("a record claims a length of {length} bytes")));
    }
    let mut body = vec![];
    from.take(length).read_to_end(&mut body).map_err(Stop::Io)?;
    if (body.len() as u64) < length {
        return Err(Stop::Cut);
    }
    *at += 4 + length;
    Ok(Some(body))
}

/// Value of a field of a record header.
fn field<'a>(mut header: &'a [u8], name: &[u8]) -> Option<&'a [u8]> {
    while let Some((length, rest)) = header.split_first_chunk::<4>() {
        let (field, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        if let Some(value) = field.strip_prefix(name).and_then(|rest| rest.strip_prefix(b"=")) {
            return Some(value);
        }
        header = rest;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use lz4_flex::frame::FrameEncoder;
    use std::{fs, io::Write as _};

    fn sized(bytes: &[u8]) -> Vec<u8> {
        [&(bytes.len() as u32).to_le_bytes(), bytes].concat()
    }

    fn record(fields: &[&[u8]], data: &[u8]) -> Vec<u8> {
        let header: Vec<u8> = fields.iter().flat_map(|field| sized(field)).collect();
        [sized(&header), sized(data)].concat()
    }

    fn field_of(name: &str, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), b"=", value].concat()
    }

    /// Chunk with two connections and a message of each.
    fn plain() -> Vec<u8> {
        let connection = |number: u32, topic: &str, ty: &str| {
            let about: Vec<u8> = [field_of("type", ty.as_bytes()), field_of("message_definition", b"float64 data")]
                .iter()
                .flat_map(|field| sized(field))
                .collect();
            let (number, topic) = (field_of("conn", &number.to_le_bytes()), field_of("topic", topic.as_bytes()));
            record(&[b"op=\x07", &number, &topic], &about)
        };
        let message = |number: u32, seconds: u32, nanos: u32, data: &[u8]| {
            let (number, time) =
                (field_of("conn", &number.to_le_bytes()), [seconds.to_le_bytes(), nanos.to_le_bytes()]);
            record(&[b"op=\x02", &number, &field_of("time", &time.concat())], data)
        };
        [
            connection(70_000, "/warmth", "std_msgs/Float64"),
            connection(3, "/cold", "std_msgs/Float64"),
            message(3, 5, 6, b"one"),
            message(70_000, 5, 7, b"two"),
        ]
        .concat()
    }

    /// Bag of a chunk and an index without entries.
    fn bag(compression: &str, size: u32, packed: &[u8]) -> Vec<u8> {
        let fields: [&[u8]; 3] =
            [b"op=\x05", &field_of("compression", compression.as_bytes()), &field_of("size", &size.to_le_bytes())];
        let (chunk, index) =
            (record(&fields, packed), |at: u64| record(&[b"op=\x03", &field_of("index_pos", &at.to_le_bytes())], b" "));
        let head = index(0);
        let end = (MAGIC.len() + head.len() + chunk.len()) as u64;
        [MAGIC, &index(end), &chunk].concat()
    }

    fn read(name: &str, bytes: &[u8]) -> io::Result<(Vec<Message>, Ros1)> {
        let path = std::env::temp_dir().join(format!("apex-bag-{}-{name}", std::process::id()));
        fs::write(&path, bytes)?;
        let mut bag = Ros1::open(&path)?;
        let mut messages = vec![];
        while let Some(message) = bag.next_message()? {
            messages.push(message);
        }
        fs::remove_file(&path)?;
        Ok((messages, bag))
    }

    #[test]
    fn messages_of_compressed_chunks_are_read() {
        let plain = plain();
        let mut lz4 = FrameEncoder::new(vec![]);
        lz4.write_all(&plain).expect("room");
        let size = plain.len() as u32;
        for (name, packed) in [("none", plain.clone()), ("lz4", lz4.finish().expect("room"))] {
            let (messages, bag) = read(name, &bag(name, size, &packed)).expect("a bag");
            assert_eq!(bag.cut, None, "{name}");
            let found: Vec<_> = messages
                .iter()
                .map(|message| (bag.channels[&message.channel].topic.as_str(), message.time, &*message.data))
                .collect();
            assert_eq!(found, [("/cold", 5_000_000_006, &b"one"[..]), ("/warmth", 5_000_000_007, b"two")]);
            let channel = &bag.channels[&0];
            assert_eq!((&*channel.schema, &*channel.encoding), ("std_msgs/msg/Float64", "ros1"));
            assert_eq!(channel.shape.as_deref(), Some("float64 data"));
        }
        let cut = |bytes: &[u8]| read("damaged.bag", bytes).expect("a file").1.cut.unwrap_or_default();
        assert!(cut(&bag("bz2", size, b"BZh9")).contains("a chunk cannot be decompressed"));
        assert!(cut(&bag("xz", size, &plain)).contains("a chunk is compressed with `xz`"));
    }

    #[test]
    fn a_bag_that_ends_early_is_read_up_to_there() {
        let plain = plain();
        let whole = bag("none", plain.len() as u32, &plain);
        for length in MAGIC.len()..whole.len() {
            let (messages, bag) = read("cut.bag", &whole[..length]).expect("a bag");
            assert!(messages.len() <= 2 && bag.cut.as_deref() == Some(CUT), "{length}: {:?}", bag.cut);
        }
        for at in MAGIC.len()..whole.len() {
            for value in [0, 255] {
                let mut damaged = whole.clone();
                damaged[at] = value;
                let _ = read("bad.bag", &damaged).expect("a file");
            }
        }
    }

    #[test]
    fn chunks_of_chunks_and_other_versions_are_refused() {
        let plain = plain();
        let nested = record(&[b"op=\x05", b"compression=none", b"size=\0\0\0\0"], &plain);
        let (_, nested) = read("nested.bag", &bag("none", nested.len() as u32, &nested)).expect("a bag");
        assert_eq!(nested.cut.as_deref(), Some("it is damaged: a chunk contains another one"));
        let why = |bytes: &[u8]| read("other.bag", bytes).map(|_| ()).map_err(|error| error.to_string());
        assert!(why(b"#ROSBAG V1.2\n").is_err_and(|why| why.contains("rosbag fix")));
        assert!(why(b"PK").is_err_and(|why| why.contains("not a bag")));
    }
}

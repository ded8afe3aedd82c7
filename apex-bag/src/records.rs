//! Records of an MCAP file. Nothing is reserved for what a length in the file promises.

use crate::format::op;
use std::collections::BTreeMap;

/// Content of a record that is used.
pub enum Record {
    Schema {
        id: u16,
        name: String,
        encoding: String,
        data: Vec<u8>,
    },
    Channel {
        id: u16,
        schema: u16,
        topic: String,
        encoding: String,
        metadata: BTreeMap<String, String>,
    },
    Message {
        channel: u16,
        sequence: u32,
        time: u64,
        data: Vec<u8>,
    },
    Metadata {
        name: String,
        entries: BTreeMap<String, String>,
    },
    /// Checksum of the data; 0 for none.
    DataEnd(u32),
    Statistics(Statistics),
    /// A record of another kind.
    Other,
}

/// Numbers of things in a file.
pub struct Statistics {
    pub messages: u64,
    pub chunks: u32,
    /// Number of messages in each channel.
    pub counts: BTreeMap<u16, u64>,
}

impl Record {
    /// Reads the body of a record.
    pub fn read(kind: u8, bytes: &[u8]) -> Result<Self, String> {
        let mut body = Body(bytes);
        Self::fields(kind, &mut body).ok_or_else(|| format!("a record of kind {kind} is not valid"))
    }

    fn fields(kind: u8, body: &mut Body<'_>) -> Option<Self> {
        Some(match kind {
            op::SCHEMA => {
                let (id, name, encoding) = (body.u16()?, body.text()?, body.text()?);
                Self::Schema { id, name, encoding, data: body.block()?.to_vec() }
            }
            op::CHANNEL => Self::Channel {
                id: body.u16()?,
                schema: body.u16()?,
                topic: body.text()?,
                encoding: body.text()?,
                metadata: body.map(|body| body.text().zip(body.text()))?,
            },
            op::MESSAGE => {
                let (channel, sequence, time) = (body.u16()?, body.u32()?, body.u64()?);
                body.u64()?;
                Self::Message { channel, sequence, time, data: body.0.to_vec() }
            }
            op::METADATA => {
                Self::Metadata { name: body.text()?, entries: body.map(|body| body.text().zip(body.text()))? }
            }
            op::DATA_END => Self::DataEnd(body.u32()?),
            op::STATISTICS => {
                let (messages, _schemas, _channels) = (body.u64()?, body.u16()?, body.u32()?);
                let (_attachments, _metadata, chunks) = (body.u32()?, body.u32()?, body.u32()?);
                let (_first, _last) = (body.u64()?, body.u64()?);
                let counts = body.map(|body| body.u16().zip(body.u64()))?;
                Self::Statistics(Statistics { messages, chunks, counts })
            }
            _ => Self::Other,
        })
    }
}

/// Bytes of a record that have not been read yet.
struct Body<'a>(&'a [u8]);

impl<'a> Body<'a> {
    fn number<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (number, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*number)
    }

    fn u16(&mut self) -> Option<u16> {
        self.number().map(u16::from_le_bytes)
    }

    fn u32(&mut self) -> Option<u32> {
        self.number().map(u32::from_le_bytes)
    }

    fn u64(&mut self) -> Option<u64> {
        self.number().map(u64::from_le_bytes)
    }

    /// Bytes whose number precedes them.
    fn block(&mut self) -> Option<&'a [u8]> {
        let length = usize::try_from(self.u32()?).ok()?;
        let (block, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(block)
    }

    fn text(&mut self) -> Option<String> {
        str::from_utf8(self.block()?).ok().map(str::to_owned)
    }

    fn map<K: Ord, V>(&mut self, entry: impl Fn(&mut Self) -> Option<(K, V)>) -> Option<BTreeMap<K, V>> {
        let mut block = Body(self.block()?);
        let mut map = BTreeMap::new();
        while !block.0.is_empty() {
            let (key, value) = entry(&mut block)?;
            map.insert(key, value);
        }
        Some(map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_that_are_not_there_are_errors() {
        let schema = [&[1, 0][..], &[4, 0, 0, 0], b"name", &[2, 0, 0, 0], b"of", &[3, 0, 0, 0], &[7; 3]].concat();
        let channel = [
            &[1, 0, 1, 0][..],
            &[4, 0, 0, 0],
            b"name",
            &[2, 0, 0, 0],
            b"of",
            &[10, 0, 0, 0],
            &[1, 0, 0, 0, b'k'],
            &[1, 0, 0, 0, b'v'],
        ];
        for (kind, whole) in [(op::SCHEMA, schema), (op::CHANNEL, channel.concat())] {
            assert!(Record::read(kind, &whole).is_ok(), "{kind}");
            for at in 0..whole.len() {
                assert!(Record::read(kind, &whole[..at]).is_err(), "{kind}: {at} bytes");
                let mut huge = whole.clone();
                huge[at] = 255;
                if let Ok(Record::Schema { data, .. }) = Record::read(kind, &huge) {
                    assert!(data.len() <= whole.len());
                }
            }
        }
    }
}

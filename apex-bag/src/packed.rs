//! Decompression of chunks and messages. Nothing is reserved for what a length in the file promises: a decoder fills a
//! list that grows.

use bzip2_rs::DecoderReader;
use lz4_flex::frame::FrameDecoder;
use ruzstd::decoding::StreamingDecoder;
use std::{
    borrow::Cow,
    io::{self, Read},
};

/// Maximum length of what is decompressed, in bytes. A larger one is damage.
pub const LARGEST: u64 = 1 << 30;
/// First bytes of what Zstandard has compressed.
pub const MAGIC_OF_ZSTD: &[u8; 4] = &[0x28, 0xb5, 0x2f, 0xfd];

/// Compression of a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    /// Bytes as they are.
    None,
    /// Frame of LZ4.
    Lz4,
    /// Frame of Zstandard.
    Zstd,
    /// Stream of bzip2.
    Bzip2,
}

/// Returns the `size` bytes of a chunk; of one that is not whole, those that can be read.
///
/// # Errors
/// It cannot be decompressed, or has another length.
pub fn unpack(packing: Packing, packed: &[u8], size: u64, is_whole: bool) -> Result<Vec<u8>, String> {
    if size > LARGEST {
        return Err(format!("a chunk claims a length of {size} bytes"));
    }
    let mut bytes = vec![];
    let read = match packing {
        Packing::None => return Ok(packed.to_vec()),
        Packing::Lz4 => read(FrameDecoder::new(packed), size, &mut bytes),
        Packing::Bzip2 => read(DecoderReader::new(packed), size, &mut bytes),
        Packing::Zstd => {
            StreamingDecoder::new(packed).map_err(io::Error::other).and_then(|decoder| read(decoder, size, &mut bytes))
        }
    };
    match read {
        Ok(()) if bytes.len() as u64 == size => Ok(bytes),
        _ if !is_whole && bytes.len() as u64 <= size => Ok(bytes),
        _ => Err("a chunk cannot be decompressed".to_owned()),
    }
}

/// Reads at most one byte more than `size`.
fn read(from: impl Read, size: u64, into: &mut Vec<u8>) -> io::Result<()> {
    from.take(size + 1).read_to_end(into).map(drop)
}

/// Returns the bytes of a message, which the recorder of ROS 2 may have compressed with Zstandard, each for itself.
///
/// # Errors
/// It cannot be decompressed.
pub fn message(bytes: &[u8]) -> Result<Cow<'_, [u8]>, &'static str> {
    if !bytes.starts_with(MAGIC_OF_ZSTD) {
        return Ok(bytes.into());
    }
    let mut plain = vec![];
    let decoder = StreamingDecoder::new(bytes).map_err(io::Error::other);
    let is_read = decoder.and_then(|decoder| read(decoder, LARGEST, &mut plain)).is_ok();
    match is_read && plain.len() as u64 <= LARGEST {
        true => Ok(plain.into()),
        false => Err("it is compressed with zstd, and cannot be decompressed"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ruzstd::encoding::{CompressionLevel, compress_to_vec};

    /// 4,000 bytes that can be compressed.
    fn plain() -> Vec<u8> {
        (0..4000_u32).map(|i| (i * i / 700) as u8 & 7).collect()
    }

    /// The word "apex" 100 times, compressed by the library of bzip2.
    const BZIP2: &[u8] = &[
        66, 90, 104, 57, 49, 65, 89, 38, 83, 89, 45, 221, 9, 202, 0, 0, 49, 129, 128, 34, 0, 64, 64, 32, 0, 48, 205,
        52, 10, 84, 122, 98, 44, 69, 242, 44, 69, 194, 238, 72, 167, 10, 18, 5, 187, 161, 57, 64,
    ];

    fn zstd(bytes: &[u8]) -> Vec<u8> {
        compress_to_vec(bytes, CompressionLevel::Fastest)
    }

    #[test]
    fn what_is_compressed_comes_back_and_parts_do_not() {
        let (plain, apex) = (plain(), b"apex".repeat(100));
        for (packing, packed, plain) in [(Packing::Zstd, zstd(&plain), &plain), (Packing::Bzip2, BZIP2.to_vec(), &apex)]
        {
            let size = plain.len() as u64;
            assert_eq!(unpack(packing, &packed, size, true).as_ref(), Ok(plain));
            assert!(
                unpack(packing, &packed, size - 1, true).is_err() && unpack(packing, &packed, size + 1, true).is_err()
            );
            for length in 0..packed.len() - 1 {
                assert!(unpack(packing, &packed[..length], size, true).is_err_and(|why| why.contains("decompressed")));
                let part = unpack(packing, &packed[..length], size, false).unwrap_or_default();
                assert!(plain.starts_with(&part), "{packing:?} {length}");
            }
        }
        assert!(unpack(Packing::Zstd, &zstd(&plain), LARGEST + 1, true).is_err());
    }

    #[test]
    fn damage_is_no_panic_and_gets_no_more_than_was_promised() {
        let plain = plain();
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        for (packing, packed) in [(Packing::Zstd, zstd(&plain)), (Packing::Bzip2, BZIP2.to_vec())] {
            for _ in 0..20_000 {
                let mut bytes = packed.clone();
                for _ in 0..=random(4) {
                    let at = random(bytes.len());
                    bytes[at] = random(256) as u8;
                }
                let found = unpack(packing, &bytes, plain.len() as u64, random(2) == 0);
                assert!(found.is_err() || found.is_ok_and(|found| found.len() <= plain.len()));
            }
        }
    }

    #[test]
    fn messages_may_be_compressed_each_for_itself() {
        let plain = plain();
        assert_eq!(message(&zstd(&plain)).as_deref(), Ok(&plain[..]));
        assert!(message(&zstd(&plain)[..20]).is_err());
        assert!(matches!(message(b"plain"), Ok(Cow::Borrowed(b"plain"))));
    }
}

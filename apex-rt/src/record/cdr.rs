//! CDR, the binary encoding of ROS 2 messages (XCDR1, little endian). Foxglove and the Python package
//! `mcap-ros2-support` read it.

use super::Reason;
use crate::Time;

/// Definition of `std_msgs/Header` and of its contents.
pub const STD_HEADER: &str = "
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec";

/// Prefix of each message: little endian, no options.
const HEADER: [u8; 4] = [0, 1, 0, 0];

/// First bytes of what zstd has compressed.
pub(super) const ZSTD: &[u8; 4] = &[0x28, 0xb5, 0x2f, 0xfd];

/// Nanoseconds in a second.
const NANOS: i64 = 1_000_000_000;

/// Writer that appends a message to a buffer.
#[derive(Debug)]
pub struct Writer<'a> {
    bytes: &'a mut Vec<u8>,
    /// Beginning of the message in the buffer, from which numbers are aligned.
    start: usize,
}

impl<'a> Writer<'a> {
    /// Begins a message at the end of `bytes`.
    pub fn new(bytes: &'a mut Vec<u8>) -> Self {
        bytes.extend_from_slice(&HEADER);
        let start = bytes.len();
        Self { bytes, start }
    }

    fn put<const N: usize>(&mut self, number: [u8; N]) {
        while !(self.bytes.len() - self.start).is_multiple_of(N) {
            self.bytes.push(0);
        }
        self.bytes.extend_from_slice(&number);
    }

    /// Writes a `std_msgs/Header`. Its seconds are an `i32`: a stamp more than 68 years from the zero of the clock does
    /// not survive.
    pub fn header(&mut self, stamp: Time, frame: &str) {
        let (seconds, rest) = (stamp.as_nanos().div_euclid(NANOS), stamp.as_nanos().rem_euclid(NANOS));
        self.i32(i32::try_from(seconds).unwrap_or(if seconds < 0 { i32::MIN } else { i32::MAX }));
        self.u32(rest as u32);
        self.text(frame);
    }

    /// Writes a text, which ends with a zero byte in CDR.
    pub fn text(&mut self, text: &str) {
        self.u32(text.len() as u32 + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }
}

/// Reader of messages. All methods return the reason if the bytes do not have such a value.
#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

/// Reason for a message that ends too early.
const MISSING: Reason = Reason::Borrowed("bytes are missing");

impl<'a> Reader<'a> {
    /// Reads the message `bytes`.
    ///
    /// # Errors
    /// The bytes are not CDR, or in an order or a version that is not supported.
    pub fn new(bytes: &'a [u8]) -> Result<Self, Reason> {
        let (prefix, rest) = bytes.split_first_chunk::<4>().ok_or(MISSING)?;
        match prefix {
            // The last two bits are the number of bytes that were added at the end.
            [0, 1, _, options] => {
                let length = rest.len().checked_sub(usize::from(options & 3)).ok_or(MISSING)?;
                Ok(Self { bytes: &rest[..length], at: 0 })
            }
            [0, 0, ..] => Err("its numbers are big-endian, which is not supported".into()),
            [0, 2..=11, ..] => Err("it is encoded in a version of CDR that is not supported".into()),
            ZSTD => Err("it is compressed with zstd: record without a compression of messages".into()),
            _ => Err("it does not begin as CDR".into()),
        }
    }

    fn get<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let at = self.at.next_multiple_of(N);
        let number = self.bytes.get(at..).and_then(<[u8]>::first_chunk).ok_or(MISSING)?;
        self.at = at + N;
        Ok(*number)
    }

    /// Reads a number of bytes.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8], Reason> {
        let end = self.at.checked_add(count).ok_or(MISSING)?;
        let bytes = self.bytes.get(self.at..end).ok_or(MISSING)?;
        self.at = end;
        Ok(bytes)
    }

    /// Number of bytes that have not been read yet.
    pub fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// Reads a `std_msgs/Header` and returns its stamp.
    pub fn header(&mut self) -> Result<Time, Reason> {
        let (seconds, rest) = (self.i32()?, self.u32()?);
        self.text()?;
        Ok(Time::from_nanos(i64::from(seconds) * NANOS + i64::from(rest)))
    }

    /// Reads a text.
    pub fn text(&mut self) -> Result<&'a str, Reason> {
        let length = usize::try_from(self.u32()?).map_err(|_| MISSING)?;
        match self.bytes(length)?.split_last() {
            Some((0, text)) => core::str::from_utf8(text).map_err(|_| "a text is not UTF-8".into()),
            _ => Err("a text does not end with a zero byte".into()),
        }
    }
}

macro_rules! numbers {
    ($($ty:ident)*) => {
        impl Writer<'_> {
            $(
                /// Writes a number.
                pub fn $ty(&mut self, number: $ty) {
                    self.put(number.to_le_bytes());
                }
            )*
        }
        impl Reader<'_> {
            $(
                /// Reads a number.
                pub fn $ty(&mut self) -> Result<$ty, Reason> {
                    self.get().map($ty::from_le_bytes)
                }
            )*
        }
    };
}
numbers!(u8 u16 u32 u64 i8 i16 i32 i64 f32 f64);

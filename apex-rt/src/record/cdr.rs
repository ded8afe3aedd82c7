//! CDR, the binary encoding of ROS 2 messages (XCDR1, little endian). Foxglove and the Python package
//! `mcap-ros2-support` read it.

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

/// Reader of the messages of a [`Writer`]. All methods return `None` if the bytes do not have such a value.
#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    /// Reads the message `bytes`; `None` if the prefix is another one.
    pub fn new(bytes: &'a [u8]) -> Option<Self> {
        Some(Self { bytes: bytes.strip_prefix(&HEADER)?, at: 0 })
    }

    fn get<const N: usize>(&mut self) -> Option<[u8; N]> {
        let at = self.at.next_multiple_of(N);
        let number = self.bytes.get(at..at.checked_add(N)?)?;
        self.at = at + N;
        number.try_into().ok()
    }

    /// Reads a `std_msgs/Header` and returns its stamp.
    pub fn header(&mut self) -> Option<Time> {
        let (seconds, rest) = (self.i32()?, self.u32()?);
        self.text()?;
        Some(Time::from_nanos(i64::from(seconds) * NANOS + i64::from(rest)))
    }

    /// Reads a text.
    pub fn text(&mut self) -> Option<&'a str> {
        let length = usize::try_from(self.u32()?).ok()?;
        let (zero, text) = self.bytes.get(self.at..self.at.checked_add(length)?)?.split_last()?;
        self.at += length;
        if *zero != 0 {
            return None;
        }
        core::str::from_utf8(text).ok()
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
                pub fn $ty(&mut self) -> Option<$ty> {
                    self.get().map($ty::from_le_bytes)
                }
            )*
        }
    };
}
numbers!(u8 u16 u32 u64 i8 i16 i32 i64 f32 f64);

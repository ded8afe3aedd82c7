//! CDR, the binary encoding of ROS 2 messages (XCDR1): written with little-endian numbers, which Foxglove and the Python
//! package `mcap-ros2-support` read, and read in both orders. The messages of ROS 1 are read, too: they have no gaps.

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
    form: Form,
}

/// Form of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// CDR with little-endian numbers.
    Little,
    /// CDR with big-endian numbers.
    Big,
    /// That of ROS 1: little-endian, without gaps and final zeros; headers begin with a number.
    Ros1,
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
            [0, order @ 0..=1, _, options] => {
                let length = rest.len().checked_sub(usize::from(options & 3)).ok_or(MISSING)?;
                let form = if *order == 1 { Form::Little } else { Form::Big };
                Ok(Self { bytes: &rest[..length], at: 0, form })
            }
            [0, 2..=11, ..] => Err("it is encoded in a version of CDR that is not supported".into()),
            _ => Err("it does not begin as CDR".into()),
        }
    }

    /// Reads the message `bytes` of ROS 1.
    pub const fn ros1(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, form: Form::Ros1 }
    }

    /// Returns `true` if the message is one of ROS 1.
    pub fn is_ros1(&self) -> bool {
        self.form == Form::Ros1
    }

    /// Takes the bytes of a number, in the order of little-endian ones.
    fn get<const N: usize>(&mut self) -> Result<[u8; N], Reason> {
        let at = if self.is_ros1() { self.at } else { self.at.next_multiple_of(N) };
        let mut number = *self.bytes.get(at..).and_then(<[u8]>::first_chunk).ok_or(MISSING)?;
        self.at = at + N;
        if self.form == Form::Big {
            number.reverse();
        }
        Ok(number)
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
        self.header_with_frame().map(|(stamp, _)| stamp)
    }

    /// Reads a `std_msgs/Header` and returns its stamp and its frame.
    pub fn header_with_frame(&mut self) -> Result<(Time, &'a str), Reason> {
        if self.is_ros1() {
            self.u32()?;
        }
        let (seconds, rest) = (self.i32()?, self.u32()?);
        Ok((Time::from_nanos(i64::from(seconds) * NANOS + i64::from(rest)), self.text()?))
    }

    /// Reads a text.
    pub fn text(&mut self) -> Result<&'a str, Reason> {
        let length = usize::try_from(self.u32()?).map_err(|_| MISSING)?;
        let bytes = self.bytes(length)?;
        match bytes.split_last() {
            _ if self.is_ros1() => core::str::from_utf8(bytes).map_err(|_| "a text is not UTF-8".into()),
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

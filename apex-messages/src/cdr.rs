//! CDR, the binary encoding of ROS 2 messages (XCDR1), in both orders of bytes. Numbers are aligned from the end of the
//! four bytes before a message. The messages of ROS 1 are read, too: they have no gaps.
//!
//! Nothing is reserved for what a length in a message promises: bytes are there before a list of them is made.

use crate::{builtin_interfaces::Time, std_msgs::Header};
use alloc::{
    borrow::{Cow, ToOwned as _},
    format,
    string::String,
    vec,
    vec::Vec,
};
use core::mem::{size_of, size_of_val};

/// Reason why bytes are not a value, for example "its encoding is `bayer_rggb8`".
pub type Reason = Cow<'static, str>;

/// Order of the bytes of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// The least significant byte is first, as all programs write.
    Little,
    /// The most significant byte is first.
    Big,
}

/// Difference between the headers of a program and those of other programs. Times of a program count from its start,
/// those of ROS 2 from 1970.
#[derive(Debug, Clone, Copy)]
pub struct Outside<'a> {
    /// Zero of the program's clock, in ns since 1970.
    pub zero: i64,
    /// Present time, in ns since 1970: the stamp of headers that have none.
    pub now: i64,
    /// Frame of all headers; that of each header if it is `None`.
    pub frame: Option<&'a str>,
}

impl Outside<'_> {
    fn leaves(self, header: &Header) -> Header {
        let stamp = match header.stamp.as_nanos() {
            0 => self.now,
            stamp => stamp.saturating_add(self.zero),
        };
        Header::new(Time::from_nanos(stamp), self.frame.unwrap_or(&header.frame_id))
    }
}

/// Writer that appends a message to a buffer.
#[derive(Debug)]
pub struct Writer<'a> {
    bytes: &'a mut Vec<u8>,
    /// Beginning of the message in the buffer, from which numbers are aligned.
    start: usize,
    order: Order,
    outside: Option<Outside<'a>>,
}

impl<'a> Writer<'a> {
    /// Begins a message at the end of `bytes`, with little-endian numbers.
    pub fn new(bytes: &'a mut Vec<u8>) -> Self {
        Self::in_order(Order::Little, bytes)
    }

    /// Begins a message with numbers of this order.
    pub fn in_order(order: Order, bytes: &'a mut Vec<u8>) -> Self {
        // The last two bytes are options.
        bytes.extend_from_slice(&[0, u8::from(order == Order::Little), 0, 0]);
        let start = bytes.len();
        Self { bytes, start, order, outside: None }
    }

    /// Writes headers as other programs need them.
    #[must_use]
    pub fn for_others(self, outside: Outside<'a>) -> Self {
        Self { outside: Some(outside), ..self }
    }

    /// Returns `true` if the message is written for other programs, not for a recording of this one.
    pub fn is_for_others(&self) -> bool {
        self.outside.is_some()
    }

    /// Returns a header as it is to be written.
    pub fn outgoing<'h>(&self, header: &'h Header) -> Cow<'h, Header> {
        self.outside.map_or(Cow::Borrowed(header), |outside| Cow::Owned(outside.leaves(header)))
    }

    /// Adds bytes until `size` divides their number.
    fn align(&mut self, size: usize) {
        let length = self.bytes.len() - self.start;
        self.bytes.resize(self.start + length.next_multiple_of(size), 0);
    }

    /// Writes a number.
    pub fn number<T: Number>(&mut self, number: T) {
        self.align(size_of::<T>());
        number.append(self.order, self.bytes);
    }

    /// Writes the numbers of an array.
    pub fn numbers<T: Number>(&mut self, numbers: &[T]) {
        if !numbers.is_empty() {
            self.align(size_of::<T>());
            T::append_all(numbers, self.order, self.bytes);
        }
    }

    /// Writes the length of a list.
    pub fn length(&mut self, length: usize) {
        self.number(length as u32);
    }

    /// Writes a text, which ends with a zero byte in CDR.
    pub fn text(&mut self, text: &str) {
        self.length(text.len() + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }
}

/// Reader of messages. All methods return the reason if the bytes do not have such a value.
#[derive(Debug, Clone)]
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
    is_ros1: bool,
    zero: i64,
    /// Frame in which the value has to be.
    frame: Option<&'a str>,
    /// Frame in which it is, if that matters.
    found: Option<String>,
}

/// Reason for a message that ends too early.
const MISSING: Reason = Cow::Borrowed("bytes are missing");

impl<'a> Reader<'a> {
    /// Reads the message `bytes`.
    ///
    /// # Errors
    /// The bytes are not CDR, or in a version that is not supported.
    pub fn new(bytes: &'a [u8]) -> Result<Self, Reason> {
        let (prefix, rest) = bytes.split_first_chunk::<4>().ok_or(MISSING)?;
        match prefix {
            // The last two bits are the number of bytes that were added at the end.
            [0, order @ 0..=1, _, options] => {
                let length = rest.len().checked_sub(usize::from(options & 3)).ok_or(MISSING)?;
                let order = if *order == 1 { Order::Little } else { Order::Big };
                Ok(Self { bytes: &rest[..length], at: 0, order, is_ros1: false, zero: 0, frame: None, found: None })
            }
            [0, 2..=11, ..] => Err("it is encoded in a version of CDR that is not supported".into()),
            _ => Err("it does not begin as CDR".into()),
        }
    }

    /// Reads the message `bytes` of ROS 1.
    pub const fn ros1(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, order: Order::Little, is_ros1: true, zero: 0, frame: None, found: None }
    }

    /// Counts the stamps of headers from `zero`, in ns since 1970, as those of a program do. A stamp of zero, which
    /// means that the time is not known, stays.
    #[must_use]
    pub fn since(self, zero: i64) -> Self {
        Self { zero, ..self }
    }

    /// Demands that the value is in this frame, which [`Self::check_frame`] compares when it was read.
    #[must_use]
    pub fn in_frame(self, frame: &'a str) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Sets the frame in which the value is. Otherwise it is that of the first header.
    pub fn set_frame(&mut self, frame: &str) {
        if self.frame.is_some() {
            self.found = Some(frame.to_owned());
        }
    }

    /// Returns an error if the value is in another frame than the demanded one. The first `/` of a name, which ROS 1
    /// may have, does not count.
    pub fn check_frame(&self) -> Result<(), Reason> {
        let Some(wanted) = self.frame else { return Ok(()) };
        let Some(found) = &self.found else {
            return Err(format!("it does not say its frame, which has to be `{wanted}`").into());
        };
        let name = |frame: &str| frame.trim_start_matches('/').to_owned();
        match name(found) == name(wanted) {
            true => Ok(()),
            false => Err(format!("it is in the frame `{found}`, and not in `{wanted}`").into()),
        }
    }

    /// Returns a header that was read as the program needs it.
    pub fn incoming(&mut self, header: Header) -> Header {
        if self.found.is_none() {
            self.set_frame(&header.frame_id);
        }
        match header.stamp.as_nanos() {
            // Numbers stay as they are, even if the nanoseconds are more than a second.
            _ if self.zero == 0 => header,
            0 => header,
            stamp => Header { stamp: Time::from_nanos(stamp.saturating_sub(self.zero)), ..header },
        }
    }

    /// Order of the bytes of its numbers.
    pub fn order(&self) -> Order {
        self.order
    }

    /// Reads a number.
    pub fn number<T: Number>(&mut self) -> Result<T, Reason> {
        self.align(size_of::<T>());
        self.bytes(size_of::<T>()).map(|bytes| T::of(self.order, bytes))
    }

    fn align(&mut self, size: usize) {
        if !self.is_ros1 {
            self.at = self.at.next_multiple_of(size);
        }
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

    /// Reads a text.
    pub fn text(&mut self) -> Result<&'a str, Reason> {
        let length = self.length()?;
        let bytes = self.bytes(length)?;
        let text = match bytes.split_last() {
            _ if self.is_ros1 => bytes,
            Some((0, text)) => text,
            // Some writers leave out the zero of an empty text.
            None => bytes,
            _ => return Err("a text does not end with a zero byte".into()),
        };
        core::str::from_utf8(text).map_err(|_| "a text is not UTF-8".into())
    }

    /// Reads a text of at most `most` bytes.
    pub fn text_of(&mut self, most: usize) -> Result<String, Reason> {
        let text = self.text()?;
        is_within(text.len(), most)?;
        Ok(text.to_owned())
    }

    /// Reads the length of a list.
    pub fn length(&mut self) -> Result<usize, Reason> {
        self.number::<u32>().map(|length| length as usize)
    }

    /// Reads the numbers of an array.
    pub fn array<T: Number, const N: usize>(&mut self) -> Result<[T; N], Reason> {
        let mut array = [T::default(); N];
        if N > 0 {
            self.align(size_of::<T>());
            T::fill(self.order, self.bytes(N * size_of::<T>())?, &mut array);
        }
        Ok(array)
    }

    /// Reads a list of at most `most` numbers.
    pub fn list<T: Number>(&mut self, most: usize) -> Result<Vec<T>, Reason> {
        let length = self.length()?;
        is_within(length, most)?;
        if length == 0 {
            return Ok(vec![]);
        }
        self.align(size_of::<T>());
        let bytes = self.bytes(length.checked_mul(size_of::<T>()).ok_or(MISSING)?)?;
        let mut list = vec![T::default(); length];
        T::fill(self.order, bytes, &mut list);
        Ok(list)
    }

    /// Reads an array whose elements `read` reads.
    pub fn array_of<T: Default, const N: usize>(
        &mut self,
        mut read: impl FnMut(&mut Self) -> Result<T, Reason>,
    ) -> Result<[T; N], Reason> {
        let mut array = core::array::from_fn(|_| T::default());
        for element in &mut array {
            *element = read(self)?;
        }
        Ok(array)
    }

    /// Reads a list of at most `most` elements, which `read` reads.
    pub fn list_of<T>(
        &mut self,
        most: usize,
        mut read: impl FnMut(&mut Self) -> Result<T, Reason>,
    ) -> Result<Vec<T>, Reason> {
        let length = self.length()?;
        is_within(length, most)?;
        // An element has at least one byte.
        if length > self.left() {
            return Err(MISSING);
        }
        (0..length).map(|_| read(self)).collect()
    }

    /// Reads the byte of a message without a field.
    pub fn empty(&mut self) -> Result<(), Reason> {
        if self.is_ros1 { Ok(()) } else { self.number::<u8>().map(drop) }
    }

    /// Reads the number with which headers of ROS 1 begin.
    pub fn number_of_header(&mut self) -> Result<(), Reason> {
        if self.is_ros1 { self.number::<u32>().map(drop) } else { Ok(()) }
    }
}

fn is_within(length: usize, most: usize) -> Result<(), Reason> {
    match length <= most {
        true => Ok(()),
        false => Err(format!("a list or a text of at most {most} has {length}").into()),
    }
}

/// Number of a message.
pub trait Number: Copy + Default {
    /// Appends the bytes of the number.
    fn append(self, order: Order, bytes: &mut Vec<u8>);

    /// Appends the bytes of numbers.
    fn append_all(numbers: &[Self], order: Order, bytes: &mut Vec<u8>) {
        bytes.reserve(size_of_val(numbers));
        numbers.iter().for_each(|number| number.append(order, bytes));
    }

    /// Number with these bytes, as many as it has.
    fn of(order: Order, bytes: &[u8]) -> Self;

    /// Reads numbers from their bytes.
    fn fill(order: Order, bytes: &[u8], numbers: &mut [Self]) {
        for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(size_of::<Self>())) {
            *number = Self::of(order, bytes);
        }
    }
}

macro_rules! numbers {
    ($($ty:ident)*) => {
        $(
            impl Number for $ty {
                fn append(self, order: Order, bytes: &mut Vec<u8>) {
                    bytes.extend_from_slice(&match order {
                        Order::Little => self.to_le_bytes(),
                        Order::Big => self.to_be_bytes(),
                    });
                }

                fn of(order: Order, bytes: &[u8]) -> Self {
                    let bytes = bytes.first_chunk().copied().unwrap_or_default();
                    match order {
                        Order::Little => Self::from_le_bytes(bytes),
                        Order::Big => Self::from_be_bytes(bytes),
                    }
                }
            }
        )*

        impl Writer<'_> {
            $(
                /// Writes a number.
                pub fn $ty(&mut self, number: $ty) {
                    self.number(number);
                }
            )*
        }

        impl Reader<'_> {
            $(
                /// Reads a number.
                pub fn $ty(&mut self) -> Result<$ty, Reason> {
                    self.number()
                }
            )*
        }
    };
}
numbers!(u16 u32 u64 i8 i16 i32 i64 f32 f64);

impl Number for u8 {
    fn append(self, _: Order, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }

    // Images and clouds are long lists of bytes.
    fn append_all(numbers: &[Self], _: Order, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(numbers);
    }

    fn of(_: Order, bytes: &[u8]) -> Self {
        bytes.first().copied().unwrap_or_default()
    }

    fn fill(_: Order, bytes: &[u8], numbers: &mut [Self]) {
        numbers.copy_from_slice(bytes);
    }
}

impl Writer<'_> {
    /// Writes a number.
    pub fn u8(&mut self, number: u8) {
        self.number(number);
    }
}

impl Reader<'_> {
    /// Reads a number.
    pub fn u8(&mut self) -> Result<u8, Reason> {
        self.number()
    }
}

impl Number for bool {
    fn append(self, _: Order, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(self));
    }

    fn of(_: Order, bytes: &[u8]) -> Self {
        bytes.first().is_some_and(|byte| *byte != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Message, sensor_msgs::LaserScan};

    /// Header of a scan that is written for others and read again.
    fn outside(stamp: i64, frame: Option<&str>, since: i64) -> Header {
        let header = Header::new(Time::from_nanos(stamp), "robot");
        let scan = LaserScan { header, ranges: vec![1.5, f32::INFINITY], ..LaserScan::default() };
        let mut bytes = vec![];
        scan.write(&mut Writer::new(&mut bytes).for_others(Outside { zero: 1_000, now: 5_000, frame }));
        let read = LaserScan::read(&mut Reader::new(&bytes).expect("CDR").since(since)).expect("a scan");
        assert_eq!(read.ranges, scan.ranges);
        read.header
    }

    #[test]
    fn stamps_of_a_program_become_those_of_ros() {
        assert_eq!(outside(7, None, 0), Header::new(Time::from_nanos(1_007), "robot"));
        assert_eq!(outside(0, Some("laser_link"), 0), Header::new(Time::from_nanos(5_000), "laser_link"));
        assert_eq!(outside(-7, None, 0).stamp.as_nanos(), 993);
    }

    #[test]
    fn stamps_come_back_as_they_were() {
        for stamp in [1, -1, 5_000_000_000, -3_000_000_001] {
            assert_eq!(outside(stamp, None, 1_000).stamp.as_nanos(), stamp);
        }
        let unknown = LaserScan::default().to_bytes();
        let read = LaserScan::read(&mut Reader::new(&unknown).expect("CDR").since(1_000)).expect("a scan");
        assert_eq!(read.header.stamp.as_nanos(), 0, "not known");
    }
}

//! Stream of what a program does as bytes, for machines without an operating system: over a serial line or a radio,
//! for `apex studio --connect bytes:…`. The bytes are the messages of `studio::message` (feature `viewer`), encoded
//! without a heap. Nothing comes back: parameters cannot be set, and tokens are not sent.

use crate::{Info, Observer, Parameters, PortKind, Program, Time};
use core::{
    fmt::{self, Display, Write as _},
    time::Duration,
};
use heapless::Vec;

/// Version of the messages.
pub const VERSION: u32 = 9;
/// Maximum length of an error message, in bytes.
const MAX_TEXT: usize = 100;
/// Size of the largest message besides the description, in bytes: kind, node, and error message.
const MAX: usize = 4 + 1 + 5 + 5 + MAX_TEXT;

/// Numbers of the kinds of messages.
const ABOUT: u32 = 0;
const ACTIVE: u32 = 1;
const REACTION: u32 = 2;
const FIRED: u32 = 3;
const HANDLED: u32 = 4;
const ACTIVITY: u32 = 6;
const FAILED: u32 = 7;
const LATE: u32 = 8;

/// Observer that sends what a program does to `S`, which is called with the bytes of each message. It must not wait for
/// long, and may drop a message only as a whole.
///
/// Call [`describe`](Self::describe) before the first reaction, and whenever a byte comes from the other side: a viewer
/// that has come later knows nothing before the next description.
///
/// ```
/// use apex_rt::{bytes::ByteStream, prelude::*};
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() {
/// let (mut blink, mut line) = (Blink::new(), vec![]);
/// // A robot sends the bytes over a serial line.
/// let mut stream = ByteStream::new(|bytes: &[u8]| line.extend_from_slice(bytes));
/// stream.describe(&blink);
/// stream.before_reaction(Time::ZERO, &mut blink);
/// blink.react_with(Time::ZERO, &mut stream);
/// assert!(line.windows(5).any(|bytes| bytes == b"clock"));
/// # }
/// ```
pub struct ByteStream<S> {
    sink: S,
}

impl<S: FnMut(&[u8])> ByteStream<S> {
    /// Returns a stream to `sink`.
    pub const fn new(sink: S) -> Self {
        Self { sink }
    }

    /// Sends the description of the program, and its active nodes.
    pub fn describe<P: Program>(&mut self, program: &P) {
        self.describe_as(const { &P::INFO }, |node| program.is_active(node));
    }

    /// Sends the description of a program, with the nodes for which `is_active` holds.
    pub fn describe_as(&mut self, info: &Info, is_active: impl Fn(usize) -> bool) {
        self.send_long(|out| about(info, out));
        let active = || (0..info.nodes.len()).filter(|node| is_active(*node));
        self.send_long(|out| {
            number(ACTIVE.into(), out);
            number(active().count() as u64, out);
            active().for_each(|node| number(node as u64, out));
        });
    }

    /// Sends a message of any length. It is written twice, first to measure it.
    fn send_long(&mut self, write: impl Fn(&mut dyn FnMut(&[u8]))) {
        let mut length: u32 = 0;
        write(&mut |bytes| length += bytes.len() as u32);
        (self.sink)(&length.to_le_bytes());
        write(&mut self.sink);
    }

    /// Sends a short message as a whole.
    fn send(&mut self, write: impl Fn(&mut dyn FnMut(&[u8]))) {
        let mut frame: Vec<u8, MAX> = Vec::new();
        let _ = frame.extend_from_slice(&[0; 4]);
        // All short messages fit.
        write(&mut |bytes| drop(frame.extend_from_slice(bytes)));
        let length = (frame.len() - 4) as u32;
        frame[..4].copy_from_slice(&length.to_le_bytes());
        (self.sink)(&frame);
    }
}

impl<S: FnMut(&[u8])> Observer for ByteStream<S> {
    fn before_reaction(&mut self, now: Time, _params: &mut impl Parameters) {
        self.send(|out| {
            number(REACTION.into(), out);
            number(0, out);
            signed(now.as_nanos(), out);
        });
    }

    fn fired(&mut self, node: usize) {
        self.send(|out| numbers([FIRED, node as u32], out));
    }

    fn handled(&mut self, connection: usize) {
        self.send(|out| numbers([HANDLED, connection as u32], out));
    }

    fn activity(&mut self, node: usize, active: bool) {
        self.send(|out| numbers([ACTIVITY, node as u32, u32::from(active)], out));
    }

    fn failed(&mut self, node: usize, error: &impl Display) {
        let mut short = Short(heapless::String::new());
        // What does not fit is left out.
        let _ = write!(short, "{error}");
        self.send(|out| {
            numbers([FAILED, node as u32], out);
            text(&short.0, out);
        });
    }

    fn late(&mut self, node: usize, age: Duration) {
        self.send(|out| {
            numbers([LATE, node as u32], out);
            number(u64::try_from(age.as_nanos()).unwrap_or(u64::MAX), out);
        });
    }
}

/// The beginning of a text.
struct Short(heapless::String<MAX_TEXT>);

impl fmt::Write for Short {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|c| self.0.push(c).map_err(|_| fmt::Error))
    }
}

type Out<'a> = dyn FnMut(&[u8]) + 'a;

/// Writes a number, seven bits a byte.
fn number(mut number: u64, out: &mut Out<'_>) {
    while number >= 0x80 {
        out(&[number as u8 | 0x80]);
        number >>= 7;
    }
    out(&[number as u8]);
}

fn numbers<const N: usize>(all: [u32; N], out: &mut Out<'_>) {
    all.into_iter().for_each(|one| number(one.into(), out));
}

/// Writes a number that may be negative.
fn signed(value: i64, out: &mut Out<'_>) {
    number(((value << 1) ^ (value >> 63)) as u64, out);
}

fn text(text: &str, out: &mut Out<'_>) {
    number(text.len() as u64, out);
    if !text.is_empty() {
        out(text.as_bytes());
    }
}

fn texts<'a>(all: impl ExactSizeIterator<Item = &'a str>, out: &mut Out<'_>) {
    number(all.len() as u64, out);
    all.for_each(|one| text(one, out));
}

/// Writes the description of a program.
fn about(info: &Info, out: &mut Out<'_>) {
    numbers([ABOUT, VERSION], out);
    text(info.name, out);
    text(info.docs, out);
    texts(info.files.iter().copied(), out);
    // Its time is that of the machine.
    number(0, out);
    number(info.nodes.len() as u64, out);
    (0..info.nodes.len()).for_each(|node| about_node(info, node, out));
    number(info.connections.len() as u64, out);
    for connection in info.connections {
        number(connection.from as u64, out);
        text(connection.output, out);
        number(connection.to as u64, out);
        text(connection.input, out);
        number(connection.activity.into(), out);
    }
    texts(info.groups.iter().map(|group| group.name), out);
    texts(info.claims.iter().copied(), out);
    // No channels, and no parameters.
    numbers([0, 0], out);
}

fn about_node(info: &Info, at: usize, out: &mut Out<'_>) {
    let (node, kind) = (&info.nodes[at], info.kind(at));
    [node.name, kind.name, kind.docs].into_iter().for_each(|words| text(words, out));
    numbers([node.place.file as u32, node.place.line, node.place.column], out);
    number(kind.ports.len() as u64, out);
    for port in kind.ports {
        text(port.name, out);
        let role = match port.kind {
            PortKind::Input => 0,
            PortKind::Output => 1,
            PortKind::Slot => 2,
            PortKind::Event => 3,
        };
        number(role, out);
        text(port.ty, out);
    }
}

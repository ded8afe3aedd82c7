//! Messages in a stream of bytes.

use super::{MAX_BYTES, Report, VERSION};
use serde::{Serialize, de::DeserializeOwned};
use std::{
    io::{self, Read},
    vec::Vec,
};

/// Maximum size of a description that is looked for in a stream that is joined in the middle, in bytes.
const MAX_JOINED: usize = 256 << 10;

/// Size of the length before each message.
const LENGTH: usize = 4;

/// Appends a message to `out`. A message that is too large is left out.
pub fn write(message: &impl Serialize, out: &mut Vec<u8>) {
    let start = out.len();
    out.extend_from_slice(&[0; LENGTH]);
    let Ok(mut all) = postcard::to_extend(message, core::mem::take(out)) else { return };
    let length = all.len() - start - LENGTH;
    if length > MAX_BYTES {
        all.truncate(start);
    } else {
        all[start..start + LENGTH].copy_from_slice(&(length as u32).to_le_bytes());
    }
    *out = all;
}

/// Bytes that have come, from which messages are taken. The time for that grows with the number of bytes only.
#[cfg(feature = "studio")]
#[derive(Default)]
pub struct Frames {
    bytes: Vec<u8>,
    /// Number of bytes that have been taken.
    at: usize,
}

#[cfg(feature = "studio")]
impl Frames {
    /// Appends bytes.
    pub fn extend(&mut self, bytes: &[u8]) {
        // Each byte is moved once for each time that as many have been taken.
        if self.at > self.bytes.len() / 2 {
            self.bytes.drain(..self.at);
            self.at = 0;
        }
        self.bytes.extend_from_slice(bytes);
    }

    /// Number of bytes that have not been taken.
    pub fn waiting(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// `true` if a message can be taken, or is wrong.
    pub fn is_ready(&self) -> bool {
        let rest = &self.bytes[self.at..];
        rest.first_chunk::<LENGTH>()
            .is_some_and(|length| checked(*length).map_or(true, |size| rest.len() >= size + LENGTH))
    }

    /// Takes the first message. Returns `None` if it is not complete yet.
    ///
    /// # Errors
    /// Bytes that are not such a message.
    pub fn take<T: DeserializeOwned>(&mut self) -> io::Result<Option<T>> {
        let rest = &self.bytes[self.at..];
        let Some(length) = rest.first_chunk::<LENGTH>() else { return Ok(None) };
        let end = checked(*length)? + LENGTH;
        let Some(message) = rest.get(LENGTH..end) else { return Ok(None) };
        let message = decoded(message)?;
        self.at += end;
        Ok(Some(message))
    }
}

/// Reads a message. Returns `None` at the end of the stream.
///
/// # Errors
/// The stream cannot be read, ends within a message, or has bytes that are not such a message.
pub fn read<T: DeserializeOwned>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; LENGTH];
    match from.read_exact(&mut length) {
        Ok(()) => {}
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Ok(None),
        Err(error) => return Err(error),
    }
    // Grows with what has come: a length alone reserves nothing.
    let (size, mut message) = (checked(length)?, Vec::new());
    from.take(size as u64).read_to_end(&mut message)?;
    if message.len() < size {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    decoded(&message).map(Some)
}

/// Reader of a stream that may be joined in the middle: it begins with the next description of a robot.
pub struct Joined<R> {
    from: R,
    /// Bytes that have come.
    came: Vec<u8>,
    has_begun: bool,
}

impl<R: Read> Joined<R> {
    /// Returns a reader of `from`.
    pub fn new(from: R) -> Self {
        Self { from, came: Vec::new(), has_begun: false }
    }

    /// Reads up to a description, which is then the beginning of `came`, or up to the end of the stream.
    fn begin(&mut self) -> io::Result<()> {
        while !self.has_begun {
            let mut bytes = [0; 512];
            match self.from.read(&mut bytes)? {
                0 => {
                    self.came.clear();
                    return Ok(());
                }
                count => self.came.extend_from_slice(&bytes[..count]),
            }
            self.skip();
        }
        Ok(())
    }

    /// Removes the bytes before a description, or what may become one.
    fn skip(&mut self) {
        let mut at = 0;
        while let Some(begin) = self.came[at..].first_chunk::<{ LENGTH + 2 }>() {
            let [length @ .., kind, version] = *begin;
            let length = u32::from_le_bytes(length) as usize;
            let is_about = (kind, u32::from(version)) == (0, VERSION) && length <= MAX_JOINED;
            match self.came.get(at + LENGTH..at + LENGTH + length).filter(|_| is_about) {
                Some(message) if postcard::from_bytes::<Report>(message).is_ok() => {
                    self.has_begun = true;
                    break;
                }
                // The rest of it has not come yet.
                None if is_about => break,
                _ => at += 1,
            }
        }
        self.came.drain(..at);
    }
}

impl<R: Read> Read for Joined<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.begin()?;
        if self.came.is_empty() {
            return self.from.read(into);
        }
        let count = self.came.len().min(into.len());
        into[..count].copy_from_slice(&self.came[..count]);
        self.came.drain(..count);
        Ok(count)
    }
}

fn checked(length: [u8; LENGTH]) -> io::Result<usize> {
    let length = u32::from_le_bytes(length) as usize;
    if length > MAX_BYTES {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "a message is too long: the sender is not an Apex robot",
        ));
    }
    Ok(length)
}

fn decoded<T: DeserializeOwned>(message: &[u8]) -> io::Result<T> {
    postcard::from_bytes(message).map_err(|error| {
        let why = std::format!("a message cannot be read ({error}): the sender has another version of Apex");
        io::Error::new(io::ErrorKind::InvalidData, why)
    })
}

#[cfg(test)]
mod tests {
    use super::{super::Command, *};

    #[test]
    fn messages_come_back_as_they_were_sent() {
        let sent = [Report::Fired(7), Report::Failed { node: 3, error: "no <scan>".into() }, Report::Ended];
        let mut bytes = std::vec![];
        sent.iter().for_each(|message| write(message, &mut bytes));
        let mut from = &bytes[..];
        let read: Vec<Report> = core::iter::from_fn(|| read(&mut from).unwrap()).collect();
        assert_eq!(read, sent);
    }

    #[cfg(feature = "studio")]
    #[test]
    fn messages_come_in_pieces_as_a_socket_delivers_them() {
        let sent = [Report::Fired(7), Report::Failed { node: 3, error: "no <scan>".into() }, Report::Ended];
        let mut bytes = std::vec![];
        sent.iter().for_each(|message| write(message, &mut bytes));
        let (mut came, mut got) = (Frames::default(), std::vec![]);
        for byte in bytes {
            assert!(!came.is_ready());
            came.extend(&[byte]);
            got.extend(came.take::<Report>().unwrap());
        }
        assert_eq!((got, came.waiting()), (sent.into(), 0));
    }

    /// Time for 2.4 MB of the smallest messages, as a viewer may send them. Taking each from the beginning of a buffer
    /// would move terabytes.
    #[cfg(feature = "studio")]
    #[test]
    fn many_small_messages_are_read_in_linear_time() {
        let mut bytes = std::vec![];
        write(&Command::Measure(true), &mut bytes);
        let count = 2_400_000 / bytes.len();
        let start = std::time::Instant::now();
        let (mut came, mut got) = (Frames::default(), 0);
        came.extend(&bytes.repeat(count));
        while let Some(Command::Measure(true)) = came.take().unwrap() {
            got += 1;
        }
        assert_eq!((got, came.waiting()), (count, 0));
        assert!(start.elapsed().as_secs() < 5, "it took {:?}", start.elapsed());
    }

    #[cfg(feature = "studio")]
    #[test]
    fn a_stream_is_joined_at_the_next_description() {
        use super::super::About;
        use crate::{Info, bytes::ByteStream};
        const INFO: Info = Info {
            name: "Cart",
            docs: "",
            files: &["cart.afg"],
            nodes: &[crate::NodeInfo::new("motor", 0, [0, 3, 5], false, false)],
            kinds: &[crate::KindInfo::new("Motor", "Turns.", &[crate::PortInfo::slot("go", "()")])],
            graphs: &[],
            connections: &[crate::ConnectionInfo::new(0, "out", 0, "go", true)],
            clusters: &[],
            groups: &[],
            end_if_hung: None,
            claims: &["exclusive(motor)"],
        };
        let mut bytes = std::vec![];
        let mut stream = ByteStream::new(|part: &[u8]| bytes.extend_from_slice(part));
        crate::Observer::fired(&mut stream, 300);
        stream.describe_as(&INFO, |node| node == 0);
        crate::Observer::activity(&mut stream, 0, true);
        crate::Observer::failed(&mut stream, 0, &"x".repeat(300));
        crate::Observer::late(&mut stream, 1, core::time::Duration::from_millis(2));
        // From the middle of the first message, in small pieces.
        let mut joined = Joined::new(&bytes[2..]);
        let all: Vec<Report> = core::iter::from_fn(|| read(&mut joined).unwrap()).collect();
        let about = About { simulated: false, ..About::new(&INFO, &[], &[], false) };
        assert_eq!(
            all,
            [
                Report::About(about),
                Report::Active(std::vec![0]),
                Report::Activity { node: 0, active: true },
                Report::Failed { node: 0, error: "x".repeat(100) },
                Report::Late { node: 1, age: 2_000_000 },
            ]
        );
        assert_eq!(read::<Report>(&mut Joined::new(&bytes[..30])).unwrap(), None);
    }

    #[test]
    fn hostile_bytes_are_errors() {
        assert!(read::<Report>(&mut &[0xff, 0xff, 0xff, 0xff, 1][..]).is_err());
        assert!(read::<Report>(&mut &[9, 0, 0, 0, 1][..]).is_err());
        assert!(read::<Report>(&mut &[][..]).unwrap().is_none());
    }

    #[cfg(feature = "studio")]
    #[test]
    fn hostile_bytes_of_a_viewer_are_errors() {
        for bytes in [&[1, 0, 0, 0, 200][..], &[0xff, 0xff, 0xff, 0xff]] {
            let mut came = Frames::default();
            came.extend(bytes);
            assert!(came.is_ready() && came.take::<Command>().is_err());
        }
    }
}

//! Messages in a stream of bytes. A message is a header with `Content-Length: 17`, an empty line, and as many bytes of
//! JSON. After an error, reading continues at the next header. This is safe because strings in JSON contain no raw line
//! ends, so that no message contains a header.

use std::io::{self, Read};

/// Maximum length of a message in bytes: that of a source file of the largest size with every character escaped.
pub const MAX_MESSAGE: usize = 6 * apex_dsl::syntax::MAX_BYTES + (1 << 20);
/// Maximum length of a header in bytes.
const MAX_HEADER: usize = 4 << 10;
/// Number of bytes to read at once.
const CHUNK: usize = 64 << 10;

const LENGTH: &str = "Content-Length:";
const HEADER_END: &[u8] = b"\r\n\r\n";

/// A piece of the stream.
#[derive(Debug, PartialEq, Eq)]
pub enum Frame {
    /// The content of a message.
    Body(Vec<u8>),
    /// Bytes that are not a message, with the reason.
    Broken(String),
}

/// A stream of messages.
pub struct Frames<R> {
    input: R,
    buffer: Vec<u8>,
    /// `true` after an error: everything before the next header is skipped.
    lost: bool,
}

impl<R: Read> Frames<R> {
    /// Messages in `input`.
    pub fn new(input: R) -> Self {
        Self { input, buffer: vec![], lost: false }
    }

    /// Returns the next piece, or `None` at the end. A broken or too long message is reported before it is skipped,
    /// because the next one may arrive much later.
    pub fn next(&mut self) -> io::Result<Option<Frame>> {
        if self.lost && !self.skip_to_header()? {
            return Ok(None);
        }
        let end = loop {
            match position(&self.buffer, HEADER_END) {
                Some(end) if end <= MAX_HEADER => break end,
                None if self.buffer.len() <= MAX_HEADER => {}
                _ => return Ok(Some(self.broken(format!("a header of more than {MAX_HEADER} bytes")))),
            }
            if !self.fill()? {
                return Ok(None);
            }
        };
        let length = match content_length(&self.buffer[..end]) {
            Ok(length) if length <= MAX_MESSAGE => length,
            Ok(length) => {
                let reason = format!("a message of {length} bytes; at most {MAX_MESSAGE} are read");
                return Ok(Some(self.broken(reason)));
            }
            Err(reason) => return Ok(Some(self.broken(reason))),
        };
        self.buffer.drain(..end + HEADER_END.len());
        while self.buffer.len() < length {
            if !self.fill()? {
                return Ok(None);
            }
        }
        let rest = self.buffer.split_off(length);
        Ok(Some(Frame::Body(std::mem::replace(&mut self.buffer, rest))))
    }

    /// Returns a body that is not a message to the stream. If its length was wrong, the next message begins in it.
    pub fn give_back(&mut self, body: Vec<u8>) {
        let (Ok(at) | Err(at)) = next_header(&body);
        self.buffer.splice(..0, body[at..].iter().copied());
    }

    fn broken(&mut self, reason: String) -> Frame {
        self.lost = true;
        Frame::Broken(reason)
    }

    /// Skips to the next header, but not to one at the start of the stream. Returns `false` if there is none.
    fn skip_to_header(&mut self) -> io::Result<bool> {
        self.buffer.drain(..1);
        loop {
            match next_header(&self.buffer) {
                Ok(at) => {
                    self.buffer.drain(..at);
                    self.lost = false;
                    return Ok(true);
                }
                Err(possible) => {
                    self.buffer.drain(..possible);
                    if !self.fill()? {
                        return Ok(false);
                    }
                }
            }
        }
    }

    /// Reads more bytes. Returns `false` at the end.
    fn fill(&mut self) -> io::Result<bool> {
        loop {
            let start = self.buffer.len();
            self.buffer.resize(start + CHUNK, 0);
            let read = self.input.read(&mut self.buffer[start..]);
            self.buffer.truncate(start + *read.as_ref().unwrap_or(&0));
            match read {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => return Ok(read? > 0),
            }
        }
    }
}

fn position(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes.windows(pattern.len()).position(|window| window == pattern)
}

/// Length in a header.
fn content_length(header: &[u8]) -> Result<usize, String> {
    let header = std::str::from_utf8(header).map_err(|_| "a header that is not ASCII".to_owned())?;
    let mut length = None;
    for line in header.split("\r\n") {
        let (name, value) = line.split_once(':').ok_or("a header without `:`")?;
        if name.eq_ignore_ascii_case("Content-Length") {
            let digits = value.trim();
            length =
                Some(digits.parse().map_err(|_| format!("`Content-Length` is not a number of bytes: `{digits}`"))?);
        }
    }
    length.ok_or("a header without `Content-Length`".to_owned())
}

/// Start of the next header, or else the start of bytes that may be the beginning of one, or else the end.
fn next_header(bytes: &[u8]) -> Result<usize, usize> {
    let mut from = 0;
    while let Some(found) = position(&bytes[from..], LENGTH.as_bytes()) {
        let at = from + found;
        let value = &bytes[at + LENGTH.len()..];
        let blanks = value.iter().take_while(|b| **b == b' ').count();
        let digits = value[blanks..].iter().take_while(|b| b.is_ascii_digit()).count();
        let behind = &value[blanks + digits..];
        if digits > 0 && behind.starts_with(b"\r\n") {
            return Ok(at);
        }
        if behind.is_empty() || behind == b"\r" {
            return Err(at);
        }
        from = at + LENGTH.len();
    }
    let tail = bytes.len().saturating_sub(LENGTH.len() - 1).max(from);
    let may_begin = |at: &usize| LENGTH.as_bytes().starts_with(&bytes[*at..]);
    Err((tail..bytes.len()).find(may_begin).unwrap_or(bytes.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All pieces of a stream that arrives one byte at a time.
    fn frames(stream: &str) -> Vec<Result<String, String>> {
        struct Slow<'a>(&'a [u8]);
        impl Read for Slow<'_> {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                self.0.read(&mut buffer[..1])
            }
        }
        let mut frames = Frames::new(Slow(stream.as_bytes()));
        let mut found = vec![];
        while let Some(frame) = frames.next().unwrap() {
            found.push(match frame {
                Frame::Body(body) => Ok(String::from_utf8(body).unwrap()),
                Frame::Broken(reason) => Err(reason),
            });
        }
        found
    }

    fn message(body: &str) -> String {
        format!("Content-Length: {}\r\n\r\n{body}", body.len())
    }

    #[test]
    fn what_is_right_comes_through() {
        let stream = format!("{}Content-Type: x\r\ncontent-length:2\r\n\r\n[]{}", message("{}"), message(""));
        assert_eq!(frames(&stream), ["{}", "[]", ""].map(|body| Ok(body.to_owned())));
        assert!(frames("Content-Length: 10\r\n\r\n{").is_empty() && frames("").is_empty());
    }

    /// After every kind of damage the next message is read.
    #[test]
    fn damage_is_skipped() {
        let huge = format!("Content-Length: {}\r\n\r\n", u64::MAX);
        let long = format!("Content-Length: {}\r\n\r\n{{}}", MAX_MESSAGE + 1);
        let header = "x".repeat(MAX_HEADER + 1);
        for damage in [
            "garbage",
            "garbage\r\n\r\n",
            "Content-Length: x\r\n\r\n",
            "Content-Length: -1\r\n\r\n",
            "Content-Length: 99999999999999999999999\r\n\r\n",
            "\r\n\r\n",
            "ü\r\n\r\n",
            "Content-Length",
            huge.as_str(),
            long.as_str(),
            header.as_str(),
        ] {
            let found = frames(&format!("{}{damage}{}", message("[1]"), message("[2]")));
            assert_eq!(found.len(), 3, "{damage:?}: {found:?}");
            assert_eq!((found[0].as_deref(), found[2].as_deref()), (Ok("[1]"), Ok("[2]")), "{damage:?}");
            assert!(found[1].is_err(), "{damage:?}");
        }
    }

    #[test]
    fn a_wrong_length_costs_one_message() {
        let (short, second) = ("Content-Length: 2\r\n\r\n[1]", message("[2]"));
        assert_eq!(frames(&format!("{short}{second}")).last(), Some(&Ok("[2]".to_owned())));
        let long = format!("Content-Length: 20\r\n\r\n[1]{second}{}", message("[3]"));
        let mut stream = Frames::new(long.as_bytes());
        let Ok(Some(Frame::Body(body))) = stream.next() else { panic!("there is a body") };
        stream.give_back(body);
        assert_eq!(stream.next().unwrap(), Some(Frame::Body(b"[2]".to_vec())));
        assert_eq!(stream.next().unwrap(), Some(Frame::Body(b"[3]".to_vec())));
    }
}

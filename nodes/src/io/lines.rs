use super::ReadError;
use std::{
    fmt,
    fs::File,
    io::{self, BufRead, BufReader, ErrorKind, Read},
    path::{Path, PathBuf},
};

/// Maximum length of a line, in bytes: a file without line breaks must not fill the memory.
const MAX_LINE: usize = 1 << 20;
/// Maximum number of characters of a cell or a word that a message shows.
const SHOWN: usize = 40;

/// Reads a text file line by line. Lines end in LF, CR LF or CR. Files whose names end in `.gz` are decompressed.
///
/// Bytes that are not UTF-8 are replaced by `\u{fffd}`: a letter of another encoding stands in a comment or a name, and
/// must not end the file. A byte order mark at the beginning is skipped.
pub(crate) struct Lines {
    path: PathBuf,
    reader: Box<dyn BufRead + Send>,
    bytes: Vec<u8>,
    line: String,
    number: usize,
    /// `true` if the last line ended in CR, after which LF does not begin a line.
    after_cr: bool,
    broken: bool,
}

impl Lines {
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let reader = Box::new(BufReader::new(reader(path)?));
        let (bytes, line) = (Vec::new(), String::new());
        Ok(Self { path: path.into(), reader, bytes, line, number: 0, after_cr: false, broken: false })
    }

    /// Reads the next line that is not blank. Returns `None` at the end of the file.
    ///
    /// After an error of the file itself (not of the content of a line), nothing more is read.
    pub fn next(&mut self) -> Result<Option<&str>, ReadError> {
        while !self.broken {
            self.number += 1;
            match self.read_line() {
                Ok(false) => break,
                Ok(true) if self.line.trim().is_empty() => {}
                Ok(true) => return Ok(Some(self.line.trim())),
                Err(e) => {
                    self.broken = true;
                    return Err(self.error(e));
                }
            }
        }
        Ok(None)
    }

    /// Reads a line. Returns `false` at the end of the file.
    fn read_line(&mut self) -> io::Result<bool> {
        self.bytes.clear();
        let mut is_ended = false;
        while !is_ended {
            let read = match self.reader.fill_buf() {
                Err(e) if e.kind() == ErrorKind::Interrupted => continue,
                read => read?,
            };
            if read.is_empty() {
                break;
            }
            if self.after_cr && read.starts_with(b"\n") {
                self.after_cr = false;
                self.reader.consume(1);
                continue;
            }
            let end = read.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            let length = end.unwrap_or(read.len());
            if self.bytes.len() + length > MAX_LINE {
                return Err(io::Error::other(format!("the line is longer than {MAX_LINE} bytes")));
            }
            self.bytes.extend_from_slice(&read[..length]);
            (self.after_cr, is_ended) = (end.is_some_and(|end| read[end] == b'\r'), end.is_some());
            self.reader.consume(length + usize::from(is_ended));
        }
        if self.number == 1 && is_wide(&self.bytes) {
            return Err(io::Error::other("the file is encoded in UTF-16: save it in UTF-8"));
        }
        self.line.clear();
        let mark: &[u8] = if self.number == 1 { "\u{feff}".as_bytes() } else { &[] };
        self.line.push_str(&String::from_utf8_lossy(self.bytes.strip_prefix(mark).unwrap_or(&self.bytes)));
        Ok(is_ended || !self.bytes.is_empty())
    }

    /// The last line read.
    pub fn current(&self) -> &str {
        self.line.trim()
    }

    /// Returns `true` after an error of the file itself.
    pub(super) fn is_broken(&self) -> bool {
        self.broken
    }

    /// Number of the last line read, counted from 1.
    #[cfg(feature = "slam")]
    pub fn number(&self) -> usize {
        self.number
    }

    /// Creates an error at the last line read.
    pub fn error(&self, message: impl fmt::Display) -> ReadError {
        self.error_at(self.number, message)
    }

    /// Creates an error at a line.
    pub fn error_at(&self, number: usize, message: impl fmt::Display) -> ReadError {
        ReadError { path: self.path.clone(), line: Some(number), message: message.to_string() }
    }
}

impl fmt::Debug for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lines").field("path", &self.path).field("number", &self.number).finish_non_exhaustive()
    }
}

/// Returns `true` for the beginning of a text in UTF-16, which has a byte order mark.
fn is_wide(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xfe]) && bytes.get(3) == Some(&0)
        || bytes.starts_with(&[0xfe, 0xff]) && bytes.get(2) == Some(&0)
}

/// Reader of a file, which is decompressed if its name ends in `.gz`.
pub(super) fn reader(path: &Path) -> Result<Box<dyn Read + Send>, ReadError> {
    let file = File::open(path).map_err(|e| ReadError::open(path, e))?;
    if Ending::of(path).is_packed { unpacked(path, file) } else { Ok(Box::new(file)) }
}

/// Reader of a compressed file.
#[cfg(feature = "gzip")]
fn unpacked(_path: &Path, file: File) -> Result<Box<dyn Read + Send>, ReadError> {
    Ok(Box::new(flate2::read::MultiGzDecoder::new(file)))
}

/// Error for a compressed file, which only the feature `gzip` can read.
#[cfg(not(feature = "gzip"))]
fn unpacked(path: &Path, _file: File) -> Result<Box<dyn Read + Send>, ReadError> {
    Err(ReadError::open(path, "compressed files need the feature `gzip` of `apex-nodes`"))
}

/// Ending of a file name, by which the format of the file is known. Cases do not matter.
pub(super) struct Ending {
    /// Ending without `.gz`, in lower case; empty if there is none.
    pub name: String,
    /// `true` if the file is compressed (`.gz`).
    pub is_packed: bool,
}

impl Ending {
    pub fn of(path: &Path) -> Self {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_lowercase();
        let (name, is_packed) = name.strip_suffix(".gz").map_or((&*name, false), |name| (name, true));
        let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        Self { name: ending.to_owned(), is_packed }
    }
}

/// A cell or a word as messages show it: its beginning, if it is long.
pub(crate) fn shown(word: &str) -> String {
    match word.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &word[..end]),
        None => word.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of a file with their numbers, and its errors.
    fn lines(name: &str, bytes: &[u8]) -> Vec<(usize, String)> {
        let path = std::env::temp_dir().join(format!("apex-lines-{}-{name}", std::process::id()));
        std::fs::write(&path, bytes).expect("a temporary file");
        let mut lines = Lines::open(&path).expect("the file");
        let mut read = Vec::new();
        loop {
            match lines.next().map(|line| line.map(str::to_owned)) {
                Ok(None) => return read,
                Ok(Some(line)) => read.push((lines.number, line)),
                Err(error) => read.push((error.line.expect("a line"), error.message)),
            }
        }
    }

    fn owned(lines: &[(usize, &str)]) -> Vec<(usize, String)> {
        lines.iter().map(|(number, line)| (*number, (*line).to_owned())).collect()
    }

    #[test]
    fn lines_of_all_systems_are_the_same() {
        let expected = owned(&[(1, "a"), (3, "b"), (4, "c")]);
        for end in ["\n", "\r\n", "\r"] {
            assert_eq!(lines("ends", ["a", "", "b", "c"].join(end).as_bytes()), expected);
            assert_eq!(lines("ends", ["a", "", "b", "c", ""].join(end).as_bytes()), expected);
        }
        // Longer than the buffer of the reader, which ends between CR and LF at some place.
        let long = format!("{}\r\n", "x".repeat(30)).repeat(1000);
        assert_eq!(lines("long", long.as_bytes()).last().map(|(number, _)| *number), Some(1000));
    }

    #[test]
    fn other_encodings_do_not_end_a_file() {
        assert_eq!(lines("latin", b"a\nGer\xe4t\nb\n"), owned(&[(1, "a"), (2, "Ger\u{fffd}t"), (3, "b")]));
        assert_eq!(lines("mark", "\u{feff}1,2\n\u{feff}3\n".as_bytes()), owned(&[(1, "1,2"), (2, "\u{feff}3")]));
        let wide: Vec<u8> = "\u{feff}1,2\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert_eq!(lines("wide", &wide), owned(&[(1, "the file is encoded in UTF-16: save it in UTF-8")]));
        let wide: Vec<u8> = "\u{feff}1,2\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(lines("wide", &wide), owned(&[(1, "the file is encoded in UTF-16: save it in UTF-8")]));
    }

    #[test]
    fn endings_have_any_case() {
        for (name, ending, is_packed) in
            [("a.csv", "csv", false), ("A.CSV.GZ", "csv", true), ("b.Log", "log", false), ("gz", "", false)]
        {
            let found = Ending::of(Path::new(name));
            assert_eq!((&*found.name, found.is_packed), (ending, is_packed), "{name}");
        }
    }

    #[test]
    fn messages_are_short() {
        assert_eq!(shown("word"), "word");
        assert_eq!(shown(&"ä".repeat(1000)), format!("{}…", "ä".repeat(SHOWN)));
    }
}

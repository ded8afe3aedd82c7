use super::ReadError;
use flate2::read::MultiGzDecoder;
use std::{
    fmt,
    fs::File,
    io::{BufRead, BufReader, Read},
    path::{Path, PathBuf},
};

/// Maximum length of a line, in bytes: a file without line breaks must not fill the memory.
const MAX_LINE: u64 = 1 << 20;

/// Reads a text file line by line. Files whose names end in `.gz` are decompressed.
pub(crate) struct Lines {
    path: PathBuf,
    reader: Box<dyn BufRead + Send>,
    line: String,
    number: usize,
    broken: bool,
}

impl Lines {
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(|e| ReadError::open(path, e))?;
        let reader: Box<dyn BufRead + Send> = if path.extension().is_some_and(|e| e == "gz") {
            Box::new(BufReader::new(MultiGzDecoder::new(file)))
        } else {
            Box::new(BufReader::new(file))
        };
        Ok(Self { path: path.into(), reader, line: String::new(), number: 0, broken: false })
    }

    /// Reads the next line that is not blank. Returns `None` at the end of the file.
    ///
    /// After an error of the file itself (not of the content of a line), nothing more is read.
    pub fn next(&mut self) -> Result<Option<&str>, ReadError> {
        while !self.broken {
            self.line.clear();
            self.number += 1;
            match self.reader.by_ref().take(MAX_LINE).read_line(&mut self.line) {
                Ok(0) => break,
                Ok(read) if read as u64 == MAX_LINE => {
                    self.broken = true;
                    return Err(self.error(format_args!("the line is longer than {MAX_LINE} bytes")));
                }
                Ok(_) if self.line.trim().is_empty() => {}
                Ok(_) => return Ok(Some(self.line.trim())),
                Err(e) => {
                    self.broken = true;
                    return Err(self.error(e));
                }
            }
        }
        Ok(None)
    }

    /// The last line read.
    pub fn current(&self) -> &str {
        self.line.trim()
    }

    /// Creates an error at the last line read.
    pub fn error(&self, message: impl fmt::Display) -> ReadError {
        ReadError { path: self.path.clone(), line: Some(self.number), message: message.to_string() }
    }
}

impl fmt::Debug for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lines").field("path", &self.path).field("number", &self.number).finish_non_exhaustive()
    }
}

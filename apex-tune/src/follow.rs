//! Journals that grow while they are read.

use crate::{JournalError, Seen, Study, journal};
use std::{
    fs::{self, File},
    io::{self, Read as _, Seek as _, SeekFrom},
    path::PathBuf,
};

/// Maximum number of bytes that are read at once, and of a line.
const BLOCK: u64 = 1 << 20;
/// Maximum number of bytes of a journal that are read.
const MAX_JOURNAL: u64 = 64 << 20;

/// Reader of a journal to which a study adds runs meanwhile.
pub struct Follower {
    path: PathBuf,
    /// First line. Another one belongs to another journal.
    head: Vec<u8>,
    /// Number of bytes and lines that have been read.
    bytes: u64,
    lines: usize,
    seen: Option<Seen>,
    /// Number of journals that have been at the path before this one.
    earlier: u64,
}

impl Follower {
    /// Reader of the journal in this file.
    pub fn new(path: PathBuf) -> Self {
        Self { path, head: vec![], bytes: 0, lines: 0, seen: None, earlier: 0 }
    }

    /// The study, once its description has been read.
    pub fn seen(&self) -> Option<&Seen> {
        self.seen.as_ref()
    }

    /// Number that grows with each line, and a number that changes when another journal takes the place of this one.
    pub fn state(&self) -> (usize, u64) {
        (self.lines, self.earlier)
    }

    /// Reads the next complete lines. Returns `false` if there are none for now.
    ///
    /// # Errors
    /// The file cannot be read, or the next line is not one of a journal. All lines before it are known then.
    pub fn read(&mut self) -> Result<bool, JournalError> {
        let block = self.block().map_err(|error| JournalError::File(self.path.clone(), error))?;
        let whole = block.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        if whole == 0 && block.len() as u64 == BLOCK {
            return Err(JournalError::BadLine(self.path.clone(), self.lines + 1));
        }
        let taken = block[..whole].split_inclusive(|byte| *byte == b'\n').try_for_each(|line| self.take(line));
        if let Some(seen) = &mut self.seen {
            seen.advance();
        }
        taken.map(|()| whole > 0)
    }

    /// The bytes behind those that have been read, or those of another journal from its start.
    fn block(&mut self) -> io::Result<Vec<u8>> {
        if !fs::metadata(&self.path)?.is_file() {
            return Err(io::Error::other("not a file"));
        }
        let mut file = File::open(&self.path)?;
        let mut head = vec![];
        (&mut file).take(self.head.len() as u64).read_to_end(&mut head)?;
        if head != self.head || file.metadata()?.len() < self.bytes {
            *self = Self { earlier: self.earlier + 1, ..Self::new(self.path.clone()) };
        }
        file.seek(SeekFrom::Start(self.bytes))?;
        let mut block = vec![];
        file.take(BLOCK).read_to_end(&mut block)?;
        Ok(block)
    }

    fn take(&mut self, line: &[u8]) -> Result<(), JournalError> {
        if self.bytes + line.len() as u64 > MAX_JOURNAL {
            return Err(JournalError::TooLong(self.path.clone(), MAX_JOURNAL));
        }
        let (path, number) = (&self.path, self.lines + 1);
        let bad = || JournalError::BadLine(path.clone(), number);
        let text = str::from_utf8(line).map_err(|_| bad())?.trim_end_matches(['\n', '\r']);
        match &mut self.seen {
            Some(seen) => {
                let (run, values) = journal::run(text, seen.study().goals.len()).ok_or_else(bad)?;
                seen.add(run, values);
            }
            None => {
                let study = Study::from_description(text).and_then(Seen::new);
                self.seen = Some(study.map_err(|reason| JournalError::BadStudy(path.clone(), reason))?);
                self.head = line.to_vec();
            }
        }
        self.bytes += line.len() as u64;
        self.lines += 1;
        Ok(())
    }
}

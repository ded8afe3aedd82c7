use crate::Study;
use std::{
    collections::{HashMap, hash_map::Entry},
    fmt::{self, Write as _},
    fs::{self, File, OpenOptions, TryLockError},
    io::{self, Write as _},
    path::{Path, PathBuf},
};

/// Search number of the runs that score results.
pub(crate) const SCORES: u64 = u64::MAX;

/// One run of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Run {
    /// Number of the search within the study.
    pub search: u64,
    /// Number of the candidate within the search.
    pub candidate: u64,
    /// Seed of the run.
    pub seed: u64,
}

/// File with the values of every run of a study, one run per line in the order in which they ended, with a checksum.
/// The first line describes the study.
#[derive(Debug)]
pub struct Journal {
    values: HashMap<Run, Vec<f64>>,
    file: Option<(PathBuf, File)>,
    damaged: Vec<(PathBuf, usize)>,
}

/// Lock of the folder of a study, as long as it lives: two programs would run the same candidates.
#[derive(Debug)]
pub struct Lock(#[allow(dead_code, reason = "the file is locked as long as it is open")] File);

impl Lock {
    /// Name of the locked file.
    const FILE: &str = ".lock";

    /// Locks a folder.
    ///
    /// # Errors
    /// Another program has locked it, or it cannot be written.
    pub fn of(folder: &Path) -> Result<Self, String> {
        let file = File::create(folder.join(Self::FILE));
        let file = file.map_err(|error| format!("cannot write in `{}`: {error}", folder.display()))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(format!(
                "another `apex tune` works in `{}`: wait for its end, or choose another folder with `--output`",
                folder.display()
            )),
            // Some file systems have no locks.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self(file)),
        }
    }
}

/// Error of a journal.
#[derive(Debug)]
pub enum JournalError {
    /// File that cannot be read or written.
    File(PathBuf, io::Error),
    /// File of another study, or of the same study with other settings; and the differences.
    OtherStudy(PathBuf, Vec<String>),
    /// Line that is not a run, by number.
    BadLine(PathBuf, usize),
    /// First line that does not describe a study, and the reason.
    BadStudy(PathBuf, String),
    /// Run with two results.
    Contradiction(Box<[(PathBuf, usize, Vec<f64>); 2]>, Run),
    /// File that is longer than this number of bytes; only its beginning is read.
    TooLong(PathBuf, u64),
}

impl fmt::Display for JournalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path, error) => write!(f, "{}: {error}", path.display()),
            Self::OtherStudy(path, changes) => write!(
                f,
                "{}: the journal belongs to a study with other settings: {}; undo that, or begin a new study in another folder",
                path.display(),
                changes.join("; ")
            ),
            Self::BadLine(path, line) => {
                write!(f, "{}:{line}: not a run: expected `search,candidate,seed,values,checksum`", path.display())
            }
            Self::BadStudy(path, reason) => {
                write!(f, "{}:1: the study of the journal cannot be shown: {reason}", path.display())
            }
            Self::Contradiction(both, run) => {
                let Run { search, candidate, seed } = run;
                let [(path, line, values), (other, of_other, others)] = &**both;
                write!(
                    f,
                    "the run `{search},{candidate},{seed}` has the values {values:?} in {}:{line} and {others:?} in {}:{of_other}: the same run gives the same values, so that one of the journals is of another program",
                    path.display(),
                    other.display()
                )
            }
            Self::TooLong(path, limit) => {
                let limit = limit >> 20;
                write!(f, "{}: the journal is too long: only its first {limit} MB are shown", path.display())
            }
        }
    }
}

impl std::error::Error for JournalError {}

impl Journal {
    /// Name of the file in the folder of a study.
    pub const FILE: &str = "journal.csv";

    /// Journal without a file.
    pub fn in_memory() -> Self {
        Self { values: HashMap::new(), file: None, damaged: vec![] }
    }

    /// Opens the journal of a study, or creates it. Runs that are already in the file are not repeated. Lines that are
    /// damaged are removed, so that their runs are repeated; so is a last line that was not written completely.
    pub fn open(path: &Path, study: &Study) -> Result<Self, JournalError> {
        let fail = |error| JournalError::File(path.to_owned(), error);
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => vec![],
            Err(error) => return Err(fail(error)),
        };
        let (mut read, description) = (Reading::default(), study.description());
        let kept = read.add(path, &bytes, study)?;
        if kept.len() < bytes.len() || bytes.is_empty() {
            // Complete at all times: the old file, or the new one.
            let new = path.with_extension("new");
            let text = if kept.is_empty() { format!("{description}\n").into_bytes() } else { kept };
            fs::write(&new, text).and_then(|()| fs::rename(&new, path)).map_err(fail)?;
        }
        let file = OpenOptions::new().append(true).open(path).map_err(fail)?;
        Ok(Self { file: Some((path.to_owned(), file)), ..read.journal() })
    }

    /// Reads the journals of several parts of a study into one without a file.
    ///
    /// # Errors
    /// A journal cannot be read or is of another study, or two of them have different values of one run.
    pub fn merge(paths: &[PathBuf], study: &Study) -> Result<Self, JournalError> {
        let mut read = Reading::default();
        for path in paths {
            let bytes = fs::read(path).map_err(|error| JournalError::File(path.clone(), error))?;
            read.add(path, &bytes, study)?;
        }
        Ok(read.journal())
    }

    /// Files and numbers of the lines that were damaged, and whose runs are not known therefore.
    pub fn damaged(&self) -> &[(PathBuf, usize)] {
        &self.damaged
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns `true` if the journal has no runs.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values of the goals of a run, if it has ended. They are NaN if it has failed.
    pub fn values(&self, run: &Run) -> Option<&[f64]> {
        self.values.get(run).map(Vec::as_slice)
    }

    /// Adds a run that has ended.
    pub fn add(&mut self, run: Run, values: Vec<f64>) -> Result<(), JournalError> {
        if let Some((path, file)) = &mut self.file {
            // One write per line, and a form of the number from which the same bits are read.
            file.write_all(line(run, &values).as_bytes()).map_err(|error| JournalError::File(path.clone(), error))?;
        }
        self.insert(run, values);
        Ok(())
    }

    /// Adds a run that is in the file already. Returns `false` if the run was known.
    pub(crate) fn insert(&mut self, run: Run, values: Vec<f64>) -> bool {
        self.values.insert(run, values).is_none()
    }
}

/// The runs of several files.
#[derive(Default)]
struct Reading {
    /// Values with the file and line that they are from.
    values: HashMap<Run, (Vec<f64>, PathBuf, usize)>,
    damaged: Vec<(PathBuf, usize)>,
}

impl Reading {
    /// Adds the runs in a file. Returns the lines that are not damaged.
    fn add(&mut self, path: &Path, bytes: &[u8], study: &Study) -> Result<Vec<u8>, JournalError> {
        let mut kept = vec![];
        for (at, whole) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
            let text = whole.strip_suffix(b"\n").and_then(|line| str::from_utf8(line).ok());
            if at == 0 {
                match text {
                    Some(text) if text == study.description() => kept.extend_from_slice(whole),
                    // The program ended before it had written the first line.
                    None if bytes.len() == whole.len() => return Ok(kept),
                    _ => {
                        let changes = study.changes_from(text.unwrap_or_default());
                        return Err(JournalError::OtherStudy(path.to_owned(), changes));
                    }
                }
                continue;
            }
            match text.and_then(|text| run(text, study.goals.len())) {
                Some((run, values)) => {
                    self.note(run, values, path, at + 1)?;
                    kept.extend_from_slice(whole);
                }
                // Interrupted while it was written.
                None if !whole.ends_with(b"\n") => {}
                None => self.damaged.push((path.to_owned(), at + 1)),
            }
        }
        Ok(kept)
    }

    fn note(&mut self, run: Run, values: Vec<f64>, path: &Path, line: usize) -> Result<(), JournalError> {
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        match self.values.entry(run) {
            Entry::Vacant(entry) => drop(entry.insert((values, path.to_owned(), line))),
            Entry::Occupied(entry) if bits(&entry.get().0) == bits(&values) => {}
            Entry::Occupied(entry) => {
                let (known, of, at) = entry.remove();
                let both = Box::new([(of, at, known), (path.to_owned(), line, values)]);
                return Err(JournalError::Contradiction(both, run));
            }
        }
        Ok(())
    }

    fn journal(self) -> Journal {
        let values = self.values.into_iter().map(|(run, (values, ..))| (run, values)).collect();
        Journal { values, file: None, damaged: self.damaged }
    }
}

/// The line of a run.
fn line(run: Run, values: &[f64]) -> String {
    let mut line = format!("{},{},{}", run.search, run.candidate, run.seed);
    // Writing to a `String` cannot fail.
    for value in values {
        let _ = write!(line, ",{value:?}");
    }
    let checksum = crc32fast::hash(line.as_bytes());
    let _ = writeln!(line, ",{checksum:08x}");
    line
}

/// Reads a line with a run of a study with so many goals. Returns `None` if it is damaged.
pub(crate) fn run(line: &str, goals: usize) -> Option<(Run, Vec<f64>)> {
    let (line, checksum) = line.rsplit_once(',')?;
    if checksum.len() != 8 || u32::from_str_radix(checksum, 16).ok()? != crc32fast::hash(line.as_bytes()) {
        return None;
    }
    let mut words = line.split(',');
    let mut number = || words.next()?.parse().ok();
    let run = Run { search: number()?, candidate: number()?, seed: number()? };
    let values: Vec<f64> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
    (values.len() == goals).then_some((run, values))
}

use std::{
    collections::HashMap,
    fmt,
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

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

/// File with the values of every run of a study, one per line in the order in which they ended. The first line
/// describes the study.
#[derive(Debug)]
pub struct Journal {
    values: HashMap<Run, Vec<f64>>,
    file: Option<(PathBuf, File)>,
}

/// Error of a journal.
#[derive(Debug)]
pub enum JournalError {
    /// File that cannot be read or written.
    File(PathBuf, io::Error),
    /// File of another study, or of the same study with other settings.
    OtherStudy(PathBuf),
    /// Line that is not a run, by number.
    BadLine(PathBuf, usize),
    /// First line that does not describe a study, and the reason.
    BadStudy(PathBuf, String),
    /// File that is longer than this number of bytes; only its beginning is read.
    TooLong(PathBuf, u64),
}

impl fmt::Display for JournalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path, error) => write!(f, "{}: {error}", path.display()),
            Self::OtherStudy(path) => {
                write!(f, "{}: the journal belongs to a study with other settings: use another file", path.display())
            }
            Self::BadLine(path, line) => {
                write!(f, "{}:{line}: not a run: expected `search,candidate,seed,value`", path.display())
            }
            Self::BadStudy(path, reason) => {
                write!(f, "{}:1: the study of the journal cannot be shown: {reason}", path.display())
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
        Self { values: HashMap::new(), file: None }
    }

    /// Opens the journal of a study with this description, or creates it. Runs that are already in the file are not
    /// repeated. A last line that was not written completely is dropped.
    pub fn open(path: &Path, description: &str) -> Result<Self, JournalError> {
        let fail = |error| JournalError::File(path.to_owned(), error);
        let text = match fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(fail(error)),
        };
        let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
        let values = parse(path, whole, description)?;
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(fail)?;
        file.set_len(whole.len() as u64).map_err(fail)?;
        if whole.is_empty() {
            writeln!(file, "{description}").map_err(fail)?;
        }
        Ok(Self { values, file: Some((path.to_owned(), file)) })
    }

    /// Reads the journals of several parts of a study into one without a file.
    pub fn merge(paths: &[PathBuf], description: &str) -> Result<Self, JournalError> {
        let mut values = HashMap::new();
        for path in paths {
            let text = fs::read_to_string(path).map_err(|error| JournalError::File(path.clone(), error))?;
            values.extend(parse(path, &text[..text.rfind('\n').map_or(0, |end| end + 1)], description)?);
        }
        Ok(Self { values, file: None })
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
            let mut line = format!("{},{},{}", run.search, run.candidate, run.seed);
            values.iter().for_each(|value| line.push_str(&format!(",{value:?}")));
            line.push('\n');
            file.write_all(line.as_bytes()).map_err(|error| JournalError::File(path.clone(), error))?;
        }
        self.insert(run, values);
        Ok(())
    }

    /// Adds a run that is in the file already. Returns `false` if the run was known.
    pub(crate) fn insert(&mut self, run: Run, values: Vec<f64>) -> bool {
        self.values.insert(run, values).is_none()
    }
}

fn parse(path: &Path, text: &str, description: &str) -> Result<HashMap<Run, Vec<f64>>, JournalError> {
    let mut lines = text.lines();
    if lines.next().is_some_and(|first| first != description) {
        return Err(JournalError::OtherStudy(path.to_owned()));
    }
    let number = |(i, line)| run(line).ok_or_else(|| JournalError::BadLine(path.to_owned(), i + 2));
    lines.enumerate().map(number).collect()
}

/// Reads a line with a run.
pub(crate) fn run(line: &str) -> Option<(Run, Vec<f64>)> {
    let mut words = line.split(',');
    let mut number = || words.next()?.parse().ok();
    let run = Run { search: number()?, candidate: number()?, seed: number()? };
    let values: Vec<f64> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
    (!values.is_empty()).then_some((run, values))
}

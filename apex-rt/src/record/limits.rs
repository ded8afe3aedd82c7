//! Limits of a recording, and the files into which they divide it.

use std::{
    collections::VecDeque,
    env,
    ffi::OsStr,
    fs, io,
    path::{Path, PathBuf},
    time::Duration,
};

/// Environment variables with the limits of a recording.
const LIMIT: &str = "APEX_RECORD_LIMIT";
const AGE: &str = "APEX_RECORD_AGE";
const COMPRESS: &str = "APEX_RECORD_COMPRESS";

/// Number of files into which the limits divide a recording.
const FILES: u32 = 8;
/// Smallest limit in bytes: a file of a recording has at least two chunks.
const LEAST: u64 = 16_000_000;
/// Smallest age.
const YOUNGEST: Duration = Duration::from_secs(8);
/// Number of digits of a file's number.
const DIGITS: usize = 4;

/// Limits of a recording, and if it is compressed. By default it is neither limited nor compressed.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct RecordOptions {
    /// Maximum size of all files together, in bytes.
    pub limit: Option<u64>,
    /// Age from which messages are removed.
    pub age: Option<Duration>,
    /// `true` if messages are compressed, on the thread that writes them.
    pub compress: bool,
}

impl RecordOptions {
    /// Returns the file and the options of a `record` statement. Each option is in a line after the file.
    pub(super) fn stated(text: &str) -> (&str, Self) {
        let mut lines = text.lines();
        let (file, mut options) = (lines.next().unwrap_or_default(), Self::default());
        for line in lines {
            match line.split_once(' ') {
                Some(("limit", bytes)) => options.limit = bytes.parse().ok(),
                Some(("age", nanos)) => options.age = nanos.parse().ok().map(Duration::from_nanos),
                _ => options.compress |= line == "compress",
            }
        }
        (file, options)
    }

    /// Returns the options with those in environment variables, which take precedence.
    pub(super) fn or_environment(self) -> io::Result<Self> {
        let wrong = |name: &str, what: &str| {
            let text = env::var(name).unwrap_or_default();
            io::Error::new(io::ErrorKind::InvalidInput, format!("`{text}` in `{name}` is not {what}"))
        };
        let limit = env::var(LIMIT).ok().map(|text| bytes(&text).ok_or_else(|| wrong(LIMIT, "a size, such as `1GB`")));
        let age = env::var(AGE).ok().map(|text| time(&text).ok_or_else(|| wrong(AGE, "a time, such as `10min`")));
        Ok(Self {
            limit: limit.transpose()?.or(self.limit),
            age: age.transpose()?.or(self.age),
            compress: self.compress || env::var_os(COMPRESS).is_some_and(|value| value != "0"),
        })
    }

    /// Checks the limits.
    ///
    /// # Errors
    /// One is too small.
    pub(super) fn check(self) -> io::Result<Self> {
        let error = |text: String| Err(io::Error::new(io::ErrorKind::InvalidInput, text));
        match self {
            Self { limit: Some(limit), .. } if limit < LEAST => {
                error(format!("a limit of {limit} bytes is too small: give it at least {}MB", LEAST / 1_000_000))
            }
            Self { age: Some(age), .. } if age < YOUNGEST => {
                error(format!("an age of {age:?} is too small: give it at least {YOUNGEST:?}"))
            }
            _ => Ok(self),
        }
    }

    /// Time after which a file ends.
    pub(super) fn period(self) -> Option<Duration> {
        self.age.map(|age| age / FILES)
    }

    /// Returns `true` if the recording is divided into files.
    pub(super) fn divides(self) -> bool {
        self.limit.is_some() || self.age.is_some()
    }
}

/// Returns a number of bytes: `1GB`, `500MB`, `16000000`.
pub fn bytes(text: &str) -> Option<u64> {
    let (number, factor) = split(text, &[("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3), ("B", 1.0), ("", 1.0)])?;
    let bytes = number * factor;
    (bytes.is_finite() && (0.0..1e18).contains(&bytes)).then_some(bytes as u64)
}

/// Returns a time: `10min`, `1.5h`, `90s`.
pub fn time(text: &str) -> Option<Duration> {
    let (number, factor) = split(text, &[("min", 60.0), ("ms", 1e-3), ("h", 3600.0), ("s", 1.0)])?;
    Duration::try_from_secs_f64(number * factor).ok()
}

fn split(text: &str, units: &[(&str, f64)]) -> Option<(f64, f64)> {
    let (number, factor) = units.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, *factor)))?;
    Some((number.trim().parse().ok()?, factor))
}

/// A file of a recording that has ended.
struct Ended {
    path: PathBuf,
    size: u64,
    /// Time of its last message, in ns.
    last: u64,
}

/// The files of a recording that is divided.
pub struct Files {
    base: PathBuf,
    options: RecordOptions,
    number: u64,
    ended: VecDeque<Ended>,
}

impl Files {
    /// Returns the files of a recording in `path`: `run.0001.mcap`, `run.0002.mcap`, and so on. If there are such
    /// files, a number is added to the name.
    pub fn new(path: &Path, options: RecordOptions) -> Self {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let names: Vec<_> = fs::read_dir(folder).into_iter().flatten().flatten().map(|file| file.file_name()).collect();
        let taken = |base: &Path| names.iter().any(|name| number_of(base, name).is_some());
        Self { base: first_free(path, taken), options, number: 1, ended: VecDeque::new() }
    }

    /// Path of the file that is being written.
    pub fn path(&self) -> PathBuf {
        numbered(&self.base, self.number)
    }

    /// Number of the file that is being written, from 1.
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Path of the file after it.
    pub fn next(&self) -> PathBuf {
        numbered(&self.base, self.number + 1)
    }

    /// Returns `true` if the file that is being written shall end, with `size` bytes.
    pub fn is_full(&self, size: u64) -> bool {
        self.options.limit.is_some_and(|limit| size >= limit / u64::from(FILES))
    }

    /// Goes on to the next file, after one of `size` bytes whose last message is of the time `last` (in ns).
    pub fn advance(&mut self, size: u64, last: u64) {
        self.ended.push_back(Ended { path: self.path(), size, last });
        self.number += 1;
    }

    /// Removes the oldest files until there is room for `size` bytes in the present file, whose last message is of the
    /// time `now` (in ns).
    pub fn make_room(&mut self, size: u64, now: u64) -> io::Result<()> {
        loop {
            let Some(oldest) = self.ended.front() else { return Ok(()) };
            let total: u64 = self.ended.iter().map(|file| file.size).sum();
            let too_large = self.options.limit.is_some_and(|limit| total.saturating_add(size) > limit);
            let too_old =
                self.options.age.is_some_and(|age| Duration::from_nanos(now.saturating_sub(oldest.last)) > age);
            if !too_large && !too_old {
                return Ok(());
            }
            match fs::remove_file(&oldest.path) {
                // Somebody has removed it already.
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => self.ended.pop_front(),
            };
        }
    }

    /// Paths of all files that are there.
    pub fn paths(&self) -> Vec<PathBuf> {
        self.ended.iter().map(|file| file.path.clone()).chain([self.path()]).collect()
    }
}

/// Path of a file of a recording in `base`.
fn numbered(base: &Path, number: u64) -> PathBuf {
    let mut name = base.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{number:0DIGITS$}"));
    if let Some(end) = base.extension() {
        name.push(".");
        name.push(end);
    }
    base.with_file_name(name)
}

/// Returns the number of the file `name` if it is one of a recording in `base`.
fn number_of(base: &Path, name: &OsStr) -> Option<u64> {
    let (stem, end) = (base.file_stem()?.to_str()?, base.extension().unwrap_or_default().to_str()?);
    let rest = name.to_str()?.strip_prefix(stem)?.strip_prefix('.')?;
    let digits = if end.is_empty() { rest } else { rest.strip_suffix(end)?.strip_suffix('.')? };
    (digits.len() >= DIGITS && digits.bytes().all(|byte| byte.is_ascii_digit())).then(|| digits.parse().ok())?
}

/// Returns `path`, or the first of `run-2.mcap`, `run-3.mcap`, … that is not `taken`.
pub fn first_free(path: &Path, taken: impl Fn(&Path) -> bool) -> PathBuf {
    let (stem, end) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let numbered = |n: u32| {
        let mut name = stem.to_owned();
        name.push(format!("-{n}"));
        let mut file = path.with_file_name(name);
        if !end.is_empty() {
            // `with_extension` would replace the last part of a name with dots.
            file.as_mut_os_string().push(".");
            file.as_mut_os_string().push(end);
        }
        file
    };
    std::iter::once(path.to_owned()).chain((2..).map(numbered)).find(|p| !taken(p)).unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_times_have_units() {
        assert_eq!(
            ["1GB", "1.5MB", "20000000", "1kB", "7B"].map(bytes),
            [1_000_000_000, 1_500_000, 20_000_000, 1000, 7].map(Some)
        );
        assert_eq!(["", "GB", "1 GiB", "-1MB", "1e30MB", "one"].map(bytes), [None; 6]);
        let seconds = |text| time(text).map(|time| time.as_secs_f64());
        assert_eq!(["10min", "1.5h", "90s", "500ms"].map(seconds), [600.0, 5400.0, 90.0, 0.5].map(Some));
        assert_eq!(["", "10", "-1s", "1e300h", "nans"].map(seconds), [None; 5]);
    }

    #[test]
    fn statements_have_options_in_lines() {
        assert_eq!(RecordOptions::stated("run.mcap"), ("run.mcap", RecordOptions::default()));
        let (limit, age) = (Some(1_000_000_000), Some(Duration::from_secs(60)));
        let all = "a b.mcap\nlimit 1000000000\nage 60000000000\ncompress";
        assert_eq!(RecordOptions::stated(all), ("a b.mcap", RecordOptions { limit, age, compress: true }));
    }

    #[test]
    fn files_have_numbers_before_the_ending() {
        assert_eq!(numbered(Path::new("a/run.mcap"), 7), Path::new("a/run.0007.mcap"));
        assert_eq!(numbered(Path::new("run"), 12_345), Path::new("run.12345"));
        let number = |name: &str| number_of(Path::new("a/run.mcap"), OsStr::new(name));
        assert_eq!(["run.0007.mcap", "run.12345.mcap"].map(number), [Some(7), Some(12_345)]);
        assert_eq!(["run.mcap", "run.7.mcap", "run.000x.mcap", "run-2.0001.mcap"].map(number), [None; 4]);
    }
}

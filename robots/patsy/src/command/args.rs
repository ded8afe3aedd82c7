//! Options that several commands have.

use lexopt::{Arg, Parser, prelude::Long};
use std::{num::NonZero, path::PathBuf};

/// Maximum number of seeds.
const MOST_SEEDS: u64 = 1_000_000;

/// Seeds of a measurement, and the number of threads (`None`: all cores), which does not change the results.
pub struct Seeds {
    first: u64,
    count: u64,
    pub jobs: Option<NonZero<usize>>,
}

impl Seeds {
    pub const fn new(count: u64) -> Self {
        Self { first: 1, count, jobs: None }
    }

    /// Reads `--first-seed`, `--seeds` or `--jobs`; other options are errors.
    pub fn read(&mut self, parser: &mut Parser, option: Option<&'static str>, arg: String) -> Result<(), String> {
        match option {
            Some("first-seed") => self.first = number(parser, "--first-seed", 0..=u64::MAX - MOST_SEEDS)?,
            Some("seeds") => self.count = number(parser, "--seeds", 1..=MOST_SEEDS)?,
            Some("jobs") => self.jobs = NonZero::new(number(parser, "--jobs", 1..=1024)? as usize),
            _ => return Err(arg),
        }
        Ok(())
    }

    pub fn all(&self) -> Vec<u64> {
        (self.first..self.first + self.count).collect()
    }
}

/// Name of an option of [`Seeds`], and the message if it is none.
pub fn seeds_option(arg: Arg<'_>) -> (Option<&'static str>, String) {
    let known = match arg {
        Long("first-seed") => Some("first-seed"),
        Long("seeds") => Some("seeds"),
        Long("jobs") => Some("jobs"),
        _ => None,
    };
    (known, unknown(arg))
}

/// Reads the options of a measurement that draws: those of [`Seeds`], and `--out` for the file, which is `out` without
/// it.
pub fn seeds_and_out(parser: &mut Parser, mut seeds: Seeds, out: &str) -> Result<(Seeds, PathBuf), String> {
    let mut out = PathBuf::from(out);
    while let Some(arg) = next(parser)? {
        if arg == Long("out") {
            out = path(parser)?;
        } else {
            let (option, message) = seeds_option(arg);
            seeds.read(parser, option, message)?;
        }
    }
    Ok((seeds, out))
}

pub fn next(parser: &mut Parser) -> Result<Option<Arg<'_>>, String> {
    parser.next().map_err(|e| e.to_string())
}

pub fn unknown(arg: Arg<'_>) -> String {
    format!("{}; `--help` lists the options", arg.unexpected())
}

pub fn path(parser: &mut Parser) -> Result<PathBuf, String> {
    parser.value().map(PathBuf::from).map_err(|e| e.to_string())
}

pub fn number(parser: &mut Parser, option: &str, range: std::ops::RangeInclusive<u64>) -> Result<u64, String> {
    let value = parser.value().map_err(|e| e.to_string())?.to_string_lossy().into_owned();
    let number = value.parse().ok().filter(|number| range.contains(number));
    let (least, most) = (range.start(), range.end());
    number.ok_or_else(|| format!("`{option}` is a whole number from {least} to {most}, not `{value}`"))
}

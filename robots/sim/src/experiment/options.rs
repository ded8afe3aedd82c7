use lexopt::{Arg, Parser, prelude::Long};
use std::{
    ffi::OsString,
    num::NonZero,
    ops::{Bound, RangeBounds},
    path::PathBuf,
    str::FromStr,
    time::Duration,
};

/// Maximum number of seeds.
const MOST_SEEDS: u64 = 1_000_000;
/// Maximum number of threads.
const MOST_JOBS: u64 = 1024;
/// Maximum duration of a run, in minutes: a day. Longer runs are typing errors.
const MOST_MINUTES: f64 = 1440.0;

/// Options of a command, such as `--seed 3`, which are read one after the other.
#[derive(Debug, Clone)]
pub struct Options(Parser);

impl Options {
    /// Creates the options of a command with these arguments.
    pub fn of(args: impl IntoIterator<Item = OsString>) -> Self {
        Self(Parser::from_args(args))
    }

    /// Name of the next option, without its dashes, or `None` at the end.
    ///
    /// # Errors
    /// If the next argument is not an option with a long name.
    pub fn next_name(&mut self) -> Result<Option<String>, String> {
        match self.0.next().map_err(|e| e.to_string())? {
            None => Ok(None),
            Some(Long(name)) => Ok(Some(name.to_owned())),
            Some(other) => Err(refused(other)),
        }
    }

    /// Checks that no options are left.
    ///
    /// # Errors
    /// If there are options.
    pub fn end(&mut self) -> Result<(), String> {
        self.next_name()?.map_or(Ok(()), |name| Err(Self::unknown(&name)))
    }

    /// Message about an option that the command does not have.
    pub fn unknown(name: &str) -> String {
        refused(Long(name))
    }

    /// Value of the option that was read last, as text.
    ///
    /// # Errors
    /// If the value is missing.
    pub fn text(&mut self) -> Result<String, String> {
        self.0.value().map(|value| value.to_string_lossy().into_owned()).map_err(|e| e.to_string())
    }

    /// Value of the option that was read last, as a path.
    ///
    /// # Errors
    /// If the value is missing.
    pub fn path(&mut self) -> Result<PathBuf, String> {
        self.0.value().map(PathBuf::from).map_err(|e| e.to_string())
    }

    /// All values of the option that was read last, as paths.
    ///
    /// # Errors
    /// If the value is missing.
    pub fn paths(&mut self) -> Result<Vec<PathBuf>, String> {
        self.0.values().map(|values| values.map(PathBuf::from).collect()).map_err(|e| e.to_string())
    }

    /// Value of the option `name`, which was read last, as a whole number from the start of a range on.
    ///
    /// # Errors
    /// If the value is missing, or not in the range.
    pub fn number(&mut self, name: &str, range: impl RangeBounds<u64>) -> Result<u64, String> {
        let value = self.text()?;
        let number = u64::from_str(&value).ok().filter(|number| range.contains(number));
        let least = if let Bound::Included(least) = range.start_bound() { *least } else { 0 };
        let most = if let Bound::Included(most) = range.end_bound() { format!(" to {most}") } else { String::new() };
        number.ok_or_else(|| format!("`--{name}` is a whole number from {least}{most}, not `{value}`"))
    }

    /// Value of the option `name`, which was read last, as a time in minutes.
    ///
    /// # Errors
    /// If the value is missing, or not such a time.
    pub fn minutes(&mut self, name: &str) -> Result<Duration, String> {
        let value = self.text()?;
        let minutes = f64::from_str(&value).ok().filter(|minutes| *minutes > 0.0 && *minutes <= MOST_MINUTES);
        let duration = minutes.map(|minutes| Duration::from_secs_f64(60.0 * minutes));
        duration.ok_or_else(|| format!("`--{name}` is a number above 0, at most {MOST_MINUTES}, not `{value}`"))
    }
}

fn refused(arg: Arg<'_>) -> String {
    format!("{}; `--help` lists the options", arg.unexpected())
}

/// Seeds of a measurement, and the number of threads (`None`: all cores), which does not change the results: the
/// options `--first-seed`, `--seeds` and `--jobs`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seeds {
    first: u64,
    count: u64,
    /// Number of threads.
    pub jobs: Option<NonZero<usize>>,
}

impl Seeds {
    /// Creates so many seeds, from 1 on.
    pub const fn new(count: u64) -> Self {
        Self { first: 1, count, jobs: None }
    }

    /// Reads the value of the option `name`.
    ///
    /// # Errors
    /// If it is not one of the options of seeds, or its value is wrong.
    pub fn read(&mut self, name: &str, options: &mut Options) -> Result<(), String> {
        match name {
            "first-seed" => self.first = options.number(name, 0..)?,
            "seeds" => self.count = options.number(name, 1..)?,
            "jobs" => self.jobs = NonZero::new(options.number(name, 1..=MOST_JOBS)? as usize),
            _ => return Err(Options::unknown(name)),
        }
        if self.first.checked_add(self.count).is_none() {
            return Err("the last seed is too large".to_owned());
        }
        match self.count {
            0..=MOST_SEEDS => Ok(()),
            _ => Err(format!("`--seeds` is at most {MOST_SEEDS}, not `{}`", self.count)),
        }
    }

    /// Reads the options of a command that has no others.
    ///
    /// # Errors
    /// The errors of [`read_beside`](Self::read_beside).
    pub fn read_all(self, options: &mut Options) -> Result<Self, String> {
        self.read_beside(options, |name, _| Err(Options::unknown(name)))
    }

    /// Reads the options of a command. `other` reads the value of an option that is not one of seeds.
    ///
    /// # Errors
    /// The errors of `other`, and values of the options of seeds that are wrong.
    pub fn read_beside(
        mut self,
        options: &mut Options,
        mut other: impl FnMut(&str, &mut Options) -> Result<(), String>,
    ) -> Result<Self, String> {
        while let Some(name) = options.next_name()? {
            match name.as_str() {
                "first-seed" | "seeds" | "jobs" => self.read(&name, options)?,
                _ => other(&name, options)?,
            }
        }
        Ok(self)
    }

    /// First seed.
    pub const fn first(&self) -> u64 {
        self.first
    }

    /// Last seed.
    pub const fn last(&self) -> u64 {
        self.first + (self.count - 1)
    }

    /// Number of seeds.
    pub const fn count(&self) -> u64 {
        self.count
    }

    /// All seeds.
    pub fn all(&self) -> Vec<u64> {
        (self.first..=self.last()).collect()
    }
}

/// Writes the first and the last one.
impl std::fmt::Display for Seeds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "seeds {} to {}", self.first, self.last())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(args: &[&str]) -> Result<Seeds, String> {
        Seeds::new(20).read_all(&mut Options::of(args.iter().map(OsString::from)))
    }

    #[test]
    fn seeds_are_read_and_their_limits_are_told() {
        let seeds = read(&["--first-seed", "7", "--seeds", "3", "--jobs", "2"]).expect("seeds");
        assert_eq!(
            (seeds.all(), seeds.jobs, seeds.to_string().as_str()),
            (vec![7, 8, 9], NonZero::new(2), "seeds 7 to 9")
        );
        for (args, message) in [
            (&["--seeds", "0"][..], "`--seeds` is a whole number from 1, not `0`"),
            (&["--seeds", "1000001"], "`--seeds` is at most 1000000, not `1000001`"),
            (&["--jobs", "many"], "`--jobs` is a whole number from 1 to 1024, not `many`"),
            (&["--first-seed", "18446744073709551615"], "the last seed is too large"),
            (&["--seed", "1"], "invalid option '--seed'; `--help` lists the options"),
            (&["-s"], "invalid option '-s'; `--help` lists the options"),
            (&["--seeds"], "missing argument for option '--seeds'"),
        ] {
            assert_eq!(read(args), Err(message.to_owned()));
        }
    }

    #[test]
    fn minutes_are_positive_numbers() {
        let minutes = |value: &str| Options::of([value.into()]).minutes("minutes");
        let mut options = Options::of(["--minutes".into(), "0.5".into()]);
        assert_eq!(options.next_name(), Ok(Some("minutes".to_owned())));
        assert_eq!(options.minutes("minutes"), Ok(Duration::from_secs(30)));
        assert!(["nan", "0", "-1", "1e9"].iter().all(|value| minutes(value).is_err()));
    }
}

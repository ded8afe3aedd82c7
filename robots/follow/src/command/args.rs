//! Options of the commands.

use lexopt::{Parser, prelude::Long};
use std::{num::NonZero, ops::RangeInclusive, path::PathBuf};

/// Maximum number of seeds.
const MOST_SEEDS: u64 = 1_000_000;

/// Seeds of a measurement, and the number of threads (`None`: all cores), which does not change the results.
pub struct Seeds {
    first: u64,
    count: u64,
    pub jobs: Option<NonZero<usize>>,
}

/// Options of all commands.
pub struct Args {
    pub seed: u64,
    pub seeds: Seeds,
    pub metres: u64,
    pub people: bool,
    pub out: PathBuf,
}

impl Seeds {
    pub fn all(&self) -> Vec<u64> {
        (self.first..self.first + self.count).collect()
    }
}

impl Args {
    /// Reads the options of a command; others are errors.
    pub fn read(mut parser: Parser, known: &[&str]) -> Result<Self, String> {
        let mut args = Self {
            seed: 1,
            seeds: Seeds { first: 1, count: 1, jobs: None },
            metres: 1700,
            people: true,
            out: PathBuf::from("out/follow/track.svg"),
        };
        while let Some(arg) = parser.next().map_err(|e| e.to_string())? {
            let name = match &arg {
                Long(name) if known.contains(name) => (*name).to_owned(),
                _ => return Err(format!("{}; `--help` lists the options", arg.unexpected())),
            };
            match name.as_str() {
                "seed" => args.seed = number(&mut parser, &name, 0..=u64::MAX)?,
                "first-seed" => args.seeds.first = number(&mut parser, &name, 0..=u64::MAX - MOST_SEEDS)?,
                "seeds" => args.seeds.count = number(&mut parser, &name, 1..=MOST_SEEDS)?,
                "jobs" => args.seeds.jobs = NonZero::new(number(&mut parser, &name, 1..=1024)? as usize),
                "metres" => args.metres = number(&mut parser, &name, 300..=5000)?,
                "no-people" => args.people = false,
                _ => args.out = parser.value().map(PathBuf::from).map_err(|e| e.to_string())?,
            }
        }
        Ok(args)
    }
}

fn number(parser: &mut Parser, option: &str, range: RangeInclusive<u64>) -> Result<u64, String> {
    let value = parser.value().map_err(|e| e.to_string())?.to_string_lossy().into_owned();
    let number = value.parse().ok().filter(|number| range.contains(number));
    let (least, most) = (range.start(), range.end());
    number.ok_or_else(|| format!("`--{option}` is a whole number from {least} to {most}, not `{value}`"))
}

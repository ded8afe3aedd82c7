//! Commands of the program.

mod args;
mod bench;
mod compete;

use apex_sim::say;
use sick_robot_day::{
    Sensors,
    measure::{ImageWriter, Progress, cubes, signs, targets},
    run::Setup,
};
use std::{fmt, num::NonZero, ops::RangeInclusive, path::PathBuf, process::ExitCode};

/// Seeds of a measurement, and the number of its threads (`None`: all cores), on which the results do not depend.
#[derive(Clone, Copy)]
pub struct Seeds {
    first: u64,
    count: u64,
    jobs: Option<NonZero<usize>>,
}

impl Seeds {
    const fn last(&self) -> u64 {
        self.first + (self.count - 1)
    }

    const fn numbers(&self) -> RangeInclusive<u64> {
        self.first..=self.last()
    }
}

impl fmt::Display for Seeds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "seeds {} to {}", self.first, self.last())
    }
}

/// Measurement in many competitions.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Bench {
    Score,
    /// The score, and what each kind of fault costs.
    Faults,
    /// Motion without sensors.
    Outages,
    /// Computing time.
    Times,
}

/// Command to carry out.
pub enum Command {
    Help,
    Compete { setup: Setup, out: Option<PathBuf>, film: Option<PathBuf> },
    Bench { seeds: Seeds, setup: Setup, kind: Bench },
    Perception { seeds: u64, out: Option<PathBuf> },
}

impl Command {
    /// Carries out the command. An error is the reason why this was not possible.
    pub fn run(self) -> Result<ExitCode, String> {
        match self {
            Self::Help => say(args::HELP).map(|()| ExitCode::SUCCESS),
            Self::Compete { setup, out, film } => compete::compete(&setup, out, film.as_deref()),
            Self::Bench { seeds, setup, kind } => bench::bench(seeds, &setup, kind),
            Self::Perception { seeds, out } => perception(seeds, out).map(|()| ExitCode::SUCCESS),
        }
    }
}

fn perception(seeds: u64, out: Option<PathBuf>) -> Result<(), String> {
    let image_writer = out.as_deref().map(ImageWriter::new).transpose()?.unwrap_or_default();
    let mut sensors = Sensors::new().map_err(|e| e.to_string())?;
    let progress = Progress::default();
    let tell = |table: String| {
        progress.clear();
        say(&table)
    };
    tell(format!("{}\n\n", targets(seeds, &mut sensors, &image_writer, &progress)?))?;
    tell(format!("{}\n\n", signs(seeds, &mut sensors, &image_writer, &progress)?))?;
    tell(format!("{}\n\n", cubes(seeds, &image_writer, &progress)?))?;
    say(&format!("seeds 1 to {seeds}\n"))?;
    out.map_or(Ok(()), |folder| say(&format!("pictures: {}\n", folder.display())))
}

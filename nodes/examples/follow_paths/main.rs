//! Drives random paths with `PathFollower` on an ideal base, and counts the drives that come to their goal after they
//! passed all points in their order:
//!
//! ```text
//! cargo run --release -p apex-nodes --example follow_paths -- [--paths N] [--seed N] [--jobs N]
//! ```
//!
//! A drive fails if it does not end with `reached`, or if the robot misses a point. It has to pass all points in their
//! order: corners of more than 100° and the goal within the `tolerance` of the node, 5 cm, other points, which it may
//! round, within 20 cm. (The faster robot: 10 cm and 50 cm. With `Steer`: 15 cm and 25 cm.)
//!
//! The test of the example drives 300 paths of each class.

use crate::{
    courses::{CLASSES, Class},
    drive::{Outcome, drive},
};
use apex_nodes::math::Random;
use std::{process::ExitCode, thread};

mod courses;
mod drive;

const HELP: &str = "\
Drives random paths with `PathFollower` on an ideal base.

Usage: follow_paths [--paths N] [--seed N] [--jobs N]

  --paths N  number of paths of each class (default 1000)
  --seed N   seed of the first path; path i has the seed N + i (default 1)
  --jobs N   number of threads (default 1); the table does not depend on it
";

#[derive(Debug, Clone, Copy)]
struct Options {
    paths: u64,
    seed: u64,
    jobs: u64,
}

fn main() -> ExitCode {
    match options().map(|options| options.map(print)) {
        Ok(_) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Reads the options. `None` if only the help was asked for.
fn options() -> Result<Option<Options>, String> {
    use lexopt::prelude::*;
    let mut parser = lexopt::Parser::from_env();
    let mut options = Options { paths: 1000, seed: 1, jobs: 1 };
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        let place = match argument {
            Long("paths") => &mut options.paths,
            Long("seed") => &mut options.seed,
            Long("jobs") => &mut options.jobs,
            Long("help") | Short('h') => {
                print!("{HELP}");
                return Ok(None);
            }
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        };
        *place = parser.value().and_then(|value| value.parse()).map_err(|e| e.to_string())?;
    }
    Ok(Some(Options { jobs: options.jobs.max(1), ..options }))
}

fn print(options: Options) {
    println!("{} paths of each class, seeds from {} on", options.paths, options.seed);
    println!("class            good    reached  all points  worst miss in tolerances  longest drive  seeds that fail");
    for class in &CLASSES {
        println!("{}", Row::of(class, options));
    }
}

/// Results of a class of paths.
#[derive(Debug, Clone)]
struct Row {
    name: &'static str,
    paths: u64,
    reached: u64,
    visited: u64,
    /// Greatest distance from a point that was to be passed, in tolerances of the point.
    worst: f32,
    /// Longest time, in s.
    longest: f32,
    /// Seeds of drives that failed.
    failed: Vec<u64>,
}

impl Row {
    fn of(class: &Class, options: Options) -> Self {
        let outcomes = |job: u64| {
            let seeds = (options.seed..options.seed + options.paths).skip(job as usize).step_by(options.jobs as usize);
            seeds.map(|seed| (seed, run(class, seed))).collect::<Vec<_>>()
        };
        let mut outcomes: Vec<(u64, Outcome)> = thread::scope(|scope| {
            let threads: Vec<_> = (0..options.jobs).map(|job| scope.spawn(move || outcomes(job))).collect();
            threads.into_iter().flat_map(|thread| thread.join().expect("a thread that does not panic")).collect()
        });
        outcomes.sort_by_key(|(seed, _)| *seed);
        let count = |test: fn(&Outcome) -> bool| outcomes.iter().filter(|(_, outcome)| test(outcome)).count() as u64;
        let largest = |value: fn(&Outcome) -> f32| outcomes.iter().map(|(_, o)| value(o)).fold(0.0, f32::max);
        Self {
            name: class.name,
            paths: options.paths,
            reached: count(|outcome| outcome.is_reached),
            visited: count(|outcome| outcome.miss <= 1.0),
            worst: largest(|outcome| outcome.miss),
            longest: largest(|outcome| outcome.seconds),
            failed: outcomes.iter().filter(|(_, outcome)| !outcome.is_good()).map(|(seed, _)| *seed).collect(),
        }
    }
}

fn run(class: &Class, seed: u64) -> Outcome {
    let mut random = Random::new(seed);
    let path = (class.path)(&mut random);
    drive(&path, class.robot, &mut random)
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let percent = |count: u64| 100.0 * count as f64 / self.paths as f64;
        write!(f, "{:<15}", self.name)?;
        write!(f, " {:6.2}%  {:6.2}%", percent(self.paths - self.failed.len() as u64), percent(self.reached))?;
        write!(f, "  {:9.2}%  {:24.2}", percent(self.visited), self.worst)?;
        write!(f, "  {:11.0} s  {:?}", self.longest, &self.failed[..self.failed.len().min(8)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_paths_are_driven_to_their_end() {
        for class in &CLASSES {
            let row = Row::of(class, Options { paths: 300, seed: 1, jobs: 2 });
            println!("{row}");
            assert!(row.failed.is_empty(), "{row}");
        }
    }
}

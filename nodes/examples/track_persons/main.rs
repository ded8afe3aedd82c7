//! Compares the tracker of the library with a nearest-neighbour tracker on recorded walks of persons:
//!
//! ```text
//! cargo run --release -p apex-nodes --example track_persons -- FILE… [--first-seed N] [--seeds N] [--jobs N]
//! ```
//!
//! Each line of a file is `frame person x z y …`, with positions in m; consecutive frames are 0.4 s apart. Detections
//! are made from the annotations at the rates of the thesis (table 6.4: 78 % of the persons are detected, 22 % of the
//! detections are false), with errors of 0.1 m. The parameters of both trackers are chosen on the first file. The table
//! is the same for any number of jobs.

use crate::{
    noise::observe,
    score::Score,
    tracking::{CHOICES, NEAREST_CHOICES, Track, nearest, with_hypotheses},
    walks::{Frame, read},
};
use std::{process::ExitCode, thread};

mod nearest;
mod noise;
mod score;
mod tracking;
mod walks;

const HELP: &str = "\
Compares the tracker of persons with a nearest-neighbour tracker on annotated walks.

Usage: track_persons FILE… [--first-seed N] [--seeds N] [--jobs N]

  FILE            annotations: lines of `frame person x z y …`, in m; the parameters are chosen on the first file
  --first-seed N  first seed of the detections (default 1)
  --seeds N       number of seeds (default 10)
  --jobs N        number of threads (default 1); the table does not depend on it
";

/// Tracker with a setting, as a function from detections to tracks.
type Tracker = fn(&[f32], &noise::Observed) -> Vec<Vec<Track>>;

struct Options {
    files: Vec<String>,
    first_seed: u64,
    seeds: u64,
    jobs: usize,
}

fn main() -> ExitCode {
    match options().and_then(|options| options.map_or(Ok(()), |options| run(&options))) {
        Ok(()) => ExitCode::SUCCESS,
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
    let mut options = Options { files: Vec::new(), first_seed: 1, seeds: 10, jobs: 1 };
    while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
        match argument {
            Long("help") | Short('h') => {
                print!("{HELP}");
                return Ok(None);
            }
            Long("first-seed") => options.first_seed = number(&mut parser, "first-seed", 0)?,
            Long("seeds") => options.seeds = number(&mut parser, "seeds", 1)?,
            Long("jobs") => options.jobs = number(&mut parser, "jobs", 1)? as usize,
            Value(file) => options.files.push(file.to_string_lossy().into_owned()),
            other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
        }
    }
    if options.files.is_empty() {
        return Err("no file is given; `--help` shows the usage".to_owned());
    }
    Ok(Some(options))
}

fn number(parser: &mut lexopt::Parser, name: &str, least: u64) -> Result<u64, String> {
    let text = parser.value().map_err(|e| e.to_string())?;
    let number = text.to_str().and_then(|text| text.parse().ok()).filter(|n| *n >= least);
    number.ok_or_else(|| format!("`--{name}` is a whole number from {least}, not `{}`", text.display()))
}

fn run(options: &Options) -> Result<(), String> {
    let walks: Vec<Vec<Frame>> = options.files.iter().map(|file| read(file)).collect::<Result<_, _>>()?;
    let seeds: Vec<u64> = (0..options.seeds).map(|i| options.first_seed.wrapping_add(i)).collect();
    let trackers: [(&str, Tracker, &[&[f32]]); 2] =
        [("nearest neighbour", nearest, &NEAREST_CHOICES), ("many hypotheses", with_hypotheses, &CHOICES)];
    let mut settings = Vec::new();
    for (name, tracker, choices) in trackers {
        let setting = choose(choices, |setting| {
            let score = evaluate(tracker, setting, &walks[0], &seeds, options.jobs);
            score.idf1() + score.mota()
        });
        println!("{name}: {setting:?} chosen on {}", options.files[0]);
        settings.push(setting);
    }
    println!(
        "{:<28} {:<18} {:>6} {:>6} {:>7} {:>7} {:>9}",
        "file", "tracker", "IDF1", "MOTA", "missed", "false", "switches"
    );
    for (at, (file, frames)) in options.files.iter().zip(&walks).enumerate() {
        for ((name, tracker, _), setting) in trackers.iter().zip(&settings) {
            let score = evaluate(*tracker, setting, frames, &seeds, options.jobs);
            let file = file.rsplit('/').next().unwrap_or(file);
            let file = if at == 0 { format!("{file} (chosen on)") } else { file.to_owned() };
            println!("{file:<28} {name:<18} {score}");
        }
    }
    let last = options.first_seed.wrapping_add(options.seeds - 1);
    println!("seeds {} to {last}; errors in % of all annotated positions", options.first_seed);
    Ok(())
}

/// Sum of the scores over all seeds.
fn evaluate(tracker: Tracker, setting: &[f32], frames: &[Frame], seeds: &[u64], jobs: usize) -> Score {
    let play = |seed: &u64| Score::of(frames, &tracker(setting, &observe(frames, *seed)));
    let share = seeds.len().div_ceil(jobs);
    let scores: Vec<Score> = thread::scope(|scope| {
        let threads: Vec<_> =
            seeds.chunks(share).map(|seeds| scope.spawn(move || seeds.iter().map(play).collect::<Vec<_>>())).collect();
        threads.into_iter().flat_map(|thread| thread.join().unwrap_or_default()).collect()
    });
    scores.iter().fold(Score::default(), |sum, score| sum.plus(score))
}

/// Best setting: one parameter after the other is tried with all its choices, twice.
fn choose(choices: &[&[f32]], value: impl Fn(&[f32]) -> f64) -> Vec<f32> {
    let mut setting: Vec<f32> = choices.iter().map(|values| values[values.len() / 2]).collect();
    let mut best = value(&setting);
    for _ in 0..2 {
        for (at, values) in choices.iter().enumerate() {
            for candidate in
                values.iter().filter(|v| values.len() > 1 && **v != setting[at]).copied().collect::<Vec<_>>()
            {
                let before = std::mem::replace(&mut setting[at], candidate);
                let new = value(&setting);
                if new > best {
                    best = new;
                } else {
                    setting[at] = before;
                }
            }
        }
    }
    setting
}

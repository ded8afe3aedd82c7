use super::{
    Detector, LookoutTable, RANGES, RangeClass, RangeTable, RecordedTable, SceneFigure, StepTimes, Summary, Thing,
    drive_on, labelled_scene, labelled_scores,
};
use crate::chart;
use apex_sim::{in_order, say};
use lexopt::{Parser, prelude::*};
use std::{
    ffi::OsString,
    io::{self, IsTerminal as _, Write as _},
    num::NonZero,
    path::{Path, PathBuf},
    process::ExitCode,
    str::FromStr,
};

const HELP: &str = "\
PATSY detects obstacles in the clouds of a time-of-flight camera (obstacles.afg).

Usage: patsy obstacles [--first-seed N] [--seeds N] [--jobs N]
       patsy obstacles --clouds FILE…

Without `--clouds` it measures the detection on simulated scenes whose points are labelled: areas under the ROC curve
beside those of a RANSAC plane with a height threshold, ranges of detection, drives towards small things, computing
time.

  --first-seed N  seed of the first scene (default 1); the weights were chosen on seeds from 1001
  --seeds N       number of scenes (default 100)
  --jobs N        number of threads (default: all cores); the table does not depend on it, the times do a little
  --clouds FILE…  recorded clouds: organised .pcd files, ascii or binary, with labels (0 none, 1 to 9 floor, from 20 on
                  objects) or without
  --help          this text

Pictures of a scene and of the points by distance are written to out/patsy. Exit codes: 0 fine, 2 it could not be done.
";

/// Default folder of the pictures.
const PICTURES: &str = "out/patsy";
/// Number of scenes, and of rounds with each, for the computing time.
const TIMED: (u64, usize) = (20, 50);
/// Speed of the drives towards things, in m/s.
const SPEED: f32 = 0.7;
/// Minimum number of trials at each distance, and of drives.
const LEAST_TRIALS: u64 = 5;

struct Options {
    first: u64,
    seeds: u64,
    jobs: Option<NonZero<usize>>,
    clouds: Vec<PathBuf>,
}

/// Runs the command with the arguments after its name.
///
/// # Errors
/// If the arguments are wrong, a file cannot be read, or a picture cannot be written.
pub fn run(args: impl IntoIterator<Item = OsString>) -> Result<ExitCode, String> {
    let Some(options) = Options::read(Parser::from_args(args))? else {
        return say(HELP).map(|()| ExitCode::SUCCESS);
    };
    if options.clouds.is_empty() {
        simulated(&options)?;
    } else {
        say(&format!("{}\n", RecordedTable::read(&options.clouds)?))?;
    }
    Ok(ExitCode::SUCCESS)
}

impl Options {
    fn read(mut parser: Parser) -> Result<Option<Self>, String> {
        let mut options = Self { first: 1, seeds: 100, jobs: None, clouds: vec![] };
        while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
            match argument {
                Long("help") | Short('h') => return Ok(None),
                Long("first-seed") => options.first = number(&mut parser, "--first-seed", 0)?,
                Long("seeds") => options.seeds = number(&mut parser, "--seeds", 1)?,
                Long("jobs") => {
                    let jobs = number(&mut parser, "--jobs", 1)?;
                    options.jobs = NonZero::new(usize::try_from(jobs).unwrap_or(usize::MAX));
                }
                Long("clouds") => options.clouds.extend(parser.values().map_err(|e| e.to_string())?.map(PathBuf::from)),
                other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
            }
        }
        if options.first.checked_add(options.seeds).is_none() {
            return Err("the last seed is too large".to_owned());
        }
        Ok(Some(options))
    }
}

fn number(parser: &mut Parser, option: &str, least: u64) -> Result<u64, String> {
    let value = parser.value().map_err(|e| e.to_string())?.to_string_lossy().into_owned();
    let number = u64::from_str(&value).ok().filter(|number| *number >= least);
    number.ok_or_else(|| format!("`{option}` is a whole number from {least}, not `{value}`"))
}

fn simulated(options: &Options) -> Result<(), String> {
    let threshold = Detector::default().weights()?.threshold;
    let seeds: Vec<u64> = (options.first..options.first + options.seeds).collect();
    let scenes = work(&seeds, options.jobs, "scenes", |seed| labelled_scores(*seed))?;
    let scenes = scenes.into_iter().collect::<Result<Vec<_>, _>>()?;
    say(&format!("{}\n\n", Summary::new(&scenes, threshold)))?;

    let [trials, drives] = [(options.seeds / 10).max(LEAST_TRIALS), (options.seeds / 4).max(LEAST_TRIALS)];
    let each = |(class, distance)| (0..trials).map(move |trial| (class, distance, options.first + trial));
    let classes = (0..RANGES.len()).flat_map(|class| RangeClass::distances().map(move |distance| (class, distance)));
    let jobs: Vec<(usize, f32, u64)> = classes.flat_map(each).collect();
    let trial =
        |(class, distance, seed): &(usize, f32, u64)| (*class, *distance, RANGES[*class].trial(*distance, *seed));
    let table = RangeTable { trials: work(&jobs, options.jobs, "trials", trial)? };
    say(&format!("{table}\n({trials} trials at each distance; detected: at least 10 points)\n\n"))?;

    let each = |thing: Option<Thing>| (options.first..options.first + drives).map(move |seed| (thing, seed));
    let jobs: Vec<(Option<Thing>, u64)> = LookoutTable::things().flat_map(each).collect();
    let drive = |(thing, seed): &(Option<Thing>, u64)| (*thing, drive_on(*thing, SPEED, *seed));
    let lookout = LookoutTable { drives: work(&jobs, options.jobs, "drives", drive)? };
    say(&format!("{lookout}\n(at {SPEED} m/s)\n\n"))?;

    say(&format!("{}\n\n", StepTimes::measure(options.first, TIMED.0.min(options.seeds), TIMED.1)))?;
    let [picture, ranges] = ["obstacles.svg", "ranges.svg"].map(|name| Path::new(PICTURES).join(name));
    draw(options.first, &picture)?;
    chart::write(&[table.figure()], &ranges)?;
    let last = options.first + options.seeds - 1;
    say(&format!(
        "seeds {} to {last}; pictures: {} of seed {}, {}\n",
        options.first,
        picture.display(),
        options.first,
        ranges.display()
    ))
}

fn draw(seed: u64, path: &Path) -> Result<(), String> {
    let frame = labelled_scene(seed).take();
    let mut detector = Detector::default();
    let (_, labels, _) = detector.detect(&frame.cloud).ok_or("the graph has not sent labels")?;
    SceneFigure { frame: &frame, labels: &labels.labels }.write(path)
}

/// Does all jobs, with their progress on a terminal.
fn work<J: Sync, R: Send>(
    jobs: &[J],
    threads: Option<NonZero<usize>>,
    what: &str,
    work: impl Fn(&J) -> R + Sync,
) -> Result<Vec<R>, String> {
    let show = |line: &str| {
        if io::stderr().is_terminal() {
            // Failing to show the line is not a reason to stop.
            let _ = write!(io::stderr(), "\r\x1b[K{line}").and_then(|()| io::stderr().flush());
        }
    };
    let mut done = 0;
    let results = in_order(jobs, threads, work, |_| {
        done += 1;
        show(&format!("{what}: {done} of {}", jobs.len()));
    });
    show("");
    results.map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(args: &[&str]) -> String {
        run(args.iter().map(OsString::from)).expect_err("wrong arguments")
    }

    #[test]
    fn wrong_arguments_are_errors() {
        assert_eq!(error(&["--seeds", "0"]), "`--seeds` is a whole number from 1, not `0`");
        assert_eq!(error(&["--first-seed", "18446744073709551615"]), "the last seed is too large");
        assert!(error(&["--sees", "3"]).ends_with("`--help` lists the options"));
        assert!(error(&["--clouds"]).contains("argument"));
        assert!(error(&["--clouds", "/nowhere/at/all.pcd"]).starts_with("/nowhere/at/all.pcd:"));
    }
}

use apex_sim::{
    experiment::{Options, Seeds, rows},
    say,
};
use patsy::{
    Detector,
    experiments::{
        chart,
        obstacles::{
            LookoutTable, RANGES, RangeClass, RangeTable, RecordedTable, SceneFigure, StepTimes, Summary, drive_on,
            labelled_scores,
        },
    },
    world::{Thing, labelled_scene},
};
use std::{path::Path, process::ExitCode};

pub const HELP: &str = "\
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

/// Measures the detection of obstacles on simulated scenes, or on recorded clouds.
pub fn obstacles(options: &mut Options) -> Result<ExitCode, String> {
    let (mut seeds, mut clouds) = (Seeds::new(100), vec![]);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "clouds" => clouds.extend(options.paths()?),
            _ => seeds.read(&name, options)?,
        }
    }
    if clouds.is_empty() {
        simulated(&seeds)?;
    } else {
        say(&format!("{}\n", RecordedTable::read(&clouds)?))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn simulated(seeds: &Seeds) -> Result<(), String> {
    let threshold = Detector::default().weights()?.threshold;
    let (first, last, count) = (seeds.first(), seeds.last(), seeds.count());
    let scenes = rows("scenes", &seeds.all(), seeds.jobs, |seed| labelled_scores(*seed), |_, _| None)?;
    say(&format!("{}\n\n", Summary::new(&scenes, threshold)))?;

    let [trials, drives] = [(count / 10).max(LEAST_TRIALS), (count / 4).max(LEAST_TRIALS)];
    let each = |(class, distance)| (0..trials).map(move |trial| (class, distance, first + trial));
    let classes = (0..RANGES.len()).flat_map(|class| RangeClass::distances().map(move |distance| (class, distance)));
    let jobs: Vec<(usize, f32, u64)> = classes.flat_map(each).collect();
    let trial =
        |(class, distance, seed): &(usize, f32, u64)| Ok((*class, *distance, RANGES[*class].trial(*distance, *seed)));
    let table = RangeTable { trials: rows("trials", &jobs, seeds.jobs, trial, |_, _| None)? };
    say(&format!("{table}\n({trials} trials at each distance; detected: at least 10 points)\n\n"))?;

    let each = |thing: Option<Thing>| (first..first + drives).map(move |seed| (thing, seed));
    let jobs: Vec<(Option<Thing>, u64)> = LookoutTable::things().flat_map(each).collect();
    let drive = |(thing, seed): &(Option<Thing>, u64)| Ok((*thing, drive_on(*thing, SPEED, *seed)));
    let lookout = LookoutTable { drives: rows("drives", &jobs, seeds.jobs, drive, |_, _| None)? };
    say(&format!("{lookout}\n(at {SPEED} m/s)\n\n"))?;

    say(&format!("{}\n\n", StepTimes::measure(first, TIMED.0.min(count), TIMED.1)))?;
    let [picture, ranges] = ["obstacles.svg", "ranges.svg"].map(|name| Path::new(PICTURES).join(name));
    draw(first, &picture)?;
    chart::write(&[table.figure()], &ranges)?;
    let [picture, ranges] = [picture.display(), ranges.display()];
    say(&format!("seeds {first} to {last}; pictures: {picture} of seed {first}, {ranges}\n"))
}

fn draw(seed: u64, path: &Path) -> Result<(), String> {
    let frame = labelled_scene(seed).take();
    let mut detector = Detector::default();
    let (_, labels, _) = detector.detect(&frame.cloud).ok_or("the graph has not sent labels")?;
    SceneFigure { frame: &frame, labels: &labels.labels }.write(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(args: &[&str]) -> String {
        obstacles(&mut Options::of(args.iter().map(Into::into))).expect_err("wrong arguments")
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

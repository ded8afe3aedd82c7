//! Lines of CARMEN logs.

use super::{
    LogEntry, ReadError,
    lines::{Lines, shown},
};
use crate::scan::{Pose2, Scan};
use apex_rt::Time;
use core::f32::consts::PI;
use std::{
    collections::BTreeMap,
    path::Path,
    str::{FromStr, SplitWhitespace},
};

/// Maximum number of different words that a message names.
const NAMED: usize = 12;

/// Lines of a log that have its scans.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScanLine {
    /// `FLASER n r₁ … rₙ x y θ odom_x odom_y odom_θ time host logger_time`: half a circle before the scanner.
    Flaser,
    /// `ROBOTLASER1 type start_angle field_of_view resolution max_range accuracy remission_mode n r₁ … rₙ m e₁ … eₘ
    /// laser_x laser_y laser_θ robot_x robot_y robot_θ tv rv forward_safety side_safety turn_axis time host
    /// logger_time`.
    Robot,
    /// `RAWLASER1`: the same line without poses, velocities and safety distances.
    Raw,
}

impl ScanLine {
    /// Determines the lines that are read. A log has its scans up to twice: as the scanner has sent them (`RAWLASER1`),
    /// and with the poses of the robot.
    ///
    /// # Errors
    /// If the log has no scan, or cannot be opened.
    pub fn of(path: &Path) -> Result<Self, ReadError> {
        let mut lines = Lines::open(path)?;
        let mut found = BTreeMap::new();
        // The reader of the log reports the errors of the file.
        while let Ok(Some(line)) = lines.next() {
            match line.split_whitespace().next() {
                Some("FLASER") => return Ok(Self::Flaser),
                Some("ROBOTLASER1") => return Ok(Self::Robot),
                Some(word) if !word.starts_with('#') => count(&mut found, word),
                _ => {}
            }
        }
        match found.contains_key("RAWLASER1") {
            true => Ok(Self::Raw),
            false if lines.is_broken() => Ok(Self::Flaser),
            false => Err(ReadError::open(path, no_scan(&found))),
        }
    }

    /// Returns `true` if a line is one of these.
    pub fn is(self, line: &str) -> bool {
        let word = match self {
            Self::Flaser => "FLASER",
            Self::Robot => "ROBOTLASER1",
            Self::Raw => "RAWLASER1",
        };
        line.split_whitespace().next() == Some(word)
    }

    /// Reads a line into `scan`, which has the range limits of the parameters. The number in the result is 0.
    pub fn read(self, line: &str, scan: &mut Scan) -> Result<LogEntry, String> {
        let mut words = line.split_whitespace();
        words.next();
        match self {
            Self::Flaser => flaser(&mut words, scan),
            Self::Robot | Self::Raw => laser(&mut words, scan, self == Self::Robot),
        }
    }
}

/// Counts a word, unless there are too many others.
fn count(found: &mut BTreeMap<String, usize>, word: &str) {
    if let Some(count) = found.get_mut(word) {
        *count += 1;
    } else if found.len() < NAMED || word == "RAWLASER1" {
        found.insert(word.to_owned(), 1);
    }
}

fn no_scan(found: &BTreeMap<String, usize>) -> String {
    const WANTED: &str = "the log has no scan: no line begins with `FLASER`, `ROBOTLASER1` or `RAWLASER1`";
    let found: Vec<String> = found.iter().map(|(word, count)| format!("{count} `{}`", shown(word))).collect();
    match found.is_empty() {
        true => "the log is empty".to_owned(),
        false => format!("{WANTED}; it has {}", found.join(", ")),
    }
}

/// Reads the words of a FLASER line. Its beams cover 180° about the x axis; an odd number of beams includes both ends.
fn flaser(words: &mut SplitWhitespace<'_>, scan: &mut Scan) -> Result<LogEntry, String> {
    let beams: usize = parse(words.next(), "number of beams")?;
    let intervals = if beams % 2 == 1 { beams - 1 } else { beams };
    scan.angle_min = -0.5 * PI;
    scan.angle_increment = PI / intervals.max(1) as f32;
    ranges(words, scan, beams)?;
    let (pose, odometry) = (pose(words)?, pose(words)?);
    Ok(LogEntry { id: 0, pose: Some(pose), odometry: Some(odometry), time: Some(time(words)?) })
}

/// Reads the words of a line with the geometry of the scanner. A beam of its maximum range has met nothing.
fn laser(words: &mut SplitWhitespace<'_>, scan: &mut Scan, has_poses: bool) -> Result<LogEntry, String> {
    let _type: f32 = parse(words.next(), "type of the scanner")?;
    scan.angle_min = parse(words.next(), "start angle")?;
    let _field_of_view: f32 = parse(words.next(), "field of view")?;
    scan.angle_increment = parse(words.next(), "angular resolution")?;
    let farthest: f32 = parse(words.next(), "maximum range")?;
    let _accuracy: f32 = parse(words.next(), "accuracy")?;
    let _mode: f32 = parse(words.next(), "mode of remissions")?;
    let beams = parse(words.next(), "number of beams")?;
    ranges(words, scan, beams)?;
    if farthest > 0.0 {
        scan.ranges.iter_mut().filter(|range| **range >= farthest).for_each(|range| *range = f32::INFINITY);
    }
    for _ in 0..parse::<usize>(words.next(), "number of remissions")? {
        words.next().ok_or("a remission is missing")?;
    }
    let mut entry = LogEntry::default();
    if has_poses {
        (entry.pose, entry.odometry) = (Some(pose(words)?), Some(pose(words)?));
        for name in ["velocity", "turn rate", "forward safety distance", "side safety distance", "turn axis"] {
            words.next().ok_or_else(|| missing(name))?;
        }
    }
    entry.time = Some(time(words)?);
    Ok(entry)
}

fn ranges(words: &mut SplitWhitespace<'_>, scan: &mut Scan, beams: usize) -> Result<(), String> {
    fill(scan, words.by_ref().take(beams))?;
    match scan.ranges.len() {
        found if found < beams => Err(format!("{beams} beams announced, {found} found")),
        _ => Ok(()),
    }
}

fn pose(words: &mut SplitWhitespace<'_>) -> Result<Pose2, String> {
    Ok(Pose2::new(parse(words.next(), "x")?, parse(words.next(), "y")?, parse(words.next(), "theta")?))
}

fn time(words: &mut SplitWhitespace<'_>) -> Result<Time, String> {
    let seconds: f64 = parse(words.next(), "time")?;
    Ok(Time::from_nanos((seconds * 1e9) as i64))
}

fn missing(name: &str) -> String {
    format!("{name} is missing")
}

/// Parses the number in a cell.
pub(super) fn parse<T: FromStr>(cell: Option<&str>, name: &str) -> Result<T, String> {
    let cell = cell.ok_or_else(|| missing(name))?.trim();
    cell.parse().map_err(|_| format!("{name}: `{}` is no valid number", shown(cell)))
}

/// Replaces the ranges of a scan by those in `cells`.
pub(super) fn fill<'a>(scan: &mut Scan, cells: impl Iterator<Item = &'a str>) -> Result<(), String> {
    scan.ranges.clear();
    for (beam, cell) in cells.enumerate() {
        let range = cell.trim().parse().map_err(|_| format!("beam {beam}: `{}` is no range", shown(cell)))?;
        scan.ranges.push(range).map_err(|e| e.to_string())?;
    }
    Ok(())
}

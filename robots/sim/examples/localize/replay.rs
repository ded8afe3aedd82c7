//! Localization on recordings.

use crate::{for_each_seed, log, options::Options, table};
use apex_nodes::{
    io::{self, PlanOptions, read_plan},
    localize::{Filter, Settings, VisibilityTable},
    map::VectorMap,
    scan::{Point2, PoseChange},
};
use std::path::{Path, PathBuf};

/// Error at which a pose is wrong, in m.
const WRONG: f32 = 1.0;

/// Result of one run.
struct Score {
    /// Way until the robot was localized, in m.
    way: Option<f32>,
    /// Errors of the scored scans while the robot was localized, in m.
    errors: Vec<f32>,
    /// Sum of the offsets from the reference poses, in the frame of the map.
    offset: Point2,
    turns: Vec<f32>,
    /// Number of scored scans.
    scored: usize,
    lost: usize,
    /// `true` if the robot is localized at the end.
    at_end: bool,
    largest_at_end: f32,
}

pub fn run(options: &Options, map: &Path, logs: &[PathBuf]) -> Result<(), String> {
    let map = read_map(options, map)?;
    let table = table(&map, options.table)?;
    println!(
        "{:24}{:>5}{:>9}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>6}{:>8}{:>11}",
        "recording",
        "seed",
        "found m",
        "median",
        "90 %",
        "largest",
        "mean x",
        "mean y",
        "deg",
        "known",
        "lost",
        "wrong",
        "end"
    );
    for path in logs {
        let recording = log::read(path)?;
        let scores = for_each_seed(options, |seed| {
            play(&recording, &table, Settings { mount: recording.mount, seed, ..options.settings }, options.trace)
        })?;
        for (i, score) in scores.into_iter().enumerate() {
            let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
            show(name, options.first_seed + i as u64, score);
        }
    }
    Ok(())
}

fn play(recording: &log::Recording, table: &VisibilityTable, settings: Settings, trace: bool) -> Score {
    let mut filter = Filter::new(table.clone(), settings);
    let mut score = Score {
        way: None,
        errors: vec![],
        offset: Point2::default(),
        turns: vec![],
        scored: 0,
        lost: 0,
        at_end: false,
        largest_at_end: 0.0,
    };
    let (mut way, mut last) = (0.0, None);
    for record in recording.records.iter().filter(|record| record.is_scored) {
        let step = last.replace(record.truth).map_or(0.0, |l| (l.position() - record.truth.position()).norm());
        way += step;
        let change = filter.update(&record.odometry, &record.scan);
        let pose = filter.pose_at(&record.odometry);
        let offset = pose.position() - record.truth.position();
        let error = offset.norm();
        score.scored += 1;
        match change {
            Some(PoseChange::Localized) => score.way = score.way.or(Some(way)),
            Some(PoseChange::Lost) => score.lost += 1,
            None => {}
        }
        if filter.is_localized() {
            score.errors.push(error);
            score.offset = score.offset + offset;
            score.turns.push(pose.relative_to(&record.truth).theta.abs().to_degrees());
        }
        score.at_end = filter.is_localized();
        score.largest_at_end = error;
        if trace {
            println!("{way:7.1} m {error:7.2} m {change:?} {:?}", filter.estimate());
        }
    }
    score
}

fn show(name: &str, seed: u64, mut score: Score) {
    score.errors.sort_by(f32::total_cmp);
    score.turns.sort_by(f32::total_cmp);
    let at = |values: &[f32], share: f32| {
        values.get(((values.len() as f32 * share) as usize).min(values.len().saturating_sub(1))).copied()
    };
    let number = |value: Option<f32>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
    let offset = score.offset.scaled(1.0 / score.errors.len() as f32);
    let wrong = score.errors.iter().filter(|error| **error > WRONG).count();
    println!(
        "{name:24}{seed:>5}{:>9}{:>8}{:>8}{:>8}{:>8.3}{:>8.3}{:>8}{:>7.0}%{:>6}{:>7.1}%{:>11}",
        score.way.map_or("-".to_owned(), |way| format!("{way:.1}")),
        number(at(&score.errors, 0.5)),
        number(at(&score.errors, 0.9)),
        number(at(&score.errors, 1.0)),
        offset.x,
        offset.y,
        number(at(&score.turns, 0.5)),
        100.0 * score.errors.len() as f32 / score.scored.max(1) as f32,
        score.lost,
        100.0 * wrong as f32 / score.scored.max(1) as f32,
        match (score.at_end, score.largest_at_end < WRONG) {
            (true, true) => "right",
            (true, false) => "wrong",
            (false, _) => "not known",
        },
    );
}

/// Reads a map of lines, or the outlines of a map of pixels.
fn read_map(options: &Options, path: &Path) -> Result<VectorMap, String> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("pgm")) {
        return outline(options, path);
    }
    let plan = PlanOptions { scale: options.scale, layers: options.layers.clone() };
    read_plan(path, &plan).map(|plan| plan.map).map_err(|e| e.to_string())
}

/// Outlines of the occupied pixels, which may be longer in one direction than in the other.
fn outline(options: &Options, path: &Path) -> Result<VectorMap, String> {
    let pixels = io::read_map(path, 1.0).map_err(|e| e.to_string())?;
    let ((x, y), (pixel_x, pixel_y)) = (options.origin, options.pixel);
    let place = |p: Point2| Point2::new(x + pixel_x * p.x, y + pixel_y * p.y);
    let mut map = VectorMap::default();
    let sides = VectorMap::outline(&pixels).map_err(|e| format!("{}: {e}", path.display()))?;
    for side in sides.segments() {
        map.add(place(side.a), place(side.b)).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(map)
}

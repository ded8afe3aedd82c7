//! Localization in a simulated building.

use crate::{draw::Picture, for_each_seed, options::Options, table};
use apex_nodes::{
    localize::{Filter, Settings, VisibilityTable},
    scan::{PoseChange, Scan},
};
use apex_sim::{Building, Laser, Random, Tour};
use std::{fs, path::Path, time::Instant};

/// Period of the simulation, in s.
const PERIOD: f32 = 0.1;
/// Time in which a start or a kidnapping has to end well, and of the rest of a run, in s.
const LIMIT: f32 = 30.0;
const AFTER: f32 = 30.0;
/// Error at which a pose is wrong, in m.
const WRONG: f32 = 0.5;
/// Errors of the wheels: those of a Pioneer 2.
const DRIFT: f32 = 1.0;

/// Result of a start or of a kidnapping.
#[derive(Clone, Default)]
struct Score {
    /// Time until the robot was rightly localized, in s.
    time: Option<f32>,
    /// Errors from then on, in m.
    errors: Vec<f32>,
    /// Time with a wrong pose that the robot believed, in s, including that until it noticed the kidnapping.
    wrong: f32,
    lost: usize,
}

pub fn run(options: &Options, plan: &Path) -> Result<(), String> {
    let building = Building::read(plan).map_err(|e| e.to_string())?;
    let table = table(&building.plan, options.table)?;
    let runs = for_each_seed(options, |seed| play(options, &building, &table, seed))?;
    let runs: Option<Vec<_>> = runs.into_iter().collect();
    let runs = runs.ok_or_else(|| format!("{}: no place for the robot in this plan", plan.display()))?;
    println!(
        "{:>5}{:>10}{:>9}{:>8}{:>6}{:>14}{:>9}{:>8}{:>6}",
        "seed", "start s", "median", "wrong", "lost", "kidnapped s", "median", "wrong", "lost"
    );
    for (i, [start, kidnapped]) in runs.iter().enumerate() {
        let cells = [(start, 10), (kidnapped, 14)].map(|(score, width)| {
            let time = score.time.map_or("-".to_owned(), |time| format!("{time:.1}"));
            format!("{time:>width$}{:>9.3}{:>8.1}{:>6}", median(&score.errors), score.wrong, score.lost)
        });
        println!("{:>5}{}{}", options.first_seed + i as u64, cells[0], cells[1]);
    }
    for (of, name) in ["starts anywhere", "kidnappings"].into_iter().enumerate() {
        summary(name, runs.iter().map(|run| &run[of]));
    }
    Ok(())
}

fn summary<'a>(name: &str, scores: impl Iterator<Item = &'a Score> + Clone) {
    let count = scores.clone().count();
    let mut times: Vec<f32> = scores.clone().filter_map(|score| score.time).collect();
    let good = times.iter().filter(|time| **time <= LIMIT).count();
    times.sort_by(f32::total_cmp);
    let errors: Vec<f32> = scores.flat_map(|score| score.errors.iter().copied()).collect();
    println!(
        "{name}: {good} of {count} rightly localized within {LIMIT} s ({:.0} %), median time {:.1} s, then median error {:.3} m",
        100.0 * good as f32 / count.max(1) as f32,
        times.get(times.len() / 2).copied().unwrap_or(f32::NAN),
        median(&errors),
    );
}

/// Begins anywhere, and is kidnapped after some time.
fn play(options: &Options, building: &Building, table: &VisibilityTable, seed: u64) -> Option<[Score; 2]> {
    let mut building = building.clone();
    building.furnish(options.furniture, &mut Random::new(seed.wrapping_mul(31)));
    let mut tour = Tour::new(building, Laser::default(), DRIFT, seed)?;
    let mut filter = Filter::new(table.clone(), Settings { seed, ..options.settings });
    let mut scan = Scan::default();
    let mut scores = [Score::default(), Score::default()];
    for score in &mut scores {
        drive(&mut tour, &mut filter, &mut scan, score, options.trace);
        tour.carry();
    }
    Some(scores)
}

fn drive(tour: &mut Tour, filter: &mut Filter, scan: &mut Scan, score: &mut Score, trace: bool) {
    for i in 0..((LIMIT + AFTER) / PERIOD) as usize {
        let odometry = tour.drive(PERIOD);
        // Scans that the filter would not use are not simulated.
        let mut change = None;
        if filter.is_due(&odometry) {
            tour.scan(scan);
            change = filter.update(&odometry, scan);
        }
        let error = (filter.pose_at(&odometry).position() - tour.pose().position()).norm();
        if trace && (change.is_some() || i % 10 == 0) {
            println!("{:5.1} s {error:7.2} m {change:?} {:?}", i as f32 * PERIOD, filter.estimate());
        }
        score.lost += usize::from(change == Some(PoseChange::Lost));
        if filter.is_localized() {
            if error <= WRONG {
                score.time = score.time.or(Some(i as f32 * PERIOD));
            } else {
                score.wrong += PERIOD;
            }
            if score.time.is_some() {
                score.errors.push(error);
            }
        }
    }
}

/// Prints the computing time of an update with about 1000 particles and 30 beams, of a search while the robot is lost,
/// and of the first scan.
pub fn speed(options: &Options, plan: &Path) -> Result<(), String> {
    let building = Building::read(plan).map_err(|e| e.to_string())?;
    let table = table(&building.plan, options.table)?;
    let mut tour = Tour::new(building, Laser::default(), DRIFT, options.first_seed).ok_or("no place for the robot")?;
    let least = Settings { particles: [1000, options.settings.particles[1]], ..options.settings };
    let mut filter = Filter::new(table, Settings { seed: options.first_seed, ..least });
    let mut scan = Scan::default();
    let (mut known, mut unknown, mut first) = (vec![], vec![], None);
    for _ in 0..3000 {
        let odometry = tour.drive(PERIOD);
        tour.scan(&mut scan);
        let (was, before) = (filter.is_localized(), *filter.estimate());
        let start = Instant::now();
        filter.update(&odometry, &scan);
        let time = start.elapsed().as_secs_f32() * 1e3;
        if before == *filter.estimate() {
            continue;
        }
        match (first, was) {
            (None, _) => first = Some(time),
            (_, true) if filter.particles().len() <= 1100 => known.push(time),
            (_, true) => {}
            (_, false) => unknown.push(time),
        }
    }
    println!("{} beams, {} to {} particles, times in ms:", least.beams, least.particles[0], least.particles[1]);
    println!("first scan, anywhere   {:8.2}", first.unwrap_or(f32::NAN));
    println!("pose not known  median {:8.2} of {}", median(&unknown), unknown.len());
    println!(
        "1000 particles  median {:8.3}, largest {:.3}, of {}",
        median(&known),
        known.iter().copied().fold(0.0, f32::max),
        known.len()
    );
    Ok(())
}

/// Draws the first scan, a moment before the robot knows its pose, and the moment in which it knows it.
pub fn draw(options: &Options, plan: &Path, file: &Path) -> Result<(), String> {
    let mut building = Building::read(plan).map_err(|e| e.to_string())?;
    let (table, plan) = (table(&building.plan, options.table)?, building.plan.clone());
    let seed = options.first_seed;
    building.furnish(options.furniture, &mut Random::new(seed.wrapping_mul(31)));
    let mut tour = Tour::new(building, Laser::default(), DRIFT, seed).ok_or("no place for the robot")?;
    let mut filter = Filter::new(table, Settings { seed, ..options.settings });
    let (mut scan, mut picture) = (Scan::default(), Picture::new(&plan));
    for i in 0..(LIMIT / PERIOD) as usize {
        let odometry = tour.drive(PERIOD);
        tour.scan(&mut scan);
        let change = filter.update(&odometry, &scan);
        if i == 0 || i == 15 || change == Some(PoseChange::Localized) {
            let caption = format!("After {:.1} s", i as f32 * PERIOD);
            picture.add(&caption, &plan, &tour.building().world, &filter, tour.pose());
        }
        if change == Some(PoseChange::Localized) {
            break;
        }
    }
    fs::write(file, picture.svg()).map_err(|e| format!("{}: {e}", file.display()))
}

fn median(values: &[f32]) -> f32 {
    let mut values = values.to_vec();
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f32::NAN)
}

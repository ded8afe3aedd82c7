//! Localization and mapping on recordings: `slam FOLDER [OUT]` prints the deviation of the poses from the reference,
//! and the computing time. With a second folder it draws each map with the path of the robot.

#[path = "../tests/slam/recordings.rs"]
mod recordings;

use apex_nodes::{
    map::{Grid, Occupancy, TooManyCells},
    scan::Point2,
    slam::{Mapper, Pose, PosedScans, ScanDrawer, Settings, selected_scans},
};
use plotters::prelude::*;
use recordings::{Recording, errors, fr079, intel, play};
use std::{
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

fn main() {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let Some(folder) = arguments.next() else {
        eprintln!("usage: slam FOLDER [OUT]");
        std::process::exit(2);
    };
    let out = arguments.next();
    println!(
        "{:24}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>9}",
        "median and largest error", "odom", "", "slam", "", "scans", "kept", "loops", "ms/kept"
    );
    for (name, recording) in [
        ("Intel, wheels", intel(&folder)),
        ("Freiburg 079, as is", fr079(&folder, 0.0)),
        ("Freiburg 079, noisy", fr079(&folder, 1.0)),
    ] {
        let (mapper, estimate, slowest) = run(name, &recording);
        if let Some(out) = &out {
            let file = out.join(format!("{}.svg", name.replace([',', ' '], "")));
            draw(&file, &mapper, &estimate).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        }
        println!("    slowest scan {slowest:.1?}");
        times_of_maps(&recording);
    }
}

fn run(name: &str, recording: &Recording) -> (Mapper, Vec<Pose>, Duration) {
    let start = Instant::now();
    let (mapper, estimate, slowest) = play(recording, Settings::default());
    let time = start.elapsed();
    let odometry: Vec<Pose> = recording.scans.iter().map(|(odometry, _)| *odometry).collect();
    let before = errors(&odometry, &recording.reference);
    let after = errors(&estimate, &recording.reference);
    let (middle, last) = (before.len() / 2, before.len() - 1);
    println!(
        "{name:24}{:8.3}{:8.3}{:8.3}{:8.3}{:8}{:8}{:8}{:9.2}",
        before[middle],
        before[last],
        after[middle],
        after[last],
        recording.scans.len(),
        mapper.scans().len(),
        mapper.loops(),
        1e3 * time.as_secs_f64() / mapper.scans().len() as f64
    );
    (mapper, estimate, slowest)
}

/// Prints the times to draw the bounded map after each kept scan: by a drawer that has drawn the map before, and by a
/// new one.
fn times_of_maps(recording: &Recording) {
    let (mut mapper, mut drawer) = (Mapper::new(Settings::default()), ScanDrawer::default());
    let (mut scans, mut map, mut anew) = (PosedScans::default(), Grid::default(), Grid::default());
    let mut times = [vec![], vec![]];
    for (odometry, points) in &recording.scans {
        if !mapper.is_due(odometry) {
            continue;
        }
        mapper.add(odometry, points.clone());
        mapper.write_scans(selected_scans(mapper.scans().len()), Point2::default(), &mut scans);
        times[0].push(time(|| drawer.draw(&scans, 0.05, &mut map)));
        times[1].push(time(|| ScanDrawer::default().draw(&scans, 0.05, &mut anew)));
        assert_eq!(map, anew);
    }
    for (what, mut times) in ["map after map", "maps anew"].into_iter().zip(times) {
        times.sort_unstable();
        let share = |share: f64| times[(share * (times.len() - 1) as f64) as usize];
        let all: Duration = times.iter().sum();
        println!(
            "    {what:14} all {all:.1?}, median {:.1?}, 90 % {:.1?}, slowest {:.1?}",
            share(0.5),
            share(0.9),
            share(1.0)
        );
    }
}

fn time(draw: impl FnOnce() -> Result<(), TooManyCells>) -> Duration {
    let start = Instant::now();
    draw().expect("a map of a building");
    start.elapsed()
}

/// Draws the map of all scans, and the path of the robot.
fn draw(file: &Path, mapper: &Mapper, way: &[Pose]) -> Result<(), Box<dyn std::error::Error>> {
    let mut map = Grid::<Occupancy>::default();
    let mut scans = PosedScans::default();
    mapper.write_scans(0..mapper.scans().len(), Point2::default(), &mut scans);
    ScanDrawer::default().draw(&scans, 0.1, &mut map)?;
    let raster = *map.raster();
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let size = (raster.width as u32 * 2, raster.height as u32 * 2);
    let area = SVGBackend::new(file, size).into_drawing_area();
    area.fill(&WHITE)?;
    let pixel = |p: Point2| {
        let cells = (p - raster.corner).scaled(2.0 / raster.resolution);
        (cells.x as i32, size.1 as i32 - cells.y as i32)
    };
    for (cell, _) in map.iter().filter(|(_, o)| **o == Occupancy::Occupied) {
        let (x, y) = pixel(raster.centre(cell));
        area.draw(&Rectangle::new([(x - 1, y - 1), (x + 1, y + 1)], BLACK.filled()))?;
    }
    let point = |p: &Pose| pixel(Point2::new(p.translation.x as f32, p.translation.y as f32));
    area.draw(&PathElement::new(way.iter().map(point).collect::<Vec<_>>(), RED))?;
    Ok(area.present()?)
}

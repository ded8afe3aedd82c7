//! A* on the maps of the MovingAI benchmark with their known shortest lengths (Sturtevant 2012).
//!
//! The maps are not part of the project. Without them the test prints a message and passes, unless it runs with
//! `CI=true`.

use apex_nodes::{
    map::{Cell, Grid, Occupancy, Raster},
    nav::{Search, Terrain},
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Folder of the maps, or `None` (with a message) if it does not exist.
fn maps() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/planning");
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", folder.display());
    eprintln!("skipped: {} is missing", folder.display());
    None
}

/// Reads rows of characters after a header of four lines; `.` is free.
fn read_map(file: &Path) -> Grid<Occupancy> {
    let text = fs::read_to_string(file).expect("the map");
    let rows: Vec<&[u8]> = text.lines().skip(4).map(str::as_bytes).collect();
    let raster = Raster { width: rows[0].len(), height: rows.len(), ..Raster::default() };
    let mut map = Grid::new(raster, Occupancy::Occupied).expect("a small map");
    for (cell, sign) in map.cells_mut().iter_mut().zip(rows.concat()) {
        if sign == b'.' {
            *cell = Occupancy::Free;
        }
    }
    map
}

/// Solves every `step`-th query of a scenario and returns their number.
fn solve(folder: &Path, name: &str, step: usize) -> usize {
    let map = read_map(&folder.join(name));
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let scenario = fs::read_to_string(folder.join(format!("{name}.scen"))).expect("the queries");
    let (mut search, mut path) = (Search::default(), Vec::new());
    let queries: Vec<&str> = scenario.lines().skip(1).filter(|line| !line.trim().is_empty()).step_by(step).collect();
    for line in &queries {
        // Bucket, map, width, height, x and y of start and goal, and the length of the shortest path.
        let number = |i| line.split_ascii_whitespace().nth(i).and_then(|word| word.parse::<f64>().ok());
        let cell = |i| Cell::new(number(i).expect("x") as usize, number(i + 1).expect("y") as usize);
        let (start, goal, best) = (cell(4), cell(6), number(8).expect("a length"));
        let length = search.run(&terrain, start, goal, &mut path).expect("there is a path");
        assert!((length - best).abs() <= 1e-4 * best, "{name}: {line}: found {length}");
        assert!(path.first() == Some(&start) && path.last() == Some(&goal));
        assert!((length_of(&path) - length).abs() < 1e-6 * length.max(1.0), "{name}: {line}");
        assert!(path.iter().all(|cell| terrain.is_open(*cell)));
    }
    queries.len()
}

fn length_of(path: &[Cell]) -> f64 {
    let step = |a: &Cell, b: &Cell| (a.x.abs_diff(b.x) as f64).hypot(a.y.abs_diff(b.y) as f64);
    path.windows(2).map(|ends| step(&ends[0], &ends[1])).sum()
}

#[test]
fn paths_have_the_known_length() {
    let Some(folder) = maps() else { return };
    assert_eq!(solve(&folder, "arena.map", 1), 160);
    assert_eq!(solve(&folder, "den312d.map", 1), 320);
    assert_eq!(solve(&folder, "32room_000.map", 10), 190);
}

#[test]
#[ignore = "takes half a minute"]
fn all_paths_through_many_rooms_have_the_known_length() {
    let Some(folder) = maps() else { return };
    assert_eq!(solve(&folder, "32room_000.map", 1), 1900);
}

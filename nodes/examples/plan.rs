//! Plans a path on a map given as an image, in the format of ROS map servers, and draws it.
//!
//! ```text
//! cargo run --release -p apex-nodes --features image --example plan -- map.pgm 0.1 5,5 30,20 path.png
//! ```
//!
//! The second argument is the size of a pixel in m. Start and goal are in m from the lower left corner. White is free,
//! black is occupied, and grey is unknown. In the output image, costs are red and the path is blue.

use apex_nodes::{
    io::read_map,
    map::{Cell, DistanceTransform, Grid, Occupancy, Raster, UnknownRegions, grow},
    nav::{Path, Planner, Smoothing, Terrain, write_costs},
    scan::Pose2,
};
use image::{Rgb, RgbImage};
use std::{
    env, fs,
    path::Path as FilePath,
    process::ExitCode,
    time::{Duration, Instant},
};

const USAGE: &str = "usage: plan MAP RESOLUTION START_X,START_Y GOAL_X,GOAL_Y PICTURE.png";

/// Distance by which obstacles grow, and radius around start and goal in which they do not, in m.
const RADIUS: f32 = 0.35;
const KEPT: f32 = 0.5;
/// Highest cost, and distance from obstacles at which costs end, in m (thesis 4.3.6).
const HIGHEST: f32 = 4.0;
const REACH: f32 = 2.5;
/// Maximum area of an unknown region that is filled, in m².
const LARGEST_UNKNOWN: f32 = 0.25;
const SMOOTHING: Smoothing = Smoothing { spacing: 0.1, rounds: 30 };

/// Arguments of the command line.
struct Request {
    map: String,
    resolution: f32,
    start: Pose2,
    goal: Pose2,
    picture: String,
}

/// Error with its exit code: 1 if there is no path, 2 if the command failed otherwise.
struct Failure(u8, String);

impl Failure {
    fn command(why: impl ToString) -> Self {
        Self(2, why.to_string())
    }
}

fn main() -> ExitCode {
    let words: Vec<String> = env::args().skip(1).collect();
    match run(&words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure(code, why)) => {
            eprintln!("error: {why}");
            ExitCode::from(code)
        }
    }
}

fn run(words: &[String]) -> Result<(), Failure> {
    let request = parse(words)?;
    let map = read_map(&request.map, request.resolution).map_err(Failure::command)?;
    let (costs, path) = plan(&map, &request)?;
    save(&draw(&map, &costs, &path), &request.picture)
}

fn parse(words: &[String]) -> Result<Request, Failure> {
    let [map, resolution, start, goal, picture] = words else { return Err(Failure::command(USAGE)) };
    let number = |word: &str| {
        let value = word.parse::<f32>().ok().filter(|value| value.is_finite());
        value.ok_or_else(|| Failure::command(format!("`{word}` is not a number\n{USAGE}")))
    };
    let pose = |word: &str| {
        let (x, y) =
            word.split_once(',').ok_or_else(|| Failure::command(format!("`{word}` is no point X,Y\n{USAGE}")))?;
        Ok::<_, Failure>(Pose2::new(number(x)?, number(y)?, 0.0))
    };
    Ok(Request {
        map: map.clone(),
        resolution: number(resolution)?,
        start: pose(start)?,
        goal: pose(goal)?,
        picture: picture.clone(),
    })
}

fn plan(map: &Grid<Occupancy>, request: &Request) -> Result<(Grid<f32>, Path), Failure> {
    let (mut grown, mut distances, mut costs) = (map.clone(), Grid::default(), Grid::default());
    let mut transform = DistanceTransform::default();
    let (mut planner, mut path) = (Planner::default(), Path::default());
    let is_occupied = |cell: &Occupancy| cell.is_obstacle();
    let Request { start, goal, .. } = request;

    let (closing, ()) = timed(|| UnknownRegions::default().close(&mut grown, LARGEST_UNKNOWN));
    let (growing, ()) = timed(|| {
        transform.run(&grown, is_occupied, &mut distances);
        grow(&mut grown, &distances, RADIUS, &[start.position(), goal.position()], KEPT);
    });
    let (costing, ()) = timed(|| {
        transform.run(&grown, is_occupied, &mut distances);
        write_costs(&distances, HIGHEST, REACH, &mut costs);
    });
    let terrain = Terrain { map: &grown, costs: Some(&costs), unknown_is_open: false };
    let (planning, result) = timed(|| planner.plan(&terrain, start, goal, SMOOTHING, &mut path));
    result.map_err(|why| Failure(1, format!("no path: {why}")))?;

    let Raster { width, height, resolution, .. } = map.raster();
    println!("map       {width} x {height} cells of {resolution} m");
    println!("path      {:.2} m, {} points", path.length(), path.points.len());
    for (step, took) in [("unknown", closing), ("grow", growing), ("costs", costing), ("plan", planning)] {
        println!("{step:9} {:.2} ms", took.as_secs_f64() * 1e3);
    }
    Ok((costs, path))
}

fn timed<T>(step: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let result = step();
    (start.elapsed(), result)
}

/// Image of the map with costs in red and the path in blue.
fn draw(map: &Grid<Occupancy>, costs: &Grid<f32>, path: &Path) -> RgbImage {
    let Raster { width, height, .. } = *map.raster();
    let row = |y: usize| (height - 1 - y) as u32;
    let mut drawn = RgbImage::new(width as u32, height as u32);
    for (cell, occupancy) in map.iter() {
        let grey = match occupancy {
            Occupancy::Free => 255,
            Occupancy::Unknown => 205,
            Occupancy::Occupied | Occupancy::Low => 0,
        };
        drawn.put_pixel(cell.x as u32, row(cell.y), Rgb([grey; 3]));
    }
    for (cell, cost) in costs.iter() {
        let pale = 1.0 - 0.7 * cost / HIGHEST;
        let Rgb([_, green, blue]) = drawn.get_pixel_mut(cell.x as u32, row(cell.y));
        (*green, *blue) = ((f32::from(*green) * pale) as u8, (f32::from(*blue) * pale) as u8);
    }
    let cells: Vec<Cell> = path.points.iter().filter_map(|point| costs.raster().cell(*point)).collect();
    for cell in cells.windows(2).flat_map(|ends| Raster::line(ends[0], ends[1])) {
        drawn.put_pixel(cell.x as u32, row(cell.y), Rgb([0, 0, 255]));
    }
    drawn
}

/// Writes an image to a file that does not exist yet.
fn save(picture: &RgbImage, file: &str) -> Result<(), Failure> {
    let failed = |why: &dyn std::fmt::Display| Failure::command(format!("{file}: {why}"));
    if fs::exists(FilePath::new(file)).map_err(|e| failed(&e))? {
        return Err(failed(&"there is such a file already: choose another name, or delete it"));
    }
    picture.save(file).map_err(|e| failed(&e))
}

use crate::{OfficePlan, Random, World};
use apex_nodes::{
    io::{PlanOptions, ReadError, read_plan},
    map::{Cell, DistanceTransform, Grid, Occupancy, Raster, VectorMap},
    scan::{Point2, Pose2},
};
use core::f32::consts::PI;
use std::{
    fs, io,
    path::Path,
    process,
    sync::atomic::{AtomicU32, Ordering},
};

/// Seed of the office floor.
const OFFICE: u64 = 1;
/// Layers of a plan that do not stop a robot or its scanner: arcs that doors move along, marks, and areas.
const WALLS: [&str; 2] = ["walls", "windows"];
/// Side of a cell of the map of free places, in m.
const RESOLUTION: f32 = 0.1;

/// Building from a plan, with furniture that is not on the plan.
#[derive(Debug, Clone)]
pub struct Building {
    /// Walls of the plan.
    pub plan: VectorMap,
    /// Walls and furniture.
    pub world: World,
}

impl Building {
    /// Reads a plan: the layers `walls` and `windows`, or all layers if there are none of these names. Doors are open.
    ///
    /// # Errors
    /// The errors of [`read_plan`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let walls = PlanOptions { layers: WALLS.map(str::to_owned).to_vec(), ..PlanOptions::default() };
        let plan = read_plan(path, &walls).or_else(|_| read_plan(path, &PlanOptions::default()))?.map;
        let mut world = World::default();
        plan.segments().iter().for_each(|segment| world.wall(segment.a, segment.b));
        Ok(Self { plan, world })
    }

    /// Writes the plan of an office floor to `path`, where nodes can read it, too, and reads it: with doors if the name
    /// ends in `.dxf`, else a table of walls. A file with this plan is left as it is.
    ///
    /// # Errors
    /// If it cannot be written or read.
    pub fn office(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let path = path.as_ref();
        write_office(path).map_err(|error| {
            let message = format!(
                "the plan of the building cannot be written: {error}; run the program in a folder where it can"
            );
            ReadError { path: path.to_owned(), line: None, message }
        })?;
        Self::read(path)
    }

    /// Tries to place `count` pieces of furniture: boxes beside walls, and legs of tables and chairs elsewhere. Places
    /// outside of the building are skipped.
    pub fn furnish(&mut self, count: usize, random: &mut Random) {
        let Some((low, high)) = self.plan.bounds() else { return };
        for _ in 0..count {
            let place =
                Pose2::new(random.uniform(low.x, high.x), random.uniform(low.y, high.y), random.uniform(-PI, PI));
            let clearance = self.world.clearance(place.position());
            if !self.is_inside(place.position()) {
                continue;
            }
            if (0.3..0.8).contains(&clearance) {
                self.world.block(&place, random.uniform(0.3, 0.9), random.uniform(0.3, 0.6));
            } else if clearance > 1.3 {
                let (length, width) = (random.uniform(0.2, 0.8), random.uniform(0.2, 0.4));
                for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)] {
                    self.world.disc(place.to_outer(Point2::new(x * length, y * width)), 0.03);
                }
            }
        }
    }

    /// Returns `true` if there are walls in all of eight directions.
    fn is_inside(&self, point: Point2) -> bool {
        (0..8).all(|i| self.world.cast(point, Point2::polar(1.0, 0.1 + i as f32 * 0.25 * PI)).is_some())
    }

    /// Map of the places where a round robot can stand, as far as they are connected: the largest such region. All
    /// others are occupied. `None` if there is no such place, or if the plan is too large for a grid.
    pub fn free_map(&self, radius: f32) -> Option<Grid<Occupancy>> {
        let (low, high) = self.plan.bounds()?;
        let raster = Raster::around([low, high], 1.0, RESOLUTION);
        let mut map = Grid::new(raster, Occupancy::Free).ok()?;
        self.draw(&mut map);
        let (walls, mut distances) = (map.clone(), Grid::default());
        DistanceTransform::default().run(&walls, |cell| *cell == Occupancy::Occupied, &mut distances);
        for (place, distance) in map.cells_mut().iter_mut().zip(distances.cells()) {
            *place = if *distance < radius + 0.5 * RESOLUTION { Occupancy::Occupied } else { Occupancy::Free };
        }
        let regions = regions(&map);
        // What touches the border of the map is outside of the building.
        let outside = regions.get(Cell::new(0, 0)).copied().unwrap_or(0);
        let mut sizes = vec![0_usize; regions.cells().iter().max().map_or(0, |most| *most as usize + 1)];
        regions.cells().iter().filter(|&&r| r != 0 && r != outside).for_each(|&r| sizes[r as usize] += 1);
        let largest = (1..sizes.len()).max_by_key(|&region| sizes[region])? as u32;
        for (place, region) in map.cells_mut().iter_mut().zip(regions.cells()) {
            *place = if *region == largest { Occupancy::Free } else { Occupancy::Occupied };
        }
        Some(map)
    }

    /// Marks the cells of all walls and discs.
    fn draw(&self, map: &mut Grid<Occupancy>) {
        let raster = *map.raster();
        let mut mark = |a: Point2, b: Point2| {
            if let (Some(a), Some(b)) = (raster.cell(a), raster.cell(b)) {
                Raster::line(a, b).for_each(|cell| {
                    if let Some(place) = map.get_mut(cell) {
                        *place = Occupancy::Occupied;
                    }
                });
            }
        };
        self.world.walls().iter().for_each(|wall| mark(wall.a, wall.b));
        self.world.discs().iter().for_each(|disc| mark(disc.centre, disc.centre));
    }
}

/// Number of the connected region of each free cell, from 1 on; 0 for others.
fn regions(map: &Grid<Occupancy>) -> Grid<u32> {
    let mut regions = Grid::<u32>::default();
    regions.reset_like(map, 0);
    let mut count = 0;
    let mut open = vec![];
    for (start, _) in map.iter() {
        let is_new =
            |regions: &Grid<u32>, cell: Cell| regions.get(cell) == Some(&0) && map.get(cell) == Some(&Occupancy::Free);
        if !is_new(&regions, start) {
            continue;
        }
        count += 1;
        open.push(start);
        while let Some(cell) = open.pop() {
            if !is_new(&regions, cell) {
                continue;
            }
            if let Some(region) = regions.get_mut(cell) {
                *region = count;
            }
            let Cell { x, y } = cell;
            open.extend(
                [(x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))].map(|(x, y)| Cell::new(x, y)),
            );
        }
    }
    regions
}

/// Writes the plan of the office floor, unless it is there. Several programs may do so at the same time.
fn write_office(path: &Path) -> io::Result<()> {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let plan = OfficePlan::new(OFFICE);
    let plan = if path.extension().is_some_and(|ending| ending == "dxf") { plan.dxf() } else { plan.table() };
    if fs::read(path).is_ok_and(|text| text == plan.as_bytes()) {
        return Ok(());
    }
    path.parent().map_or(Ok(()), fs::create_dir_all)?;
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let part = path.with_extension(format!("{}-{number}.part", process::id()));
    fs::write(&part, plan)?;
    fs::rename(&part, path)
}

/// Returns the path of the plan of the office floor, for tests.
#[cfg(test)]
pub(crate) fn office_file() -> &'static str {
    static FILE: std::sync::OnceLock<String> = std::sync::OnceLock::new();
    FILE.get_or_init(|| {
        let path = std::env::temp_dir().join(format!("apex-sim-{}.csv", process::id()));
        write_office(&path).expect("room for a file");
        path.to_str().expect("a name").to_owned()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drawing_and_the_table_have_the_same_walls() {
        let folder = std::env::temp_dir().join(format!("apex-walls-{}", process::id()));
        let read = |name| Building::office(folder.join(name)).expect("room for a file").plan;
        let (drawing, table) = (read("plan.dxf"), read("plan.csv"));
        assert!(drawing.segments().len() > 100);
        assert_eq!(drawing, table);
        fs::remove_dir_all(&folder).expect("it is ours");
    }

    #[test]
    fn the_plan_is_written_where_it_is_wanted() {
        let folder = std::env::temp_dir().join(format!("apex-office-{}", process::id()));
        let path = folder.join("deep/plan.dxf");
        let walls = Building::office(&path).expect("room for a file").plan.segments().len();
        fs::write(&path, "another").expect("room for a file");
        assert_eq!(Building::office(&path).expect("room for a file").plan.segments().len(), walls);
        assert_eq!(fs::read_dir(folder.join("deep")).expect("a folder").count(), 1, "nothing else is left there");
        let error = Building::office(path.join("plan.dxf")).expect_err("below a file").to_string();
        assert!(error.contains("the plan of the building cannot be written"), "{error}");
        fs::remove_dir_all(&folder).expect("it is ours");
    }

    #[test]
    fn a_furnished_building_has_free_places() {
        let mut building = Building::read(office_file()).expect("the plan");
        let walls = building.world.walls().len();
        assert_eq!(walls, building.plan.segments().len());
        building.furnish(300, &mut Random::new(1));
        assert!(building.world.walls().len() > walls + 100 && building.world.discs().len() > 50);
        let free = building.free_map(0.3).expect("a map");
        let area = free.cells().iter().filter(|c| **c == Occupancy::Free).count() as f32 * RESOLUTION * RESOLUTION;
        assert!((600.0..1400.0).contains(&area), "{area} m²");
        assert_eq!(free.at(Point2::new(-0.9, -0.9)), Some(&Occupancy::Occupied), "the street is no place");
    }

    #[test]
    fn a_missing_plan_is_an_error() {
        assert!(Building::read("/nowhere/plan.dxf").is_err() && Building::read("plan.pdf").is_err());
    }
}

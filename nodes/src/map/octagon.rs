use super::{Grid, Occupancy};
use crate::{
    math::Random,
    scan::{BeamDirections, Point2, Pose2, Scan, wrap_angle},
};
use apex_rt::{Out, node};
use core::f32::consts::FRAC_PI_4;

/// Half of a side divided by the apothem: the tangent of 22.5°.
const HALF_SIDE: f32 = 0.414_213_57;

/// Maximum number of computed distances between cells and octagons in a search, which takes about a second.
const MOST_DISTANCES: usize = 20_000_000;

/// Regular octagon in the plane: the island in the middle of an arena (thesis 4.3.4).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Octagon {
    /// Centre, in m.
    pub centre: Point2,
    /// Distance of each side from the centre, in m.
    pub apothem: f32,
    /// Direction of side 0 from the centre, in rad; the other sides follow counter-clockwise.
    pub theta: f32,
}

impl Octagon {
    /// Creates the octagon with a side from `a` to `b` that is on the same side of this line as `inside`.
    pub fn over_side(a: Point2, b: Point2, inside: Point2) -> Self {
        let (middle, side) = ((a + b).scaled(0.5), b - a);
        let apothem = 0.5 * side.norm() / HALF_SIDE;
        let normal = side.perpendicular().scaled(1.0 / side.norm());
        let inwards = if normal.dot(inside - middle) < 0.0 { normal.scaled(-1.0) } else { normal };
        Self { centre: middle + inwards.scaled(apothem), apothem, theta: inwards.scaled(-1.0).angle() }
    }

    /// Length of a side, in m.
    pub fn side(&self) -> f32 {
        2.0 * HALF_SIDE * self.apothem
    }

    /// Pose at the middle of a side, with x pointing outwards.
    pub fn side_pose(&self, side: usize) -> Pose2 {
        let theta = self.theta + FRAC_PI_4 * (side % 8) as f32;
        let middle = self.centre + Point2::polar(self.apothem, theta);
        Pose2::new(middle.x, middle.y, wrap_angle(theta))
    }

    /// Distance of a point from the nearest side, in m.
    pub fn distance(&self, point: Point2) -> f32 {
        let d = point - self.centre;
        // Angle from the normal of the side in the direction of the point.
        let from_middle = libm::remainderf(d.angle() - self.theta, FRAC_PI_4);
        (d.norm() * libm::cosf(from_middle) - self.apothem).abs()
    }
}

/// Finds the octagon in the middle of a map by RANSAC (thesis 4.3.4): two occupied cells are taken as the ends of a
/// side, which is extended to an octagon towards the centroid of the map. The octagon with the most cells on its sides
/// wins.
///
/// ⊥ if no octagon has enough cells on enough sides. The result is in the frame of the map.
#[node]
#[derive(Debug, Clone)]
pub struct OctagonSearch {
    /// Maximum distance of the middle's occupied cells from the centroid of all. Cells farther away belong to the
    /// border.
    #[param(unit = "m", default = 3.0, range = 0.1..=1000.0)]
    radius: f32,
    /// Minimum length of a side.
    #[param(unit = "m", default = 0.5, range = 0.01..=1000.0)]
    min_side: f32,
    /// Maximum length of a side.
    #[param(unit = "m", default = 2.0, range = 0.01..=1000.0)]
    max_side: f32,
    /// Maximum distance of a cell from the side that it lies on.
    #[param(unit = "m", default = 0.08, range = 0.001..=10.0)]
    tolerance: f32,
    /// Minimum share of the cells in the middle that lie on the octagon.
    #[param(default = 0.6, range = 0.0..=1.0)]
    min_share: f32,
    /// Minimum number of sides with cells on them. From one viewpoint, three or four are visible.
    #[param(default = 6, range = 1..=8)]
    min_sides: usize,
    /// Number of tested pairs of cells. It is reduced if the middle has so many cells that the search would take more
    /// than a second.
    #[param(default = 20_000, range = 1..=10_000_000)]
    tries: u32,
    /// Seed of the random pairs.
    #[param(default = 1)]
    seed: u64,
    cells: Vec<Point2>,
}

#[node]
impl OctagonSearch {
    /// Searches the octagon. The same map gives the same octagon, independent of previous maps.
    fn process(&mut self, map: &Grid<Occupancy>) -> Option<Octagon> {
        let centroid = self.middle_cells(map)?;
        let mut random = Random::new(self.seed);
        let mut best: Option<(f32, Octagon)> = None;
        let mut left = MOST_DISTANCES;
        for _ in 0..self.tries {
            let mut pick = || self.cells[(random.bits() % self.cells.len() as u64) as usize];
            let (a, b) = (pick(), pick());
            if (self.min_side..=self.max_side).contains(&(b - a).norm()) {
                let Some(rest) = left.checked_sub(self.cells.len()) else { break };
                left = rest;
                let octagon = Octagon::over_side(a, b, centroid);
                let score = self.score(&octagon);
                if best.is_none_or(|(least, _)| score > least) {
                    best = Some((score, octagon));
                }
            }
        }
        best.map(|(_, octagon)| octagon).filter(|octagon| self.holds(octagon))
    }

    /// Collects the cells in the middle and returns the centroid of all occupied cells.
    fn middle_cells(&mut self, map: &Grid<Occupancy>) -> Option<Point2> {
        let occupied = || {
            let cells = map.iter().filter(|(_, state)| **state == Occupancy::Occupied);
            cells.map(|(cell, _)| map.raster().centre(cell))
        };
        let (sum, count) = occupied().fold((Point2::default(), 0), |(sum, count), p| (sum + p, count + 1));
        let centroid = sum.scaled(1.0 / count as f32);
        self.cells.clear();
        self.cells.extend(occupied().filter(|p| (*p - centroid).norm() <= self.radius));
        (!self.cells.is_empty()).then_some(centroid)
    }

    /// Score: cells on the octagon count, nearer ones more (MSAC; Torr and Zisserman 2000).
    fn score(&self, octagon: &Octagon) -> f32 {
        let each = |p: &Point2| 1.0 - (octagon.distance(*p) / self.tolerance).powi(2);
        self.cells.iter().map(|p| each(p).max(0.0)).sum()
    }

    /// Returns `true` if enough cells are on the octagon, and on enough of its sides: a straight wall does not suffice.
    fn holds(&self, octagon: &Octagon) -> bool {
        let on = |p: &&Point2| octagon.distance(**p) <= self.tolerance;
        let mut sides = [false; 8];
        let mut count = 0;
        for p in self.cells.iter().filter(on) {
            let turn = ((*p - octagon.centre).angle() - octagon.theta) / FRAC_PI_4;
            sides[(turn.round() as i32).rem_euclid(8) as usize] = true;
            count += 1;
        }
        count as f32 >= self.min_share * self.cells.len() as f32
            && sides.iter().filter(|s| **s).count() >= self.min_sides
    }
}

/// Filling station at a side of the octagon.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Station {
    /// Middle of the side, with x pointing to the place of a robot.
    pub pose: Pose2,
    /// `true` if nothing is in front of the station.
    pub free: bool,
}

/// Filling stations of an octagon and their availability (thesis 4.3.4). They are on the side that faces the start and
/// on every second side from there, counter-clockwise. A station is free if the scan has fewer than `min_points` points
/// in a box in front of it.
///
/// A station out of view counts as free. The poses are in the frame of the octagon.
#[node]
#[derive(Debug, Clone)]
pub struct Stations {
    /// Distance of the far end of the box from the wall.
    #[param(unit = "m", default = 1.0, range = 0.0..=100.0)]
    depth: f32,
    /// Distance of the near end of the box from the wall. Nearer points belong to the wall.
    #[param(unit = "m", default = 0.15, range = 0.0..=100.0)]
    margin: f32,
    /// Width of the box, as a fraction of the side.
    #[param(default = 0.9, range = 0.0..=2.0)]
    share: f32,
    /// Number of points in the box from which on the station is occupied.
    #[param(default = 3, range = 1..=1000)]
    min_points: usize,
    directions: BeamDirections,
}

#[node]
impl Stations {
    /// Finds the stations. `start` is the start pose of the robot and `scanner` the pose of the scanner, both in the
    /// frame of the octagon.
    fn process(
        &mut self,
        octagon: &Octagon,
        start: &Pose2,
        scanner: &Pose2,
        scan: &Scan,
        stations: &mut Out<heapless::Vec<Station, 4>>,
    ) {
        let turn = ((start.position() - octagon.centre).angle() - octagon.theta) / FRAC_PI_4;
        let first = (libm::roundf(turn) as i32).rem_euclid(8) as usize;
        let stations = stations.get_mut();
        stations.clear();
        stations.extend((0..4).map(|i| {
            let pose = octagon.side_pose(first + 2 * i);
            Station { pose, free: self.is_free(&pose, octagon.side(), scanner, scan) }
        }));
    }

    fn is_free(&mut self, station: &Pose2, side: f32, scanner: &Pose2, scan: &Scan) -> bool {
        let Self { depth, margin, share, min_points, .. } = *self;
        let inside = |p: &Point2| (margin..=depth).contains(&p.x) && p.y.abs() <= 0.5 * share * side;
        let (station, scanner) = (station.transform(), scanner.transform());
        let points = self.directions.points(scan).map(|(_, p)| station.to_inner(scanner.to_outer(p)));
        points.filter(inside).take(min_points).count() < min_points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::Construct;
    use core::f32::consts::{PI, TAU};

    const TRUTH: Octagon = Octagon { centre: Point2::new(0.4, -0.3), apothem: 1.2, theta: 0.3 };

    /// An arena with a round border and an island, and some wrong cells.
    fn arena(island: &Octagon, wrong: usize) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(-7.0, -7.0), resolution: 0.05, width: 280, height: 280 };
        let mut map = Grid::new(raster, Occupancy::Free).expect("a map");
        let mut mark = |p: Point2| {
            if let Some(cell) = raster.cell(p).and_then(|cell| map.get_mut(cell)) {
                *cell = Occupancy::Occupied;
            }
        };
        (0..2000).for_each(|i| mark(Point2::polar(6.0, i as f32 * TAU / 2000.0)));
        for side in 0..8 {
            let along = |i: i32| Point2::new(0.0, island.side() * (i as f32 / 100.0 - 0.5));
            (0..=100).for_each(|i| mark(island.side_pose(side).to_outer(along(i))));
        }
        let mut random = Random::new(3);
        (0..wrong).for_each(|_| mark(Point2::new(random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5))));
        map
    }

    fn search() -> OctagonSearch {
        OctagonSearch::construct((3.0, 0.5, 2.0, 0.08, 0.6, 6, 20_000, 1))
    }

    #[test]
    fn the_island_is_found_among_wrong_cells() {
        for wrong in [0, 40] {
            let found = search().process(&arena(&TRUTH, wrong)).expect("an octagon");
            let turn = libm::remainderf(found.theta - TRUTH.theta, FRAC_PI_4).abs();
            assert!((found.centre - TRUTH.centre).norm() < 0.06, "{found:?}");
            assert!((found.apothem - TRUTH.apothem).abs() < 0.05 && turn < 0.05, "{found:?}");
        }
    }

    #[test]
    fn maps_without_an_island_are_bottom() {
        assert_eq!(search().process(&Grid::default()), None);
        let small = Octagon { apothem: 0.1, ..TRUTH };
        assert_eq!(search().process(&arena(&small, 0)), None);
        let far = Octagon { centre: Point2::new(50.0, 0.0), ..TRUTH };
        assert_eq!(search().process(&arena(&far, 0)), None);
        assert_eq!(search().process(&arena(&far, 300)), None);
    }

    #[test]
    fn an_octagon_has_eight_sides() {
        let corner = |side: usize, y: f32| TRUTH.side_pose(side).to_outer(Point2::new(0.0, y * TRUTH.side()));
        for side in 0..8 {
            assert!((corner(side, 0.5) - corner(side + 1, -0.5)).norm() < 1e-5, "{side}");
            assert!(TRUTH.distance(corner(side, 0.2)) < 1e-5);
            let again = Octagon::over_side(corner(side, -0.5), corner(side, 0.5), TRUTH.centre);
            assert!((again.centre - TRUTH.centre).norm() < 1e-5 && (again.apothem - 1.2).abs() < 1e-5);
        }
        assert!((TRUTH.distance(TRUTH.centre) - 1.2).abs() < 1e-5);
    }

    #[test]
    fn a_robot_before_a_station_takes_it() {
        let start = Pose2::new(5.0, 1.5, PI);
        let mut scan = Scan { angle_min: -0.2, angle_increment: 0.05, ..Scan::default() };
        // From the start towards the island, half a metre before it.
        scan.ranges.extend([(start.position() - TRUTH.centre).norm() - 1.7; 9]);
        let scanner = Pose2::new(5.0, 1.5, (TRUTH.centre - start.position()).angle());
        let mut out = Out::new();
        let mut node = Stations::construct((1.0, 0.15, 0.9, 3));
        node.process(&TRUTH, &start, &scanner, &scan, &mut out);
        let stations = out.get().expect("stations");
        assert_eq!(stations.iter().map(|s| s.free).collect::<Vec<_>>(), [false, true, true, true]);
        let facing = (start.position() - stations[0].pose.position()).angle() - stations[0].pose.theta;
        assert!(libm::remainderf(facing, TAU).abs() < PI / 8.0);
        node.process(&TRUTH, &start, &scanner, &Scan::default(), &mut out);
        assert!(out.get().is_some_and(|all| all.iter().all(|s| s.free)));
    }
}

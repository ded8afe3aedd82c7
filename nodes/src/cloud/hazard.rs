use super::{Columns, Label, Labels, rolling::Rolling};
use crate::{
    map::{Grid, Occupancy},
    persons::Persons,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::{Out, node};
use core::f32::consts::PI;

/// Nearest hazard in the observed area before the robot.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hazard {
    /// Kind of the hazard.
    pub kind: HazardKind,
    /// Position in the frame of the robot, in m.
    pub position: Point2,
}

/// Kind of a [`Hazard`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum HazardKind {
    /// An obstacle was seen there.
    Obstacle,
    /// No floor was seen there: a negative obstacle, such as stairs that go down, or a place that was never in view.
    NoFloor,
}

/// Rectangle before the robot that has to be free of hazards, symmetric about its x axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Distance of the near side, in m.
    pub near: f32,
    /// Distance of the far side, in m.
    pub far: f32,
    /// Width, in m.
    pub width: f32,
}

/// Remembers obstacles and floor around the robot, and reports the nearest hazard in the area before it (thesis
/// 6.5.3).
///
/// Two rolling windows of cells: m_f holds where floor was seen, m_o the share of obstacles among the points of a cell,
/// averaged over the clouds, so that single false detections do not count. Near the robot, where a small thing is a
/// small share of the many points of a cell, obstacles are forgotten slowly. Floor between two consecutive points of a
/// column that are floor is seen too. Where the floor ends in a column before a point far below it, or near the robot
/// before nothing, in two clouds, m_f holds that floor is missing. Obstacles at points of `scan`, which is in the frame
/// of the robot, do not count: the scanner sees them itself, and they may be persons, who do not stay. Neither do those
/// at `persons`. There is floor beneath them, unless it is known to be missing. `pose` is that of the robot in a fixed
/// frame, which is also that of the persons and of `trailer`, the axis of a trailer: wheel odometry is enough.
///
/// `map` is the window in this frame: occupied where m_o is at least `threshold` or floor is missing, free where floor
/// was seen, unknown elsewhere. An obstacle whose top is up to `low` high on average is a low one. `hazard` is ⊥ if the
/// area is free. All outputs are ⊥ if the inputs differ in size, or if the pose is not a number or more than 100 km
/// away.
#[node]
#[derive(Debug, Clone)]
pub struct HazardMap {
    /// Side of the window.
    #[param(unit = "m", default = 6.0, range = 0.1..=100.0)]
    size: f32,
    /// Side of a cell.
    #[param(unit = "m", default = 0.05, range = 0.01..=10.0)]
    resolution: f32,
    /// Minimum share of obstacles, averaged, of a cell with an obstacle: P_t.
    #[param(default = 0.92, range = 0.0..=1.0)]
    threshold: f32,
    /// Weight of a cloud in the average of a cell.
    #[param(default = 0.2, range = 0.001..=1.0)]
    weight: f32,
    /// Distance from the origin of the robot up to which obstacles are forgotten slowly.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    kept: f32,
    /// Distance from the origin of the robot up to which the camera always sees the floor, so that it is missing where
    /// nothing is measured.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    sure: f32,
    /// Maximum height of obstacles: the robot and its load pass under higher ones.
    #[param(unit = "m", default = 2.0, range = 0.0..=100.0)]
    max_height: f32,
    /// Height up to which an obstacle is low.
    #[param(unit = "m", default = 0.0, range = 0.0..=2.0)]
    low: f32,
    /// Maximum distance between consecutive points with floor between them.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    max_gap: f32,
    /// Distance of the near side of the observed area.
    #[param(unit = "m", default = 0.4, range = 0.0..=100.0)]
    near: f32,
    /// Distance of the far side of the observed area.
    #[param(unit = "m", default = 1.2, range = 0.0..=100.0)]
    far: f32,
    /// Width of the observed area.
    #[param(unit = "m", default = 0.6, range = 0.0..=100.0)]
    width: f32,
    /// Angle of the camera's view across, about the x axis of the robot. In the observed area, floor can only be
    /// missing within it.
    #[param(unit = "rad", default = PI, range = 0.0..=3.2)]
    view_angle: f32,
    /// Distance from the robot up to which `forget` forgets obstacles.
    #[param(unit = "m", default = 1.8, range = 0.0..=100.0)]
    forgotten: f32,
    /// Radius of the discs about the robot and its trailer in which there is floor, as they stand on it; twice as large
    /// in the first cloud.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    stands: f32,
    /// Position of the robot at the last cloud.
    here: Option<Point2>,
    /// Number of the cloud, from 0 again after 255.
    cloud: u8,
    floor: Rolling<Ground>,
    obstacles: Rolling<f32>,
    /// Averaged heights of the tops of obstacles, in m.
    tops: Rolling<f32>,
    /// Points of this cloud, by cell.
    sums: Vec<Sum>,
    /// Cells with a sum.
    touched: Vec<usize>,
}

/// Points of a cloud in a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    obstacles: f32,
    points: f32,
    /// Height of the top of the obstacle, in m.
    top: f32,
    is_near: bool,
}

/// Knowledge of the floor in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Ground {
    #[default]
    Unknown,
    Floor,
    /// Missing in the cloud of this number alone, which may be wrong.
    Doubtful(u8),
    /// Missing in two clouds since it was floor.
    Missing,
}

/// Distance in the direction of view, and across, up to which an obstacle is at a point of a scan, in m.
const SCANNED: [f32; 2] = [0.3, 0.2];
/// Distance from the position of a person up to which the person is seen, with both legs in a step, in m.
const PERSON: f32 = 0.45;
/// Length of the strip beyond the end of the floor in which it is missing, in m.
const BRINK: f32 = 0.3;
/// Greatest height of a top in the average, in m: a single wrong point does not count for long.
const TALL: f32 = 0.2;
/// Factor of the weight of a cloud without the obstacle, for obstacles near the robot.
const SLOWER: f32 = 0.05;
/// Number of rows without a measurement beyond the end of the floor from which on it is missing.
const ROWS: u8 = 4;

#[node]
impl HazardMap {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        points: &Columns,
        labels: &Labels,
        pose: &Pose2,
        scan: Option<&Scan>,
        persons: Option<&Persons>,
        trailer: Option<&Pose2>,
        map: &mut Out<Grid<Occupancy>>,
        hazard: &mut Out<Hazard>,
    ) {
        if !pose.is_usable() || !points.fits(labels) {
            return;
        }
        self.cloud = self.cloud.wrapping_add(1);
        self.floor.follow(pose.position(), self.size, self.resolution);
        self.obstacles.follow(pose.position(), self.size, self.resolution);
        self.tops.follow(pose.position(), self.size, self.resolution);
        // Where the robot is switched on, it never saw the floor before its feet.
        let is_first = self.here.replace(pose.position()).is_none();
        let radius = if is_first { 2.0 * self.stands } else { self.stands };
        [Some(pose), trailer].into_iter().flatten().for_each(|axle| self.stand(axle.position(), radius));
        self.see_floor(points, labels, pose);
        self.see_obstacles(points, labels, pose, |place, outer| {
            scan.is_some_and(|scan| is_scanned(scan, place)) || persons.is_some_and(|persons| is_person(persons, outer))
        });
        self.draw(map.get_mut());
        let area = Area { near: self.near, far: self.far, width: self.width };
        if let Some(nearest) = self.nearest(&area, pose) {
            hazard.set(nearest);
        }
    }

    /// Forgets the obstacles around the robot, but not the floor: for example those of a container that the robot has
    /// driven beneath. Floor that an obstacle hid has to be seen again.
    #[slot]
    fn forget(&mut self) {
        let Some(here) = self.here else { return };
        for place in disc(here, self.forgotten, self.resolution) {
            if let Some(index) = self.obstacles.index(place) {
                *self.obstacles.get_mut(index) = 0.0;
            }
        }
    }

    /// Marks the floor around an axle that stands on it, and that the robot sees no longer.
    fn stand(&mut self, axle: Point2, radius: f32) {
        for place in disc(axle, radius, self.resolution) {
            let Some(cell) = self.floor.index(place).map(|index| self.floor.get_mut(index)) else { continue };
            if *cell != Ground::Missing {
                *cell = Ground::Floor;
            }
        }
    }

    /// Marks the cells of floor points in m_f, those between consecutive ones, and those where the floor ends.
    fn see_floor(&mut self, points: &Columns, labels: &Labels, pose: &Pose2) {
        let pose = pose.transform();
        for first in (0..points.len()).step_by(points.height.max(1)) {
            // From the far end to the near one.
            let (mut last, mut below): (Option<Point2>, Option<Point2>) = (None, None);
            let mut missing = 0;
            for i in first..first + points.height {
                let label = labels.labels[i];
                if !label.is_valid() {
                    missing = (missing + u8::from(label == Label::Missing)).min(ROWS);
                    continue;
                }
                let place = Point2::new(points.x[i], points.y[i]);
                let point = pose.to_outer(place);
                let ends = core::mem::take(&mut missing) >= ROWS && place.norm() < self.sure;
                match label {
                    Label::Floor => {
                        if ends {
                            let beyond = pose.to_outer(place.scaled(1.0 + BRINK / place.norm()));
                            self.mark(point, beyond, Ground::Doubtful(self.cloud));
                        }
                        if let Some(below) = below.take() {
                            let way = below - point;
                            let share = (BRINK / way.norm().max(f32::MIN_POSITIVE)).min(1.0);
                            self.mark(point, point + way.scaled(share), Ground::Doubtful(self.cloud));
                        }
                        if let Some(last) = last.filter(|last| (*last - point).norm() <= self.max_gap) {
                            self.mark(point, last, Ground::Unknown);
                        }
                        self.mark(point, point, Ground::Floor);
                        last = Some(point);
                    }
                    // A missing point says nothing; every other one separates.
                    Label::Below => (last, below) = (None, Some(point)),
                    _ => (last, below) = (None, None),
                }
            }
        }
    }

    /// Marks the cells on a line in m_f; with `Unknown` as floor between points that is taken for granted, unless more
    /// is known.
    fn mark(&mut self, from: Point2, to: Point2, ground: Ground) {
        let way = to - from;
        let count = (way.norm() / (0.5 * self.resolution)) as usize;
        for k in 0..=count {
            let at = from + way.scaled(k as f32 / count.max(1) as f32);
            let Some(index) = self.floor.index(at) else { continue };
            let cell = self.floor.get_mut(index);
            *cell = match (ground, *cell) {
                (Ground::Unknown, Ground::Unknown) => Ground::Floor,
                (Ground::Unknown, known) => known,
                (Ground::Doubtful(_), Ground::Missing) => Ground::Missing,
                (Ground::Doubtful(now), Ground::Doubtful(before)) if now != before => Ground::Missing,
                (ground, _) => ground,
            };
        }
    }

    /// Adds the share of obstacles among the points of each cell to the average m_o. `passes` tells of a place, in the
    /// frame of the robot and in the fixed one, if an obstacle there does not count.
    fn see_obstacles(
        &mut self,
        points: &Columns,
        labels: &Labels,
        pose: &Pose2,
        passes: impl Fn(Point2, Point2) -> bool,
    ) {
        let raster = self.obstacles.raster();
        self.sums.resize(raster.width * raster.height, Sum::default());
        let pose = pose.transform();
        for (i, label) in labels.labels.iter().enumerate() {
            let counts = matches!(label, Label::Floor | Label::Obstacle | Label::Overhanging);
            if !counts || points.z[i] > self.max_height {
                continue;
            }
            let place = Point2::new(points.x[i], points.y[i]);
            let outer = pose.to_outer(place);
            if label.is_hazard() && passes(place, outer) {
                // What the scanner sees there, or who, stands on floor.
                self.mark(outer, outer, Ground::Unknown);
                continue;
            }
            let Some(index) = self.obstacles.index(outer) else { continue };
            let sum = &mut self.sums[index];
            if sum.points == 0.0 {
                self.touched.push(index);
            }
            if label.is_hazard() {
                sum.obstacles += 1.0;
                sum.top = sum.top.max(if *label == Label::Overhanging { TALL } else { points.z[i].min(TALL) });
            }
            sum.points += 1.0;
            sum.is_near |= place.norm_squared() < self.kept * self.kept;
        }
        for index in self.touched.drain(..) {
            let Sum { obstacles, points, top, is_near } = core::mem::take(&mut self.sums[index]);
            let value = self.obstacles.get_mut(index);
            if obstacles > 0.0 {
                let share = if *value < self.threshold { 1.0 } else { self.weight };
                let known = self.tops.get_mut(index);
                *known += share * (top - *known);
            }
            let change = obstacles / points - *value;
            let is_kept = is_near && *value >= self.threshold && change < 0.0;
            *value += if is_kept { SLOWER * self.weight } else { self.weight } * change;
        }
    }

    fn draw(&self, map: &mut Grid<Occupancy>) {
        // The window has a size that fits a grid.
        if map.reset(self.floor.raster(), Occupancy::Unknown).is_err() {
            return;
        }
        let values = self.obstacles.values().zip(self.tops.values()).zip(self.floor.values());
        for (cell, ((probability, top), ground)) in map.cells_mut().iter_mut().zip(values) {
            *cell = match ground {
                Ground::Missing => Occupancy::Occupied,
                _ if probability >= self.threshold && top < self.low => Occupancy::Low,
                _ if probability >= self.threshold => Occupancy::Occupied,
                Ground::Floor => Occupancy::Free,
                Ground::Unknown | Ground::Doubtful(_) => Occupancy::Unknown,
            };
        }
    }

    /// Nearest hazard of the area, by its distance along x.
    fn nearest(&self, area: &Area, pose: &Pose2) -> Option<Hazard> {
        let pose = pose.transform();
        let (rows, columns) = (steps(area.far - area.near, self.resolution), steps(area.width, self.resolution));
        for row in 0..=rows {
            for column in 0..=columns {
                let x = area.near + (area.far - area.near) * row as f32 / rows.max(1) as f32;
                let y = area.width * (column as f32 / columns.max(1) as f32 - 0.5);
                let position = Point2::new(x, y);
                let Some(index) = self.floor.index(pose.to_outer(position)) else { continue };
                if self.obstacles.get(index) >= self.threshold {
                    return Some(Hazard { kind: HazardKind::Obstacle, position });
                }
                if self.floor.get(index) != Ground::Floor && self.is_in_view(position) {
                    return Some(Hazard { kind: HazardKind::NoFloor, position });
                }
            }
        }
        None
    }

    /// Returns `true` if a position in the frame of the robot is one that its camera sees.
    fn is_in_view(&self, position: Point2) -> bool {
        position.angle().abs() <= 0.5 * self.view_angle
    }
}

/// Returns `true` if beams of a scan end at a place.
fn is_scanned(scan: &Scan, place: Point2) -> bool {
    let distance = place.norm();
    let middle = (place.angle() - scan.angle_min) / scan.angle_increment;
    let aside = (SCANNED[1] / distance.max(SCANNED[1]) / scan.angle_increment).abs();
    // Casts saturate, and NaN becomes 0.
    let beams = (middle - aside).max(0.0) as usize..=(middle + aside).max(0.0) as usize;
    let mut ranges = beams.map_while(|beam| scan.ranges.get(beam));
    ranges.any(|range| (range - distance).abs() <= SCANNED[0])
}

/// Places in a disc, about a cell apart.
fn disc(centre: Point2, radius: f32, resolution: f32) -> impl Iterator<Item = Point2> {
    let count = (radius / resolution) as i32;
    let offsets = (-count..=count).flat_map(move |i| (-count..=count).map(move |k| (i, k)));
    let places = offsets.map(move |(i, k)| Point2::new(i as f32, k as f32).scaled(resolution));
    places.filter(move |off| off.norm() <= radius).map(move |off| centre + off)
}

/// Returns `true` if a person is at a place.
fn is_person(persons: &Persons, place: Point2) -> bool {
    persons.iter().any(|person| (person.position - place).norm_squared() <= PERSON * PERSON)
}

/// Number of steps that are not longer than a cell.
fn steps(length: f32, resolution: f32) -> usize {
    (length / resolution).ceil().max(0.0) as usize
}

#[cfg(test)]
mod tests;

use super::{Path, open::Open};
use crate::{
    map::{Cell, DistanceTransform, Grid, Occupancy},
    persons::{Person, Persons},
    scan::{BeamDirections, Point2, Pose2, Scan, wrap_angle},
};
use apex_rt::{Event, node};
use core::f32::consts::TAU;
use libm::{floorf, hypotf, sqrtf};
use std::collections::BinaryHeap;

/// Length of a step, in m, and number of its parts that are checked.
const STEP: f32 = 0.6;
const PARTS: u8 = 3;
/// Curvatures of the steps, in parts of the sharpest one.
const STEERING: [f32; 7] = [0.0, 0.25, -0.25, 0.5, -0.5, 1.0, -1.0];
/// Side of a state, in m, and number of its headings.
const SIDE: f32 = 0.4;
const HEADINGS: usize = 32;
/// Additional cost per metre of the sharpest curve, and of a change from straight to it, in m.
const BENDING: [f32; 2] = [0.1, 0.15];
/// Cost per metre backward, and of a change of the direction, in m.
const BACKWARD: [f32; 2] = [2.0, 1.5];
/// Weight of the estimate: a path may be longer than the shortest one, and is found sooner.
const GREED: f32 = 1.3;
/// Maximum number of expanded states.
const MOST: usize = 20_000;
/// Distance from the start up to which a vehicle may be as near to obstacles as it is there, in m, and by how much
/// nearer, in m: it drives past what stands beside it.
const LEAVES: f32 = 0.8;
const PAST: f32 = 0.05;
/// Additional cost per metre, for each metre of distance from the trail between these two, in m.
const STRAY: f32 = 0.5;
const ASTRAY: [f32; 2] = [0.3, 2.3];
/// Distance of the place on the border of the map at which it is reached, in m.
const BEYOND: f32 = 1.5;
/// Distance from the place of the followed person up to which the scanner sees that person, in m.
const PERSON: f32 = 0.6;
/// Radius of a person with room to walk, in m, and time for which persons are predicted, in s.
const BODY: f32 = 0.45;
const PREDICTED: f32 = 2.0;
/// Node before the first one.
const NONE: u32 = u32::MAX;

/// Plans a path to a person with arcs that a vehicle can drive, on a map of its surroundings (thesis 8.4.3; hybrid A*,
/// Dolgov et al. 2010).
///
/// A path ends where the person is `gap` away. It consists of arcs with radii of at least `radius`, forward; with
/// `backward` the vehicle may also back up, and change its direction. The rectangle of the vehicle, as two discs, keeps
/// the `margin` from occupied cells, and better `room` more. Cells that are not known are free, as far away a scanner
/// sees the ground only here and there. Other `persons` are avoided where they will be when the vehicle, at the speed
/// `pace`, is there.
///
/// With a `trail`, where the person went, a path near to it costs less: where a person went, nothing stands, and the
/// ground carries.
///
/// `map`, `pose` and `trail` are in the frame of the person; the last ones count when a goal comes. What is occupied
/// where the vehicle stands is taken to be wrong, unless the last `scan`, which is in the frame of the vehicle, sees it
/// there: from what really stands that close the vehicle can only get away. A person outside of the map is approached
/// up to its border, along the trail if there is one. `path` is a path forward, `back` one backward, which are to be
/// followed by different inputs of a follower: of a path that changes its direction only the first piece is sent.
/// `no_path` says that there is none to this person, or that no map or pose has come yet.
#[node]
#[derive(Debug, Clone)]
pub struct ArcPlanner {
    /// Length of the vehicle.
    #[param(unit = "m", default = 0.72, range = 0.01..=20.0)]
    length: f32,
    /// Width of the vehicle.
    #[param(unit = "m", default = 0.61, range = 0.01..=20.0)]
    width: f32,
    /// Distance of the vehicle from occupied cells.
    #[param(unit = "m", default = 0.12, range = 0.0..=10.0)]
    margin: f32,
    /// Additional distance that costs less.
    #[param(unit = "m", default = 0.6, range = 0.0..=10.0)]
    room: f32,
    /// Smallest radius of an arc.
    #[param(unit = "m", default = 1.2, range = 0.05..=100.0)]
    radius: f32,
    /// Distance from the person at which a path ends.
    #[param(unit = "m", default = 2.0, range = 0.0..=100.0)]
    gap: f32,
    /// Time for which the motion of the person is predicted: the path ends where the person will be `gap` away.
    #[param(unit = "s", default = 0.0, range = 0.0..=10.0)]
    lead: f32,
    /// `true` if the vehicle may also drive backward.
    #[param(default = false)]
    backward: bool,
    /// Speed with which the places of other persons are predicted.
    #[param(unit = "m/s", default = 2.0, range = 0.1..=20.0)]
    pace: f32,
    map: Option<Grid<Occupancy>>,
    pose: Option<Pose2>,
    persons: Persons,
    trail: Path,
    /// Points of the last scan near the vehicle, in the frame of the map.
    seen: Vec<Point2>,
    directions: BeamDirections,
    search: Search,
}

/// Buffers of a search.
#[derive(Debug, Clone, Default)]
struct Search {
    transform: DistanceTransform,
    distances: Grid<f32>,
    nodes: Vec<Node>,
    open: BinaryHeap<Open>,
    /// Least cost of each state.
    best: Vec<f32>,
    columns: usize,
    /// Points of the trail on the map.
    trail: Vec<Point2>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    pose: Pose2,
    cost: f32,
    /// Length of the path to it, in m.
    driven: f32,
    curvature: f32,
    is_back: bool,
    before: u32,
}

#[node]
impl ArcPlanner {
    fn process(
        &mut self,
        map: Option<&Grid<Occupancy>>,
        pose: Option<&Pose2>,
        persons: Option<&Persons>,
        trail: Option<&Path>,
        scan: Option<&Scan>,
    ) {
        if let Some(map) = map {
            match &mut self.map {
                Some(last) => last.clone_from(map),
                none => *none = Some(map.clone()),
            }
        }
        self.pose = pose.filter(|pose| pose.is_usable()).copied().or(self.pose);
        if let Some(persons) = persons {
            self.persons.clone_from(persons);
        }
        if let Some(trail) = trail {
            self.trail.clone_from(trail);
        }
        if let (Some(scan), Some(pose)) = (scan, self.pose) {
            let reach = self.length + 2.0 * self.radius_of_discs();
            let near = self.directions.points(scan).filter(|(_, point)| point.norm() <= reach);
            self.seen.clear();
            self.seen.extend(near.map(|(_, point)| pose.to_outer(point)));
        }
    }

    /// Plans a path to a person.
    #[slot]
    fn goal(&mut self, person: &Person, path: Event<Path>, back: Event<Path>, #[failure] no_path: Event<Person>) {
        let Some((planned, is_back)) = self.plan(person) else {
            no_path.emit(*person);
            return;
        };
        if is_back { back.emit(planned) } else { path.emit(planned) }
    }

    fn plan(&mut self, person: &Person) -> Option<(Path, bool)> {
        let (mut map, start) = (self.map.take()?, self.pose?);
        let mut search = core::mem::take(&mut self.search);
        self.free_discs(&mut map, &start, person);
        search.transform.run(&map, |cell| cell.is_obstacle(), &mut search.distances);
        self.map = Some(map);
        let (goal, reach) = self.target(&search.distances, &start, person);
        let end = (goal.x + goal.y + reach).is_finite().then(|| search.run(self, &start, goal, reach, person.id))?;
        let planned = end.map(|end| search.trace(end));
        self.search = search;
        planned
    }

    /// Frees the cells in the discs that cover the vehicle, which stands there: obstacles in them are false, unless
    /// they are seen. It could not leave them otherwise.
    fn free_discs(&self, map: &mut Grid<Occupancy>, start: &Pose2, followed: &Person) {
        let raster = *map.raster();
        let radius = self.radius_of_discs() + raster.resolution;
        let discs = self.discs(start);
        discs.into_iter().for_each(|middle| free(map, middle, radius));
        let is_there = |point: &&Point2| {
            let is_freed = discs.into_iter().any(|middle| (**point - middle).norm() <= radius + raster.resolution);
            is_freed && (**point - followed.position).norm() > PERSON
        };
        for point in self.seen.iter().filter(is_there) {
            if let Some(cell) = raster.cell(*point).and_then(|cell| map.get_mut(cell)) {
                *cell = Occupancy::Occupied;
            }
        }
    }

    /// Middles of the two discs that cover the vehicle.
    fn discs(&self, pose: &Pose2) -> [Point2; 2] {
        [0.25, -0.25].map(|part| pose.to_outer(Point2::new(part * self.length, 0.0)))
    }

    fn radius_of_discs(&self) -> f32 {
        hypotf(0.5 * self.width, 0.25 * self.length)
    }

    /// Place to get near to, and distance from it at which it is reached. It is on the map.
    fn target(&self, distances: &Grid<f32>, start: &Pose2, person: &Person) -> (Point2, f32) {
        let raster = distances.raster();
        let half = 0.5 * raster.resolution * raster.width.min(raster.height) as f32;
        let middle = raster.corner + Point2::new(half, half);
        let place = person.position + person.velocity.scaled(self.lead);
        let most = half - 1.0;
        if (place - middle).norm() <= most {
            return (place, self.gap);
        }
        let is_near = |point: &Point2| (*point - middle).norm() <= most;
        if let Some(on_trail) = self.trail_ahead(start).take_while(is_near).last() {
            return (on_trail, BEYOND);
        }
        let way = place - start.position();
        let reach = (most - (start.position() - middle).norm()).max(1.0);
        (start.position() + way.scaled(reach / way.norm().max(1e-3)), BEYOND)
    }

    /// Trail from the point on that is the nearest to a pose.
    fn trail_ahead(&self, start: &Pose2) -> impl Iterator<Item = Point2> + '_ {
        let off = |i: &usize| (self.trail.points[*i] - start.position()).norm_squared();
        let nearest = (0..self.trail.points.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
        self.trail.points[nearest.unwrap_or(0)..].iter().copied()
    }
}

impl Search {
    /// Searches for a path, and returns its last node.
    fn run(&mut self, vehicle: &ArcPlanner, start: &Pose2, goal: Point2, reach: f32, followed: u32) -> Option<u32> {
        self.begin(start);
        self.trail.clear();
        self.trail.extend(vehicle.trail_ahead(start));
        let near = self.clearance(vehicle, start);
        let mut expanded = 0;
        while let Some(Open { node: at, .. }) = self.open.pop() {
            let node = self.nodes[at as usize];
            if (node.pose.position() - goal).norm() <= reach {
                return Some(at);
            }
            let Some(state) = self.state(&node.pose).filter(|state| node.cost < self.best[*state]) else { continue };
            self.best[state] = node.cost;
            expanded += 1;
            if expanded > MOST {
                return None;
            }
            for steering in STEERING {
                self.step(vehicle, at, steering / vehicle.radius, false, (goal, reach), near, followed);
                if vehicle.backward {
                    self.step(vehicle, at, steering / vehicle.radius, true, (goal, reach), near, followed);
                }
            }
        }
        None
    }

    fn begin(&mut self, start: &Pose2) {
        let raster = self.distances.raster();
        let side = |count: usize| (count as f32 * raster.resolution / SIDE) as usize + 1;
        self.columns = side(raster.width);
        let count = self.columns * side(raster.height) * HEADINGS;
        self.best.clear();
        self.best.resize(count, f32::INFINITY);
        self.nodes.clear();
        self.open.clear();
        self.nodes.push(Node { pose: *start, cost: 0.0, driven: 0.0, curvature: 0.0, is_back: false, before: NONE });
        self.open.push(Open { estimate: 0.0, node: 0 });
    }

    #[allow(clippy::too_many_arguments, reason = "they are the search")]
    fn step(
        &mut self,
        vehicle: &ArcPlanner,
        before: u32,
        curvature: f32,
        is_back: bool,
        (goal, reach): (Point2, f32),
        near: f32,
        followed: u32,
    ) {
        let node = self.nodes[before as usize];
        let length = if is_back { -STEP } else { STEP };
        let driven = node.driven + STEP;
        let mut narrow = 0.0;
        let mut pose = node.pose;
        for part in 1..=PARTS {
            pose = advanced(&node.pose, curvature, length * f32::from(part) / f32::from(PARTS));
            let clearance = self.clearance(vehicle, &pose);
            let least = if driven <= LEAVES { vehicle.margin.min(near - PAST) } else { vehicle.margin };
            // False for NaN: outside of the map.
            let is_free = clearance >= least;
            if !is_free {
                return;
            }
            narrow += (1.0 - (clearance - vehicle.margin) / vehicle.room.max(1e-3)).clamp(0.0, 1.0) / f32::from(PARTS);
        }
        if vehicle.meets_person(&pose, driven, followed) {
            return;
        }
        let bend = [curvature.abs(), (curvature - node.curvature).abs()].map(|c| c * vehicle.radius);
        let way = STEP * (1.0 + 2.0 * narrow + self.stray(pose.position())) * if is_back { BACKWARD[0] } else { 1.0 };
        let turns = node.before != NONE && node.is_back != is_back;
        let change = if turns { BACKWARD[1] } else { 0.0 };
        let cost = node.cost + way + BENDING[0] * STEP * bend[0] + BENDING[1] * bend[1] + change;
        if self.state(&pose).is_none_or(|state| cost >= self.best[state]) {
            return;
        }
        let rest = ((pose.position() - goal).norm() - reach).max(0.0);
        self.open.push(Open { estimate: cost + GREED * rest, node: self.nodes.len() as u32 });
        self.nodes.push(Node { pose, cost, driven, curvature, is_back, before });
    }

    /// Additional cost per metre at a place beside the trail.
    fn stray(&self, place: Point2) -> f32 {
        let off = |point: &Point2| (*point - place).norm_squared();
        let Some(nearest) = self.trail.iter().map(off).min_by(f32::total_cmp) else { return 0.0 };
        STRAY * (sqrtf(nearest).min(ASTRAY[1]) - ASTRAY[0]).max(0.0)
    }

    /// Distance of the vehicle from the nearest occupied cell, in m; NaN outside of the map.
    fn clearance(&self, vehicle: &ArcPlanner, pose: &Pose2) -> f32 {
        let radius = vehicle.radius_of_discs() + 0.5 * self.distances.raster().resolution;
        let [front, rear] = vehicle.discs(pose).map(|place| {
            self.distances.raster().cell(place).and_then(|cell| self.distances.get(cell)).copied().unwrap_or(f32::NAN)
        });
        let least = if front < rear || front.is_nan() { front } else { rear };
        least - radius
    }

    /// Index of a state, if it is on the map.
    fn state(&self, pose: &Pose2) -> Option<usize> {
        let off = (pose.position() - self.distances.raster().corner).scaled(1.0 / SIDE);
        let heading = (floorf(pose.theta / TAU * HEADINGS as f32 + 0.5) as i32).rem_euclid(HEADINGS as i32) as usize;
        let (x, y) = (off.x, off.y);
        // False for NaN.
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.columns as f32;
        let index = is_inside.then(|| ((y as usize) * self.columns + x as usize) * HEADINGS + heading)?;
        (index < self.best.len()).then_some(index)
    }

    /// First piece of the path to a node, in one direction, and `true` if that is backward.
    fn trace(&self, end: u32) -> (Path, bool) {
        let (mut at, mut nodes) = (end, vec![]);
        while at != NONE {
            nodes.push(self.nodes[at as usize]);
            at = self.nodes[at as usize].before;
        }
        nodes.reverse();
        let start = nodes[0];
        let is_back = nodes.get(1).is_some_and(|node| node.is_back);
        let mut points = vec![start.pose.position()];
        let mut last = start.pose;
        for node in nodes[1..].iter().take_while(|node| node.is_back == is_back) {
            let length = if is_back { -STEP } else { STEP };
            points.extend(
                (1..=PARTS).map(|part| {
                    advanced(&last, node.curvature, length * f32::from(part) / f32::from(PARTS)).position()
                }),
            );
            last = node.pose;
        }
        (Path { points, heading: last.theta }, is_back)
    }
}

impl ArcPlanner {
    /// Returns `true` if another person than the followed one will be in the way.
    fn meets_person(&self, pose: &Pose2, driven: f32, followed: u32) -> bool {
        let time = driven / self.pace;
        let reach = BODY + 0.5 * self.width;
        time <= PREDICTED
            && self.persons.iter().filter(|person| person.id != followed).any(|person| {
                let place = person.position + person.velocity.scaled(time);
                (place - pose.position()).norm_squared() < reach * reach
            })
    }
}

/// Frees the cells whose centres are in a disc.
fn free(map: &mut Grid<Occupancy>, middle: Point2, radius: f32) {
    let raster = *map.raster();
    let Some(at) = raster.cell(middle) else { return };
    let count = (radius / raster.resolution) as usize + 1;
    let around = |at: usize| at.saturating_sub(count)..=at + count;
    for cell in around(at.y).flat_map(|y| around(at.x).map(move |x| Cell::new(x, y))) {
        if (raster.centre(cell) - middle).norm() <= radius
            && let Some(cell) = map.get_mut(cell)
        {
            *cell = Occupancy::Unknown;
        }
    }
}

/// Pose after an arc of a curvature in 1/m and a length in m, which is negative backward.
fn advanced(pose: &Pose2, curvature: f32, length: f32) -> Pose2 {
    let turn = curvature * length;
    // Chord of the arc: the error of its length is below 1 %.
    let chord = length * (1.0 - turn * turn / 24.0);
    let position = pose.position() + Point2::polar(chord, pose.theta + 0.5 * turn);
    Pose2::new(position.x, position.y, wrap_angle(pose.theta + turn))
}

/// Length of the way between two points, in m.
#[cfg(test)]
fn way(a: Point2, b: Point2) -> f32 {
    (a - b).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::{Construct, event};
    use core::f32::consts::PI;

    fn map(walls: &[(f32, f32, f32, f32)]) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(-12.0, -12.0), resolution: 0.15, width: 160, height: 160 };
        let mut map = Grid::new(raster, Occupancy::Unknown).expect("small");
        for cell in (0..160).flat_map(|y| (0..160).map(move |x| Cell::new(x, y))) {
            let p = raster.centre(cell);
            if walls.iter().any(|(x0, x1, y0, y1)| p.x >= *x0 && p.x <= *x1 && p.y >= *y0 && p.y <= *y1) {
                *map.get_mut(cell).expect("inside") = Occupancy::Occupied;
            }
        }
        map
    }

    fn plan(walls: &[(f32, f32, f32, f32)], backward: bool, person: Point2, others: &[Person]) -> Option<(Path, bool)> {
        plan_with(walls, backward, person, others, None, None)
    }

    fn plan_with(
        walls: &[(f32, f32, f32, f32)],
        backward: bool,
        person: Point2,
        others: &[Person],
        trail: Option<&Path>,
        scan: Option<&Scan>,
    ) -> Option<(Path, bool)> {
        let mut node = ArcPlanner::construct((0.72, 0.61, 0.1, 0.5, 1.2, 2.0, 0.0, backward, 2.0));
        let persons: Persons = others.iter().copied().collect();
        node.process(Some(&map(walls)), Some(&Pose2::default()), Some(&persons), trail, scan);
        let (mut path, mut back, mut none) = (None, None, None);
        let goal = Person { id: 7, position: person, ..Person::default() };
        node.goal(&goal, event(&mut path), event(&mut back), event(&mut none));
        assert_eq!(path.is_none() && back.is_none(), none.is_some());
        path.map(|path| (path, false)).or(back.map(|path| (path, true)))
    }

    /// Sharpest curvature of a path, in 1/m.
    fn sharpest(path: &Path) -> f32 {
        let turns = (1..path.points.len() - 1).map(|i| {
            let piece = 0.5 * (way(path.points[i - 1], path.points[i]) + way(path.points[i], path.points[i + 1]));
            path.turn(i).abs() / piece
        });
        turns.fold(0.0, f32::max)
    }

    #[test]
    fn a_free_way_is_straight_and_ends_before_the_person() {
        let (path, is_back) = plan(&[], false, Point2::new(8.0, 0.0), &[]).expect("a path");
        let goal = path.goal().expect("an end");
        assert!(!is_back && (goal.x - 6.0).abs() < 0.65 && goal.y.abs() < 1e-4, "{goal:?}");
    }

    #[test]
    fn obstacles_are_passed_in_curves_of_the_radius() {
        let wall = (3.0, 3.3, -1.5, 6.0);
        let (path, _) = plan(&[wall], false, Point2::new(8.0, 0.0), &[]).expect("a path");
        let gap = path.points.iter().map(|p| {
            let (dx, dy) = ((wall.0 - p.x).max(p.x - wall.1).max(0.0), (wall.2 - p.y).max(p.y - wall.3).max(0.0));
            hypotf(dx, dy)
        });
        let least = gap.fold(f32::INFINITY, f32::min);
        assert!(least > 0.3 && least < 1.5, "{least} m");
        assert!(sharpest(&path) < 1.05 / 1.2, "{} / m", sharpest(&path));
        assert!(plan(&[(3.0, 3.3, -12.0, 12.0)], false, Point2::new(8.0, 0.0), &[]).is_none());
    }

    #[test]
    fn only_a_vehicle_that_may_back_up_gets_out_of_a_dead_end() {
        let walls = [(0.8, 1.0, -1.2, 1.2), (-1.0, 1.0, 0.7, 0.9), (-1.0, 1.0, -0.9, -0.7)];
        let person = Point2::new(6.0, 0.0);
        assert!(plan(&walls, false, person, &[]).is_none());
        let (path, is_back) = plan(&walls, true, person, &[]).expect("a path");
        assert!(is_back && path.goal().expect("an end").x < -0.5, "{:?}", path.goal());
    }

    #[test]
    fn a_vehicle_leaves_what_it_seems_to_stand_in() {
        let person = Point2::new(8.0, 0.0);
        for wall in [(-0.1, 0.1, -0.3, 0.3), (0.3, 0.5, -0.2, 0.5), (-0.4, 0.4, 0.25, 0.4)] {
            assert!(plan(&[wall], true, person, &[]).is_some(), "{wall:?}");
        }
        // What is ahead of it remains.
        assert!(plan(&[(0.9, 1.1, -12.0, 12.0)], false, person, &[]).is_none());
    }

    #[test]
    fn a_vehicle_backs_away_from_what_it_sees_close_by() {
        let person = Point2::new(8.0, 0.0);
        // A pole 0.55 m ahead of the middle, which the map takes for a part of the vehicle's place.
        let mut scan = Scan { angle_min: -PI, angle_increment: PI / 180.0, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend((0..360_i32).map(|i| if (i - 180).abs() <= 12 { 0.55 } else { f32::INFINITY }));
        let ask = |backward, person| plan_with(&[], backward, person, &[], None, Some(&scan));
        assert!(ask(false, person).is_none());
        let (path, is_back) = ask(true, person).expect("a path");
        assert!(is_back && path.goal().expect("an end").x < -0.2, "{path:?}");
        // Not if it is the person.
        let gap = Point2::new(0.7, 0.0);
        assert!(ask(false, gap).is_some());
    }

    #[test]
    fn a_vehicle_drives_past_who_stands_beside_it() {
        let mut scan = Scan { angle_min: -PI, angle_increment: PI / 180.0, range_max: 20.0, ..Scan::default() };
        // Someone with a radius of 0.22 m, whose middle is 0.67 m to the right of that of the vehicle.
        let beside = |degrees: i32| {
            let (sin, cos) = libm::sincosf((degrees - 180) as f32 * PI / 180.0);
            let rest = 0.22 * 0.22 - 0.67 * 0.67 * cos * cos;
            if sin < 0.0 && rest > 0.0 { -0.67 * sin - sqrtf(rest) } else { f32::INFINITY }
        };
        scan.ranges.extend((0..360).map(beside));
        for backward in [false, true] {
            assert!(plan_with(&[], backward, Point2::new(8.0, 0.0), &[], None, Some(&scan)).is_some(), "{backward}");
        }
    }

    #[test]
    fn it_goes_where_the_person_went() {
        // Round a corner to the left: the straight way is free, too.
        let corner = [Point2::new(0.0, 0.0), Point2::new(7.0, 0.0), Point2::new(7.0, 7.0)];
        let legs =
            corner.windows(2).flat_map(|leg| (0..15).map(|i| leg[0] + (leg[1] - leg[0]).scaled(i as f32 / 15.0)));
        let trail = Path { points: legs.collect(), heading: 0.0 };
        let off = |path: &Path| {
            let off = |p: &Point2| trail.points.iter().map(|t| way(*t, *p)).fold(f32::INFINITY, f32::min);
            path.points.iter().map(off).fold(0.0, f32::max)
        };
        let straight = plan(&[], false, corner[2], &[]).expect("a path").0;
        let along = plan_with(&[], false, corner[2], &[], Some(&trail), None).expect("a path").0;
        assert!(off(&straight) > 2.2 && off(&along) < 1.6, "{} m, {} m", off(&straight), off(&along));
        // Beyond the map it leads towards the end of the trail on it.
        let far = Point2::new(-20.0, 30.0);
        let along = plan_with(&[], false, far, &[], Some(&trail), None).expect("a path").0;
        assert!(way(along.goal().expect("an end"), corner[2]) < 2.0, "{:?}", along.goal());
    }

    #[test]
    fn others_are_avoided_where_they_will_be() {
        let walks = |x: f32, vy: f32| Person {
            id: 1,
            position: Point2::new(x, -vy),
            velocity: Point2::new(0.0, vy),
            ..Person::default()
        };
        let aside = |others: &[Person]| {
            let (path, _) = plan(&[], false, Point2::new(8.0, 0.0), others).expect("a path");
            path.points.iter().map(|p| p.y.abs()).fold(0.0, f32::max)
        };
        // In the way after 1 s, where the vehicle is at 2 m.
        assert!(aside(&[walks(2.0, 1.2)]) > 0.3);
        assert!(aside(&[walks(7.9, 0.2)]) < 0.01, "beyond the end");
        let behind = Person { position: Point2::new(-3.0, PI), ..walks(0.0, 0.0) };
        assert!(aside(&[behind]) < 0.01);
    }

    #[test]
    fn a_person_beyond_the_map_is_approached_and_without_a_map_there_is_no_path() {
        let (path, _) = plan(&[], false, Point2::new(30.0, 5.0), &[]).expect("a path");
        let goal = path.goal().expect("an end");
        assert!(goal.x > 7.0 && goal.norm() < 12.0, "{goal:?}");
        assert!(plan(&[], false, Point2::new(f32::NAN, 0.0), &[]).is_none());
        let mut node = ArcPlanner::construct((0.72, 0.61, 0.1, 0.5, 1.2, 2.0, 0.0, false, 2.0));
        let mut none = None;
        node.goal(&Person::default(), Event::unconnected(), Event::unconnected(), event(&mut none));
        assert!(none.is_some());
    }
}

use super::{
    NoPath, Path, Terrain,
    payload::{
        dubins::{Curve, advanced, curves},
        trailer_rotation,
    },
};
use crate::{
    map::{Cell, Grid, Occupancy, Raster},
    scan::{Point2, Pose2},
};
use apex_rt::{Event, Out, node};
use core::{cmp::Ordering, f32::consts::TAU};
use libm::remainderf;
use std::collections::BinaryHeap;

/// Number of headings of the states.
const HEADINGS: usize = 32;
/// Side of a state, in m.
const SIDE: f32 = 0.2;
/// Length of a step, in m.
const STEP: f32 = 0.3;
/// Distance between places that are checked on a step, in m.
const CHECK: f32 = 0.1;
/// Curvatures of the steps, in parts of the sharpest one.
const STEERING: [f32; 5] = [0.0, 0.5, -0.5, 1.0, -1.0];
/// Additional cost per metre of the sharpest curve, and of a change from straight to that curve, in m.
const BENDING: [f32; 2] = [0.15, 0.1];
/// Estimated distance from the goal at which it is tried to get there by one curve, in m, and number of expansions
/// between such tries.
const NEAR: f32 = 4.0;
const TRIES: usize = 8;
/// Maximum angle between the vehicle and its trailer, in rad.
const MAX_BEND: f32 = 1.2;
/// Distance from the places of the trailer at the start within which the map does not count, in m: it stands there.
const STANDS: f32 = 0.2;
/// Maximum number of expanded states.
const MOST: usize = 60_000;
/// Length of a way to nowhere.
const NONE: u32 = u32::MAX;

/// Vehicle that drives forward in curves: its shape on the map in which obstacles are grown by half of its width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveDrive {
    /// Smallest radius of a curve, in m.
    pub radius: f32,
    /// Distance from the axis to the front, in m.
    pub front: f32,
    /// Distance from the axis back to the hitch of a trailer, in m.
    pub hitch: f32,
    /// Distance from the hitch back to the axis of the trailer, in m.
    pub drawbar: f32,
    /// Places on the trailer, with its load, that must not touch anything: distances from its axis forward, in m.
    /// Without places there is no trailer.
    pub body: &'static [f32],
}

impl CurveDrive {
    /// Places on the trailer that must not touch anything, at a pose and with this heading of the trailer.
    fn places(&self, pose: &Pose2, trailer: f32) -> impl Iterator<Item = Point2> {
        let (hitch, drawbar) = (pose.to_outer(Point2::new(-self.hitch, 0.0)), self.drawbar);
        self.body.iter().map(move |place| hitch + Point2::polar(place - drawbar, trailer))
    }
}

/// Planner for vehicles that only drive forward in curves of a smallest radius: A* on states of position and heading,
/// with arcs as steps (hybrid A*; Dolgov et al. 2010), and Dubins curves at the end. A passively steered trailer is
/// predicted on the way. The heuristic is the length of the shortest way on the map without regard to the heading.
/// Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct CurveSearch {
    /// Estimated distance of each coarse cell from the goal, in m, with costs.
    estimates: Grid<f32>,
    nodes: Vec<Node>,
    open: BinaryHeap<Open>,
    /// Places of the trailer at the start.
    stands: Vec<Point2>,
    /// Least cost with which a state was expanded.
    best: Vec<f32>,
}

/// State on a way.
#[derive(Debug, Clone, Copy)]
struct Node {
    pose: Pose2,
    /// Heading of the trailer, in rad.
    trailer: f32,
    cost: f32,
    /// Curvature of the way to it, in 1/m.
    curvature: f32,
    before: u32,
    /// Number of the goal to which a Dubins curve leads from here.
    ends: Option<u8>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Open {
    estimate: f32,
    node: u32,
}

impl Eq for Open {}

/// The greatest entry is expanded next: the one with the least estimate, then the latest.
impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.estimate.total_cmp(&self.estimate).then_with(|| self.node.cmp(&other.node))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl CurveSearch {
    /// Writes a path from `start` to the goal that is reached at the least cost, which ends with the heading of that
    /// goal, into `path`, with points about 0.1 m apart. `trailer` is the heading of the trailer at the start, in rad.
    ///
    /// # Errors
    /// There is no such path. `path` is then empty.
    pub fn plan(
        &mut self,
        terrain: &Terrain<'_>,
        vehicle: &CurveDrive,
        start: &Pose2,
        goals: &[Pose2],
        trailer: f32,
        path: &mut Path,
    ) -> Result<(), NoPath> {
        path.points.clear();
        check(terrain, start, goals)?;
        self.estimate(terrain, goals);
        self.begin(vehicle, start, trailer);
        let mut expanded = 0;
        while let Some(Open { node: at, .. }) = self.open.pop() {
            let node = self.nodes[at as usize];
            if let Some(goal) = node.ends.and_then(|number| goals.get(usize::from(number))) {
                self.trace(at, vehicle, goal, path);
                return Ok(());
            }
            let Some(state) = self.state(&node.pose) else { continue };
            if self.best[state] <= node.cost {
                continue;
            }
            self.best[state] = node.cost;
            expanded += 1;
            if expanded > MOST {
                break;
            }
            let rest = self.rest(node.pose.position());
            if rest < NEAR || expanded % TRIES == 1 {
                (0..).zip(goals).for_each(|goal| self.try_to_end(terrain, vehicle, at, goal));
            }
            for steering in STEERING {
                self.step(terrain, vehicle, at, steering / vehicle.radius);
            }
        }
        Err(NoPath::Unreachable)
    }

    fn begin(&mut self, vehicle: &CurveDrive, start: &Pose2, trailer: f32) {
        self.stands.clear();
        self.stands.extend(vehicle.places(start, trailer));
        self.nodes.clear();
        self.open.clear();
        self.best.clear();
        self.best.resize(self.estimates.cells().len() * HEADINGS, f32::INFINITY);
        self.nodes.push(Node { pose: *start, trailer, cost: 0.0, curvature: 0.0, before: NONE, ends: None });
        self.open.push(Open { estimate: 0.0, node: 0 });
    }

    /// Index of the state of a pose.
    fn state(&self, pose: &Pose2) -> Option<usize> {
        let cell = self.estimates.raster().cell(pose.position())?;
        let turn = libm::floorf(pose.theta / TAU * HEADINGS as f32 + 0.5);
        let heading = (turn as i32).rem_euclid(HEADINGS as i32) as usize;
        Some((cell.y * self.estimates.raster().width + cell.x) * HEADINGS + heading)
    }

    /// Estimated distance of a point from the goal, in m: infinite if there is no way.
    fn rest(&self, point: Point2) -> f32 {
        self.estimates.at(point).copied().unwrap_or(f32::INFINITY)
    }

    fn step(&mut self, terrain: &Terrain<'_>, vehicle: &CurveDrive, before: u32, curvature: f32) {
        let node = self.nodes[before as usize];
        let drive = Drive { terrain, vehicle, stands: &self.stands };
        let Some((length, trailer)) = drive.arc(&node.pose, node.trailer, curvature, STEP) else { return };
        let bend = [curvature.abs(), (curvature - node.curvature).abs()].map(|c| c * vehicle.radius);
        let cost = node.cost + length + BENDING[0] * STEP * bend[0] + BENDING[1] * bend[1];
        let pose = advanced(&node.pose, curvature, STEP);
        let (Some(state), rest) = (self.state(&pose), self.rest(pose.position())) else { return };
        if rest.is_finite() && cost < self.best[state] {
            self.open.push(Open { estimate: cost + rest, node: self.nodes.len() as u32 });
            self.nodes.push(Node { pose, trailer, cost, curvature, before, ends: None });
        }
    }

    /// Adds the shortest free Dubins curve from a node to a goal.
    fn try_to_end(&mut self, terrain: &Terrain<'_>, vehicle: &CurveDrive, before: u32, (number, goal): (u8, &Pose2)) {
        let node = self.nodes[before as usize];
        let drive = Drive { terrain, vehicle, stands: &self.stands };
        let mut best: Option<f32> = None;
        for curve in curves(&node.pose, goal, vehicle.radius, 0.0) {
            let length = curve.length();
            if best.is_none_or(|best| length < best) {
                best = drive.curve(&curve, node.trailer).or(best);
            }
        }
        if let Some(length) = best {
            let cost = node.cost + length;
            self.open.push(Open { estimate: cost, node: self.nodes.len() as u32 });
            self.nodes.push(Node { cost, before, ends: Some(number), ..node });
        }
    }

    /// Distances of all coarse cells from the nearest goal (Dijkstra 1959). A coarse cell is open if a part of it is.
    fn estimate(&mut self, terrain: &Terrain<'_>, goals: &[Pose2]) {
        let fine = terrain.map.raster();
        let part = libm::roundf(SIDE / fine.resolution).max(1.0) as usize;
        let raster = Raster {
            corner: fine.corner,
            resolution: fine.resolution * part as f32,
            width: fine.width.div_ceil(part),
            height: fine.height.div_ceil(part),
        };
        // Coarser than a grid that exists.
        if self.estimates.reset(raster, f32::INFINITY).is_err() {
            return;
        }
        let mut open = BinaryHeap::new();
        for cell in goals.iter().filter_map(|goal| raster.cell(goal.position())) {
            self.reach(cell, 0.0, &mut open);
        }
        while let Some(Open { estimate, node }) = open.pop() {
            let at = Cell::new(node as usize % raster.width, node as usize / raster.width);
            if self.estimates.get(at).is_none_or(|known| *known < estimate) {
                continue;
            }
            for (dx, dy) in [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)] {
                // A neighbour left of or below 0 wraps to the greatest number, which no raster contains.
                let next = Cell::new(at.x.wrapping_add_signed(dx), at.y.wrapping_add_signed(dy));
                if let Some(cost) = openness(terrain, &raster, next, part) {
                    let length = raster.resolution * if dx != 0 && dy != 0 { core::f32::consts::SQRT_2 } else { 1.0 };
                    self.reach(next, estimate + length * (1.0 + cost), &mut open);
                }
            }
        }
    }

    fn reach(&mut self, cell: Cell, estimate: f32, open: &mut BinaryHeap<Open>) {
        let width = self.estimates.raster().width;
        if let Some(known) = self.estimates.get_mut(cell).filter(|known| estimate < **known) {
            *known = estimate;
            open.push(Open { estimate, node: (cell.y * width + cell.x) as u32 });
        }
    }

    fn trace(&self, end: u32, vehicle: &CurveDrive, goal: &Pose2, path: &mut Path) {
        path.heading = goal.theta;
        let (mut at, mut nodes) = (self.nodes[end as usize].before, vec![]);
        while at != NONE {
            nodes.push(self.nodes[at as usize]);
            at = self.nodes[at as usize].before;
        }
        for pair in nodes.windows(2).rev() {
            let [to, from] = pair else { continue };
            path.points.extend(places(STEP).map(|s| advanced(&from.pose, to.curvature, s).position()));
        }
        let Some(last) = nodes.first() else { return };
        let all = curves(&last.pose, goal, vehicle.radius, 0.0);
        let length = self.nodes[end as usize].cost - last.cost;
        // The curve that was found free is the one whose cost this is.
        let chosen = all.min_by(|a, b| (a.length() - length).abs().total_cmp(&(b.length() - length).abs()));
        if let Some(curve) = chosen {
            path.points.extend(places(curve.length()).map(|s| curve.at(s).0.position()));
        }
        path.points.push(goal.position());
    }
}

/// Distances from 0 to before `length`, about a step of a check apart.
fn places(length: f32) -> impl Iterator<Item = f32> {
    let count = libm::ceilf(length / CHECK).max(1.0);
    (0..count as u32).map(move |i| length * i as f32 / count)
}

fn check(terrain: &Terrain<'_>, start: &Pose2, goals: &[Pose2]) -> Result<(), NoPath> {
    let raster = terrain.map.raster();
    if terrain.costs.is_some_and(|costs| costs.raster() != raster) {
        return Err(NoPath::OtherRaster);
    }
    let from = raster.cell(start.position()).ok_or(NoPath::StartOutside)?;
    if !(terrain.is_open(from) && start.theta.is_finite()) {
        return Err(NoPath::StartBlocked);
    }
    let mut inside = goals.iter().filter_map(|goal| Some((goal, raster.cell(goal.position())?))).peekable();
    inside.peek().ok_or(NoPath::GoalOutside)?;
    let is_open = inside.any(|(goal, cell)| terrain.is_open(cell) && goal.theta.is_finite());
    if is_open { Ok(()) } else { Err(NoPath::GoalBlocked) }
}

/// Least cost of the open fine cells of a coarse cell, or `None` if none is open.
fn openness(terrain: &Terrain<'_>, raster: &Raster, cell: Cell, part: usize) -> Option<f32> {
    if !raster.contains(cell) {
        return None;
    }
    let fine = (0..part * part).map(|i| Cell::new(cell.x * part + i % part, cell.y * part + i / part));
    fine.filter(|cell| terrain.is_open(*cell)).map(|cell| terrain.cost(cell)).reduce(f32::min)
}

/// Vehicle on a map.
struct Drive<'a> {
    terrain: &'a Terrain<'a>,
    vehicle: &'a CurveDrive,
    /// Places of the trailer at the start.
    stands: &'a [Point2],
}

impl Drive<'_> {
    /// Length of an arc with costs, and the heading of the trailer at its end, or `None` if something is touched on it.
    fn arc(&self, from: &Pose2, mut trailer: f32, curvature: f32, length: f32) -> Option<(f32, f32)> {
        let count = libm::ceilf(length / CHECK);
        let step = length / count;
        let (mut cost, mut pose) = (0.0, *from);
        for _ in 0..count as u32 {
            let bend = bend(&pose, trailer);
            trailer = self.towed(&pose, trailer, curvature, step);
            pose = advanced(&pose, curvature, step);
            // A trailer that is bent too far at the start may come into line.
            if self::bend(&pose, trailer) > MAX_BEND.max(bend) {
                return None;
            }
            cost += step * (1.0 + self.fits(&pose, trailer)?);
        }
        Some((cost, trailer))
    }

    /// Length of a curve without costs, or `None` if something is touched on it.
    fn curve(&self, curve: &Curve, trailer: f32) -> Option<f32> {
        let (mut pose, mut trailer) = (curve.start, trailer);
        for (curvature, length) in curve.parts {
            if length > 0.0 {
                trailer = self.arc(&pose, trailer, curvature, length)?.1;
                pose = advanced(&pose, curvature, length);
            }
        }
        Some(curve.length())
    }

    /// Heading of the trailer after a step; that of the vehicle if there is none.
    fn towed(&self, pose: &Pose2, trailer: f32, curvature: f32, step: f32) -> f32 {
        let CurveDrive { hitch, drawbar, body, .. } = *self.vehicle;
        if body.is_empty() {
            return pose.theta + step * curvature;
        }
        trailer + step * trailer_rotation(1.0, curvature, pose.theta - trailer, hitch, drawbar)
    }

    /// Cost at a pose, or `None` if something is touched there.
    fn fits(&self, pose: &Pose2, trailer: f32) -> Option<f32> {
        let Self { terrain, vehicle, stands } = self;
        let raster = terrain.map.raster();
        let is_free = |point: Point2| raster.cell(point).filter(|cell| terrain.is_open(*cell));
        is_free(pose.to_outer(Point2::new(vehicle.front, 0.0)))?;
        let is_start = |place: Point2| stands.iter().any(|at| (*at - place).norm_squared() <= STANDS * STANDS);
        if vehicle.places(pose, trailer).any(|place| is_free(place).is_none() && !is_start(place)) {
            return None;
        }
        is_free(pose.position()).map(|cell| terrain.cost(cell))
    }
}

/// Angle between a vehicle and its trailer, in rad.
fn bend(pose: &Pose2, trailer: f32) -> f32 {
    remainderf(pose.theta - trailer, TAU).abs()
}

/// Plans a path for a vehicle that only drives forward in curves, such as a tractor with a trailer (see
/// [`CurveSearch`]). The path ends with the heading of the goal.
///
/// `start`, `goal` and the path are in the frame of the map. `other` is another goal that is as good, such as the other
/// end of something that the vehicle drives beneath: the path leads to the one that is reached at the least cost. The
/// obstacles of the map must be grown by half of the width of the vehicle. `costs` are those of `CostMap`. `trailer` is
/// the pose of the trailer's axis in the frame of the vehicle. If it is ⊥, the trailer is assumed to be straight
/// behind. Without a path, the output is ⊥ and `no_path` gives the reason.
#[node]
#[derive(Debug, Clone)]
pub struct CurvePlanner {
    /// Smallest radius of a curve.
    #[param(unit = "m", default = 0.8, range = 0.1..=100.0)]
    radius: f32,
    /// Distance from the axis of the vehicle to its front.
    #[param(unit = "m", default = 0.25, range = 0.0..=10.0)]
    front: f32,
    /// Distance from the axis back to the hitch of a trailer.
    #[param(unit = "m", default = 0.1, range = 0.0..=10.0)]
    hitch: f32,
    /// Distance from the hitch back to the axis of the trailer.
    #[param(unit = "m", default = 0.55, range = 0.01..=10.0)]
    drawbar: f32,
    /// Places on the trailer, with its load, that must not touch anything, from its axis forward; empty without a
    /// trailer.
    #[param(unit = "m", default = &[])]
    body: &'static [f32],
    search: CurveSearch,
}

#[node]
impl CurvePlanner {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        start: &Pose2,
        goal: &Pose2,
        other: Option<&Pose2>,
        map: &Grid<Occupancy>,
        costs: Option<&Grid<f32>>,
        trailer: Option<&Pose2>,
        path: &mut Out<Path>,
        #[failure] no_path: Event<NoPath>,
    ) {
        let terrain = Terrain { map, costs, unknown_is_open: false };
        let Self { radius, front, hitch, drawbar, body, .. } = *self;
        let vehicle = CurveDrive { radius, front, hitch, drawbar, body };
        let heading = start.theta + trailer.filter(|pose| pose.is_finite()).map_or(0.0, |pose| pose.theta);
        let both = [*goal, *other.unwrap_or(goal)];
        let goals = &both[..1 + usize::from(other.is_some())];
        if let Err(why) = self.search.plan(&terrain, &vehicle, start, goals, heading, path.get_mut()) {
            path.clear();
            no_path.emit(why);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{FRAC_PI_2, PI};

    const VEHICLE: CurveDrive = CurveDrive { radius: 0.8, front: 0.25, hitch: 0.1, drawbar: 0.55, body: &[] };

    /// Room of 12 m × 8 m with a wall that ends at y = 5 m.
    fn room() -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 120, height: 80 };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        for y in 0..50 {
            *map.get_mut(Cell::new(60, y)).expect("inside") = Occupancy::Occupied;
        }
        map
    }

    fn plan(map: &Grid<Occupancy>, start: Pose2, goal: Pose2) -> Result<Path, NoPath> {
        plan_to_any(map, start, &[goal])
    }

    fn plan_to_any(map: &Grid<Occupancy>, start: Pose2, goals: &[Pose2]) -> Result<Path, NoPath> {
        let mut path = Path::default();
        let terrain = Terrain { map, costs: None, unknown_is_open: false };
        CurveSearch::default().plan(&terrain, &VEHICLE, &start, goals, start.theta, &mut path).map(|()| path)
    }

    #[test]
    fn paths_are_smooth_and_free_and_end_with_the_heading() {
        let map = room();
        let start = Pose2::new(2.0, 2.0, PI);
        for goal in [Pose2::new(10.0, 2.0, 0.0), Pose2::new(9.0, 6.0, PI), Pose2::new(3.0, 6.0, -FRAC_PI_2)] {
            let path = plan(&map, start, goal).expect("a way");
            assert_eq!((path.points[0], path.goal()), (start.position(), Some(goal.position())));
            assert!(path.points.iter().all(|p| map.at(*p) == Some(&Occupancy::Free)));
            let headings: Vec<f32> = path.points.windows(2).map(|w| (w[1] - w[0]).angle()).collect();
            let turns = headings.windows(2).map(|w| libm::remainderf(w[1] - w[0], TAU).abs());
            let sharpest = turns.fold(0.0, f32::max);
            assert!(sharpest < 0.25, "{sharpest} rad from one point to the next to {goal:?}");
            let off = |a: f32, b: f32| libm::remainderf(a - b, TAU).abs();
            assert!(off(headings[0], PI) < 0.1 && off(headings[headings.len() - 1], goal.theta) < 0.1);
        }
    }

    #[test]
    fn a_load_needs_more_room_in_a_curve() {
        // A passage of 2 m around a corner: the tractor gets through, a long load behind it does not.
        let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 80, height: 80 };
        let mut map = Grid::new(raster, Occupancy::Occupied).expect("small");
        for i in 0..80 {
            (40..60).for_each(|j| *map.get_mut(Cell::new(i, j)).expect("inside") = Occupancy::Free);
            (40..60).for_each(|j| *map.get_mut(Cell::new(j, i)).expect("inside") = Occupancy::Free);
        }
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let (start, goals) = (Pose2::new(2.5, 5.0, 0.0), [Pose2::new(5.0, 2.0, -FRAC_PI_2)]);
        let is_way = |body: &'static [f32]| {
            let (mut path, vehicle) = (Path::default(), CurveDrive { body, ..VEHICLE });
            CurveSearch::default().plan(&terrain, &vehicle, &start, &goals, 0.0, &mut path).is_ok()
        };
        assert_eq!([is_way(&[]), is_way(&[0.0]), is_way(&[-4.0, -3.0, -2.0, 0.0])], [true, true, false]);
    }

    #[test]
    fn a_load_that_stands_beside_an_obstacle_gets_away() {
        let mut map = room();
        // Something in the grown map where the trailer is.
        for y in 18..22 {
            *map.get_mut(Cell::new(13, y)).expect("inside") = Occupancy::Occupied;
        }
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let vehicle = CurveDrive { body: &[0.0], ..VEHICLE };
        let is_way = |start: Pose2| {
            let goals = [Pose2::new(5.0, 2.0, 0.0)];
            CurveSearch::default().plan(&terrain, &vehicle, &start, &goals, 0.0, &mut Path::default()).is_ok()
        };
        // No way leads through the obstacle.
        assert_eq!([2.0, 0.8].map(|x| is_way(Pose2::new(x, 2.0, 0.0))), [true, false]);
    }

    #[test]
    fn of_two_goals_the_nearer_one_that_is_free_is_reached() {
        let (map, start) = (room(), Pose2::new(2.0, 2.0, 0.0));
        let (near, far, blocked) = (Pose2::new(4.0, 2.0, 0.0), Pose2::new(3.0, 2.0, PI), Pose2::new(6.05, 2.0, 0.0));
        let end = |goals: &[Pose2]| plan_to_any(&map, start, goals).map(|path| (path.goal(), path.heading));
        let at = |goal: Pose2| Ok((Some(goal.position()), goal.theta));
        assert_eq!([end(&[near, far]), end(&[far, near])], [at(near), at(near)]);
        assert_eq!(end(&[blocked, far]), at(far));
        assert_eq!(end(&[blocked]), Err(NoPath::GoalBlocked));
    }

    #[test]
    fn what_cannot_be_reached_has_a_reason() {
        let mut map = room();
        let start = Pose2::new(2.0, 2.0, 0.0);
        assert_eq!(plan(&map, start, Pose2::new(20.0, 2.0, 0.0)), Err(NoPath::GoalOutside));
        assert_eq!(plan(&map, start, Pose2::new(6.05, 2.0, 0.0)), Err(NoPath::GoalBlocked));
        assert_eq!(plan(&map, Pose2::new(f32::NAN, 2.0, 0.0), start), Err(NoPath::StartOutside));
        assert_eq!(plan(&map, Pose2::new(2.0, 2.0, f32::NAN), start), Err(NoPath::StartBlocked));
        for y in 50..80 {
            *map.get_mut(Cell::new(60, y)).expect("inside") = Occupancy::Occupied;
        }
        assert_eq!(plan(&map, start, Pose2::new(9.0, 2.0, 0.0)), Err(NoPath::Unreachable));
        assert_eq!(plan(&Grid::default(), start, start), Err(NoPath::StartOutside));
    }
}

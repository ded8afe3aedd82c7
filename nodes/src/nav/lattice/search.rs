use super::{
    CurveDrive, Goal, Ground, Start, Way,
    drive::{Drive, Look, bend},
    ends::Place,
    estimate::Estimates,
    footing::Footing,
    node::{NONE, Node},
    room::{Room, SQUEEZED},
    states::States,
};
use crate::{
    nav::{
        NoPath, Terrain,
        open::Open,
        payload::dubins::{Curve, advanced, curves},
    },
    scan::{Point2, Pose2},
};
use std::collections::BinaryHeap;

/// Curvatures of the steps, in parts of the sharpest one.
const STEERING: [f32; 5] = [0.0, 0.5, -0.5, 1.0, -1.0];
/// Angles between the vehicle and its trailer that it backs up with, in rad.
const BENDS: [f32; 5] = [0.0, 0.35, -0.35, 0.7, -0.7];
/// Estimated distance from the goal at which it is tried to get there by one curve, in m, and number of expansions
/// between such tries.
const NEAR: f32 = 4.0;
const TRIES: usize = 8;
/// Number of lengths of the straight line at the end that are tried, the longest of them whole.
const LINES: u8 = 4;
/// Largest angle between the vehicle and its trailer at a goal with a straight line before it, in rad.
const IN_LINE: f32 = 0.02;
/// Maximum number of expanded states, and part of it after a search that reached it at about the same place: what
/// blocks the way may be gone, but then the way is mostly found soon.
const MOST: usize = 60_000;
const RETRY: usize = 4;
/// Distance up to which a start is at the same place, in m.
const SAME: f32 = 0.3;
/// Weight of the estimate in a second search, after one that was too long: it finds longer ways, sooner.
const GREEDY: f32 = 2.0;
/// Distance between places that are tried before a goal at which something stands, in m, and cost of such a place.
const SHORT_STEP: f32 = 0.1;
const SHORT_COST: f32 = 20.0;
/// Distance from the start from which on such a place is worth a way, in m.
const NEARER: f32 = 0.5;

/// Planner for vehicles that drive in curves of a smallest radius: A* on states of position and heading, with arcs as
/// steps (hybrid A*; Dolgov et al. 2010), and Dubins curves at the end. A passively steered trailer is predicted on the
/// way. Vehicles that may back up do so with a constant angle to the trailer in each step, as `BackFollower` does. The
/// heuristic is the length of the shortest way on the map without regard to the heading. The outline of the vehicle
/// with its load keeps a margin from obstacles; on the first 0.8 m it may be as near to them as it is at the start.
/// From hazards on the floor it keeps the clearance that `SweepStop` keeps, and 4 cm more. If a vehicle that backs up
/// does not get away from a narrow place, a second search has shorter steps and smaller states near the start. If the
/// first search is too long, the second one trusts the heuristic more. A way to a goal at which something stands ends
/// before it. Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct CurveSearch {
    estimates: Estimates,
    nodes: Vec<Node>,
    endings: Vec<Ending>,
    open: BinaryHeap<Open>,
    room: Room,
    footing: Footing,
    states: States,
    /// Curves to a goal that are tried.
    curves: Vec<Curve>,
    /// Least cost of a way that was found so far.
    ended: f32,
    /// Weight of the estimates.
    weight: f32,
    /// Start of the last search, if it expanded all states that it may.
    exhausted: Option<Point2>,
}

/// Dubins curve to a goal.
#[derive(Debug, Clone, Copy)]
struct Ending {
    curve: Curve,
    goal: Place,
}

/// Kind of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Effort {
    Normal,
    /// Short steps and small states near the start.
    Fine,
    /// The estimate counts more.
    Greedy,
}

impl CurveSearch {
    /// Plans a way from `start` to the goal that is reached at the least cost, which ends with the heading of that
    /// goal.
    ///
    /// # Errors
    /// No such way exists.
    pub fn plan(
        &mut self,
        ground: &Ground<'_>,
        vehicle: &CurveDrive,
        start: &Start,
        goals: &[Goal],
    ) -> Result<Way, NoPath> {
        check(&ground.terrain, &start.pose, goals)?;
        self.room.measure(&ground.terrain, vehicle, start);
        if let Some(floor) = &ground.floor {
            self.footing.measure(floor, vehicle, start);
        }
        let places = goals.iter().filter_map(|goal| self.place(vehicle, &start.pose, goal)).collect::<Vec<_>>();
        if places.is_empty() {
            return Err(NoPath::GoalBlocked);
        }
        let core = Terrain { map: self.room.core(), ..ground.terrain };
        self.estimates.run(&core, &places);
        let is_same = |at: Point2| (at - start.pose.position()).norm() <= SAME;
        let most = if self.exhausted.take().is_some_and(is_same) { MOST / RETRY } else { MOST };
        let way = match self.search(ground, vehicle, start, &places, (Effort::Normal, most)) {
            Err(expanded) if expanded > most => self.search(ground, vehicle, start, &places, (Effort::Greedy, most)),
            Err(_) if vehicle.backs_up() => {
                let squeezed = CurveDrive { margin: SQUEEZED * vehicle.margin, ..*vehicle };
                self.search(ground, &squeezed, start, &places, (Effort::Fine, most))
            }
            way => way,
        };
        way.map_err(|expanded| {
            self.exhausted = (expanded > most).then_some(start.pose.position());
            NoPath::Unreachable
        })
    }

    /// Place nearest to a goal where the straight vehicle fits: at the goal, or on a line to it; `None` if there is
    /// none but at the start. What stands at a goal may be gone when the vehicle is near enough to see it.
    fn place(&self, vehicle: &CurveDrive, start: &Pose2, goal: &Goal) -> Option<Place> {
        let fits = |pose: &Pose2| self.room.is_free(vehicle, &vehicle.axes(pose, pose.theta));
        if fits(&goal.pose) {
            return Some(Place { pose: goal.pose, cost: goal.cost, is_goal: true });
        }
        let count = (vehicle.short / SHORT_STEP) as u16;
        let mut before = (1..=count).map(|k| goal.pose.compose(&Pose2::new(-SHORT_STEP * f32::from(k), 0.0, 0.0)));
        let pose = before.find(fits).filter(|pose| (pose.position() - start.position()).norm() > NEARER)?;
        Some(Place { pose, cost: goal.cost + SHORT_COST, is_goal: false })
    }

    /// Searches for a way. Otherwise, returns the number of expanded states.
    fn search(
        &mut self,
        ground: &Ground<'_>,
        vehicle: &CurveDrive,
        start: &Start,
        goals: &[Place],
        (effort, most): (Effort, usize),
    ) -> Result<Way, usize> {
        self.begin(start, effort);
        let mut expanded = 0;
        while let Some(Open { node: at, .. }) = self.open.pop() {
            let node = self.nodes[at as usize];
            if let Some(ending) = node.ending {
                return Ok(self.trace(at, self.endings[ending as usize]));
            }
            if self.states.best(&node.pose, node.trailer).is_none_or(|best| node.cost >= *best) {
                continue;
            }
            if !node.is_checked {
                self.check(ground, vehicle, at);
                continue;
            }
            if let Some(best) = self.states.best(&node.pose, node.trailer) {
                *best = node.cost;
            }
            expanded += 1;
            if expanded > most {
                break;
            }
            let step = self.states.step(&node.pose);
            if vehicle.backs_up() {
                BENDS.iter().for_each(|bend| self.step_back(ground, vehicle, at, *bend, step));
            }
            if start.is_back && node.before == NONE {
                continue;
            }
            if self.estimates.at(node.pose.position()) < NEAR || expanded % TRIES == 1 {
                goals.iter().for_each(|goal| self.try_to_end(ground, vehicle, at, goal));
            }
            STEERING.iter().for_each(|steering| self.step(ground, vehicle, at, steering / vehicle.radius, step));
        }
        Err(expanded)
    }

    fn begin(&mut self, start: &Start, effort: Effort) {
        let Start { pose, trailer, .. } = *start;
        self.weight = if effort == Effort::Greedy { GREEDY } else { 1.0 };
        self.nodes.clear();
        self.endings.clear();
        self.open.clear();
        self.ended = f32::INFINITY;
        self.states.reset(self.estimates.raster(), (effort == Effort::Fine).then_some(pose.position()));
        self.nodes.push(Node { pose, trailer, is_checked: true, ..Node::NEXT });
        self.open.push(Open { estimate: 0.0, node: 0 });
    }

    /// Adds the node after a step, without a look at what is touched on it.
    fn step(&mut self, ground: &Ground<'_>, vehicle: &CurveDrive, before: u32, curvature: f32, length: f32) {
        let node = self.nodes[before as usize];
        let pose = advanced(&node.pose, curvature, length);
        if !self.states.may_be_best(&pose, node.cost_after(vehicle, length, (curvature, None), length)) {
            return;
        }
        let Some((way, trailer)) =
            self.drive(ground, vehicle).arc(&node.pose, node.trailer, curvature, length, Look::Glance)
        else {
            return;
        };
        let cost = node.cost_after(vehicle, way, (curvature, None), length);
        self.add(vehicle, Node { pose, trailer, cost, length, curvature, back: None, before, ..Node::NEXT });
    }

    fn step_back(&mut self, ground: &Ground<'_>, vehicle: &CurveDrive, before: u32, bend: f32, length: f32) {
        let node = self.nodes[before as usize];
        let drive = self.drive(ground, vehicle);
        let Some((way, pose, trailer)) = drive.back(&node.pose, node.trailer, bend, length, Look::Glance) else {
            return;
        };
        let cost = node.cost_after(vehicle, way, (0.0, Some(bend)), length);
        self.add(vehicle, Node { pose, trailer, cost, length, back: Some(bend), before, ..Node::NEXT });
    }

    /// Adds a node again with its true cost, unless something is touched on the step to it.
    fn check(&mut self, ground: &Ground<'_>, vehicle: &CurveDrive, at: u32) {
        let node = self.nodes[at as usize];
        let (before, drive) = (self.nodes[node.before as usize], self.drive(ground, vehicle));
        let way = match node.back {
            None => drive.arc(&before.pose, before.trailer, node.curvature, node.length, Look::Check).map(|way| way.0),
            Some(bend) => drive.back(&before.pose, before.trailer, bend, node.length, Look::Check).map(|way| way.0),
        };
        if let Some(way) = way {
            let cost = before.cost_after(vehicle, way, (node.curvature, node.back), node.length);
            self.nodes[at as usize] = Node { cost, is_checked: true, ..node };
            self.enqueue(vehicle, at);
        }
    }

    fn enqueue(&mut self, vehicle: &CurveDrive, at: u32) {
        let node = &self.nodes[at as usize];
        let estimate = node.cost + self.weight * self.estimates.ahead(vehicle, node);
        self.open.push(Open { estimate, node: at });
    }

    fn drive<'a>(&'a self, ground: &'a Ground<'a>, vehicle: &'a CurveDrive) -> Drive<'a> {
        Drive { ground, vehicle, room: &self.room, footing: ground.floor.is_some().then_some(&self.footing) }
    }

    /// Adds a node, unless its state was reached at a lower cost.
    fn add(&mut self, vehicle: &CurveDrive, node: Node) {
        let is_best = self.states.best(&node.pose, node.trailer).is_some_and(|best| node.cost < *best);
        if is_best && self.estimates.at(node.pose.position()).is_finite() {
            self.nodes.push(node);
            self.enqueue(vehicle, self.nodes.len() as u32 - 1);
        }
    }

    /// Adds the shortest free Dubins curve from a node to a goal, with a trailer that is in line at its end if the goal
    /// asks for that. Only its length counts: with costs, most ways to a goal would be searched before one is found.
    fn try_to_end(&mut self, ground: &Ground<'_>, vehicle: &CurveDrive, before: u32, goal: &Place) {
        let node = self.nodes[before as usize];
        let reached = node.cost + node.turn(false) + goal.cost;
        let mut ways = core::mem::take(&mut self.curves);
        ways.clear();
        let lines = if vehicle.straight > 0.0 { LINES } else { 1 };
        let first = u8::from(vehicle.comes_straight).min(lines - 1);
        for straight in (first..lines).map(|i| vehicle.straight * f32::from(i) / f32::from(LINES - 1)) {
            let begin = goal.pose.compose(&Pose2::new(-straight, 0.0, 0.0));
            ways.extend(curves(&node.pose, &begin, vehicle.radius, straight));
        }
        ways.sort_unstable_by(|a, b| a.length().total_cmp(&b.length()));
        let drive = self.drive(ground, vehicle);
        let is_right = |curve: &Curve| {
            let is_in_line = || lines == 1 || bend(&goal.pose, drive.trailer_at_end(curve, node.trailer)) <= IN_LINE;
            self.estimates.leads_along(curve) && is_in_line() && drive.is_free(curve, node.trailer)
        };
        let mut shorter = ways.iter().take_while(|curve| reached + curve.length() < self.ended);
        let best = shorter.find(|curve| is_right(curve)).copied();
        self.curves = ways;
        if let Some(curve) = best {
            let cost = reached + curve.length();
            self.ended = cost;
            self.open.push(Open { estimate: cost, node: self.nodes.len() as u32 });
            self.nodes.push(Node { cost, before, ending: Some(self.endings.len() as u32), ..node });
            self.endings.push(Ending { curve, goal: *goal });
        }
    }

    /// The way to the node before an ending.
    fn trace(&self, end: u32, ending: Ending) -> Way {
        let (mut at, mut nodes) = (self.nodes[end as usize].before, vec![]);
        while at != NONE {
            nodes.push(self.nodes[at as usize]);
            at = self.nodes[at as usize].before;
        }
        nodes.reverse();
        Way { nodes, end: ending.curve, goal: ending.goal.pose, is_whole: ending.goal.is_goal }
    }
}

fn check(terrain: &Terrain<'_>, start: &Pose2, goals: &[Goal]) -> Result<(), NoPath> {
    let raster = terrain.map.raster();
    if terrain.costs.is_some_and(|costs| costs.raster() != raster) {
        return Err(NoPath::OtherRaster);
    }
    if start.is_far() || goals.iter().any(|goal| goal.pose.is_far()) {
        return Err(NoPath::FarFromOrigin);
    }
    raster.cell(start.position()).ok_or(NoPath::StartOutside)?;
    if !start.theta.is_finite() {
        return Err(NoPath::StartBlocked);
    }
    let is_inside = goals.iter().any(|goal| raster.cell(goal.pose.position()).is_some());
    if is_inside { Ok(()) } else { Err(NoPath::GoalOutside) }
}

#[cfg(test)]
mod tests;

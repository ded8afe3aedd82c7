use super::{NoPath, Search, Terrain, search::index};
use crate::{
    map::{Cell, Grid, Occupancy},
    scan::{Point2, Pose2},
};
use apex_rt::{Event, Out, node};
use std::collections::VecDeque;

/// Maximum number of remembered goals. The oldest one makes room.
const MOST_GOALS: usize = 1024;

/// Chooses the next place for a robot that explores: the best frontier between free and unknown cells of a map
/// (Yamauchi 1997).
///
/// A frontier consists of adjacent free cells beside unknown ones. It counts if a way over free cells leads to it, and
/// if it is at least `min_size` long. The best one is that with the shortest way, of which `gain` for each metre of the
/// frontier is taken off. `goal` is the cell in its middle, facing the unknown, in the frame of the map. A goal that
/// was chosen `tries` times is not chosen again: what is behind it cannot be seen.
///
/// The obstacles of the map must be grown by the radius of the robot. `explored` comes in place of a goal when no
/// frontier is left, and `lost` tells why none can be looked for, such as a robot that is not on a free cell.
#[node]
#[derive(Debug, Clone)]
pub struct Frontiers {
    /// Minimum length of a frontier.
    #[param(unit = "m", default = 0.5, range = 0.0..=100.0)]
    min_size: f32,
    /// Length of the way that a metre of frontier is worth.
    #[param(default = 0.5, range = 0.0..=100.0)]
    gain: f32,
    /// Number of times that a goal is chosen.
    #[param(default = 2, range = 1..=1000)]
    tries: usize,
    /// Distance up to which two goals are the same.
    #[param(unit = "m", default = 0.5, range = 0.0..=100.0)]
    apart: f32,
    search: Search,
    lengths: Grid<f32>,
    visited: Vec<bool>,
    cells: Vec<Cell>,
    goals: VecDeque<Point2>,
}

/// Goal at a frontier, and the length of the way to it less what its size is worth, in m.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    goal: Pose2,
    cost: f32,
}

#[node]
impl Frontiers {
    fn process(
        &mut self,
        map: &Grid<Occupancy>,
        pose: &Pose2,
        goal: &mut Out<Pose2>,
        explored: Event<()>,
        #[failure] lost: Event<NoPath>,
    ) {
        match self.choose(map, pose) {
            Ok(Some(best)) => goal.set(best),
            Ok(None) => explored.emit(()),
            Err(why) => lost.emit(why),
        }
    }

    /// Forgets the goals that were chosen.
    #[slot]
    fn reset(&mut self) {
        self.goals.clear();
    }

    fn choose(&mut self, map: &Grid<Occupancy>, pose: &Pose2) -> Result<Option<Pose2>, NoPath> {
        if pose.is_far() {
            return Err(NoPath::FarFromOrigin);
        }
        let terrain = Terrain { map, costs: None, unknown_is_open: false };
        let start = map.raster().cell(pose.position()).ok_or(NoPath::StartOutside)?;
        self.search.lengths(&terrain, start, &mut self.lengths)?;
        self.visited.clear();
        self.visited.resize(map.cells().len(), false);
        let mut best: Option<Candidate> = None;
        for i in 0..map.cells().len() {
            let cell = Cell::new(i % map.raster().width, i / map.raster().width);
            if self.visited[i] || !self.is_frontier(map, cell) {
                continue;
            }
            self.collect(map, cell);
            let candidate = self.candidate(map).filter(|new| best.is_none_or(|best| new.cost < best.cost));
            best = candidate.or(best);
        }
        if let Some(best) = best {
            if self.goals.len() >= MOST_GOALS {
                self.goals.pop_front();
            }
            self.goals.push_back(best.goal.position());
        }
        Ok(best.map(|best| best.goal))
    }

    /// Returns `true` if a cell can be reached and has an unknown side.
    fn is_frontier(&self, map: &Grid<Occupancy>, cell: Cell) -> bool {
        let is_reached = self.lengths.get(cell).is_some_and(|length| length.is_finite());
        is_reached && around(cell).step_by(2).any(|side| map.get(side) == Some(&Occupancy::Unknown))
    }

    /// Collects the frontier of a cell.
    fn collect(&mut self, map: &Grid<Occupancy>, first: Cell) {
        self.cells.clear();
        self.cells.push(first);
        self.visited[index(map.raster(), first) as usize] = true;
        let mut next = 0;
        while let Some(cell) = self.cells.get(next).copied() {
            next += 1;
            for other in around(cell).filter(|cell| map.raster().contains(*cell)) {
                let i = index(map.raster(), other) as usize;
                if !self.visited[i] && self.is_frontier(map, other) {
                    self.visited[i] = true;
                    self.cells.push(other);
                }
            }
        }
    }

    /// Goal at the collected frontier, unless it is too small, or was tried too often.
    fn candidate(&self, map: &Grid<Occupancy>) -> Option<Candidate> {
        let raster = map.raster();
        let size = self.cells.len() as f32 * raster.resolution;
        let sum = self.cells.iter().fold(Point2::default(), |sum, cell| sum + raster.centre(*cell));
        let middle = sum.scaled(1.0 / self.cells.len() as f32);
        let offset = |cell: &Cell| (raster.centre(*cell) - middle).norm_squared();
        let cell = *self.cells.iter().min_by(|a, b| offset(a).total_cmp(&offset(b)))?;
        let place = raster.centre(cell);
        let same = self.goals.iter().filter(|goal| (**goal - place).norm() <= self.apart).count();
        if size < self.min_size || same >= self.tries {
            return None;
        }
        let way = self.lengths.get(cell).copied()?;
        let goal = Pose2::new(place.x, place.y, self.outward(map).angle());
        Some(Candidate { goal, cost: way - self.gain * size })
    }

    /// Direction from the collected frontier into the unknown.
    fn outward(&self, map: &Grid<Occupancy>) -> Point2 {
        let unknown = |cell: Cell| around(cell).filter(|side| map.get(*side) == Some(&Occupancy::Unknown));
        let steps = self.cells.iter().flat_map(|cell| unknown(*cell).map(|side| (*cell, side)));
        steps.fold(Point2::default(), |sum, (cell, side)| sum + (map.raster().centre(side) - map.raster().centre(cell)))
    }
}

/// The 8 neighbours of a cell, its sides first, third, and so on. One below 0 wraps around, and is outside any raster.
fn around(cell: Cell) -> impl DoubleEndedIterator<Item = Cell> + ExactSizeIterator {
    let steps = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];
    steps.into_iter().map(move |(dx, dy)| Cell::new(cell.x.wrapping_add_signed(dx), cell.y.wrapping_add_signed(dy)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::drawn as map;
    use apex_rt::Construct;
    use core::f32::consts::{FRAC_PI_2, PI};

    fn node(gain: f32) -> Frontiers {
        Frontiers::construct((2.0, gain, 2, 0.5))
    }

    /// Goal, whether all is explored, and the reason why nothing can be said.
    fn ask(node: &mut Frontiers, map: &Grid<Occupancy>, pose: Pose2) -> (Option<Pose2>, bool, Option<NoPath>) {
        let (mut goal, mut explored, mut lost) = (Out::new(), None, None);
        node.process(map, &pose, &mut goal, apex_rt::event(&mut explored), apex_rt::event(&mut lost));
        (goal.get().copied(), explored.is_some(), lost)
    }

    /// A frontier of 3 m on the right, one of 2 m at the top, a single cell at the bottom, and one behind a wall.
    const ROOMS: [&str; 6] = ["####?#####", "#........?", "#........?", "#........?", "#??#######", "..?#######"];

    #[test]
    fn the_nearest_frontier_is_chosen_or_a_larger_one() {
        let (map, here) = (map(&ROOMS), Pose2::new(3.5, 1.5, 0.0));
        let (goal, explored, lost) = ask(&mut node(0.0), &map, here);
        let goal = goal.expect("a frontier");
        assert_eq!((goal.position(), explored, lost), (Point2::new(1.5, 3.5), false, None));
        assert!((goal.theta - FRAC_PI_2).abs() < 0.5, "it faces the unknown: {}", goal.theta);
        let (goal, ..) = ask(&mut node(5.0), &map, here);
        assert_eq!(goal.map(|goal| goal.position()), Some(Point2::new(8.5, 2.5)));
    }

    #[test]
    fn a_goal_that_was_tried_is_left_out_until_all_are_forgotten() {
        let (map, here, mut node) = (map(&ROOMS), Pose2::new(3.5, 1.5, PI), node(0.0));
        let goals: Vec<_> = (0..5).map(|_| ask(&mut node, &map, here).0.map(|goal| goal.x)).collect();
        assert_eq!(goals, [Some(1.5), Some(1.5), Some(8.5), Some(8.5), None]);
        assert_eq!(ask(&mut node, &map, here), (None, true, None));
        node.reset();
        assert!(ask(&mut node, &map, here).0.is_some());
    }

    #[test]
    fn a_known_map_is_explored_and_a_wrong_place_is_reported() {
        let mut node = node(0.5);
        let known = map(&["####", "#..#", "####", "?..?"]);
        assert_eq!(ask(&mut node, &known, Pose2::new(1.5, 1.5, 0.0)), (None, true, None));
        for (x, why) in [
            (0.5, NoPath::StartBlocked),
            (-3.0, NoPath::StartOutside),
            (f32::NAN, NoPath::StartOutside),
            (5e6, NoPath::FarFromOrigin),
        ] {
            assert_eq!(ask(&mut node, &known, Pose2::new(x, 1.5, 0.0)), (None, false, Some(why)));
        }
        assert_eq!(ask(&mut node, &Grid::default(), Pose2::default()), (None, false, Some(NoPath::StartOutside)));
    }
}

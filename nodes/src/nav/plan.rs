use super::{NoPath, Path, Search, Terrain, simplify, smooth, subdivide};
use crate::{
    map::{Cell, Grid, Occupancy},
    scan::{Point2, Pose2},
};
use apex_rt::{Event, Out, node};

/// Resolution and smoothness of a planned path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// Approximate distance between points of the path, in m.
    pub spacing: f32,
    /// Number of smoothing rounds.
    pub rounds: usize,
}

/// Path planner in four steps: search, simplification, subdivision and smoothing (thesis 4.3.6). Keeps its buffers.
#[derive(Debug, Clone, Default)]
pub struct Planner {
    search: Search,
    cells: Vec<Cell>,
    rough: Vec<Point2>,
    simple: Vec<Point2>,
}

impl Planner {
    /// Writes a path from `start` to `goal` into `path`. All cells that the path touches are open.
    ///
    /// # Errors
    /// There is no such path. `path` is then empty.
    pub fn plan(
        &mut self,
        terrain: &Terrain<'_>,
        start: &Pose2,
        goal: &Pose2,
        smoothing: Smoothing,
        path: &mut Path,
    ) -> Result<(), NoPath> {
        path.points.clear();
        path.heading = goal.theta;
        if start.is_far() || goal.is_far() {
            return Err(NoPath::FarFromOrigin);
        }
        let raster = terrain.map.raster();
        let from = raster.cell(start.position()).ok_or(NoPath::StartOutside)?;
        let to = raster.cell(goal.position()).ok_or(NoPath::GoalOutside)?;
        self.search.run(terrain, from, to, &mut self.cells)?;
        // The path ends at the given positions, not at the centres of their cells.
        let inner = self.cells.get(1..self.cells.len().saturating_sub(1)).unwrap_or_default();
        self.rough.clear();
        self.rough.push(start.position());
        self.rough.extend(inner.iter().map(|cell| raster.centre(*cell)));
        self.rough.push(goal.position());
        simplify(terrain, &self.rough, &mut self.simple);
        subdivide(&self.simple, smoothing.spacing, &mut path.points);
        smooth(terrain, &mut path.points, smoothing.rounds);
        Ok(())
    }
}

/// Plans a path for an omnidirectional robot with A* on a grid map (thesis 4.3.6).
///
/// `start`, `goal` and the path are in the frame of the map. The obstacles of the map must be grown by the radius of
/// the robot. `costs` are those of `CostMap`; without them the path is the shortest one. If there is no path, the
/// output is ⊥ and `no_path` gives the reason.
#[node]
#[derive(Debug, Clone)]
pub struct PathPlanner {
    /// Permission for paths through unknown cells.
    #[param(default = false)]
    unknown_is_open: bool,
    /// Approximate distance between points of the path.
    #[param(unit = "m", default = 0.1, range = 0.01..=10.0)]
    spacing: f32,
    /// Number of smoothing rounds; fewer if the path has very many points.
    #[param(default = 30, range = 0..=1000)]
    rounds: usize,
    planner: Planner,
}

#[node]
impl PathPlanner {
    fn process(
        &mut self,
        start: &Pose2,
        goal: &Pose2,
        map: &Grid<Occupancy>,
        costs: Option<&Grid<f32>>,
        path: &mut Out<Path>,
        #[failure] no_path: Event<NoPath>,
    ) {
        let terrain = Terrain { map, costs, unknown_is_open: self.unknown_is_open };
        let smoothing = Smoothing { spacing: self.spacing, rounds: self.rounds };
        if let Err(why) = self.planner.plan(&terrain, start, goal, smoothing, path.get_mut()) {
            path.clear();
            no_path.emit(why);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::Construct;
    use apex_sim::Random;

    const SMOOTHING: Smoothing = Smoothing { spacing: 0.1, rounds: 30 };

    fn random_map(random: &mut Random, density: f32) -> Grid<Occupancy> {
        let raster = Raster { resolution: 0.1, width: 60, height: 45, corner: Point2::new(-1.0, -2.0) };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        for cell in map.cells_mut() {
            if random.chance(density) {
                *cell = Occupancy::Occupied;
            }
        }
        map
    }

    #[test]
    fn paths_never_leave_free_space() {
        let mut random = Random::new(5);
        let (mut planner, mut path, mut found) = (Planner::default(), Path::default(), 0);
        for round in 0..400 {
            let map = random_map(&mut random, [0.02, 0.1, 0.2, 0.3][round % 4]);
            let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
            let mut pose =
                || Pose2::new(random.uniform(-1.0, 5.0), random.uniform(-2.0, 2.5), random.uniform(-3.0, 3.0));
            let (start, goal) = (pose(), pose());
            if planner.plan(&terrain, &start, &goal, SMOOTHING, &mut path).is_err() {
                assert!(path.points.is_empty());
                continue;
            }
            found += 1;
            assert_eq!((path.points[0], path.goal()), (start.position(), Some(goal.position())));
            assert_eq!(path.heading, goal.theta);
            for ends in path.points.windows(2) {
                let along = (0..=100).map(|i| ends[0] + (ends[1] - ends[0]).scaled(i as f32 / 100.0));
                assert!(along.map(|p| map.at(p)).all(|cell| cell == Some(&Occupancy::Free)), "round {round}");
            }
        }
        assert!(found > 200, "only {found} paths");
    }

    #[test]
    fn a_path_over_open_ground_is_straight() {
        let map = random_map(&mut Random::new(0), 0.0);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let mut path = Path::default();
        let (start, goal) = (Pose2::new(-0.9, -1.9, 0.0), Pose2::new(4.7, 0.3, 1.0));
        Planner::default().plan(&terrain, &start, &goal, SMOOTHING, &mut path).expect("nothing is in the way");
        assert!((path.length() - (goal.position() - start.position()).norm()).abs() < 1e-3);
        assert!(path.points.len() > 50);
    }

    #[test]
    fn an_impossible_path_is_no_message_and_says_why() {
        let mut map = random_map(&mut Random::new(0), 0.0);
        for cell in map.cells_mut().iter_mut().skip(60 * 20).take(60) {
            *cell = Occupancy::Occupied;
        }
        let mut node = PathPlanner::construct((false, 0.1, 30));
        let mut out = Out::new();
        let mut ask = |goal: Pose2| {
            let mut why = None;
            node.process(&Pose2::new(0.0, -1.5, 0.0), &goal, &map, None, out.begin(), apex_rt::event(&mut why));
            (out.get().is_some(), why)
        };
        assert_eq!(ask(Pose2::new(0.0, 2.0, 0.0)), (false, Some(NoPath::Unreachable)));
        assert_eq!(ask(Pose2::new(0.0, 0.05, 0.0)), (false, Some(NoPath::GoalBlocked)));
        assert_eq!(ask(Pose2::new(5e6, 0.0, 0.0)), (false, Some(NoPath::FarFromOrigin)));
        assert_eq!(ask(Pose2::new(f32::NAN, 0.0, 0.0)), (false, Some(NoPath::GoalOutside)));
        assert_eq!(ask(Pose2::new(4.0, -1.0, 0.0)), (true, None));
    }
}

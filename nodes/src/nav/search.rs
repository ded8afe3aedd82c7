use crate::map::{Cell, Grid, Occupancy, Raster};
use core::{cmp::Ordering, f64::consts::SQRT_2, fmt};
use std::collections::BinaryHeap;

/// Traversable cells of a map and their costs.
#[derive(Debug, Clone, Copy)]
pub struct Terrain<'a> {
    /// Map. Occupied cells are closed.
    pub map: &'a Grid<Occupancy>,
    /// Additional cost of each metre through a cell, on the same raster. Without costs only lengths count. Negative
    /// costs and NaN count as 0.
    pub costs: Option<&'a Grid<f32>>,
    /// `true` if unknown cells are open.
    pub unknown_is_open: bool,
}

impl Terrain<'_> {
    /// Returns `true` if a robot may be in a cell.
    #[inline]
    pub fn is_open(&self, cell: Cell) -> bool {
        match self.map.get(cell) {
            Some(Occupancy::Free) => true,
            Some(Occupancy::Unknown) => self.unknown_is_open,
            Some(Occupancy::Occupied | Occupancy::Low) | None => false,
        }
    }

    /// Cost of a metre through a cell, in addition to its length.
    #[inline]
    pub fn cost(&self, cell: Cell) -> f32 {
        self.costs.and_then(|costs| costs.get(cell)).map_or(0.0, |cost| cost.max(0.0))
    }
}

/// Reason why there is no path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum NoPath {
    /// The start is outside the map.
    StartOutside,
    /// The goal is outside the map.
    GoalOutside,
    /// The start is in a cell that is not open.
    StartBlocked,
    /// The goal is in a cell that is not open.
    GoalBlocked,
    /// No path connects the start and the goal.
    Unreachable,
    /// The raster of the costs differs from that of the map.
    OtherRaster,
    /// The start or the goal is more than 100 km from the origin of the map: an `f32` has no centimetres there.
    FarFromOrigin,
}

impl fmt::Display for NoPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StartOutside => "the start is outside of the map",
            Self::GoalOutside => "the goal is outside of the map",
            Self::StartBlocked => "the start is in a cell that is not free",
            Self::GoalBlocked => "the goal is in a cell that is not free",
            Self::Unreachable => "nothing leads from the start to the goal",
            Self::OtherRaster => "the costs lie on another raster than the map",
            Self::FarFromOrigin => {
                "the start or the goal is more than 100 km from the origin of the map: shift the origin"
            }
        })
    }
}

impl std::error::Error for NoPath {}

/// Shortest paths on a grid: A* (Hart, Nilsson and Raphael 1968) with steps to the 8 neighbours.
///
/// The cost of a step is its length times `1 + cost`. This is `g′ = g + m_c` of the thesis (4.3.6) with costs per
/// metre, so that a path does not depend on the cell size. A diagonal step needs both adjacent cells open: corners are
/// not cut. The heuristic is the length of the shortest path without obstacles. It is admissible and never below the
/// L₂ norm of the thesis, so that the path is still the shortest one and fewer cells are expanded.
///
/// Keeps its buffers: on a grid of the same size as before, it allocates only if more cells are open than ever before.
#[derive(Debug, Clone, Default)]
pub struct Search {
    /// Nodes by cell index, valid if they have the number of this round.
    nodes: Vec<Node>,
    open: BinaryHeap<Open>,
    round: u32,
}

#[derive(Debug, Clone, Copy, Default)]
struct Node {
    /// Length of the shortest known path to the cell, in cells, with costs.
    length: f64,
    /// Index of the previous cell on that path.
    before: u32,
    round: u32,
    closed: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Open {
    /// Length to the cell plus heuristic.
    estimate: f64,
    length: f64,
    cell: u32,
}

impl Eq for Open {}

/// The greatest entry is expanded next: the one with the least estimate, then with the greatest length, then with the
/// least index.
impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .estimate
            .total_cmp(&self.estimate)
            .then_with(|| self.length.total_cmp(&other.length))
            .then_with(|| other.cell.cmp(&self.cell))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Search {
    /// Writes the cells of the shortest path, including start and goal, into `path` and returns its length with costs,
    /// in m.
    ///
    /// # Errors
    /// There is no such path. `path` is then empty.
    pub fn run(&mut self, terrain: &Terrain<'_>, start: Cell, goal: Cell, path: &mut Vec<Cell>) -> Result<f64, NoPath> {
        path.clear();
        check(terrain, start, goal)?;
        let raster = *terrain.map.raster();
        self.begin(terrain.map.cells().len());
        self.reach(index(&raster, start), index(&raster, start), 0.0, octile(start, goal));
        while let Some(Open { cell: at, length, .. }) = self.open.pop() {
            // A stale entry: the cell was reached by a shorter path since, and that entry came first.
            if core::mem::replace(&mut self.nodes[at as usize].closed, true) {
                continue;
            }
            let cell = cell(&raster, at);
            if cell == goal {
                self.trace(&raster, at, path);
                return Ok(length * f64::from(raster.resolution));
            }
            self.expand(terrain, cell, length, |next| octile(next, goal));
        }
        Err(NoPath::Unreachable)
    }

    /// Writes the length with costs of the shortest path from `start` to each cell, in m: infinite where no path leads.
    ///
    /// # Errors
    /// The start is not an open cell of the map, or the costs are on another raster. All lengths are infinite then.
    pub fn lengths(&mut self, terrain: &Terrain<'_>, start: Cell, lengths: &mut Grid<f32>) -> Result<(), NoPath> {
        lengths.reset_like(terrain.map, f32::INFINITY);
        check(terrain, start, start)?;
        let raster = *terrain.map.raster();
        self.begin(terrain.map.cells().len());
        self.reach(index(&raster, start), index(&raster, start), 0.0, 0.0);
        while let Some(Open { cell: at, length, .. }) = self.open.pop() {
            if !core::mem::replace(&mut self.nodes[at as usize].closed, true) {
                lengths.cells_mut()[at as usize] = (length * f64::from(raster.resolution)) as f32;
                self.expand(terrain, cell(&raster, at), length, |_| 0.0);
            }
        }
        Ok(())
    }

    /// Reaches the neighbours of a cell, to which a path of this length leads. `rest` is the heuristic.
    fn expand(&mut self, terrain: &Terrain<'_>, at: Cell, length: f64, rest: impl Fn(Cell) -> f64) {
        let raster = terrain.map.raster();
        for (next, step) in neighbours(terrain, at) {
            let length = length + step * (1.0 + f64::from(terrain.cost(next)));
            if length.is_finite() {
                self.reach(index(raster, next), index(raster, at), length, rest(next));
            }
        }
    }

    fn begin(&mut self, cells: usize) {
        self.open.clear();
        self.round = self.round.wrapping_add(1);
        if self.nodes.len() != cells || self.round == 0 {
            self.nodes.clear();
            self.nodes.resize(cells, Node::default());
            self.round = 1;
        }
    }

    fn reach(&mut self, at: u32, before: u32, length: f64, rest: f64) {
        let round = self.round;
        let node = &mut self.nodes[at as usize];
        if node.round != round || (!node.closed && length < node.length) {
            *node = Node { length, before, round, closed: false };
            self.open.push(Open { estimate: length + rest, length, cell: at });
        }
    }

    /// Collects the cells from the goal back to the start, and reverses them.
    fn trace(&self, raster: &Raster, goal: u32, path: &mut Vec<Cell>) {
        let mut at = goal;
        path.push(cell(raster, at));
        while self.nodes[at as usize].before != at {
            at = self.nodes[at as usize].before;
            path.push(cell(raster, at));
        }
        path.reverse();
    }
}

fn check(terrain: &Terrain<'_>, start: Cell, goal: Cell) -> Result<(), NoPath> {
    let raster = terrain.map.raster();
    if terrain.costs.is_some_and(|costs| costs.raster() != raster) {
        return Err(NoPath::OtherRaster);
    }
    if !raster.contains(start) {
        return Err(NoPath::StartOutside);
    }
    if !raster.contains(goal) {
        return Err(NoPath::GoalOutside);
    }
    if !terrain.is_open(start) {
        return Err(NoPath::StartBlocked);
    }
    if terrain.is_open(goal) { Ok(()) } else { Err(NoPath::GoalBlocked) }
}

/// Open neighbours of a cell with the lengths of the steps to them, in cells.
fn neighbours(terrain: &Terrain<'_>, cell: Cell) -> impl Iterator<Item = (Cell, f64)> {
    // A neighbour left of or below 0 wraps to the greatest number, which no raster contains.
    let at = |dx: isize, dy: isize| Cell::new(cell.x.wrapping_add_signed(dx), cell.y.wrapping_add_signed(dy));
    let sides = [(1, 0), (0, 1), (-1, 0), (0, -1)].map(|(dx, dy)| at(dx, dy));
    let open = sides.map(|side| terrain.is_open(side));
    let corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)].map(|(dx, dy)| at(dx, dy));
    // Corner `i` is between the sides `i` and `i + 1`.
    let reachable: [bool; 4] = core::array::from_fn(|i| open[i] && open[(i + 1) % 4] && terrain.is_open(corners[i]));
    let straight = sides.into_iter().zip(open).filter_map(|(cell, open)| open.then_some((cell, 1.0)));
    straight.chain(corners.into_iter().zip(reachable).filter_map(|(cell, open)| open.then_some((cell, SQRT_2))))
}

/// Length of the shortest path without obstacles, in cells.
fn octile(a: Cell, b: Cell) -> f64 {
    let (dx, dy) = (a.x.abs_diff(b.x), a.y.abs_diff(b.y));
    (SQRT_2 - 1.0) * dx.min(dy) as f64 + dx.max(dy) as f64
}

/// Index of a cell. Grids have far fewer cells than a `u32` has values.
pub(super) fn index(raster: &Raster, cell: Cell) -> u32 {
    (cell.y * raster.width + cell.x) as u32
}

fn cell(raster: &Raster, index: u32) -> Cell {
    Cell::new(index as usize % raster.width, index as usize / raster.width)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::drawn as map;

    fn length(terrain: &Terrain<'_>, start: (usize, usize), goal: (usize, usize)) -> Result<f64, NoPath> {
        Search::default().run(terrain, Cell::new(start.0, start.1), Cell::new(goal.0, goal.1), &mut Vec::new())
    }

    #[test]
    fn corners_are_not_cut() {
        let map = map(&["...", ".#.", "..."]);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        assert_eq!(length(&terrain, (0, 0), (2, 2)), Ok(4.0));
        assert_eq!(length(&terrain, (0, 0), (0, 0)), Ok(0.0));
    }

    #[test]
    fn unknown_cells_are_open_on_demand() {
        let map = map(&[".?.", ".?.", "#?#"]);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        assert_eq!(length(&terrain, (0, 0), (2, 0)), Err(NoPath::Unreachable));
        assert_eq!(length(&Terrain { unknown_is_open: true, ..terrain }, (0, 0), (2, 0)), Ok(2.0));
    }

    #[test]
    fn costs_lead_around() {
        let map = map(&["...", "...", "..."]);
        let mut costs = Grid::new(*map.raster(), 0.0).expect("small");
        costs.cells_mut()[1] = 10.0;
        let with = |costs: &Grid<f32>| {
            length(&Terrain { map: &map, costs: Some(costs), unknown_is_open: false }, (0, 0), (2, 0))
        };
        assert_eq!(with(&costs), Ok(2.0 * SQRT_2));
        costs.cells_mut()[1] = 0.5;
        assert_eq!(with(&costs), Ok(2.5));
        costs.cells_mut().fill(f32::INFINITY);
        assert_eq!(with(&costs), Err(NoPath::Unreachable));
        costs.cells_mut().fill(f32::NAN);
        assert_eq!(with(&costs), Ok(2.0));
        assert_eq!(with(&Grid::default()), Err(NoPath::OtherRaster));
    }

    #[test]
    fn lengths_to_all_cells_are_those_of_single_paths() {
        let map = map(&["..#.", ".#..", "...?", ".#.."]);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let (mut search, mut lengths) = (Search::default(), Grid::default());
        assert_eq!(search.lengths(&terrain, Cell::new(0, 0), &mut lengths), Ok(()));
        for (goal, all) in lengths.iter() {
            let one = length(&terrain, (0, 0), (goal.x, goal.y)).map_or(f32::INFINITY, |length| length as f32);
            assert_eq!(*all, one, "{goal:?}");
        }
        assert_eq!(search.lengths(&terrain, Cell::new(2, 0), &mut lengths), Err(NoPath::StartBlocked));
        assert!(lengths.cells().iter().all(|length| length.is_infinite()));
    }

    #[test]
    fn it_says_why_there_is_no_path() {
        let map = map(&["..#", "..#", "##."]);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let why = |start, goal| length(&terrain, start, goal);
        assert_eq!(why((3, 0), (0, 0)), Err(NoPath::StartOutside));
        assert_eq!(why((0, 0), (0, 3)), Err(NoPath::GoalOutside));
        assert_eq!(why((2, 0), (0, 0)), Err(NoPath::StartBlocked));
        assert_eq!(why((0, 0), (2, 0)), Err(NoPath::GoalBlocked));
        assert_eq!(why((0, 0), (2, 2)), Err(NoPath::Unreachable));
    }
}

use super::{Cell, Grid, Occupancy, Raster};
use crate::scan::{Point2, Pose2};
use apex_rt::{Ctx, Out, Time, node};

/// Maximum number of remembered cells.
const MOST: usize = 2000;
/// Distance by which a camera may be farther from a cell that it sees free than from one in which it saw something, in
/// m.
const FARTHER: f32 = 0.2;

/// Marks in a map of a building what a camera has seen around the robot, and remembers it.
///
/// `surroundings` is a window such as the map of `HazardMap`, in the frame of `odometry`. `pose` is the pose of the
/// robot in the frame of `map`, ⊥ while it is not known. Occupied cells in view are remembered until they are seen to
/// be free, or for `memory`; at most 2000, of which a new one replaces the one that was seen the longest ago. Small
/// things are only seen from near: a cell is free if it is seen so from about the distance from which something was
/// seen in it, or from nearer. The occupied cells of the last window are marked around the robot too, as a node such as
/// `SweepStop` stops before them.
#[node]
#[derive(Debug, Clone)]
pub struct MarkSurroundings {
    /// Time for which a cell is remembered.
    #[param(unit = "s", default = 300.0, range = 0.0..=86400.0)]
    memory: f32,
    /// Distance up to which the camera sees cells well.
    #[param(unit = "m", default = 2.0, range = 0.0..=100.0)]
    reach: f32,
    /// Angle of the camera's view across, about the x axis of the robot.
    #[param(unit = "rad", default = 1.0, range = 0.0..=6.3)]
    view_angle: f32,
    /// Distance up to which cells of the last window are marked that are no longer in view, nor remembered: where
    /// odometry still tells where they are.
    #[param(unit = "m", default = 3.0, range = 0.0..=100.0)]
    near: f32,
    /// Distance from the robot up to which `forget` forgets cells.
    #[param(unit = "m", default = 1.8, range = 0.0..=100.0)]
    forgotten: f32,
    /// Last window.
    last: Grid<Occupancy>,
    /// Last position of the robot in the map, and the cells of the map.
    here: Point2,
    raster: Raster,
    /// Remembered cells of the map in their order.
    known: Vec<Known>,
}

/// Occupied cell.
#[derive(Debug, Clone, Copy)]
struct Known {
    cell: Cell,
    kind: Occupancy,
    /// Time at which it was last seen, and distance from which it was.
    at: Time,
    distance: f32,
}

#[node]
impl MarkSurroundings {
    fn process(
        &mut self,
        ctx: &Ctx,
        map: &Grid<Occupancy>,
        pose: Option<&Pose2>,
        odometry: &Pose2,
        surroundings: Option<&Grid<Occupancy>>,
        marked: &mut Out<Grid<Occupancy>>,
    ) {
        let memory = self.memory;
        self.known.retain(|known| ctx.now().since(known.at).as_secs_f32() <= memory);
        let pose = pose.filter(|pose| pose.is_usable() && odometry.is_usable());
        if let Some((surroundings, pose)) = surroundings.zip(pose) {
            self.look(surroundings, map.raster(), [pose, odometry], ctx.now());
            self.last.clone_from(surroundings);
            (self.here, self.raster) = (pose.position(), *map.raster());
        }
        let marked = marked.get_mut();
        marked.clone_from(map);
        for known in &self.known {
            mark(marked, known.cell, known.kind);
        }
        if let Some(pose) = pose {
            self.mark_window(marked, [pose, odometry]);
        }
    }

    /// Marks the occupied cells of the last window, also those that are not in view.
    fn mark_window(&self, marked: &mut Grid<Occupancy>, [pose, odometry]: [&Pose2; 2]) {
        let (window, raster, pose) = (&self.last, *marked.raster(), pose.transform());
        for (place, kind) in occupied(window, odometry).filter(|(place, _)| place.norm() <= self.near) {
            if let Some(cell) = raster.cell(pose.to_outer(place)) {
                mark(marked, cell, kind);
            }
        }
    }

    /// Forgets the cells around the robot, for example when the robot has lifted the thing in them.
    #[slot]
    fn forget(&mut self) {
        let (here, raster, reach) = (self.here, self.raster, self.forgotten);
        self.known.retain(|known| (raster.centre(known.cell) - here).norm() > reach);
        self.last = Grid::default();
    }

    /// Forgets the cells that are free now, and adds those that are occupied.
    fn look(&mut self, window: &Grid<Occupancy>, raster: &Raster, [pose, odometry]: [&Pose2; 2], now: Time) {
        let Self { reach, view_angle, known, .. } = self;
        let (pose, outside) = (pose.transform(), odometry.transform());
        let is_in_view = |place: Point2| place.norm() <= *reach && place.angle().abs() <= 0.5 * *view_angle;
        known.retain(|known| {
            let place = pose.to_inner(raster.centre(known.cell));
            let is_seen = is_in_view(place) && place.norm() <= known.distance + FARTHER;
            !(is_seen && window.at(outside.to_outer(place)) == Some(&Occupancy::Free))
        });
        for (place, kind) in occupied(window, odometry).filter(|(place, _)| is_in_view(*place)) {
            let Some(cell) = raster.cell(pose.to_outer(place)) else { continue };
            let new = Known { cell, kind, at: now, distance: place.norm() };
            match known.binary_search_by_key(&cell, |known| known.cell) {
                Ok(place) => known[place] = new,
                Err(place) => insert(known, place, new),
            }
        }
    }
}

/// Inserts a cell at its place; if there is no room, instead of the cell that was seen the longest ago, unless all were
/// seen now.
fn insert(known: &mut Vec<Known>, place: usize, new: Known) {
    if known.len() < MOST {
        return known.insert(place, new);
    }
    let oldest = known.iter().enumerate().min_by_key(|(_, known)| known.at).map(|(i, known)| (i, known.at));
    if let Some((oldest, _)) = oldest.filter(|(_, at)| *at < new.at) {
        known.remove(oldest);
        known.insert(place - usize::from(oldest < place), new);
    }
}

/// Places of the occupied cells of a window, in the frame of the robot, and what is in them.
fn occupied<'a>(window: &'a Grid<Occupancy>, odometry: &Pose2) -> impl Iterator<Item = (Point2, Occupancy)> + use<'a> {
    let odometry = odometry.transform();
    let cells = window.iter().filter(|(_, kind)| kind.is_obstacle());
    cells.map(move |(cell, kind)| (odometry.to_inner(window.raster().centre(cell)), *kind))
}

/// Marks an obstacle in a cell. A low one does not replace a higher one.
fn mark(map: &mut Grid<Occupancy>, cell: Cell, kind: Occupancy) {
    if let Some(cell) = map.get_mut(cell).filter(|cell| **cell != Occupancy::Occupied) {
        *cell = kind;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    const BUILDING: Raster = Raster { corner: Point2::new(-10.0, -10.0), resolution: 0.1, width: 200, height: 200 };
    /// Pose in the building; odometry began elsewhere.
    const POSE: Pose2 = Pose2::new(4.0, 2.0, core::f32::consts::FRAC_PI_2);

    fn window(cells: &[(f32, f32, Occupancy)]) -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::new(-3.0, -3.0), resolution: 0.05, width: 120, height: 120 };
        let mut map = Grid::new(raster, Occupancy::Unknown).expect("small");
        for (x, y, kind) in cells {
            *map.get_mut(raster.cell(Point2::new(*x, *y)).expect("inside")).expect("inside") = *kind;
        }
        map
    }

    /// Number of marked cells, and whether the one of a place before the robot is.
    fn look(node: &mut MarkSurroundings, ms: i64, window: Option<&Grid<Occupancy>>) -> (usize, bool) {
        let map = Grid::new(BUILDING, Occupancy::Free).expect("small");
        let (ctx, mut out) = (Ctx::new(Time::from_millis(ms)), Out::new());
        node.process(&ctx, &map, Some(&POSE), &Pose2::default(), window, &mut out);
        let marked = out.get().expect("a map");
        let count = marked.cells().iter().filter(|cell| **cell == Occupancy::Occupied).count();
        (count, marked.at(POSE.to_outer(Point2::new(1.02, 0.22))) == Some(&Occupancy::Occupied))
    }

    #[test]
    fn what_was_seen_is_marked_until_it_is_seen_free() {
        let mut node = MarkSurroundings::construct((10.0, 2.0, 1.0, 0.0, 1.5));
        let hazards = [(1.02, 0.22), (2.5, 0.0), (0.1, 1.0)].map(|(x, y)| (x, y, Occupancy::Occupied));
        let occupied = window(&hazards);
        let free = Grid::new(*occupied.raster(), Occupancy::Free).expect("small");
        assert_eq!(look(&mut node, 0, Some(&occupied)), (1, true));
        assert_eq!(look(&mut node, 9000, None), (1, true));
        assert_eq!(look(&mut node, 11_000, None), (0, false));
        look(&mut node, 12_000, Some(&occupied));
        assert_eq!(look(&mut node, 12_100, Some(&free)), (0, false));
        look(&mut node, 13_000, Some(&occupied));
        node.forget();
        assert_eq!(look(&mut node, 13_100, None), (0, false));
    }

    /// A vehicle that had backed off from a small thing forgot it, and drove there again and again.
    #[test]
    fn what_was_seen_from_near_is_not_free_from_afar() {
        let mut node = MarkSurroundings::construct((10.0, 2.0, 1.0, 0.0, 1.5));
        let mut seen = |ms: i64, x: f32, occupancy: Occupancy| {
            // The thing is at (4, 0), the robot before it.
            let free = Grid::new(*window(&[]).raster(), Occupancy::Free).expect("small");
            let mut surroundings = free;
            let cell = surroundings.raster().cell(Point2::new(x, 0.02)).expect("inside");
            *surroundings.get_mut(cell).expect("inside") = occupancy;
            let map = Grid::new(BUILDING, Occupancy::Free).expect("small");
            let (ctx, pose, mut out) = (Ctx::new(Time::from_millis(ms)), Pose2::new(4.0 - x, 0.0, 0.0), Out::new());
            node.process(&ctx, &map, Some(&pose), &Pose2::default(), Some(&surroundings), &mut out);
            out.get().expect("a map").cells().contains(&Occupancy::Occupied)
        };
        assert!(seen(0, 0.62, Occupancy::Occupied));
        assert!(seen(1000, 1.52, Occupancy::Free));
        assert!(!seen(2000, 0.72, Occupancy::Free));
        assert!(seen(3000, 1.82, Occupancy::Occupied) && !seen(4000, 1.92, Occupancy::Free));
    }

    #[test]
    fn what_is_low_stays_low_but_hides_nothing() {
        let mut node = MarkSurroundings::construct((10.0, 2.0, 1.0, 0.0, 1.5));
        let window = window(&[(1.02, 0.22, Occupancy::Low)]);
        let at = POSE.to_outer(Point2::new(1.02, 0.22));
        let mut mark = |map: &Grid<Occupancy>| {
            let (ctx, mut out) = (Ctx::new(Time::ZERO), Out::new());
            node.process(&ctx, map, Some(&POSE), &Pose2::default(), Some(&window), &mut out);
            out.get().and_then(|marked| marked.at(at)).copied()
        };
        let mut map = Grid::new(BUILDING, Occupancy::Free).expect("small");
        assert_eq!(mark(&map), Some(Occupancy::Low));
        *map.get_mut(BUILDING.cell(at).expect("inside")).expect("inside") = Occupancy::Occupied;
        assert_eq!(mark(&map), Some(Occupancy::Occupied));
    }

    #[test]
    fn what_is_near_is_marked_out_of_view_too() {
        let window = window(&[(1.0, 0.2), (-1.0, 0.0), (0.1, 1.5)].map(|(x, y)| (x, y, Occupancy::Occupied)));
        let mut node = MarkSurroundings::construct((10.0, 2.0, 1.0, 1.2, 1.5));
        assert_eq!(look(&mut node, 0, Some(&window)).0, 2);
        assert_eq!(look(&mut node, 9000, None).0, 2);
        node.forget();
        assert_eq!(look(&mut node, 9100, None).0, 0);
    }

    #[test]
    fn a_full_memory_keeps_what_was_seen_last() {
        let mut known = Vec::<Known>::new();
        let known_at = |i: usize| Known {
            cell: Cell::new(i % 97, i / 97),
            kind: Occupancy::Occupied,
            at: Time::from_millis(i as i64 / 100),
            distance: 1.0,
        };
        let mut see = |i: usize| {
            let new = known_at(i);
            match known.binary_search_by_key(&new.cell, |known| known.cell) {
                Ok(_) => panic!("each cell is new"),
                Err(place) => insert(&mut known, place, new),
            }
        };
        (0..2 * MOST).rev().for_each(&mut see);
        assert_eq!(known.len(), MOST);
        assert!(known.iter().all(|known| known.at >= Time::from_millis(MOST as i64 / 100)));
        let mut known = Vec::<Known>::new();
        for i in 0..3 * MOST {
            let new = known_at(i);
            let place = known.binary_search_by_key(&new.cell, |known| known.cell).expect_err("each cell is new");
            insert(&mut known, place, new);
        }
        assert!(known.len() == MOST && known.is_sorted_by_key(|known| known.cell));
        assert!(known.iter().all(|known| known.at >= Time::from_millis(2 * MOST as i64 / 100)));
    }

    #[test]
    fn without_a_pose_nothing_is_marked() {
        let mut node = MarkSurroundings::construct((10.0, 2.0, 1.0, 0.0, 1.5));
        let window = window(&[(1.02, 0.22, Occupancy::Occupied)]);
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        let (map, mut out) = (Grid::new(BUILDING, Occupancy::Free).expect("small"), Out::new());
        node.process(&Ctx::new(Time::ZERO), &map, Some(&nan), &nan, Some(&window), &mut out);
        assert_eq!(out.get(), Some(&map));
    }
}

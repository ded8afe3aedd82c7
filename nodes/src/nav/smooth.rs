use super::Terrain;
use crate::{
    map::{Cell, Raster},
    scan::Point2,
};

/// Returns `true` if all cells that a straight line touches are open.
pub fn is_clear(terrain: &Terrain<'_>, from: Point2, to: Point2) -> bool {
    all_along(terrain.map.raster(), from, to, |cell| terrain.is_open(cell))
}

/// Writes the points of a path into `simple`, without needless detours (thesis 4.3.6). Where the straight line between
/// two points is open and free of costs, only its ends remain; otherwise both halves are simplified recursively.
pub fn simplify(terrain: &Terrain<'_>, points: &[Point2], simple: &mut Vec<Point2>) {
    simple.clear();
    simple.extend(points.first());
    let raster = terrain.map.raster();
    let is_free = |cell| terrain.is_open(cell) && terrain.cost(cell) == 0.0;
    // An explicit stack instead of recursion: the call stack has to suffice for any path.
    let mut parts = vec![(0, points.len().saturating_sub(1))];
    while let Some((first, last)) = parts.pop() {
        if last <= first {
            continue;
        }
        if last == first + 1 || all_along(raster, points[first], points[last], is_free) {
            simple.push(points[last]);
        } else {
            let middle = first + farthest(&points[first..=last]);
            parts.extend([(middle, last), (first, middle)]);
        }
    }
}

/// The inner point farthest from the line through both ends, or the middle point if all are on it.
fn farthest(points: &[Point2]) -> usize {
    let normal = (points[points.len() - 1] - points[0]).perpendicular();
    let mut best = (0.0, points.len() / 2);
    for (i, point) in points.iter().enumerate().take(points.len() - 1).skip(1) {
        let distance = normal.dot(*point - points[0]).abs();
        // More than the rounding error of a straight line.
        if distance > best.0 + 1e-4 * normal.norm_squared() {
            best = (distance, i);
        }
    }
    best.1
}

/// Writes `points` into `fine` with others between them, so that consecutive points are at most about `spacing` m
/// apart. A spacing that is not positive or not a number adds no points.
pub fn subdivide(points: &[Point2], spacing: f32, fine: &mut Vec<Point2>) {
    fine.clear();
    fine.extend(points.first());
    for ends in points.windows(2) {
        let along = ends[1] - ends[0];
        // Rounding must not add a part.
        let parts = if spacing > 0.0 { (along.norm() / spacing - 1e-3).ceil().clamp(1.0, 1e6) as usize } else { 1 };
        fine.extend((1..parts).map(|i| ends[0] + along.scaled(i as f32 / parts as f32)));
        fine.push(ends[1]);
    }
}

/// Maximum number of moved points per path, which takes less than half a second.
const MOST_MOVES: usize = 4_000_000;

/// Moves each inner point `rounds` times halfway towards the middle of its neighbours, where the path stays clear.
/// There are fewer rounds if the path has so many points that they would be moved more than four million times.
pub fn smooth(terrain: &Terrain<'_>, points: &mut [Point2], rounds: usize) {
    for _ in 0..rounds.min(MOST_MOVES / points.len().max(1)) {
        for i in 1..points.len().saturating_sub(1) {
            let (before, after) = (points[i - 1], points[i + 1]);
            let point = points[i].scaled(0.5) + (before + after).scaled(0.25);
            if is_clear(terrain, before, point) && is_clear(terrain, point, after) {
                points[i] = point;
            }
        }
    }
}

/// Returns `true` if `test` holds for all cells that a straight line touches (Amanatides and Woo 1987). Returns `false`
/// if the line leaves the raster.
fn all_along(raster: &Raster, from: Point2, to: Point2, mut test: impl FnMut(Cell) -> bool) -> bool {
    let (Some(mut at), Some(end)) = (raster.cell(from), raster.cell(to)) else { return false };
    let in_cells = |p: f32, corner: f32| f64::from(p - corner) / f64::from(raster.resolution);
    let start = [in_cells(from.x, raster.corner.x), in_cells(from.y, raster.corner.y)];
    let along = [in_cells(to.x, raster.corner.x) - start[0], in_cells(to.y, raster.corner.y) - start[1]];
    // Position along the line (0 to 1) at which it leaves the cell at an axis. It is infinite once the cell is in the
    // last column or row of the line.
    let leaves = |at: usize, end: usize, axis: usize| {
        let border = if end > at { at + 1 } else { at };
        if at == end { f64::INFINITY } else { (border as f64 - start[axis]) / along[axis] }
    };
    let corner = 1e-4 / along[0].abs().min(along[1].abs());
    while test(at) {
        if at == end {
            return true;
        }
        let (x, y) = (leaves(at.x, end.x, 0), leaves(at.y, end.y, 1));
        let next = |at: usize, end: usize| if end > at { at + 1 } else { at - 1 };
        let aside = || Cell::new(next(at.x, end.x), at.y);
        let ahead = || Cell::new(at.x, next(at.y, end.y));
        // The line passes through a corner, within rounding: the cells on both sides count.
        if (x - y).abs() < corner && !(test(aside()) && test(ahead())) {
            return false;
        }
        at = if x < y { aside() } else { ahead() };
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Grid, Occupancy};
    use apex_sim::Random;

    fn free(width: usize, height: usize) -> Grid<Occupancy> {
        Grid::new(Raster { width, height, ..Raster::default() }, Occupancy::Free).expect("small")
    }

    fn at(x: f32, y: f32) -> Point2 {
        Point2::new(x, y)
    }

    #[test]
    fn a_line_touches_the_cells_that_points_on_it_lie_in() {
        let map = free(20, 20);
        let mut random = Random::new(3);
        for _ in 0..500 {
            let mut point = || at(random.uniform(0.0, 20.0), random.uniform(0.0, 20.0));
            let (from, to) = (point(), point());
            let mut touched = Vec::new();
            assert!(all_along(map.raster(), from, to, |cell| {
                touched.push(cell);
                true
            }));
            for i in 0..=1000 {
                // Points near a cell boundary may be rounded across it.
                let p = from + (to - from).scaled(i as f32 / 1000.0);
                let inside = [p.x, p.y].iter().all(|v| (v - v.round()).abs() > 1e-4);
                assert!(!inside || map.raster().cell(p).is_some_and(|cell| touched.contains(&cell)));
            }
        }
        assert!(!all_along(map.raster(), at(1.0, 1.0), at(20.5, 1.0), |_| true));
        assert!(!all_along(map.raster(), at(f32::NAN, 1.0), at(2.0, 1.0), |_| true));
    }

    #[test]
    fn a_line_between_two_corners_is_not_clear() {
        let mut map = free(2, 2);
        map.cells_mut()[1] = Occupancy::Occupied;
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        assert!(!is_clear(&terrain, at(0.5, 0.5), at(1.5, 1.5)) && !is_clear(&terrain, at(1.5, 1.5), at(0.5, 0.5)));
        assert!(is_clear(&terrain, at(0.5, 0.5), at(0.5, 1.5)));
    }

    #[test]
    fn only_what_costs_nothing_is_simplified() {
        let mut map = free(9, 3);
        // Up, along, and down again.
        let points: Vec<Point2> = [(0, 0), (1, 1), (2, 1), (3, 1), (4, 1), (5, 1), (6, 1), (7, 1), (8, 0)]
            .map(|(x, y)| map.raster().centre(Cell::new(x, y)))
            .to_vec();
        let mut simple = Vec::new();
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        simplify(&terrain, &points, &mut simple);
        assert_eq!(simple, [points[0], points[8]]);
        let costs = Grid::new(*map.raster(), 1.0).expect("small");
        simplify(&Terrain { costs: Some(&costs), ..terrain }, &points, &mut simple);
        assert_eq!(simple, points);
        map.cells_mut()[4] = Occupancy::Occupied;
        simplify(&Terrain { map: &map, costs: None, unknown_is_open: false }, &points, &mut simple);
        assert!(simple.len() < points.len() && simple.len() > 2, "{simple:?}");
        simplify(&Terrain { map: &map, costs: None, unknown_is_open: false }, &[], &mut simple);
        assert_eq!(simple, []);
    }

    #[test]
    fn points_are_added_at_a_spacing() {
        let mut fine = Vec::new();
        subdivide(&[at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.3)], 0.25, &mut fine);
        assert_eq!(
            fine,
            [(0.0, 0.0), (0.25, 0.0), (0.5, 0.0), (0.75, 0.0), (1.0, 0.0), (1.0, 0.15), (1.0, 0.3)]
                .map(|(x, y)| at(x, y))
        );
        for odd in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            subdivide(&[at(0.0, 0.0), at(1.0, 0.0)], odd, &mut fine);
            assert_eq!(fine.len(), 2, "{odd}");
        }
    }

    #[test]
    fn smoothing_rounds_corners_but_not_into_obstacles() {
        let mut map = free(10, 10);
        let corner = |map: &Grid<Occupancy>| {
            let mut points: Vec<Point2> =
                (0..=8).map(|i| at(0.5 + i as f32, 0.5)).chain((1..=8).map(|i| at(8.5, 0.5 + i as f32))).collect();
            smooth(&Terrain { map, costs: None, unknown_is_open: false }, &mut points, 40);
            points
        };
        let open = corner(&map);
        assert_eq!((open[0], open[16]), (at(0.5, 0.5), at(8.5, 8.5)));
        assert!((open[8] - at(8.5, 0.5)).norm() > 1.0);
        // All cells inside the corner are occupied.
        for (i, cell) in map.cells_mut().iter_mut().enumerate() {
            if i % 10 < 8 && i / 10 > 0 {
                *cell = Occupancy::Occupied;
            }
        }
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let closed = corner(&map);
        assert!(closed.windows(2).all(|ends| is_clear(&terrain, ends[0], ends[1])));
        assert!((closed[8] - at(8.5, 0.5)).norm() < 0.75);
    }
}

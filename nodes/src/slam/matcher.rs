use super::{
    Pose, heading, pose,
    table::{LEVELS, Table, block},
};
use crate::{scan::Point2, slam::table::Placement};
use nalgebra::{Matrix3, Vector3};

/// Minimum standard deviation of the position of a match, in cells.
const LEAST_SPREAD: f64 = 0.5;
/// Minimum standard deviation of the heading of a match, in rad.
const LEAST_TURN: f64 = 0.005;
/// Weight of the prediction against the points in the refinement: decisive only where the points are not.
const PREDICTION: f64 = 0.01;

/// Search window around a prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Half of the width along x and y, in m.
    pub distance: f64,
    /// Half of the range of the heading, in rad.
    pub angle: f64,
}

/// Best match of a scan.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Match {
    /// Frame of the points of the scan.
    pub pose: Pose,
    /// Mean value at the points of the scan: 1 if all are where points were seen before.
    pub response: f64,
    /// Inverse of the covariance of x, y and heading, along the axes of the frame of the scan.
    pub information: Matrix3<f64>,
}

/// Block of offsets from the prediction.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    /// Upper bound of the score of all offsets in the block.
    score: f64,
    /// Offset of the heading, in steps.
    turn: i32,
    /// First offset of the block, in cells.
    x: i32,
    y: i32,
}

/// Correlative scan matcher: branch and bound over all offsets in a window, then a refinement between the cells.
#[derive(Debug, Clone, Default)]
pub(super) struct Matcher {
    /// Cells of all points for each heading, one heading after the other.
    cells: Vec<(i32, i32)>,
    candidates: Vec<Candidate>,
}

/// State of one search.
struct Search<'a> {
    table: &'a Table,
    /// Cells of all points for each heading, one heading after the other.
    cells: &'a [(i32, i32)],
    points: usize,
    /// Minimum response. Offsets with less are rejected.
    least: f64,
    /// Maximum offsets, in cells and in steps of the heading.
    shifts: i32,
    turns: i32,
    best: Candidate,
}

impl Matcher {
    /// Finds the pose near `prediction` at which points match a table best. The table must surround the points by more
    /// than the window. Returns `None` without points, or if the response is below `least` (0 to 1) everywhere.
    ///
    /// Offsets are weighted by their distance from the prediction: at the border of the window along one axis, the
    /// response has to be 1.6 times greater than at the prediction.
    pub fn search(
        &mut self,
        table: &Table,
        points: &[Point2],
        prediction: &Pose,
        window: &Window,
        least: f64,
    ) -> Option<Match> {
        let mean = points.iter().map(|p| f64::from(p.norm())).sum::<f64>() / points.len().max(1) as f64;
        // A step of the heading moves a point at mean range by one cell.
        let step = (table.resolution / mean.max(1e-3)).clamp(0.004, 0.04);
        let turns = (window.angle / step).ceil() as i32;
        let at = |offset: &Candidate| {
            let t = &prediction.translation;
            let (x, y) = (f64::from(offset.x) * table.resolution, f64::from(offset.y) * table.resolution);
            pose(t.x + x, t.y + y, heading(prediction) + f64::from(offset.turn) * step)
        };
        self.cells.clear();
        for turn in -turns..=turns {
            let place = Placement::new(table, &at(&Candidate { score: 0.0, turn, x: 0, y: 0 }));
            self.cells.extend(points.iter().map(|p| place.cell(p)));
        }
        let best = Candidate { score: 0.0, turn: 0, x: 0, y: 0 };
        let shifts = (window.distance / table.resolution).ceil() as i32;
        let mut search = Search { table, cells: &self.cells, points: points.len(), least, shifts, turns, best };
        search.run(&mut self.candidates);
        (search.best.score > 0.0).then(|| refine(table, points, prediction, window, &at(&search.best)))
    }
}

impl Search<'_> {
    fn run(&mut self, candidates: &mut Vec<Candidate>) {
        let level = (1..LEVELS).rev().find(|&level| block(level) <= self.shifts).unwrap_or(0);
        let offsets = || (-self.shifts..=self.shifts).step_by(block(level) as usize);
        candidates.clear();
        for turn in -self.turns..=self.turns {
            for y in offsets() {
                candidates.extend(offsets().map(|x| self.candidate(level, turn, x, y)));
            }
        }
        candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        for candidate in candidates {
            if candidate.score <= self.best.score {
                break;
            }
            self.descend(level, candidate);
        }
    }

    /// Searches a block whose bound exceeds the best score.
    fn descend(&mut self, level: usize, at: &Candidate) {
        let Some(finer) = level.checked_sub(1) else {
            self.best = *at;
            return;
        };
        let (size, step) = (block(level), block(finer) as usize);
        let mut children = heapless::Vec::<Candidate, 16>::new();
        for y in (at.y..at.y + size).step_by(step).filter(|&y| y <= self.shifts) {
            let row = (at.x..at.x + size).step_by(step).filter(|&x| x <= self.shifts);
            children.extend(row.map(|x| self.candidate(finer, at.turn, x, y)));
        }
        children.sort_unstable_by(|a, b| b.score.total_cmp(&a.score).then((a.y, a.x).cmp(&(b.y, b.x))));
        for child in &children {
            if child.score <= self.best.score {
                break;
            }
            self.descend(finer, child);
        }
    }

    fn candidate(&self, level: usize, turn: i32, x: i32, y: i32) -> Candidate {
        let first = (turn + self.turns) as usize * self.points;
        let sum = self.table.sum(level, &self.cells[first..first + self.points], x, y);
        let mean = f64::from(sum) / (255.0 * self.points as f64);
        if mean < self.least {
            return Candidate { score: 0.0, turn, x, y };
        }
        // The offset in the block that is nearest to the prediction.
        let share = |first: i32, widest: i32| {
            let nearest = 0.clamp(first, first + block(level) - 1);
            f64::from(nearest) / f64::from(widest.max(1))
        };
        let (dx, dy) = (share(x, self.shifts), share(y, self.shifts));
        let turned = f64::from(turn) / f64::from(self.turns.max(1));
        Candidate { score: mean * (-0.5 * (dx * dx + dy * dy + turned * turned)).exp(), turn, x, y }
    }
}

/// Derivatives of the response.
struct Slope {
    /// Mean value.
    response: f64,
    /// Mean of (1 − value)².
    missing: f64,
    /// Σ J Jᵀ over the derivatives J of the value at a point with respect to x, y and heading of the scan.
    curvature: Matrix3<f64>,
    /// Σ (1 − value) J.
    gradient: Vector3<f64>,
}

fn slope(table: &Table, points: &[Point2], at: &Pose) -> Slope {
    let mut slope = Slope { response: 0.0, missing: 0.0, curvature: Matrix3::zeros(), gradient: Vector3::zeros() };
    for point in points {
        let arm = at.rotation * nalgebra::Vector2::new(f64::from(point.x), f64::from(point.y));
        let (value, [dx, dy]) = table.at(at.translation.x + arm.x, at.translation.y + arm.y);
        let derivative = Vector3::new(dx, dy, dy * arm.x - dx * arm.y);
        slope.response += value;
        slope.missing += (1.0 - value) * (1.0 - value);
        slope.curvature += derivative * derivative.transpose();
        slope.gradient += derivative * (1.0 - value);
    }
    let count = points.len().max(1) as f64;
    slope.response /= count;
    slope.missing /= count;
    slope
}

/// Refines the best cell by Gauss–Newton steps, as long as the mismatch decreases (Kohlbrecher et al.: A Flexible and
/// Scalable SLAM System with Full 3D Motion Estimation, 2011, section IV-B).
fn refine(table: &Table, points: &[Point2], prediction: &Pose, window: &Window, start: &Pose) -> Match {
    let weight = |width: f64| PREDICTION * points.len() as f64 / (width * width).max(1e-6);
    let pull = Vector3::new(weight(window.distance), weight(window.distance), weight(window.angle));
    let (mut at, mut here) = (*start, slope(table, points, start));
    for _ in 0..10 {
        let away = prediction.translation.vector - at.translation.vector;
        let turn = heading(&(at.rotation.inverse() * prediction));
        let gradient = here.gradient + pull.component_mul(&Vector3::new(away.x, away.y, turn));
        let Some(step) = (here.curvature + Matrix3::from_diagonal(&pull)).cholesky().map(|h| h.solve(&gradient)) else {
            break;
        };
        let next = pose(at.translation.x + step.x, at.translation.y + step.y, heading(&at) + step.z);
        let there = slope(table, points, &next);
        if there.missing < here.missing - 1e-6 {
            (at, here) = (next, there);
        } else {
            break;
        }
    }
    let information = information(table, &here, &at);
    Match { pose: at, response: here.response, information }
}

/// Inverse of the covariance of a match, from the curvature of the response.
fn information(table: &Table, slope: &Slope, at: &Pose) -> Matrix3<f64> {
    let least = LEAST_SPREAD * table.resolution;
    let least = Matrix3::from_diagonal(&Vector3::new(least * least, least * least, LEAST_TURN * LEAST_TURN));
    // Standard deviations of 1 km and 100 rad, where the scan gives no information.
    let nothing = Matrix3::from_diagonal(&Vector3::new(1e-6, 1e-6, 1e-4));
    let known = slope.curvature / slope.missing.max(0.01) + nothing;
    let covariance = known.try_inverse().map_or(least, |spread| spread + least);
    let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), heading(at)).into_inner();
    let information = turn.transpose() * covariance.try_inverse().unwrap_or(nothing) * turn;
    // Symmetrized, as rounding may break the symmetry.
    (information + information.transpose()) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points that a scanner at `at` sees of a room of 6 m × 4 m around it.
    fn room(at: &Pose) -> Vec<Point2> {
        let wall = |i: i32| {
            let s = f64::from(i) * 0.05;
            [(s - 3.0, -2.0), (s - 3.0, 2.0), (-3.0, (s - 2.0).min(2.0)), (3.0, (s - 2.0).min(2.0))]
        };
        let seen = |(x, y): (f64, f64)| {
            let p = at.inverse() * nalgebra::Point2::new(x, y);
            Point2::new(p.x as f32, p.y as f32)
        };
        (0..120).flat_map(wall).map(seen).collect()
    }

    fn search(truth: &Pose, window: &Window) -> Match {
        let start = Pose::identity();
        let mut table = Table::new(0.025, 0.05);
        table.reset(&start, 8.0);
        table.add(&start, &room(&start));
        Matcher::default().search(&table, &room(truth), &start, window, 0.3).expect("a match")
    }

    #[test]
    fn a_scan_is_found_between_the_cells() {
        for window in [Window { distance: 0.4, angle: 0.3 }, Window { distance: 2.0, angle: 0.5 }] {
            for (x, y, theta) in [(0.0, 0.0, 0.0), (0.21, -0.13, 0.1), (-0.333, 0.287, -0.221)] {
                let found = search(&pose(x, y, theta), &window);
                let off = pose(x, y, theta).inv_mul(&found.pose);
                assert!(off.translation.vector.amax() < 0.015 && heading(&off).abs() < 0.01, "{x} {y} {theta}: {off}");
                assert!(found.response > 0.75, "{}", found.response);
            }
        }
    }

    #[test]
    fn a_corridor_says_nothing_about_its_length() {
        let walls: Vec<Point2> =
            (-200..=200).flat_map(|i| [-1.02, 1.02].map(|y| Point2::new(0.025 * i as f32 + 0.01, y))).collect();
        let (start, window) = (Pose::identity(), Window { distance: 0.3, angle: 0.1 });
        let mut table = Table::new(0.05, 0.05);
        table.reset(&start, 6.0);
        table.add(&start, &walls);
        let found = Matcher::default().search(&table, &walls[120..680], &start, &window, 0.3).expect("a match");
        assert!(found.information[(1, 1)] > 50.0 * found.information[(0, 0)], "{}", found.information);
        assert!(found.pose.translation.x.abs() < 0.05, "the prediction decides: {}", found.pose);
    }

    #[test]
    fn nothing_is_found_where_nothing_is() {
        let (start, window) = (Pose::identity(), Window { distance: 0.3, angle: 0.1 });
        let mut table = Table::new(0.05, 0.05);
        table.reset(&start, 3.0);
        assert_eq!(Matcher::default().search(&table, &[Point2::new(1.0, 0.0)], &start, &window, 0.0), None);
        table.add(&start, &[Point2::new(1.0, 0.0)]);
        assert_eq!(Matcher::default().search(&table, &[], &start, &window, 0.0), None);
    }
}

//! Turns of points that came in any order, each with the number of its ring.

use super::{CloudPoint, RingCloud};
use apex_rt::Time;
use core::f32::consts::TAU;
use std::{collections::BTreeMap, vec, vec::Vec};

/// Maximum number of rings: the largest scanners have 128.
const MAX_RINGS: usize = 256;
/// Smallest step between two columns, in rad: half of that of the finest scanners.
const MIN_STEP: f32 = 8e-4;

/// A point with the number of its ring, and its time in s after the stamp of the cloud.
#[derive(Debug, Clone, Copy)]
pub struct RingPoint {
    pub point: CloudPoint,
    pub ring: u32,
    pub time: f32,
}

/// Why points are not a turn.
pub const TOO_MANY: &str = "its points are of more than 256 rings";
pub const TOO_FEW: &str = "no ring has two points in different directions";

/// Returns the turn that has these points.
///
/// The rows are the rings that have points, sorted by their mean elevation. The columns are equal steps all around: the
/// mean distance of neighbours of a ring says how long a step is. If two points of a ring are in one column, it has the
/// nearer one. The columns are in the order of their times; one without points has a time between those of its
/// neighbours. Points without measurements or times are left out.
///
/// # Errors
/// [`TOO_MANY`] or [`TOO_FEW`].
pub fn gather(stamp: Time, mut points: Vec<RingPoint>) -> Result<RingCloud, &'static str> {
    points.retain(|one| one.point.is_measured() && one.time.is_finite());
    let mut turn = RingCloud::default();
    turn.reset(stamp, 0, 0);
    if points.is_empty() {
        return Ok(turn);
    }
    let rows = rows(&points).ok_or(TOO_MANY)?;
    let rings = rows.len();
    let grid = Grid::of(&points, &rows).ok_or(TOO_FEW)?;
    // A stable sort: where no point has a time, they stay in the order of the message, which is that of the scanner.
    points.sort_by(|one, other| one.time.total_cmp(&other.time));
    let mut placed = vec![CloudPoint::MISSING; rings * grid.columns];
    let mut first: Vec<Option<(usize, f32)>> = vec![None; grid.columns];
    let (begin, end) = (points[0].time, points[points.len() - 1].time);
    for (number, one) in points.iter().enumerate() {
        let row = rows[&one.ring];
        let column = grid.column(row, &one.point);
        let (_, time) = *first[column].get_or_insert((number, one.time));
        let at = &mut placed[column * rings + row];
        // A cloud may have a little more than a turn: what comes again does not belong to the column.
        let is_again = one.time - time > (end - begin) / 2.0;
        let is_farther = at.is_measured() && distance(at) <= distance(&one.point);
        if !is_again && !is_farther {
            *at = one.point;
        }
    }
    turn.reset(stamp, rings, 0);
    for (column, time) in in_order(&first) {
        turn.push_column(time, &placed[column * rings..][..rings]);
    }
    Ok(turn)
}

/// Row of each ring that has points, from the uppermost one; `None` if there are too many.
fn rows(points: &[RingPoint]) -> Option<BTreeMap<u32, usize>> {
    let mut sums: BTreeMap<u32, (f32, f32)> = BTreeMap::new();
    for one in points {
        let (sum, count) = sums.entry(one.ring).or_default();
        *sum += one.point.z.atan2(one.point.x.hypot(one.point.y));
        *count += 1.0;
    }
    let mut rings: Vec<(u32, f32)> = sums.into_iter().map(|(ring, (sum, count))| (ring, sum / count)).collect();
    rings.sort_by(|one, other| other.1.total_cmp(&one.1));
    let rows = rings.iter().enumerate().map(|(row, (ring, _))| (*ring, row)).collect();
    (rings.len() <= MAX_RINGS).then_some(rows)
}

/// Columns in equal steps.
struct Grid {
    columns: usize,
    /// For each row, where its points are within a step, in steps.
    phases: Vec<f32>,
}

impl Grid {
    /// The columns of these points; `None` if no two of them tell how long a step is.
    fn of(points: &[RingPoint], rows: &BTreeMap<u32, usize>) -> Option<Self> {
        let mut azimuths = vec![vec![]; rows.len()];
        points.iter().for_each(|one| azimuths[rows[&one.ring]].push(azimuth(&one.point)));
        let mut gaps = vec![];
        for row in &mut azimuths {
            row.sort_by(f32::total_cmp);
            gaps.extend(row.windows(2).map(|two| two[1] - two[0]).filter(|gap| *gap > MIN_STEP));
        }
        let middle = gaps.len() / 2;
        let median = (!gaps.is_empty()).then(|| *gaps.select_nth_unstable_by(middle, f32::total_cmp).1)?;
        // Wider ones lead over directions without a point.
        let (sum, count) = gaps
            .iter()
            .filter(|gap| (0.8 * median..1.2 * median).contains(*gap))
            .fold((0.0, 0.0), |(sum, count), gap| (sum + f64::from(*gap), count + 1.0));
        let columns = (f64::from(TAU) / (sum / count)).round().max(1.0) as usize;
        let phases = azimuths.iter().map(|row| phase(row, columns)).collect();
        Some(Self { columns, phases })
    }

    fn column(&self, row: usize, point: &CloudPoint) -> usize {
        let steps = azimuth(point) / TAU * self.columns as f32 - self.phases[row];
        (steps.round() as isize).rem_euclid(self.columns as isize) as usize
    }
}

/// Mean place of directions within their step, in steps.
fn phase(azimuths: &[f32], columns: usize) -> f32 {
    let (sines, cosines) = azimuths.iter().fold((0.0, 0.0), |(sines, cosines), azimuth| {
        let (sine, cosine) = (azimuth * columns as f32).sin_cos();
        (sines + sine, cosines + cosine)
    });
    sines.atan2(cosines) / TAU
}

/// Columns in the order of their times, each with its time. `first` has, for each column, the number and the time of
/// its first point.
fn in_order(first: &[Option<(usize, f32)>]) -> Vec<(usize, f32)> {
    let count = first.len();
    let Some(begin) =
        (0..count).filter(|at| first[*at].is_some()).min_by_key(|at| first[*at].map(|(number, _)| number))
    else {
        return vec![];
    };
    let seen: Vec<usize> = (begin..begin + count).map(|at| at % count).filter(|at| first[*at].is_some()).collect();
    let rising = seen.windows(2).filter(|two| first[two[0]] < first[two[1]]).count();
    let is_left = 2 * rising >= seen.len().saturating_sub(1);
    let step = if is_left { 1 } else { count - 1 };
    let order: Vec<usize> = (0..count).map(|i| (begin + i * step) % count).collect();
    let times = order.iter().map(|at| first[*at].map(|(_, time)| time)).collect();
    order.into_iter().zip(filled(times)).collect()
}

/// Times in ascending order, of which the first is known. Those that are missing are between their neighbours; at the
/// end, the last known one is repeated.
fn filled(times: Vec<Option<f32>>) -> Vec<f32> {
    let mut known = (0, times.first().copied().flatten().unwrap_or_default());
    let mut all = vec![known.1; times.len()];
    for (at, time) in times.into_iter().enumerate().filter_map(|(at, time)| Some((at, time?))) {
        let (from, begin) = known;
        // A point at the edge of its step may be in the next column.
        let time = time.max(begin);
        for (steps, between) in all[from..=at].iter_mut().enumerate() {
            let share = steps as f32 / (at - from).max(1) as f32;
            *between = begin + share * (time - begin);
        }
        known = (at, time);
        all[at..].fill(time);
    }
    all
}

fn azimuth(point: &CloudPoint) -> f32 {
    point.y.atan2(point.x)
}

fn distance(point: &CloudPoint) -> f32 {
    point.x.hypot(point.y).hypot(point.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: usize = 360;

    /// Three rings with a point in each degree at 10 m, which turn to the right in 0.1 s; ring 0 is the lowest.
    fn cylinder() -> Vec<RingPoint> {
        let all = (0..COLUMNS).flat_map(|column| (0..3).map(move |ring| (column, ring)));
        let one = |(column, ring): (usize, u32)| {
            let azimuth = -((column as f32 + 0.2 * ring as f32).to_radians());
            let point = CloudPoint { x: 10.0 * azimuth.cos(), y: 10.0 * azimuth.sin(), z: ring as f32, intensity: 1.0 };
            RingPoint { point, ring, time: 0.1 * column as f32 / COLUMNS as f32 }
        };
        all.map(one).collect()
    }

    fn turn(points: Vec<RingPoint>) -> RingCloud {
        gather(Time::from_millis(7), points).expect("a turn")
    }

    #[test]
    fn points_in_any_order_make_the_same_turn() {
        let expected = turn(cylinder());
        assert_eq!((expected.rings(), expected.columns(), expected.stamp), (3, COLUMNS, Time::from_millis(7)));
        assert!(expected.points().iter().all(CloudPoint::is_measured) && expected.times().is_sorted());
        assert_eq!(expected.points()[..3].iter().map(|point| point.z).collect::<Vec<_>>(), [2.0, 1.0, 0.0]);
        // The first column is where the scanner has begun, and the second one to the right of it.
        assert!(expected.points()[2].y == 0.0 && expected.points()[5].y < 0.0);
        let mut reversed = cylinder();
        reversed.reverse();
        assert_eq!(turn(reversed), expected);
        let rows = (0..3).flat_map(|ring| cylinder().into_iter().filter(move |one| one.ring == ring));
        assert_eq!(turn(rows.collect()), expected);
    }

    #[test]
    fn what_is_missing_has_no_points_and_times_between() {
        let mut points = cylinder();
        let is_lost = |one: &RingPoint| (0.02..0.05).contains(&one.time) || one.ring == 1 && one.time > 0.08;
        points.retain(|one| !is_lost(one));
        let left = points.len();
        let (made, whole) = (turn(points), turn(cylinder()));
        assert_eq!((made.rings(), made.columns()), (3, COLUMNS));
        let apart = made.times().iter().zip(whole.times()).map(|(one, other)| (one - other).abs());
        assert!(apart.fold(0.0, f32::max) < 1e-4);
        let kept = made.points().iter().zip(whole.points()).filter(|(point, _)| point.is_measured());
        assert!(kept.clone().all(|(one, other)| one == other) && kept.count() == left);
        assert!(!made.points()[3 * 100].is_measured());
    }

    #[test]
    fn a_direction_has_its_nearest_point_and_a_turn_does_not_overlap() {
        let mut points = cylinder();
        let first = points[0];
        let mut nearer = first;
        (nearer.point.x, nearer.point.y) = (4.0, 0.0);
        let mut again = first;
        (again.point.x, again.time) = (3.0, 0.1);
        points.extend([nearer, again]);
        assert_eq!(turn(points).points()[2].x, 4.0);
    }

    #[test]
    fn what_is_no_turn_says_why() {
        assert_eq!(gather(Time::ZERO, vec![]), Ok(RingCloud::default()));
        let one = cylinder()[0];
        assert_eq!(gather(Time::ZERO, vec![one, one]), Err(TOO_FEW));
        let many = (0..300).map(|ring| RingPoint { ring, ..one }).collect();
        assert_eq!(gather(Time::ZERO, many), Err(TOO_MANY));
        let wrong = CloudPoint { x: f32::NAN, ..one.point };
        let missing = vec![RingPoint { point: wrong, ..one }, RingPoint { time: f32::INFINITY, ..one }];
        assert_eq!(gather(Time::ZERO, missing), Ok(RingCloud::default()));
    }
}

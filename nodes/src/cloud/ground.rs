use super::{
    Columns, Label, Labels,
    sides::{Turn, marks_around},
};
use apex_rt::{Out, node};
use libm::{fabsf, sqrtf, tanf};

/// Greatest number of rings.
const MOST: usize = 128;

/// Tells ground and obstacles apart in the turns of a scanner with rings on rough terrain (thesis 8.4.2, a variant of
/// 6.5.2).
///
/// A column is followed from the robot outward, from the lowest ring to the highest one. Ground is what continues the
/// ground before it: each point is compared with the line through the last point of the ground, with the slope of the
/// ground over a distance as long as that to the point. As in equation 6.2, both neighbours of a point count. A point
/// is on an obstacle if
///
/// - it is above the line by more than `step`, and by `bend` for each metre from the ground before it, and the way from
///   there is steeper than `max_slope`, or the point is higher above the line than any hill;
/// - it may be above the line, and the next point of its column that is higher by `step` is straight above it: it is at
///   the foot of something;
/// - the point before it in its column is on an obstacle, and it is straight above that.
///
/// Beside an obstacle in its ring there is another one: a single point is a blade of grass. A low thing, whose column
/// is like that of a bump, is higher by `rise` than the ground to both sides of it, 0.6 m or 1.2 m away.
///
/// A slope is steeper than the angle `steep` if one point is straight above another one. Obstacles are overhanging
/// beyond `overhang` above the line. A point is below the ground, in a ditch, if the ground goes on behind it: if there
/// is a point behind it, at most as high as the ground may be there, and it is below the line from the ground before it
/// to that point by more than `ditch`, and by half of `bend` for each metre. Both ends of the line are nearer than
/// `brink`. Ground that falls behind a bump or a crest, and stays low, is not a ditch.
///
/// `columns` are those of a full turn in equal steps, in the level frame of the robot, whose origin is on the ground,
/// as `CompensateTurn` sends them. Columns that are not whole give ⊥.
///
/// Cost: O(n) for n points; 0.8 ms for 28,800. Allocates with the first cloud.
#[node]
#[derive(Debug, Clone)]
pub struct RingClassifier {
    /// Difference from the line of the ground up to which a point is ground.
    #[param(unit = "m", default = 0.13, range = 0.0..=2.0)]
    step: f32,
    /// Change of the slope, as its tangent, within which a point is ground.
    #[param(default = 0.08, range = 0.0..=1.0)]
    bend: f32,
    /// Greatest slope of the ground.
    #[param(unit = "rad", default = 0.4, range = 0.0..=1.2)]
    max_slope: f32,
    /// Angle from which on two points are straight above each other.
    #[param(unit = "rad", default = 0.9, range = 0.1..=1.5)]
    steep: f32,
    /// Height above the ground from which on obstacles are overhanging: the robot passes beneath them.
    #[param(unit = "m", default = 1.6, range = 0.1..=100.0)]
    overhang: f32,
    /// Depth below the line of the ground from which on a point is in a ditch.
    #[param(unit = "m", default = 0.1, range = 0.01..=10.0)]
    ditch: f32,
    /// Distance of the ground before a point in a ditch, and of that behind it.
    #[param(unit = "m", default = 2.5, range = 0.0..=100.0)]
    brink: f32,
    /// Height above the ground to both sides from which on a point is on an obstacle.
    #[param(unit = "m", default = 0.11, range = 0.0..=2.0)]
    rise: f32,
    /// Distances of the points from the axis of the scanner, in m.
    distances: Vec<f32>,
    /// Points that are obstacles, or that are higher than the ground to both sides.
    marks: Vec<bool>,
}

/// Distance behind a foot up to which something is straight above it, in m.
const FOOT: f32 = 1.2;
/// Least number of points of a low thing among five of a ring.
const ENOUGH: usize = 3;
/// Height above the line of the ground beyond which a point is on an obstacle, in m, and per metre from the ground.
const HIGH: [f32; 2] = [0.4, 0.12];
/// Part of `bend` by which the slope may change at a ditch, and between the points of the ground beside a low thing.
const UNSURE: f32 = 0.5;
/// Least distance over which the slope of the ground is measured, in m.
const LEAST: f32 = 1.5;

/// Points of a column: distances and heights, in m.
#[derive(Debug, Clone, Copy)]
struct Column<'a> {
    distances: &'a [f32],
    heights: &'a [f32],
    /// Tangents of the greatest slope of ground, and of the least one of what is straight above something.
    limits: [f32; 2],
}

/// Ground along a column: its points, with the place of the robot as the first one.
#[derive(Debug, Clone, Copy)]
struct Ground {
    points: [[f32; 2]; MOST + 1],
    count: usize,
}

#[node]
impl RingClassifier {
    fn process(&mut self, columns: &Columns, labels: &mut Out<Labels>) {
        if !columns.is_whole() || columns.height > MOST {
            return;
        }
        let height = columns.height;
        let out = labels.get_mut();
        out.height = height;
        out.labels.clear();
        out.labels.resize(columns.len(), Label::Missing);
        if height == 0 {
            return;
        }
        let limits = [tanf(self.max_slope), tanf(self.steep)];
        let [ox, oy, _] = columns.origin;
        self.distances.clear();
        self.distances.extend(columns.x.iter().zip(&columns.y).map(|(x, y)| {
            let (x, y) = (x - ox, y - oy);
            sqrtf(x * x + y * y)
        }));
        let mut ground = Ground { points: [[0.0; 2]; MOST + 1], count: 1 };
        for (column, labels) in out.labels.chunks_exact_mut(height).enumerate() {
            let rows = column * height..(column + 1) * height;
            let column = Column { distances: &self.distances[rows.clone()], heights: &columns.z[rows], limits };
            self.classify(&column, &mut ground, labels);
        }
        self.drop_single(height, &mut out.labels);
        self.find_low(columns, &mut out.labels);
    }

    /// Takes obstacles without another one beside them for ground.
    fn drop_single(&mut self, height: usize, labels: &mut [Label]) {
        self.marks.clear();
        self.marks.extend(labels.iter().map(|label| label.is_hazard()));
        for (i, label) in labels.iter_mut().enumerate().filter(|(_, label)| **label == Label::Obstacle) {
            if marks_around(&self.marks, i, height) == 1 {
                *label = Label::Floor;
            }
        }
    }

    /// Finds obstacles that are higher than the ground to both sides.
    fn find_low(&mut self, columns: &Columns, labels: &mut [Label]) {
        let turn = Turn { columns, distances: &self.distances, labels };
        let stands_out = |i: usize| turn.stands_out(i, self.rise, UNSURE * self.bend);
        self.marks.clear();
        self.marks.extend(labels.iter().enumerate().map(|(i, label)| *label == Label::Floor && stands_out(i)));
        for (i, label) in labels.iter_mut().enumerate().filter(|(i, _)| self.marks[*i]) {
            if marks_around(&self.marks, i, columns.height) >= ENOUGH {
                *label = Label::Obstacle;
            }
        }
    }

    fn classify(&self, column: &Column<'_>, ground: &mut Ground, labels: &mut [Label]) {
        ground.count = 1;
        let mut last = None;
        for row in (0..labels.len()).rev().filter(|row| column.is_measured(*row)) {
            let (r, z) = (column.distances[row], column.heights[row]);
            let [from, height] = ground.points[ground.count - 1];
            let ahead = (r - from).max(0.0);
            let slope = ground.slope(ahead);
            let off = z - height - slope * ahead;
            let tolerance = self.bend * ahead;
            let is_steep = z - height > column.limits[0] * ahead || off > HIGH[0] + HIGH[1] * ahead;
            let goes_on = last.is_some_and(|below: usize| {
                matches!(labels[below], Label::Obstacle | Label::Overhanging) && column.is_above(row, below, 0.0)
            });
            let stands = off > self.step + tolerance && is_steep;
            let is_foot = || off > 0.3 * self.step - tolerance && column.is_foot(row, self.step);
            labels[row] = if goes_on || stands || is_foot() {
                if off > self.overhang { Label::Overhanging } else { Label::Obstacle }
            } else if ahead < self.brink && self.is_in_ditch(column, row, [from, height], slope) {
                Label::Below
            } else {
                ground.add([r, z]);
                Label::Floor
            };
            last = Some(row);
        }
    }
}

impl RingClassifier {
    /// Returns `true` for a point below the ground, which goes on behind it. The ground before the point is at `from`,
    /// with this slope.
    fn is_in_ditch(&self, column: &Column<'_>, row: usize, from: [f32; 2], slope: f32) -> bool {
        let [ahead, rise] = [column.distances[row] - from[0], column.heights[row] - from[1]];
        let is_below = |slope: f32| slope * ahead - rise > self.ditch + UNSURE * self.bend * ahead;
        // What is higher than this behind the point stands on the ground.
        let most = slope + UNSURE * self.bend;
        if !is_below(most) {
            return false;
        }
        let behind = (0..row).rev().filter(|i| column.is_measured(*i));
        let mut near = behind.take_while(|i| column.distances[*i] - column.distances[row] < self.brink);
        near.any(|i| {
            let way = column.distances[i] - from[0];
            way > ahead && is_below(((column.heights[i] - from[1]) / way).min(most))
        })
    }
}

impl Column<'_> {
    const fn is_measured(&self, row: usize) -> bool {
        // False for NaN.
        (self.distances[row] + self.heights[row]).is_finite()
    }

    /// Returns `true` if the next point that is higher by `step` m is straight above a point.
    fn is_foot(&self, row: usize, step: f32) -> bool {
        let behind = self.distances[row] + FOOT;
        let mut above = (0..row).rev().take_while(|i| self.distances[*i].is_nan() || self.distances[*i] < behind);
        // False for NaN.
        let next = above.find(|i| self.heights[*i] - self.heights[row] > step);
        next.is_some_and(|i| self.is_above(i, row, step))
    }

    /// Returns `true` if a point is straight above another one, and higher than that by `least` m.
    fn is_above(&self, upper: usize, lower: usize, least: f32) -> bool {
        let rise = self.heights[upper] - self.heights[lower];
        rise > least && rise > self.limits[1] * fabsf(self.distances[upper] - self.distances[lower])
    }
}

impl Ground {
    /// Slope of the ground over about this distance before its last point, as its tangent.
    fn slope(&self, distance: f32) -> f32 {
        let last = self.points[self.count - 1];
        let reach = distance.max(LEAST);
        let before = self.points[..self.count].iter().rev().find(|point| last[0] - point[0] >= reach);
        let before = before.unwrap_or(&self.points[0]);
        let way = last[0] - before[0];
        if way > 0.1 { (last[1] - before[1]) / way } else { 0.0 }
    }

    fn add(&mut self, point: [f32; 2]) {
        if point[0] > self.points[self.count - 1][0] + 0.05 && self.count <= MOST {
            self.points[self.count] = point;
            self.count += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;
    use core::f32::consts::PI;

    const RINGS: usize = 16;
    const HEIGHT: f32 = 0.85;

    fn node() -> RingClassifier {
        RingClassifier::construct((0.1, 0.08, 0.4, 0.9, 1.6, 0.1, 2.5, 0.11))
    }

    /// Column of a scanner above a profile of the ground: distances and heights, in m, joined by straight lines.
    fn column(profile: &[[f32; 2]]) -> Columns {
        let mut columns = Columns { height: RINGS, origin: [0.0, 0.0, HEIGHT], ..Columns::default() };
        for row in 0..RINGS {
            let slope = tanf((15.0 - 2.0 * row as f32) * PI / 180.0);
            let meets = |pair: &[[f32; 2]]| {
                let [[r0, z0], [r1, z1]] = [pair[0], pair[1]];
                let (a, b) = (HEIGHT + slope * r0 - z0, HEIGHT + slope * r1 - z1);
                (a >= 0.0 && b < 0.0).then(|| r0 + (r1 - r0) * a / (a - b))
            };
            let r = profile.windows(2).find_map(meets).unwrap_or(f32::NAN);
            columns.x.push(r);
            columns.y.push(0.0);
            columns.z.push(HEIGHT + slope * r);
            columns.intensity.push(0.0);
        }
        columns
    }

    /// Labels of the points of a column that are farther than `from` m and nearer than `to` m.
    fn labels(profile: &[[f32; 2]], from: f32, to: f32) -> Vec<Label> {
        let columns = column(profile);
        let mut out = Out::new();
        node().process(&columns, &mut out);
        let labels = &out.get().expect("labels").labels;
        assert!(columns.x.iter().zip(labels).all(|(x, label)| x.is_nan() == (*label == Label::Missing)));
        let is_there = |x: f32| x >= from && x < to;
        columns.x.iter().zip(labels).filter(|(x, _)| is_there(**x)).map(|(_, label)| *label).collect()
    }

    /// Labels of the points of a full turn over a country, with their heights above its ground: `country` gives the
    /// height of what a ray meets at a place, and that of the ground there, in m.
    fn seen(country: impl Fn(f32, f32) -> [f32; 2]) -> Vec<(f32, Label)> {
        const COLUMNS: usize = 360;
        const STEP: f32 = 0.01;
        let mut columns = Columns { height: RINGS, origin: [0.0, 0.0, HEIGHT], ..Columns::default() };
        let mut heights = vec![];
        for i in 0..COLUMNS * RINGS {
            let (sin, cos) = libm::sincosf((i / RINGS) as f32 * 2.0 * PI / COLUMNS as f32);
            let slope = tanf((15.0 - 2.0 * (i % RINGS) as f32) * PI / 180.0);
            let meets = |r: &f32| HEIGHT + slope * r <= country(r * cos, r * sin)[0];
            let r = (50..1000).map(|step| STEP * step as f32).find(meets).unwrap_or(f32::NAN);
            let z = HEIGHT + slope * r;
            columns.x.push(r * cos);
            columns.y.push(r * sin);
            columns.z.push(z);
            columns.intensity.push(0.0);
            heights.push(z - country(r * cos, r * sin)[1]);
        }
        let mut out = Out::new();
        node().process(&columns, &mut out);
        let labels = out.get().expect("labels").labels.iter().copied();
        heights.into_iter().zip(labels).filter(|(_, label)| *label != Label::Missing).collect()
    }

    #[test]
    fn a_low_rock_is_an_obstacle() {
        for (at, slope) in [(2.5, 0.0), (3.0, 0.1), (3.6, 0.0), (3.6, -0.1)] {
            let seen = seen(|x, y| {
                let left = 0.25 * 0.25 - (x - at) * (x - at) - y * y;
                [slope * y + sqrtf(left.max(0.0)), slope * y]
            });
            let high: Vec<Label> = seen.iter().filter(|(height, _)| *height > 0.17).map(|(_, label)| *label).collect();
            let found = high.iter().filter(|label| **label == Label::Obstacle).count();
            assert!(high.len() > 3 && 4 * found >= 3 * high.len(), "{at}: {high:?}");
            let low: Vec<Label> = seen.iter().filter(|(height, _)| *height < 0.015).map(|(_, label)| *label).collect();
            assert!(all(&low, Label::Floor), "{at}");
        }
    }

    #[test]
    fn mounds_and_blades_of_grass_are_ground() {
        let mound = |x: f32, y: f32| [0.2 * libm::expf(-((x - 4.0) * (x - 4.0) + y * y) / 2.0), 0.0];
        // Blades 0.3 m high in one direction of four, and nothing beside them.
        let blades = |x: f32, y: f32| {
            let degrees = libm::roundf(libm::atan2f(y, x) * 180.0 / PI) as i32;
            let is_blade = degrees % 4 == 0 && (sqrtf(x * x + y * y) - 3.0).abs() < 0.02;
            [if is_blade { 0.3 } else { 0.0 }, 0.0]
        };
        for seen in [seen(mound), seen(blades)] {
            let labels: Vec<Label> = seen.into_iter().map(|(_, label)| label).collect();
            assert!(all(&labels, Label::Floor));
        }
    }

    fn all(labels: &[Label], label: Label) -> bool {
        !labels.is_empty() && labels.iter().all(|l| *l == label)
    }

    #[test]
    fn slopes_and_their_ends_are_ground() {
        for slope in [0.0, 0.2, -0.04] {
            let hill = [[0.0, 0.0], [4.0, 0.0], [12.0, 8.0 * slope], [80.0, 8.0 * slope]];
            assert!(all(&labels(&hill, 0.0, 80.0), Label::Floor), "{slope}");
        }
    }

    #[test]
    fn what_stands_on_the_ground_is_an_obstacle_down_to_its_foot() {
        for (at, height) in [(3.0, 1.8), (8.0, 1.8), (15.0, 1.8), (3.6, 0.5)] {
            let trunk = [[0.0, 0.0], [at, 0.0], [at + 0.05, height], [at + 0.3, height], [at + 0.35, 0.0], [80.0, 0.0]];
            assert!(labels(&trunk, 0.0, at - 0.01).iter().all(|label| *label == Label::Floor), "{at}");
            let seen = labels(&trunk, at + 0.002, at + 0.35);
            let wrong = seen.iter().filter(|l| **l != Label::Obstacle && **l != Label::Overhanging).count();
            assert!(seen.len() > 1 && wrong <= 1, "{at}: {seen:?}");
        }
    }

    #[test]
    fn a_ditch_is_below_and_the_ground_goes_on_behind_it() {
        let ditch = [[0.0, 0.0], [4.2, 0.0], [4.4, -0.6], [5.8, -0.6], [6.0, 0.0], [80.0, 0.0]];
        let seen = labels(&ditch, 4.2, 5.99);
        assert!(seen.contains(&Label::Below), "{seen:?}");
        assert!(all(&labels(&ditch, 6.0, 80.0), Label::Floor));
    }

    #[test]
    fn bumps_and_crests_are_no_ditches() {
        // A bump that the lowest rings meet, and two crests behind which the ground falls.
        let bump = [[0.0, 0.0], [2.2, 0.0], [2.6, 0.16], [3.0, 0.0], [80.0, 0.0]];
        let crest = |fall: f32| [[0.0, 0.0], [3.0, 0.3], [6.0, 0.3 - 3.0 * fall], [80.0, 0.3 - 3.0 * fall]];
        for profile in [&bump[..], &crest(0.05), &crest(0.1), &crest(0.2)] {
            let seen = labels(profile, 0.0, 80.0);
            assert!(!seen.contains(&Label::Below), "{profile:?}: {seen:?}");
        }
    }

    #[test]
    fn a_ditch_on_a_slope_is_seen() {
        let on = |slope: f32, profile: &[[f32; 2]]| -> Vec<[f32; 2]> {
            profile.iter().map(|[r, z]| [*r, z + slope * r]).collect()
        };
        let ditch = [[0.0, 0.0], [3.3, 0.0], [3.6, -0.6], [4.4, -0.6], [4.7, 0.0], [80.0, 0.0]];
        for slope in [-0.05, 0.1] {
            // A ring that meets the far wall sees something upright.
            let seen = labels(&on(slope, &ditch), 3.3, 4.7);
            assert!(seen.iter().any(|label| *label != Label::Floor), "{slope}: {seen:?}");
        }
    }

    #[test]
    fn clouds_without_points_and_odd_ones() {
        let mut out = Out::new();
        node().process(&Columns::default(), &mut out);
        assert_eq!(out.get(), Some(&Labels::default()));
        let odd =
            Columns { height: 2, x: vec![1.0], y: vec![1.0], z: vec![1.0], intensity: vec![1.0], ..Columns::default() };
        let mut out = Out::new();
        node().process(&odd, &mut out);
        assert!(out.get().is_none());
        // On the axis of the scanner, and infinitely far away.
        let values = [0.0, 1e-30, 1.0, 1e30, f32::INFINITY, f32::NAN];
        let points = |every: usize| (0..216).map(|i| values[i / every % values.len()]).collect();
        let odd = Columns { height: 12, x: points(1), y: points(6), z: points(36), ..Columns::default() };
        let odd = Columns { intensity: points(1), ..odd };
        let mut out = Out::new();
        node().process(&odd, &mut out);
        assert_eq!(out.get().map(|labels| labels.labels.len()), Some(216));
    }
}

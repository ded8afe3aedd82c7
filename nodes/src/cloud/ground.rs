use super::{Columns, Label, Labels};
use apex_rt::{Out, node};
use libm::{fabsf, sqrtf, tanf};

/// Greatest number of rings.
const MOST: usize = 128;
/// Weight of a new slope in the average along a column.
const NEW: f32 = 0.5;

/// Tells ground and obstacles apart in the turns of a scanner with rings on rough terrain (thesis 8.4.2, a variant of
/// 6.5.2).
///
/// A column is followed from the robot outward, from the lowest ring to the highest one. Ground is what continues the
/// ground before it: each point is compared with the line through the last point of the ground with the slope of the
/// ground, and may be off by `step`, and by `bend` for each metre in between, as a slope may change. The slope of the
/// ground itself is at most `max_slope`. As in equation 6.2, both neighbours of a point count: one that has the next
/// higher point of its column straight above it is at the foot of something that stands there. Points above the line
/// are obstacles, and overhanging beyond `overhang`; those far below it are below the ground, in a ditch.
///
/// `columns` are in the level frame of the robot, whose origin is on the ground, as `CompensateTurn` sends them. Columns
/// that are not whole give ⊥.
///
/// Cost: O(n) for n points; 0.3 ms for 28,800. Allocates with the first cloud.
#[node]
#[derive(Debug, Clone)]
pub struct RingClassifier {
    /// Difference from the line of the ground up to which a point is ground.
    #[param(unit = "m", default = 0.1, range = 0.0..=2.0)]
    step: f32,
    /// Change of the slope, as its tangent, within which a point is ground.
    #[param(default = 0.06, range = 0.0..=1.0)]
    bend: f32,
    /// Greatest slope of the ground.
    #[param(unit = "rad", default = 0.4, range = 0.0..=1.2)]
    max_slope: f32,
    /// Angle from which on two consecutive points stand on each other.
    #[param(unit = "rad", default = 1.0, range = 0.1..=1.5)]
    steep: f32,
    /// Height above the ground from which on obstacles are overhanging: the robot passes beneath them.
    #[param(unit = "m", default = 1.6, range = 0.1..=100.0)]
    overhang: f32,
    /// Depth below the line of the ground from which on a point is in a ditch.
    #[param(unit = "m", default = 0.14, range = 0.01..=10.0)]
    ditch: f32,
}

/// Ground along a column.
#[derive(Debug, Clone, Copy)]
struct Line {
    /// Distance and height of the last point of the ground, in m.
    at: [f32; 2],
    /// Slope, as its tangent.
    slope: f32,
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
        let mut distances = [0.0; MOST];
        for (column, labels) in out.labels.chunks_exact_mut(height).enumerate() {
            let first = column * height;
            for (row, distance) in distances[..height].iter_mut().enumerate() {
                let (x, y) = (columns.x[first + row] - ox, columns.y[first + row] - oy);
                *distance = sqrtf(x * x + y * y);
            }
            self.classify(&distances[..height], &columns.z[first..first + height], limits, labels);
        }
    }

    /// Labels a column. `limits` are the tangents of the greatest slope of ground and of the least one of what stands.
    fn classify(&self, distances: &[f32], heights: &[f32], limits: [f32; 2], labels: &mut [Label]) {
        let mut line = Line { at: [0.0, 0.0], slope: 0.0 };
        let mut row = distances.len();
        while row > 0 {
            row -= 1;
            let (r, z) = (distances[row], heights[row]);
            // False for NaN.
            if !(r + z).is_finite() {
                continue;
            }
            let ahead = r - line.at[0];
            let off = z - line.at[1] - line.slope * ahead.max(0.0);
            let tolerance = self.step + self.bend * ahead.max(0.0);
            labels[row] = if off > tolerance {
                self.standing(off)
            } else if off < -self.ditch - self.bend * ahead.max(0.0) {
                Label::Below
            } else if off > 0.3 * self.step && self.is_foot(distances, heights, row, limits[1]) {
                Label::Obstacle
            } else {
                line.advance([r, z], limits[0]);
                Label::Floor
            };
        }
    }

    const fn standing(&self, above: f32) -> Label {
        if above > self.overhang { Label::Overhanging } else { Label::Obstacle }
    }

    /// Returns `true` if the next measured point of the column is straight above this one.
    fn is_foot(&self, distances: &[f32], heights: &[f32], row: usize, steep: f32) -> bool {
        let next = (0..row).rev().find(|i| (distances[*i] + heights[*i]).is_finite());
        next.is_some_and(|i| {
            let (dr, dz) = (distances[i] - distances[row], heights[i] - heights[row]);
            dz > self.step && dz > steep * fabsf(dr)
        })
    }
}

impl Line {
    fn advance(&mut self, to: [f32; 2], steepest: f32) {
        let ahead = to[0] - self.at[0];
        if ahead > 0.05 {
            let slope = ((to[1] - self.at[1]) / ahead).clamp(-steepest, steepest);
            self.slope += NEW * (slope - self.slope);
            self.at = to;
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
        RingClassifier::construct((0.1, 0.06, 0.4, 1.0, 1.6, 0.14))
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
    fn clouds_without_points_and_odd_ones() {
        let mut out = Out::new();
        node().process(&Columns::default(), &mut out);
        assert_eq!(out.get(), Some(&Labels::default()));
        let odd =
            Columns { height: 2, x: vec![1.0], y: vec![1.0], z: vec![1.0], intensity: vec![1.0], ..Columns::default() };
        let mut out = Out::new();
        node().process(&odd, &mut out);
        assert!(out.get().is_none());
    }
}

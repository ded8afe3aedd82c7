use super::{Columns, FloorSurface, Label, Labels};
use apex_rt::{Out, node};
use std::f32::consts::FRAC_PI_2;

/// Probabilities of all points of [`Columns`] that they belong to an obstacle, P_i from 0 to 1, in the same order.
/// 0 for points that are missing, artefacts or unknown; 1 for overhanging ones.
pub type Probabilities = Vec<f32>;

/// Classifies the points near the floor as floor or obstacle (thesis 6.5.2, eqs. 6.1 to 6.10).
///
/// Each point is compared with the nearest ones before and after it in its column that are farther than `step` along
/// x: by the change of slope, h_D, and by the change of intensity, h_I. A point without such neighbours stays unknown.
///
/// An optional third score h_F, which is not in the thesis, is the angle of elevation over the fitted floor, seen from
/// the camera, divided by `max_elevation`. It sees flat tops of objects too, and points without neighbours. The
/// probability is min(1, α h_D + β h_I + γ h_F). With the default γ = 0 it is that of the thesis.
///
/// Points that lie more than `depth` under the floor are labelled `Below`. The outputs are ⊥ if points and labels
/// differ in size.
#[node]
#[derive(Debug, Clone)]
pub struct ColumnClassifier {
    /// Weight of the score of depth, α.
    #[param(default = 25.57, range = 0.0..=1000.0)]
    alpha: f32,
    /// Weight of the score of intensity, β.
    #[param(default = 19.18, range = 0.0..=1000.0)]
    beta: f32,
    /// Weight of the score of elevation, γ.
    #[param(default = 0.0, range = 0.0..=1000.0)]
    gamma: f32,
    /// Minimum distance of the compared points along x, δ_x.
    #[param(unit = "m", default = 0.0012, range = 0.0..=1.0)]
    step: f32,
    /// Maximum number of valid points between the compared ones.
    #[param(default = 16, range = 1..=10_000)]
    steps: usize,
    /// Sum of the differences in height below which h_D is 0, ε_z.
    #[param(unit = "m", default = 0.01, range = 0.0..=1.0)]
    min_height: f32,
    /// Change of slope at which h_D is 1, κ_max. The thesis gives no value.
    #[param(unit = "rad", default = 1.0, range = 0.001..=3.2)]
    max_curvature: f32,
    /// Difference of intensities at which h_I is 1, I_max. The thesis gives no value.
    #[param(default = 1024.0, range = 0.001..=1e9)]
    max_intensity: f32,
    /// Angle of elevation over the floor at which h_F is 1.
    #[param(unit = "rad", default = 0.05, range = 0.0001..=1.6)]
    max_elevation: f32,
    /// Minimum probability of an obstacle, P_t.
    #[param(default = 0.92, range = 0.0..=1.0)]
    threshold: f32,
    /// Minimum depth of a point that is not floor.
    #[param(unit = "m", default = 0.12, range = 0.0..=10.0)]
    depth: f32,
    column: Column,
}

/// Valid points of a column, without gaps.
#[derive(Debug, Clone, Default)]
struct Column {
    points: Vec<Point>,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    /// Index in the cloud.
    index: usize,
    x: f32,
    z: f32,
    intensity: f32,
}

#[node]
impl ColumnClassifier {
    fn process(
        &mut self,
        points: &Columns,
        labels: &Labels,
        floor: Option<&FloorSurface>,
        classified: &mut Out<Labels>,
        probabilities: &mut Out<Probabilities>,
    ) {
        if !points.fits(labels) {
            return;
        }
        let (out, scores) = (classified.get_mut(), probabilities.get_mut());
        out.clone_from(labels);
        scores.clear();
        scores.resize(points.len(), 0.0);
        let mut column = core::mem::take(&mut self.column);
        for first in (0..points.len()).step_by(points.height.max(1)) {
            column.collect(points, labels, first..first + points.height);
            for (k, p) in column.points.iter().enumerate() {
                let i = p.index;
                (out.labels[i], scores[i]) = match labels.labels[i] {
                    Label::Overhanging => (Label::Overhanging, 1.0),
                    _ => self.classify(points, &column.points, k, floor),
                };
            }
        }
        self.column = column;
    }

    fn classify(&self, points: &Columns, column: &[Point], k: usize, floor: Option<&FloorSurface>) -> (Label, f32) {
        let p = column[k];
        let y = points.y[p.index];
        let over = p.z - floor.map_or(0.0, |floor| floor.height(p.x, y));
        if over < -self.depth {
            return (Label::Below, 0.0);
        }
        let step = self.step;
        let is_apart = |q: &&Point| (p.x - q.x).abs() > step;
        let before = column[..k].iter().rev().take(self.steps).find(is_apart);
        let after = column[k + 1..].iter().take(self.steps).find(is_apart);
        let by_neighbours = match (before, after) {
            (Some(before), Some(after)) => {
                self.alpha * self.by_depth(&p, before, after) + self.beta * self.by_intensity(&p, before, after)
            }
            _ if floor.is_none() || self.gamma == 0.0 => return (Label::Unknown, 0.0),
            _ => 0.0,
        };
        let by_elevation = match floor {
            Some(_) if self.gamma > 0.0 => {
                let (dx, dy) = (p.x - points.origin[0], y - points.origin[1]);
                let distance = libm::sqrtf(dx * dx + dy * dy).max(f32::MIN_POSITIVE);
                self.gamma * (over / distance / self.max_elevation).clamp(0.0, 1.0)
            }
            _ => 0.0,
        };
        let probability = (by_neighbours + by_elevation).min(1.0);
        (if probability >= self.threshold { Label::Obstacle } else { Label::Floor }, probability)
    }

    /// h_D (eqs. 6.2 to 6.7).
    #[inline]
    fn by_depth(&self, p: &Point, before: &Point, after: &Point) -> f32 {
        let (rise_before, rise_after) = ((before.z - p.z).abs(), (after.z - p.z).abs());
        if rise_before + rise_after < self.min_height {
            return 0.0;
        }
        let slope_before = arc_tangent(rise_before, (before.x - p.x).abs());
        let slope_after = arc_tangent(rise_after, (after.x - p.x).abs());
        let curvature = if p.z >= 0.5 * (before.z + after.z) {
            (slope_before - slope_after).abs()
        } else {
            slope_before.min(slope_after)
        };
        (curvature / self.max_curvature).min(1.0)
    }

    /// h_I (eqs. 6.8 to 6.10).
    #[inline]
    fn by_intensity(&self, p: &Point, before: &Point, after: &Point) -> f32 {
        if p.intensity > self.max_intensity {
            return 1.0;
        }
        let difference = (after.intensity - p.intensity).abs().max((p.intensity - before.intensity).abs());
        (difference / self.max_intensity).min(1.0)
    }
}

impl Column {
    fn collect(&mut self, points: &Columns, labels: &Labels, range: core::ops::Range<usize>) {
        self.points.clear();
        self.points.extend(range.filter(|i| labels.labels[*i].is_valid()).map(|index| Point {
            index,
            x: points.x[index],
            z: points.z[index],
            intensity: points.intensity[index],
        }));
    }
}

/// Angle of the slope `rise` over `run`, both not negative, in rad. The error is below 10⁻⁵ rad (Abramowitz and Stegun
/// 1964, 4.4.49), in a fifth of the time of an exact one.
#[inline]
fn arc_tangent(rise: f32, run: f32) -> f32 {
    let t = rise.min(run) / rise.max(run);
    let s = t * t;
    let angle = t * (0.999_866 + s * (-0.330_299_5 + s * (0.180_141 + s * (-0.085_133 + s * 0.020_835_1))));
    if rise > run { FRAC_PI_2 - angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::columns::tests::columns;
    use apex_rt::Construct;

    /// The thesis's weights, with 1 for κ_max and 1000 for I_max.
    fn thesis(steps: usize) -> ColumnClassifier {
        ColumnClassifier::construct((25.57, 19.18, 0.0, 0.0012, steps, 0.01, 1.0, 1000.0, 0.05, 0.92, 0.12))
    }

    fn classify(node: &mut ColumnClassifier, column: &[[f32; 4]], floor: Option<&FloorSurface>) -> Vec<(Label, f32)> {
        let (points, mut labels) = columns(column.len(), column);
        labels.labels.iter_mut().zip(column).filter(|(_, p)| p[2] > 0.12).for_each(|(l, _)| *l = Label::Overhanging);
        let (mut out, mut scores) = (Out::new(), Out::new());
        node.process(&points, &labels, floor, &mut out, &mut scores);
        let labels = out.get().expect("labels").labels.clone();
        labels.into_iter().zip(scores.get().expect("scores").clone()).collect()
    }

    #[test]
    fn the_arc_tangent_is_nearly_exact() {
        for i in 0..10_000 {
            let (rise, run) = ((i % 100) as f32 * 0.03, 0.001 + (i / 100) as f32 * 0.02);
            assert!((arc_tangent(rise, run) - libm::atan2f(rise, run)).abs() < 2e-5, "{rise} {run}");
        }
    }

    #[test]
    fn an_edge_over_the_floor_is_an_obstacle() {
        use Label::{Floor, Obstacle, Overhanging, Unknown};
        // From far to near: a wall, the floor, a step of 3 cm, the floor.
        let z = [0.5, 0.0, 0.0, 0.03, 0.03, 0.0, 0.0, 0.0];
        let x = [2.0, 1.9, 1.8, 1.795, 1.75, 1.745, 1.7, 1.65];
        let column: Vec<[f32; 4]> = x.iter().zip(z).map(|(x, z)| [*x, 0.0, z, 100.0]).collect();
        let labels: Vec<Label> = classify(&mut thesis(16), &column, None).into_iter().map(|(l, _)| l).collect();
        assert_eq!(labels, [Overhanging, Floor, Floor, Obstacle, Obstacle, Floor, Floor, Unknown]);
    }

    #[test]
    fn scores_are_those_of_the_equations() {
        let mut node = ColumnClassifier { alpha: 1.0, beta: 0.0, ..thesis(16) };
        // Above the mean: the difference of the slopes; below: the smaller one.
        let p = classify(&mut node, &[[1.1, 0.0, 0.02, 0.0], [1.0, 0.0, 0.1, 0.0], [0.9, 0.0, 0.09, 0.0]], None)[1].1;
        assert!((p - (0.8_f32.atan() - 0.1_f32.atan())).abs() < 1e-4, "{p}");
        let p = classify(&mut node, &[[1.1, 0.0, 0.08, 0.0], [1.0, 0.0, 0.0, 0.0], [0.9, 0.0, 0.09, 0.0]], None)[1].1;
        assert!((p - 0.8_f32.atan()).abs() < 1e-4, "{p}");
        let p = classify(&mut node, &[[1.1, 0.0, 0.004, 0.0], [1.0, 0.0, 0.0, 0.0], [0.9, 0.0, 0.005, 0.0]], None)[1].1;
        assert_eq!(p, 0.0, "lower than 1 cm");
        let mut node = ColumnClassifier { alpha: 0.0, beta: 1.0, ..thesis(16) };
        let flat = |intensity: [f32; 3]| {
            let column: Vec<[f32; 4]> = (0..3).map(|i| [1.2 - 0.1 * i as f32, 0.0, 0.0, intensity[i]]).collect();
            column
        };
        assert_eq!(classify(&mut node, &flat([100.0, 400.0, 350.0]), None)[1].1, 0.3);
        assert_eq!(classify(&mut node, &flat([1100.0, 1001.0, 1100.0]), None)[1].1, 1.0);
    }

    #[test]
    fn elevation_sees_flat_tops_and_depth_sees_stairs() {
        let floor = FloorSurface::default();
        let mut node = ColumnClassifier { gamma: 1.0, ..thesis(16) };
        let flat = |z: f32| -> Vec<[f32; 4]> { (0..5).map(|i| [1.2 - 0.1 * i as f32, 0.0, z, 9.0]).collect() };
        assert!(classify(&mut node, &flat(0.07), Some(&floor)).iter().all(|(l, p)| *l == Label::Obstacle && *p == 1.0));
        assert!(classify(&mut node, &flat(0.0), Some(&floor)).iter().all(|(l, _)| *l == Label::Floor));
        assert!(classify(&mut thesis(16), &flat(-0.2), None).iter().all(|(l, _)| *l == Label::Below));
    }

    #[test]
    fn the_search_ends_after_its_steps() {
        let mut column = vec![[1.0, 0.0, 0.0, 9.0]; 9];
        column[0][0] = 1.5;
        column[8][0] = 0.5;
        assert_eq!(classify(&mut thesis(3), &column, None)[4].0, Label::Unknown);
        assert_eq!(classify(&mut thesis(4), &column, None)[4].0, Label::Floor);
        assert_eq!(classify(&mut thesis(4), &[], None), []);
        assert_eq!(classify(&mut thesis(4), &[[f32::NAN; 4]; 3], None), [(Label::Missing, 0.0); 3]);
    }
}

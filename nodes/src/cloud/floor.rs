use super::{Columns, Label, Labels};
use apex_rt::node;

/// Smooth surface of the floor before the robot: z as a quadratic polynomial of x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FloorSurface {
    /// Coefficients of 1, x, y, x², xy and y², in m and its powers.
    pub coefficients: [f32; 6],
    /// Distance up to which the polynomial holds, in m. Beyond, the surface keeps its angle of elevation.
    pub reach: f32,
}

/// Plane z = 0.
impl Default for FloorSurface {
    fn default() -> Self {
        Self { coefficients: [0.0; 6], reach: 1.0 }
    }
}

impl FloorSurface {
    /// Height of the floor at a point, in m.
    #[inline]
    pub fn height(&self, x: f32, y: f32) -> f32 {
        let distance = libm::sqrtf(x * x + y * y);
        let scale = if distance > self.reach { self.reach / distance } else { 1.0 };
        let (x, y) = (x * scale, y * scale);
        let [c, cx, cy, cxx, cxy, cyy] = self.coefficients;
        (c + x * (cx + cxx * x + cxy * y) + y * (cy + cyy * y)) / scale
    }
}

/// Fits a smooth surface to the floor, which distortions of the camera bend (thesis 6.4.2, fig. 6.6: a plane does not
/// fit).
///
/// Robust least squares with a sample of the unknown points. Angles of elevation, seen from the camera, are fitted, as
/// the error of a height grows with distance. Points above the surface count less than those below, since objects
/// stand on the floor. Where there is no floor in view, the surface is that of the mounted camera: z = 0. Not part of
/// the thesis. The output is ⊥ if points and labels differ in size.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct FloorFit {
    /// Maximum height of the floor in the cloud, above and below z = 0.
    #[param(unit = "m", default = 0.12, range = 0.001..=10.0)]
    band: f32,
    /// Deviation of the points of the floor from the surface, as an angle of elevation.
    #[param(unit = "rad", default = 0.005, range = 0.0001..=0.5)]
    deviation: f32,
    /// Distance up to which points are used.
    #[param(unit = "m", default = 3.0, range = 0.1..=100.0)]
    reach: f32,
    /// Height by which the distortion bends the floor at 1 m: standard deviation; 0 for a plane.
    #[param(unit = "m", default = 0.02, range = 0.0..=1.0)]
    bend: f32,
    samples: Vec<Sample>,
}

/// Point near the floor, scaled by its distance from the camera.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Values of 1, x, y, x², xy, y² over the distance.
    terms: [f32; 6],
    /// Angle of elevation over z = 0.
    elevation: f32,
}

/// Maximum number of samples.
const SAMPLES: usize = 1600;
/// Standard deviations of height (in m) and slopes of the mounting.
const MOUNTING: [f32; 3] = [0.05, 0.02, 0.02];
/// Minimum standard deviation of a coefficient, so that it can be divided by.
const LEAST: f32 = 1e-6;
/// Deviations in the iterations, in multiples of the last one: the first ones accept more points.
const SCHEDULE: [f32; 6] = [6.0, 4.0, 3.0, 2.0, 1.5, 1.0];

#[node]
impl FloorFit {
    fn process(&mut self, points: &Columns, labels: &Labels) -> Option<FloorSurface> {
        if !points.fits(labels) {
            return None;
        }
        self.sample(points, labels);
        let mut surface = FloorSurface { reach: self.reach, ..FloorSurface::default() };
        for scale in SCHEDULE {
            surface.coefficients = self.fit(&surface.coefficients, scale * self.deviation);
        }
        Some(surface)
    }

    fn sample(&mut self, points: &Columns, labels: &Labels) {
        self.samples.clear();
        let mut step = points.len().div_ceil(SAMPLES).max(1);
        // Every row has to be sampled, not the same few ones in each column.
        while step > 1 && points.height.is_multiple_of(step) {
            step += 1;
        }
        for i in (0..points.len()).step_by(step) {
            let (x, y, z) = (points.x[i], points.y[i], points.z[i]);
            let distance = libm::hypotf(x - points.origin[0], y - points.origin[1]);
            let is_near = labels.labels[i] == Label::Unknown && z.abs() <= self.band;
            if is_near && distance > 0.0 && libm::hypotf(x, y) <= self.reach {
                let terms = [1.0, x, y, x * x, x * y, y * y].map(|term| term / distance);
                self.samples.push(Sample { terms, elevation: z / distance });
            }
        }
    }

    /// One step of iteratively reweighted least squares.
    fn fit(&self, last: &[f32; 6], deviation: f32) -> [f32; 6] {
        let mut matrix = [[0.0_f64; 6]; 6];
        let mut right = [0.0_f64; 6];
        for (i, sigma) in MOUNTING.iter().chain(&[self.bend.max(LEAST); 3]).enumerate() {
            matrix[i][i] = f64::from(deviation / sigma).powi(2);
        }
        for Sample { terms, elevation } in &self.samples {
            let fitted: f32 = terms.iter().zip(last).map(|(term, c)| term * c).sum();
            let error = (elevation - fitted) / deviation;
            let error = if error > 0.0 { error } else { error / 3.0 };
            let weight = f64::from(1.0 / (1.0 + error.powi(4)));
            for i in 0..6 {
                let weighted = weight * f64::from(terms[i]);
                right[i] += weighted * f64::from(*elevation);
                for j in 0..=i {
                    matrix[i][j] += weighted * f64::from(terms[j]);
                }
            }
        }
        solve(matrix, right).map(|c| c as f32)
    }
}

/// Solves a symmetric positive definite system, given by its lower triangle (Cholesky).
fn solve<const N: usize>(mut a: [[f64; N]; N], mut b: [f64; N]) -> [f64; N] {
    for i in 0..N {
        for j in 0..=i {
            let sum: f64 = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            // The prior keeps the diagonal positive.
            a[i][j] = if i == j { sum.max(f64::MIN_POSITIVE).sqrt() } else { sum / a[j][j] };
        }
    }
    for i in 0..N {
        b[i] = (b[i] - (0..i).map(|k| a[i][k] * b[k]).sum::<f64>()) / a[i][i];
    }
    for i in (0..N).rev() {
        b[i] = (b[i] - (i + 1..N).map(|k| a[k][i] * b[k]).sum::<f64>()) / a[i][i];
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::columns::tests::columns;
    use apex_rt::Construct;

    fn surface(height: usize, points: &[[f32; 4]]) -> FloorSurface {
        let (points, labels) = columns(height, points);
        FloorFit::construct((0.12, 0.005, 3.0, 0.02)).process(&points, &labels).expect("labels for all points")
    }

    #[test]
    fn a_bent_floor_with_objects_is_found() {
        let bent = |x: f32, y: f32| 0.01 + 0.01 * x - 0.008 * x * x + 0.006 * y * y;
        let point = |i: usize| {
            let (x, y) = (0.6 + 0.01 * (i % 200) as f32, -1.0 + 0.02 * (i / 200) as f32);
            let object = if i % 200 > 100 && i % 200 < 130 && (20..50).contains(&(i / 200)) { 0.08 } else { 0.0 };
            [x, y, bent(x, y) + object, 1.0]
        };
        let points: Vec<[f32; 4]> = (0..20_000).map(point).collect();
        let fitted = surface(200, &points);
        for [x, y, ..] in points {
            assert!((fitted.height(x, y) - bent(x, y)).abs() < 0.005, "{x} {y} {}", fitted.height(x, y));
        }
    }

    #[test]
    fn without_a_floor_it_is_the_plane_of_the_robot() {
        for points in [vec![], vec![[f32::NAN; 4]; 12], vec![[1.0, 0.0, 5.0, 1.0]; 12]] {
            assert_eq!(surface(4, &points).coefficients, [0.0; 6]);
        }
        assert_eq!(surface(1, &[[0.0, 0.0, 0.0, 1.0]]).coefficients, [0.0; 6], "below the camera");
    }

    #[test]
    fn beyond_its_reach_the_surface_keeps_its_elevation() {
        let surface = FloorSurface { coefficients: [0.0, 0.0, 0.0, 0.01, 0.0, 0.0], reach: 2.0 };
        assert!((surface.height(2.0, 0.0) - 0.04).abs() < 1e-6 && (surface.height(6.0, 0.0) - 0.12).abs() < 1e-6);
        assert_eq!(surface.height(0.0, 0.0), 0.0);
    }
}

use apex_nodes::cloud::PointCloud;
use apex_sim::Random;

/// Plane of the floor in the frame of a camera, found by RANSAC (Fischler and Bolles 1981): the method that obstacle
/// detection is compared with. The score of a point is its height over the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Normal that points up, of length 1.
    pub normal: [f64; 3],
    /// Height of the camera over the plane, in m.
    pub height: f64,
}

/// Maximum distance of an inlier from the plane, in m.
const INLIER: f64 = 0.015;
const ROUNDS: usize = 300;
/// Minimum upward part of a normal: walls are not a floor.
const LEAST_UP: f64 = 0.5;

impl Plane {
    /// Finds the plane with the most inliers among those that are not steeper than 60° in the frame of the camera, and
    /// fits it to its inliers. `None` if there are fewer than three points or all on a line.
    pub fn find(cloud: &PointCloud, random: &mut Random) -> Option<Self> {
        let points = cloud.points().iter().filter(|p| p.is_measured());
        let points: Vec<[f64; 3]> = points.map(|p| [p.x, p.y, p.z].map(f64::from)).collect();
        // A sample is enough for counting.
        let sample: Vec<[f64; 3]> = points.iter().step_by(points.len().div_ceil(4000).max(1)).copied().collect();
        let pick = |random: &mut Random| sample[(random.unit() * sample.len() as f64) as usize];
        let mut best: Option<(usize, Self)> = None;
        for _ in 0..if sample.len() < 3 { 0 } else { ROUNDS } {
            let Some(plane) = Self::through([pick(random), pick(random), pick(random)]) else { continue };
            let count = sample.iter().filter(|p| plane.over(**p).abs() < INLIER).count();
            if best.is_none_or(|(most, _)| count > most) {
                best = Some((count, plane));
            }
        }
        best.map(|(_, plane)| plane.refined(&points))
    }

    /// Height of a point over the plane, in m.
    pub fn over(&self, point: [f64; 3]) -> f64 {
        dot(self.normal, point) + self.height
    }

    fn through([a, b, c]: [[f64; 3]; 3]) -> Option<Self> {
        let (u, v) = (sub(b, a), sub(c, a));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let length = dot(normal, normal).sqrt();
        let length = if normal[2] < 0.0 { -length } else { length };
        let normal = normal.map(|x| x / length);
        // False for NaN: three points on a line.
        (normal[2] >= LEAST_UP).then(|| Self { normal, height: -dot(normal, a) })
    }

    /// Least squares with the inliers: heights over this plane as a linear function of the place.
    fn refined(&self, points: &[[f64; 3]]) -> Self {
        let mut sums = [[0.0; 4]; 3];
        for p in points.iter().filter(|p| self.over(**p).abs() < INLIER) {
            let (terms, rise) = ([1.0, p[0], p[1]], self.over(*p));
            for (row, term) in sums.iter_mut().zip(terms) {
                (0..3).for_each(|k| row[k] += term * terms[k]);
                row[3] += term * rise;
            }
        }
        let Some([c, cx, cy]) = solve(sums) else { return *self };
        // over(p) − c − cx·x − cy·y = 0, with a normal of length 1.
        let normal = [self.normal[0] - cx, self.normal[1] - cy, self.normal[2]];
        let length = dot(normal, normal).sqrt();
        Self { normal: normal.map(|x| x / length), height: (self.height - c) / length }
    }
}

/// Solves three equations (Cramer). `None` if they are not independent.
fn solve(m: [[f64; 4]; 3]) -> Option<[f64; 3]> {
    let determinant = |columns: [usize; 3]| {
        let [a, b, c] = columns.map(|k| [m[0][k], m[1][k], m[2][k]]);
        a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1])
    };
    let whole = determinant([0, 1, 2]);
    let parts = [[3, 1, 2], [0, 3, 2], [0, 1, 3]].map(|columns| determinant(columns) / whole);
    parts.iter().all(|part| part.is_finite()).then_some(parts)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::cloud::CloudPoint;
    use apex_rt::Time;

    fn cloud(points: &[[f32; 3]]) -> PointCloud {
        let mut cloud = PointCloud::default();
        cloud.reset(Time::ZERO, (points.len(), 1));
        for (point, [x, y, z]) in cloud.points_mut().iter_mut().zip(points) {
            *point = CloudPoint { x: *x, y: *y, z: *z, intensity: 0.0 };
        }
        cloud
    }

    #[test]
    fn a_floor_is_found_under_a_wall_and_a_box() {
        let mut points = vec![];
        for i in 0..4000 {
            let (x, y) = (0.5 + 0.001 * i as f32, ((i * 37) % 100) as f32 * 0.02 - 1.0);
            points.push([x, y, -0.5 + 0.1 * x - 0.02 * y]);
            points.push([4.0, y, 0.001 * i as f32]);
        }
        let plane = Plane::find(&cloud(&points), &mut Random::new(1)).expect("a floor");
        assert!(points.iter().step_by(2).all(|p| plane.over(p.map(f64::from)).abs() < 1e-3), "{plane:?}");
        assert!((plane.over([1.0, 0.0, 0.1]) - 0.5 / (1.0_f64 + 0.0104).sqrt()).abs() < 1e-3);
    }

    #[test]
    fn too_few_points_have_no_plane() {
        for points in [vec![], vec![[f32::NAN; 3]; 9], vec![[1.0, 0.0, 0.0]; 9], vec![[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]]
        {
            assert_eq!(Plane::find(&cloud(&points), &mut Random::new(1)), None);
        }
    }
}

use super::{Clusters, Columns};
use crate::scan::{Container, Point2, Pose2};
use apex_rt::node;
use libm::{fabsf, sqrtf};

/// Distance around the model within which points are looked at, in m: the error of the prior pose.
const REACH: f32 = 0.25;
/// Maximum distance of a point from the face of the body that it is fitted to, in m: in the first step and in the later
/// ones.
const NEAR_FACE: [f32; 2] = [0.1, 0.04];
/// Number of steps of the least-squares fit.
const STEPS: usize = 4;
/// Weights of the prior position along and across and of the prior heading (in m²), for each fitted point: what the
/// points have in common, such as the static errors of a camera, is not averaged out by their number.
const PRIOR: [f32; 3] = [0.05, 0.08, 0.02];
/// Weight of the middle between the edges of the near face, for each fitted point.
const MIDDLE: f32 = 0.04;
/// Maximum number of points that are fitted.
const MAX_FITTED: usize = 1500;

/// Verifies a container that was found in a laser scan, by its body in a point cloud, and corrects its pose (thesis
/// 6.6.2).
///
/// `container` is in the frame of the columns, with its error of some centimetres: castors hide where the body is. The
/// points of clusters near it are split at the height of the body (eqs. 6.20 and 6.21). The nearest ones of its upper
/// part give the offset along its axis (eqs. 6.22 to 6.25). It is verified if enough points are in its body and in its
/// wheel boxes and few beside them (eqs. 6.26 and 6.27). Otherwise, and without clusters near it, the output is ⊥.
///
/// Extension of the thesis, which leaves it to the future: the pose is then fitted to the points of the visible faces
/// of the body by least squares, with the prior pose as a further measurement.
///
/// Equation 6.22 is printed with −l/2; the near face is at −l/2, so that the offset is the mean plus l/2 if the
/// container's x axis leads away from the robot, as it does here.
#[node]
#[derive(Debug, Clone)]
pub struct VerifyContainer {
    /// Length of the body (l).
    #[param(unit = "m", default = 1.2, range = 0.05..=10.0)]
    length: f32,
    /// Width of the body (w).
    #[param(unit = "m", default = 0.7, range = 0.05..=10.0)]
    width: f32,
    /// Height of the body above the floor (h_t).
    #[param(unit = "m", default = 0.22, range = 0.0..=10.0)]
    body: f32,
    /// Depth of the nearest points of the body (δ_o).
    #[param(unit = "m", default = 0.05, range = 0.001..=1.0)]
    depth: f32,
    /// Tolerance of the boxes of the model.
    #[param(unit = "m", default = 0.05, range = 0.0..=1.0)]
    tolerance: f32,
    /// Minimum number of points in the model (d_I).
    #[param(default = 100, range = 1..=1_000_000)]
    min_inliers: u32,
    /// Maximum number of points beside the model, per point in it (d_O). A share, because the number of points grows
    /// towards the robot.
    #[param(default = 0.1, range = 0.0..=10.0)]
    max_outliers: f32,
    /// Wheels: rows of `[x, y, length, width]` in metres, as those of `ContainerSearch`.
    #[param(unit = "m")]
    boxes: &'static [[f32; 4]],
    /// Points of the body, in the frame of the prior pose.
    upper: Vec<Point2>,
    /// Points at the height of its lower edge, within the tolerance.
    edge: Vec<Point2>,
}

#[node]
impl VerifyContainer {
    fn process(&mut self, columns: &Columns, clusters: &Clusters, container: &Container) -> Option<Container> {
        if !columns.is_whole() || clusters.points != columns.len() || !container.pose.is_finite() {
            return None;
        }
        let counts = self.collect(columns, clusters, &container.pose)?;
        let offset = self.offset()?;
        let counts = self.count(counts, offset);
        let [inliers, outliers] = [counts.inliers, counts.outliers];
        if inliers < self.min_inliers || outliers as f32 > self.max_outliers * inliers as f32 {
            return None;
        }
        let refined = self.refine(Pose2::new(offset, 0.0, 0.0));
        Some(Container { pose: container.pose.compose(&refined), ..*container })
    }

    /// Splits the points near the container at the height of the body (eqs. 6.19 to 6.21): keeps those of the body and
    /// of its lower edge, and counts the others. `None` if nothing is near.
    fn collect(&mut self, columns: &Columns, clusters: &Clusters, pose: &Pose2) -> Option<Counts> {
        self.upper.clear();
        self.edge.clear();
        let mut counts = Counts::default();
        let (sin, cos) = libm::sincosf(pose.theta);
        let (x, y) = (0.5 * self.length + REACH, 0.5 * self.width + REACH);
        // Members of other columns, such as those of a broken recording, are left out.
        let indices = clusters.members.iter().map(|member| member.point as usize);
        for i in indices.filter(|i| *i < columns.len()) {
            let d = Point2::new(columns.x[i] - pose.x, columns.y[i] - pose.y);
            let p = Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x);
            if fabsf(p.x) > x || fabsf(p.y) > y {
                continue;
            }
            if columns.z[i] >= self.body {
                self.upper.push(p);
            } else if self.boxes.iter().any(|b| in_box(p, b, self.tolerance)) {
                counts.add(true);
            } else if columns.z[i] >= self.body - self.tolerance {
                self.edge.push(p);
            } else {
                counts.add(false);
            }
        }
        (!self.upper.is_empty()).then_some(counts)
    }

    /// Offset of the body along the axis of the prior pose (eqs. 6.22 to 6.24). Points beside the body do not count.
    fn offset(&self) -> Option<f32> {
        let ahead = || self.upper.iter().filter(|p| fabsf(p.y) <= 0.5 * self.width).map(|p| p.x);
        let nearest = ahead().fold(f32::INFINITY, f32::min);
        let front = ahead().filter(|x| x - nearest < self.depth);
        let (sum, count) = front.fold((0.0, 0_u32), |(sum, count), x| (sum + x, count + 1));
        (count > 0).then(|| sum / count as f32 + 0.5 * self.length)
    }

    /// Adds the points of the body, at its offset, to the counts of those of the wheels (eqs. 6.26 and 6.27).
    fn count(&self, mut counts: Counts, offset: f32) -> Counts {
        let body = [offset, 0.0, self.length, self.width];
        self.upper.iter().chain(&self.edge).for_each(|p| counts.add(in_box(*p, &body, self.tolerance)));
        counts
    }

    /// Pose of the body in the frame of the prior pose: the least-squares fit of its near face and its sides, and of
    /// the prior pose, from the pose `start`.
    fn refine(&self, start: Pose2) -> Pose2 {
        let mut pose = start;
        let stride = self.upper.len() / MAX_FITTED + 1;
        let points = (self.upper.len() / stride) as f32;
        for step in 0..STEPS {
            let near = NEAR_FACE[usize::from(step > 0)];
            let mut normal = Normal::prior(&pose, points);
            let (sin, cos) = libm::sincosf(pose.theta);
            let mut span = [f32::INFINITY, f32::NEG_INFINITY];
            for q in self.upper.iter().step_by(stride) {
                let d = Point2::new(q.x - pose.x, q.y - pose.y);
                let p = Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x);
                let front = p.x + 0.5 * self.length;
                let side = fabsf(p.y) - 0.5 * self.width;
                if fabsf(front) <= near && side <= near {
                    normal.add([1.0, 0.0, -p.y], front);
                    span = [span[0].min(p.y), span[1].max(p.y)];
                } else if fabsf(side) <= near && fabsf(p.x) <= 0.5 * self.length {
                    let sign = if p.y > 0.0 { 1.0 } else { -1.0 };
                    normal.add([0.0, sign, sign * p.x], side);
                }
            }
            // If both edges of the near face are seen, its middle is known.
            if fabsf(span[1] - span[0] - self.width) < 2.0 * near {
                normal.add_weighted([0.0, 1.0, 0.0], 0.5 * (span[0] + span[1]), MIDDLE * points);
            }
            let Some([x, y, turn]) = normal.solve() else { break };
            pose = pose.compose(&Pose2::new(x, y, turn));
        }
        pose
    }
}

/// Numbers of points in the model and beside it.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    inliers: u32,
    outliers: u32,
}

impl Counts {
    fn add(&mut self, is_inside: bool) {
        self.inliers += u32::from(is_inside);
        self.outliers += u32::from(!is_inside);
    }
}

/// Normal equations of the changes in x, y and heading: the upper triangle, and the right side.
#[derive(Debug, Clone, Copy, Default)]
struct Normal {
    matrix: [f32; 6],
    right: [f32; 3],
}

impl Normal {
    /// Equations that hold a pose near the prior one, the origin of its frame, against a number of points.
    fn prior(pose: &Pose2, points: f32) -> Self {
        let mut normal = Self::default();
        let back = Pose2::default().relative_to(pose);
        let [x, y, turn] = PRIOR.map(|weight| weight * points);
        normal.add_weighted([1.0, 0.0, 0.0], back.x, x);
        normal.add_weighted([0.0, 1.0, 0.0], back.y, y);
        normal.add_weighted([0.0, 0.0, 1.0], back.theta, turn);
        normal
    }

    fn add(&mut self, gradient: [f32; 3], residual: f32) {
        self.add_weighted(gradient, residual, 1.0);
    }

    fn add_weighted(&mut self, [a, b, c]: [f32; 3], residual: f32, weight: f32) {
        let products = [a * a, a * b, a * c, b * b, b * c, c * c];
        self.matrix.iter_mut().zip(products).for_each(|(sum, product)| *sum += weight * product);
        self.right.iter_mut().zip([a, b, c]).for_each(|(sum, value)| *sum += weight * value * residual);
    }

    /// Solution by the Cholesky decomposition, or `None` if it is not unique.
    fn solve(&self) -> Option<[f32; 3]> {
        let [xx, xy, xt, yy, yt, tt] = self.matrix;
        let root = |square: f32| (square > 0.0 && square.is_finite()).then(|| sqrtf(square));
        let a = root(xx)?;
        let (b, c) = (xy / a, xt / a);
        let d = root(yy - b * b)?;
        let e = (yt - b * c) / d;
        let f = root(tt - c * c - e * e)?;
        let [x, y, t] = self.right;
        let u = x / a;
        let v = (y - b * u) / d;
        let turn = (t - c * u - e * v) / f / f;
        let across = (v - e * turn) / d;
        Some([(u - b * across - c * turn) / a, across, turn])
    }
}

/// Returns `true` if a point is in a box of centre, length and width that is larger by a tolerance on each side.
fn in_box(p: Point2, &[x, y, length, width]: &[f32; 4], tolerance: f32) -> bool {
    fabsf(p.x - x) <= 0.5 * length + tolerance && fabsf(p.y - y) <= 0.5 * width + tolerance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Cluster, Member};
    use apex_rt::Construct;

    const BOXES: &[[f32; 4]] = &[[-0.54, 0.32, 0.25, 0.25], [-0.54, -0.32, 0.25, 0.25]];

    fn node() -> VerifyContainer {
        VerifyContainer::construct((1.2, 0.7, 0.22, 0.05, 0.05, 100, 0.1, BOXES))
    }

    /// Columns with the near face and the left side of a container at `pose`, and `others`, in one cluster.
    fn scene(pose: &Pose2, others: &[[f32; 3]]) -> (Columns, Clusters) {
        let mut points = others.to_vec();
        for i in 0..400 {
            let (u, v) = ((i % 20) as f32 / 19.0 - 0.5, 0.25 + 0.01 * (i / 20) as f32);
            for local in [Point2::new(-0.6, 0.7 * u), Point2::new(1.2 * u, 0.35)] {
                let p = pose.to_outer(local);
                points.push([p.x, p.y, v]);
            }
        }
        let list = |i: usize| points.iter().map(|p| p[i]).collect();
        let intensity = vec![0.0; points.len()];
        let columns = Columns { height: 1, x: list(0), y: list(1), z: list(2), intensity, ..Columns::default() };
        let cluster = Cluster { points: points.len(), min: [0.0; 3], max: [4.0; 3] };
        let members = (0..points.len() as u32).map(|point| Member { point, cluster: 0 }).collect();
        (columns, Clusters { clusters: vec![cluster], members, points: points.len() })
    }

    fn prior(pose: Pose2) -> Container {
        Container { pose, error: 0.0, inliers: 5, outliers: 0, wheels: 4, model: 0 }
    }

    #[test]
    fn the_pose_is_that_of_the_body() {
        let truth = Pose2::new(2.0, 0.3, 0.2);
        let (columns, clusters) = scene(&truth, &[]);
        for off in [Pose2::new(0.08, 0.03, 0.05), Pose2::new(-0.07, -0.02, -0.06), Pose2::default()] {
            let found = node().process(&columns, &clusters, &prior(truth.compose(&off))).expect("a container");
            let error = found.pose.relative_to(&truth);
            // A tenth of the prior position is left, and a fifth of the heading.
            assert!(error.position().norm() < 0.009 && error.theta.abs() < 0.014, "{error:?} after {off:?}");
        }
    }

    #[test]
    fn the_lower_edge_of_the_body_belongs_to_it_and_what_is_beneath_does_not() {
        let truth = Pose2::new(2.0, 0.0, 0.0);
        let strip = |height| (0..300).map(|i| [1.42, 0.001 * i as f32 - 0.15, height]).collect::<Vec<_>>();
        let verified = |height| {
            let (columns, clusters) = scene(&truth, &strip(height));
            node().process(&columns, &clusters, &prior(truth)).is_some()
        };
        assert_eq!([verified(0.2), verified(0.15)], [true, false]);
    }

    #[test]
    fn the_offset_alone_is_that_of_the_thesis() {
        let truth = Pose2::new(2.0, 0.0, 0.0);
        let (columns, clusters) = scene(&truth, &[]);
        let mut node = node();
        node.collect(&columns, &clusters, &Pose2::new(1.93, 0.0, 0.0)).expect("points");
        // The mean of the nearest 5 cm of the side is a little behind the face.
        assert!((node.offset().expect("an offset") - 0.07).abs() < 0.005);
    }

    #[test]
    fn nothing_and_something_else_are_not_verified() {
        let truth = Pose2::new(2.0, 0.0, 0.0);
        let (columns, clusters) = scene(&truth, &[]);
        assert_eq!(node().process(&columns, &clusters, &prior(Pose2::new(5.0, 0.0, 0.0))), None);
        assert_eq!(VerifyContainer { min_inliers: 10_000, ..node() }.process(&columns, &clusters, &prior(truth)), None);
        // Boxes stand where the vehicle has to drive.
        let beneath: Vec<[f32; 3]> = (0..200).map(|i| [1.6 + 0.001 * i as f32, 0.0, 0.1]).collect();
        let (columns, clusters) = scene(&truth, &beneath);
        assert_eq!(node().process(&columns, &clusters, &prior(truth)), None);
        assert!(VerifyContainer { max_outliers: 1.0, ..node() }.process(&columns, &clusters, &prior(truth)).is_some());
    }

    #[test]
    fn bad_input_is_absent_output() {
        let truth = Pose2::new(2.0, 0.0, 0.0);
        let (columns, clusters) = scene(&truth, &[]);
        assert_eq!(node().process(&columns, &Clusters::default(), &prior(truth)), None);
        assert_eq!(node().process(&Columns::default(), &Clusters::default(), &prior(truth)), None);
        assert_eq!(node().process(&columns, &clusters, &prior(Pose2::new(f32::NAN, 0.0, 0.0))), None);
    }
}

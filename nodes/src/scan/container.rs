use super::{Consensus, MAX_BEAMS, Point2, Pose2, Scan, Segment, Segments, WheelBoxes, consensus::BoxModel};
use apex_rt::node;
use core::f32::consts::PI;
use heapless::Vec;

/// A container that was found in a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Container {
    /// Its centre and heading in the frame of the scanner. The heading leads from its near wheels to its far ones.
    pub pose: Pose2,
    /// Squared deviation of the distance of the near wheels, in m² (ε, thesis eq. 6.18).
    pub error: f32,
    /// The points that agree with the model, and those that do not.
    pub consensus: Consensus,
}

/// Finds a container by two of its wheels (thesis 6.6.1).
///
/// Every ordered pair of segments is taken as the two near wheels. Pairs at the wrong distance are dropped (δ_w); the
/// others give a pose (eqs. 6.12–6.16), at which the points of the scan must agree with the box model (eq. 6.17).
/// Of the poses that do, the one with the smallest error ε wins (eq. 6.18); ⊥ if there is none. As pairs with a larger ε
/// than the best so far cannot win, their points are not looked at.
///
/// Beyond the thesis, a number of wheel boxes must hold a point, and the model may be limited to be seen from the front. The defaults
/// are for a container on four castors; a pallet on nine feet differs in numbers only.
///
/// Cost: O(s²) for s segments, and O(points) for a pair that is neither pruned nor dropped. Allocates nothing.
#[node]
#[derive(Debug, Clone)]
pub struct ContainerSearch {
    /// Distance of the outer sides of the wheels, across (w).
    #[param(unit = "m", default = 0.7, range = 0.05..=10.0)]
    width: f32,
    /// Distance of the outer sides of the wheels, along (l).
    #[param(unit = "m", default = 1.2, range = 0.05..=10.0)]
    length: f32,
    /// Size of a wheel across (w_w).
    #[param(unit = "m", default = 0.04, range = 0.0..=1.0)]
    wheel_width: f32,
    /// Size of a wheel along (w_l).
    #[param(unit = "m", default = 0.125, range = 0.0..=1.0)]
    wheel_length: f32,
    /// How much the width of a hypothesis may differ from `width` (δ_w).
    #[param(unit = "m", default = 0.15, range = 0.0..=2.0)]
    width_tolerance: f32,
    /// Fewest points in wheel boxes (d_I).
    #[param(default = 6, range = 0..=10_000)]
    min_inliers: u16,
    /// So many points in the footprint beside the wheels refute the hypothesis (d_O).
    #[param(default = 5, range = 1..=10_000)]
    max_outliers: u16,
    /// Fewest wheel boxes that must hold a point. Two always do, by construction.
    #[param(default = 3, range = 0..=100)]
    min_wheels: usize,
    /// Largest angle between the line of sight to the centre and the heading: how much from the side it may be seen.
    #[param(unit = "rad", default = PI, range = 0.0..=PI)]
    max_view_angle: f32,
    /// The wheels: rows of `[x, y, length, width]` in metres, in the frame of the container, whose origin is its centre.
    #[param]
    boxes: &'static [[f32; 4]],
    points: Vec<Point2, MAX_BEAMS>,
}

#[node]
impl ContainerSearch {
    fn process(&mut self, scan: &Scan, segments: &Segments) -> Option<Container> {
        self.points.clear();
        self.points.extend(scan.points().map(|(_, p)| p));
        let mut best = None;
        for (i, a) in segments.iter().enumerate() {
            for b in &segments[i + 1..] {
                self.try_pair(a, b, &mut best);
            }
        }
        best
    }

    /// Replaces `best` if the pair, in one of its two orders, gives a better container.
    fn try_pair(&self, a: &Segment, b: &Segment, best: &mut Option<Container>) {
        let (a, b) = (a.mid_range(), b.mid_range());
        let distance = (b - a).norm();
        if !((distance + self.wheel_width - self.width).abs() <= self.width_tolerance) {
            return;
        }
        let deviation = (self.width - self.wheel_width).abs() - distance;
        let error = deviation * deviation;
        for (a, b) in [(a, b), (b, a)] {
            if best.is_none_or(|best| error < best.error) {
                let found = self.pose(a, b).and_then(|pose| self.agree(pose));
                *best = found.map(|(pose, consensus)| Container { pose, error, consensus }).or(*best);
            }
        }
    }

    /// The pose of a container with its near wheels at `a` and `b` (thesis eqs. 6.12–6.16); `None` if it cannot be seen so.
    fn pose(&self, a: Point2, b: Point2) -> Option<Pose2> {
        let u = b - a;
        let across = u.norm();
        if across == 0.0 {
            return None;
        }
        let v = u.perpendicular().scaled((self.length - self.wheel_length) / across);
        let centre = a + (u + v).scaled(0.5);
        let aligned = centre.dot(v) >= libm::cosf(self.max_view_angle) * centre.norm() * v.norm();
        (aligned || self.max_view_angle >= PI).then(|| Pose2::new(centre.x, centre.y, v.angle()))
    }

    /// The consensus at a pose; `None` if the points do not agree with the model.
    fn agree(&self, pose: Pose2) -> Option<(Pose2, Consensus)> {
        let model = BoxModel { length: self.length, width: self.width, wheels: self.boxes };
        let consensus = model.consensus(&pose, &self.points, self.max_outliers);
        let agrees = consensus.inliers >= self.min_inliers
            && consensus.outliers < self.max_outliers
            && model.occupied(&pose, &self.points) >= self.min_wheels;
        agrees.then_some((pose, consensus))
    }
}

use super::{MAX_BEAMS, Point2, Pose2};
use heapless::Vec;

/// Where wheels (or feet) are: rows of x and y of the centre, length along x and width along y, in metres, in the
/// frame of the container, whose origin is its centre.
pub type WheelBoxes = &'static [[f32; 4]];

/// How well points agree with a box model at a pose (thesis 6.6.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Consensus {
    /// Points in a wheel box: |I|.
    pub inliers: u16,
    /// Points in the footprint, but in no wheel box: |O|.
    pub outliers: u16,
}

/// The box model of a container: footprint and wheels.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxModel {
    pub length: f32,
    pub width: f32,
    pub wheels: WheelBoxes,
}

impl BoxModel {
    /// Counts inliers and outliers. Stops counting at `max_outliers`: the hypothesis has failed by then.
    pub fn consensus(&self, pose: &Pose2, points: &Vec<Point2, MAX_BEAMS>, max_outliers: u16) -> Consensus {
        let mut count = Consensus::default();
        for p in self.nearby(pose, points) {
            if self.wheels.iter().any(|wheel| in_box(p, wheel)) {
                count.inliers += 1;
            } else if in_box(p, &[0.0, 0.0, self.length, self.width]) {
                count.outliers += 1;
                if count.outliers >= max_outliers {
                    break;
                }
            }
        }
        count
    }

    /// How many of the wheel boxes hold a point.
    pub fn occupied(&self, pose: &Pose2, points: &Vec<Point2, MAX_BEAMS>) -> usize {
        self.wheels.iter().filter(|wheel| self.nearby(pose, points).any(|p| in_box(p, wheel))).count()
    }

    /// The points that can lie in the model at all, in its frame.
    fn nearby<'a>(&self, pose: &Pose2, points: &'a [Point2]) -> impl Iterator<Item = Point2> + use<'a> {
        let reach = self.reach_squared();
        let (sin, cos) = libm::sincosf(pose.theta);
        let centre = pose.position();
        points.iter().filter_map(move |&p| {
            let d = p - centre;
            (d.norm_squared() <= reach).then(|| Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x))
        })
    }

    /// Square of the radius around the centre beyond which nothing of the model lies.
    fn reach_squared(&self) -> f32 {
        let footprint = [0.0, 0.0, self.length, self.width];
        let corner = |b: &[f32; 4]| Point2::new(b[0].abs() + 0.5 * b[2], b[1].abs() + 0.5 * b[3]).norm_squared();
        self.wheels.iter().map(corner).fold(corner(&footprint), f32::max)
    }
}

/// Whether a point lies in a box of centre, length and width; the border belongs to it.
#[inline]
fn in_box(p: Point2, &[x, y, length, width]: &[f32; 4]) -> bool {
    (p.x - x).abs() <= 0.5 * length && (p.y - y).abs() <= 0.5 * width
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    const MODEL: BoxModel =
        BoxModel { length: 2.0, width: 1.0, wheels: &[[-0.9, 0.4, 0.2, 0.2], [-0.9, -0.4, 0.2, 0.2], [1.5, 0.0, 0.2, 0.2]] };

    #[test]
    fn points_are_inliers_outliers_or_elsewhere() {
        // The container stands at (3, 1) and faces left: its x axis is the y axis of the scanner.
        let pose = Pose2::new(3.0, 1.0, FRAC_PI_2);
        let inner = [(-0.9, 0.4), (-0.85, -0.45), (0.0, 0.0), (0.9, 0.45), (0.0, 0.6), (1.5, 0.0), (5.0, 0.0)];
        let points: Vec<Point2, MAX_BEAMS> = inner.iter().map(|&(x, y)| pose.to_outer(Point2::new(x, y))).collect();
        assert_eq!(MODEL.consensus(&pose, &points, 100), Consensus { inliers: 3, outliers: 2 });
        assert_eq!(MODEL.occupied(&pose, &points), 3);
        assert_eq!(MODEL.consensus(&pose, &points, 1).outliers, 1);
    }

    #[test]
    fn no_points_no_consensus() {
        assert_eq!(MODEL.consensus(&Pose2::default(), &Vec::new(), 1), Consensus::default());
        assert_eq!(MODEL.occupied(&Pose2::default(), &Vec::new()), 0);
    }
}

use super::{Point2, Pose2, Scan};
use core::ops::Range;

/// Agreement of points with a box model at a pose (thesis 6.6.1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Consensus {
    /// Number of points in wheel boxes: |I|.
    pub inliers: u16,
    /// Number of points in the footprint, but in no wheel box: |O|.
    pub outliers: u16,
}

/// Visibility of the wheels of a model at a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Sighting {
    /// Number of wheel boxes that contain a point.
    pub seen: usize,
    /// Number of wheel boxes that contain no point although nothing hides them.
    pub missing: usize,
}

/// Box model of a container: footprint and wheels, in m, in the frame of the container.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxModel {
    pub length: f32,
    pub width: f32,
    /// Wheel boxes: rows of x and y of the centre, length along x and width along y.
    pub wheels: &'static [[f32; 4]],
    /// Length of the strip before the container that also has to be free.
    pub clearance: f32,
}

impl BoxModel {
    /// Counts inliers and outliers. Stops at `max_outliers`, as the hypothesis has then failed.
    pub fn consensus(&self, pose: &Pose2, points: &[Point2], max_outliers: u16) -> Consensus {
        let mut count = Consensus::default();
        for p in self.nearby(pose, points) {
            if self.wheels.iter().any(|wheel| in_box(p, wheel)) {
                count.inliers += 1;
            } else if in_box(p, &self.footprint()) {
                count.outliers += 1;
                if count.outliers >= max_outliers {
                    break;
                }
            }
        }
        count
    }

    /// Counts the seen and missing wheels. Only points of segments that could be wheels count, as the points of a wall
    /// would also fill a wheel box.
    pub fn sighting(&self, pose: &Pose2, candidates: &[Point2], scan: &Scan) -> Sighting {
        let mut sighting = Sighting::default();
        for wheel in self.wheels {
            if self.nearby(pose, candidates).any(|p| in_box(p, wheel)) {
                sighting.seen += 1;
            } else if in_plain_view(pose.to_outer(Point2::new(wheel[0], wheel[1])), scan) {
                sighting.missing += 1;
            }
        }
        sighting
    }

    /// Beams that can hit the model at `pose`: those between its two outermost lines of sight.
    pub fn beams(&self, pose: &Pose2, scan: &Scan) -> Range<usize> {
        let all = 0..scan.ranges.len();
        let (distance, reach) = (pose.position().norm(), libm::sqrtf(self.reach_squared()));
        if distance <= reach {
            return all;
        }
        let (bearing, half) = (pose.position().angle(), libm::asinf(reach / distance));
        match (scan.beam_towards(bearing - half), scan.beam_towards(bearing + half)) {
            (Some(a), Some(b)) if (a <= b) == (scan.angle_increment > 0.0) => {
                // One more on each side, as both are rounded.
                a.min(b).saturating_sub(1)..(a.max(b) + 2).min(all.end)
            }
            // The model reaches out of the field of view, or across the seam of a full turn.
            _ => all,
        }
    }

    /// Points that may be inside the model, in its frame. NaN is dropped.
    fn nearby<'a>(&self, pose: &Pose2, points: &'a [Point2]) -> impl Iterator<Item = Point2> + use<'a> {
        let reach = self.reach_squared();
        let (sin, cos) = libm::sincosf(pose.theta);
        let centre = pose.position();
        points.iter().filter_map(move |&p| {
            let d = p - centre;
            (d.norm_squared() <= reach).then(|| Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x))
        })
    }

    /// Box in which only wheels may stand: the container and the strip before it.
    fn footprint(&self) -> [f32; 4] {
        [-0.5 * self.clearance, 0.0, self.length + self.clearance, self.width]
    }

    /// Square of the radius around the centre that contains the whole model.
    fn reach_squared(&self) -> f32 {
        let corner = |b: &[f32; 4]| Point2::new(b[0].abs() + 0.5 * b[2], b[1].abs() + 0.5 * b[3]).norm_squared();
        self.wheels.iter().map(corner).fold(corner(&self.footprint()), f32::max)
    }
}

/// Returns `true` if the beam towards `point` and its neighbours measured beyond it. A beam without a measurement
/// counts as hidden.
fn in_plain_view(point: Point2, scan: &Scan) -> bool {
    let distance = point.norm();
    scan.beam_towards(point.angle()).is_some_and(|beam| {
        (beam.saturating_sub(1)..=beam + 1).all(|b| scan.range(b).is_some_and(|range| range > distance))
    })
}

/// Returns `true` if a point is in a box of centre, length and width, including its boundary.
#[inline]
fn in_box(p: Point2, &[x, y, length, width]: &[f32; 4]) -> bool {
    (p.x - x).abs() <= 0.5 * length && (p.y - y).abs() <= 0.5 * width
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    const MODEL: BoxModel = BoxModel {
        length: 2.0,
        width: 1.0,
        wheels: &[[-0.9, 0.4, 0.2, 0.2], [-0.9, -0.4, 0.2, 0.2], [1.5, 0.0, 0.2, 0.2]],
        clearance: 0.0,
    };

    #[test]
    fn points_are_inliers_outliers_or_elsewhere() {
        // The container is at (3, 1) and faces left: its x axis is the y axis of the scanner.
        let pose = Pose2::new(3.0, 1.0, FRAC_PI_2);
        let inner = [(-0.9, 0.4), (-0.85, -0.45), (0.0, 0.0), (0.9, 0.45), (0.0, 0.6), (1.5, 0.0), (5.0, 0.0)];
        let points = inner.map(|(x, y)| pose.to_outer(Point2::new(x, y)));
        assert_eq!(MODEL.consensus(&pose, &points, 100), Consensus { inliers: 3, outliers: 2 });
        assert_eq!(MODEL.consensus(&pose, &points, 1).outliers, 1);
    }

    #[test]
    fn no_points_no_consensus() {
        assert_eq!(MODEL.consensus(&Pose2::default(), &[], 1), Consensus::default());
    }

    #[test]
    fn the_strip_before_the_container_has_to_be_free() {
        let points = [Point2::new(-1.2, 0.0), Point2::new(1.2, 0.0)];
        let outliers = |clearance| BoxModel { clearance, ..MODEL }.consensus(&Pose2::default(), &points, 100).outliers;
        assert_eq!([outliers(0.0), outliers(0.3)], [0, 1]);
    }

    #[test]
    fn an_empty_wheel_box_is_missing_unless_something_hides_it() {
        // The scanner looks along x at a container 3 m away; all beams but those to its left near wheel end at 10 m.
        let pose = Pose2::new(3.0, 0.0, 0.0);
        let mut scan = Scan { angle_min: -0.5, angle_increment: 0.01, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([10.0; 101]);
        let near = pose.to_outer(Point2::new(-0.9, 0.4));
        let beam = scan.beam_towards(near.angle()).expect("in view");
        let sighting = |scan: &Scan| {
            let points: std::vec::Vec<Point2> = scan.points().map(|(_, p)| p).collect();
            MODEL.sighting(&pose, &points, scan)
        };
        scan.ranges[beam] = near.norm();
        assert_eq!(sighting(&scan), Sighting { seen: 1, missing: 2 });
        scan.ranges[beam] = 1.0;
        assert_eq!(sighting(&scan), Sighting { seen: 0, missing: 2 });
        scan.ranges[beam] = f32::NAN;
        assert_eq!(sighting(&scan), Sighting { seen: 0, missing: 2 });
        scan.ranges[beam] = 10.0;
        assert_eq!(sighting(&scan), Sighting { seen: 0, missing: 3 });
    }

    #[test]
    fn no_beam_that_can_hit_is_left_out() {
        let scanner = |angle_min: f32, angle_increment: f32| {
            let mut scan = Scan { angle_min, angle_increment, ..Scan::default() };
            scan.ranges.extend([1.0; 720]);
            scan
        };
        // Half a turn, half a turn clockwise, and a full turn with the seam behind the scanner.
        let (half, full) = (core::f32::consts::PI / 719.0, core::f32::consts::TAU / 720.0);
        for scan in [scanner(-FRAC_PI_2, half), scanner(FRAC_PI_2, -half), scanner(-2.0 * FRAC_PI_2, full)] {
            for bearing in [-3.1, -1.5, -0.4, 0.0, 0.9, 1.5, 3.1] {
                let at = Point2::polar(4.0, bearing);
                let pose = Pose2::new(at.x, at.y, 0.3);
                let beams = MODEL.beams(&pose, &scan);
                for beam in 0..720 {
                    let line = (1..80).map(|i| Point2::polar(0.1 * i as f32, scan.angle(beam)));
                    let hits = line.map(|p| pose.to_inner(p)).any(|p| in_box(p, &MODEL.footprint()));
                    assert!(!hits || beams.contains(&beam), "beam {beam} at {bearing}");
                }
            }
        }
        let ahead = MODEL.beams(&Pose2::new(4.0, 0.0, 0.0), &scanner(-FRAC_PI_2, half));
        assert!(ahead.len() < 300, "{ahead:?}");
    }
}

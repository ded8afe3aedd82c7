use super::{Point2, Pose2, Scan, wheel::View};
use core::ops::Range;

/// Distance before the centres of the near wheels within which a point may belong to a wheel, in m.
const NEAR_SIDE: f32 = 0.15;

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
    /// Number of wheel boxes that contain the centre of a segment.
    pub seen: usize,
    /// Number of wheel boxes that contain no segment although nothing hides them.
    pub missing: usize,
}

/// Box model of a container: footprint and wheels, in m, in the frame of the container.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoxModel {
    pub length: f32,
    pub width: f32,
    /// Wheel boxes: rows of x and y of the centre, length along x and width along y.
    pub wheels: &'static [[f32; 4]],
    /// Boxes in which points count neither for nor against the model.
    pub boards: &'static [[f32; 4]],
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
            } else if in_box(p, &self.footprint()) && !self.boards.iter().any(|board| in_box(p, board)) {
                count.outliers += 1;
                if count.outliers >= max_outliers {
                    break;
                }
            }
        }
        count
    }

    /// Finds the segment of each wheel: the nearest one with its centre in the wheel box. A segment along a board shows
    /// all wheels on it. Calls `seen` with the index of the box and the view of a wheel with a segment of its own, and
    /// returns the counts.
    pub fn sighting(&self, pose: &Pose2, views: &[View], scan: &Scan, mut seen: impl FnMut(usize, &View)) -> Sighting {
        let mut sighting = Sighting::default();
        let (reach, centre) = (self.reach_squared(), pose.position());
        let near = |view: &&View| (view.centre - centre).norm_squared() <= reach;
        for (index, wheel) in self.wheels.iter().enumerate() {
            // Without boards, the segments are no longer than a wheel.
            let is_held = |view: &View| self.boards.is_empty() || self.holds(view.ends.map(|end| pose.to_inner(end)));
            let inside = |view: &&View| in_box(pose.to_inner(view.centre), wheel) && is_held(view);
            let own = views.iter().filter(near).filter(inside).min_by(|a, b| a.range.total_cmp(&b.range));
            if let Some(view) = own {
                sighting.seen += 1;
                seen(index, view);
            } else if views.iter().filter(near).any(|view| self.covers(view.ends.map(|end| pose.to_inner(end)), wheel))
            {
                sighting.seen += 1;
            } else if in_plain_view(pose.to_outer(Point2::new(wheel[0], wheel[1])), scan) {
                sighting.missing += 1;
            }
        }
        sighting
    }

    /// Returns `true` if the ends of a segment, in the frame of the model, are in one wheel box, or on one board: a
    /// wall reaches beyond them.
    fn holds(&self, ends: [Point2; 2]) -> bool {
        let both = |area: &[f32; 4]| ends.iter().all(|end| in_box(*end, area));
        self.wheels.iter().chain(self.boards).any(both)
    }

    /// Returns `true` if a segment with these ends, in the frame of the model, runs along a board through a wheel.
    fn covers(&self, ends: [Point2; 2], &[x, y, length, _]: &[f32; 4]) -> bool {
        let [from, to] = [ends[0].x.min(ends[1].x), ends[0].x.max(ends[1].x)];
        let along =
            |board: &&[f32; 4]| ends.iter().all(|end| in_box(*end, board)) && (y - board[1]).abs() <= 0.5 * board[3];
        from <= x + 0.5 * length && to >= x - 0.5 * length && self.boards.iter().any(|board| along(&board))
    }

    /// Share of the beams between two wheels of the near side that are not stopped before it: 1 if there are none.
    pub fn passing(&self, [a, b]: [&View; 2], scan: &Scan) -> f32 {
        let (Some(from), Some(to)) = (scan.beam_towards(a.bearing), scan.beam_towards(b.bearing)) else { return 1.0 };
        let (mut free, mut all) = (0_u16, 0_u16);
        let across = b.centre - a.centre;
        let (from, to, count) = (from.min(to), from.max(to), scan.ranges.len());
        // The shorter way: across the seam of a full turn, if it is there.
        let crosses = scan.is_full_turn() && 2 * (to - from) > count;
        let between = if crosses { to + 1..from + count } else { from + 1..to };
        for beam in between.filter_map(|beam| scan.beam_around(beam as isize)) {
            let Some(range) = scan.range(beam) else { continue };
            // Distance along the beam to the line between the wheels.
            let direction = Point2::polar(1.0, scan.angle(beam));
            let line = a.centre.dot(across.perpendicular()) / direction.dot(across.perpendicular());
            all += 1;
            free += u16::from(range > line - NEAR_SIDE);
        }
        if all == 0 { 1.0 } else { f32::from(free) / f32::from(all) }
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
        let (centre, frame) = (pose.position(), pose.transform());
        let near = points.iter().filter(move |&&p| (p - centre).norm_squared() <= reach);
        near.map(move |&p| frame.to_inner(p))
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
        boards: &[],
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
        let sighting = |scan: &Scan, is_seen: bool| {
            let view = View { centre: near, ..View::default() };
            MODEL.sighting(&pose, if is_seen { core::slice::from_ref(&view) } else { &[] }, scan, |index, _| {
                assert_eq!(index, 0);
            })
        };
        scan.ranges[beam] = near.norm();
        assert_eq!(sighting(&scan, true), Sighting { seen: 1, missing: 2 });
        scan.ranges[beam] = 1.0;
        assert_eq!(sighting(&scan, false), Sighting { seen: 0, missing: 2 });
        scan.ranges[beam] = f32::NAN;
        assert_eq!(sighting(&scan, false), Sighting { seen: 0, missing: 2 });
        scan.ranges[beam] = 10.0;
        assert_eq!(sighting(&scan, false), Sighting { seen: 0, missing: 3 });
    }

    #[test]
    fn points_on_boards_count_for_nothing() {
        let points = [Point2::new(0.0, 0.3), Point2::new(0.0, 0.0)];
        let model = BoxModel { boards: &[[0.0, 0.3, 2.0, 0.2]], ..MODEL };
        let count = model.consensus(&Pose2::default(), &points, 100);
        assert_eq!(count, Consensus { inliers: 0, outliers: 1 });
    }

    #[test]
    fn beams_between_the_near_wheels_pass_or_are_stopped() {
        let mut scan = Scan { angle_min: -0.5, angle_increment: 0.01, range_max: 20.0, ..Scan::default() };
        scan.ranges.extend([10.0; 101]);
        let [a, b] = [0.2, -0.2].map(|bearing| {
            let centre = Point2::polar(2.0, bearing);
            View { bearing, centre, ends: [centre; 2], ..View::default() }
        });
        assert_eq!(MODEL.passing([&a, &b], &scan), 1.0);
        // From 1 m on the left, something stands in the way.
        scan.ranges[50..80].fill(1.0);
        let share = MODEL.passing([&a, &b], &scan);
        assert!((share - 0.5).abs() < 0.05, "{share}");
        scan.ranges.fill(f32::NAN);
        assert_eq!(MODEL.passing([&a, &b], &scan), 1.0);
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

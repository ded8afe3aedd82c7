use super::{
    BeamDirections, MAX_SEGMENTS, Point2, Pose2, Scan, Segments,
    consensus::{BoxModel, Consensus, Sighting},
    ranges::PerBeam,
    wheel::{Sums, View, WheelShape},
};
use apex_rt::node;
use core::f32::consts::PI;
use heapless::Vec;

/// Container detected in a scan.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Container {
    /// Centre and heading in the frame of the scanner. The heading points from the near wheels to the far ones.
    pub pose: Pose2,
    /// Squared deviation of the distance between the near wheels, in m² (ε, thesis eq. 6.18).
    pub error: f32,
    /// Number of points in wheel boxes (|I|).
    pub inliers: u16,
    /// Number of points in the footprint, but in no wheel box (|O|).
    pub outliers: u16,
    /// Number of wheels that are seen.
    pub wheels: usize,
    /// Number of the model (see [`ContainerSearch`]).
    pub model: u16,
}

impl Container {
    /// Returns `true` if this container shows more wheels or, with equally many, fits the near wheels better (thesis
    /// eq. 6.18).
    fn is_better_than(&self, other: &Self) -> bool {
        self.wheels > other.wheels || (self.wheels == other.wheels && self.error < other.error)
    }
}

/// Best of the containers that searches with different models found: the one that explains the most points, or, with
/// equally many, fits its near wheels better. ⊥ if there is none.
#[node]
pub fn best_container<const N: usize>(containers: [Option<&Container>; N]) -> Option<Container> {
    let found = containers.into_iter().flatten().copied();
    found.reduce(|best, one| {
        let fits_better = one.inliers == best.inliers && one.error < best.error;
        if one.inliers > best.inliers || fits_better { one } else { best }
    })
}

/// Detects a container by two of its wheels (thesis 6.6.1).
///
/// Every ordered pair of segments is a hypothesis for two wheels of the near side. Pairs at the wrong distance are
/// dropped (δ_w); the others give a pose (eqs. 6.12–6.16), at which the points of the scan must agree with a box model
/// (eq. 6.17). The output is ⊥ if no pose agrees. The pose is in the frame of the scanner.
///
/// Extensions of the thesis:
/// * The centre of a wheel is estimated from its mean range and its angular width instead of the mid-range of the
///   visible points (eq. 6.11), which lies before it.
/// * Near wheels are whole: nothing hides a part of them. The beams between them must not end before the container.
/// * Of the poses that agree, the one with the most visible wheels wins, and ε (eq. 6.18) decides between equals,
///   because ε alone often prefers a chance pair in clutter.
/// * A minimum number of wheels must be seen as segments of their own, and the others must be hidden: a wall through
///   the place of a wheel is not a wheel.
/// * A strip before the container may be required to be free.
/// * The container may be required to be seen from the front.
/// * A segment that stands for a wheel ends in its box, or, if it runs along a board, on that board: walls are longer.
/// * The pose is fitted to all wheels that are seen, and the remaining distances are small. Castors trail, so that
///   each has several possible pivots: the combinations are weighted by their agreement with the model.
///
/// The defaults are for a container on four castors. A pallet on nine feet differs in numbers only. [`best_container`]
/// selects between several models.
///
/// Cost: O(s²) for s segments, and for each pair at the right distance the beams that can hit the model. Allocates
/// nothing after the first scans.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct ContainerSearch {
    /// Distance across between the outer sides of the wheels (w).
    #[param(unit = "m", default = 0.68, range = 0.05..=10.0)]
    width: f32,
    /// Distance lengthwise between the outer sides of the wheels (l).
    #[param(unit = "m", default = 1.2, range = 0.05..=10.0)]
    length: f32,
    /// Size of a wheel across (w_w).
    #[param(unit = "m", default = 0.04, range = 0.0..=1.0)]
    wheel_width: f32,
    /// Size of a wheel lengthwise (w_l).
    #[param(unit = "m", default = 0.125, range = 0.0..=1.0)]
    wheel_length: f32,
    /// Distance from the pivot of a castor to its axle; 0 for wheels or feet that do not turn.
    #[param(unit = "m", default = 0.04, range = 0.0..=1.0)]
    trail: f32,
    /// Maximum deviation of the distance between two near wheels (δ_w).
    #[param(unit = "m", default = 0.15, range = 0.0..=2.0)]
    width_tolerance: f32,
    /// Minimum number of points of a segment used as a near wheel. Far wheels may have fewer.
    #[param(default = 1, range = 1..=1000)]
    min_points: u16,
    /// Minimum number of points in wheel boxes (d_I).
    #[param(default = 4, range = 0..=10_000)]
    min_inliers: u16,
    /// Number of points in the footprint beside the wheels that refutes a hypothesis (d_O). A greater number makes each
    /// hypothesis slower to test.
    #[param(default = 3, range = 1..=100)]
    max_outliers: u16,
    /// Minimum number of wheels that are seen.
    #[param(default = 3, range = 0..=100)]
    min_wheels: usize,
    /// Maximum number of wheels that are not seen although the beams towards them pass by.
    #[param(default = 0, range = 0..=100)]
    max_missing: usize,
    /// Length of the strip before the near wheels that belongs to the footprint.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    clearance: f32,
    /// Minimum share of the beams between the near wheels that do not end before the container.
    #[param(default = 0.8, range = 0.0..=1.0)]
    min_passing: f32,
    /// Maximum root mean square of the distances between the wheels that are seen and those of the fitted model.
    #[param(unit = "m", default = 0.08, range = 0.0..=1.0)]
    max_residual: f32,
    /// Maximum angle between the line of sight to the centre and the heading: the obliqueness of the view. With π any
    /// pose is allowed, even around the scanner, and the far wheels of a symmetric container may be taken for the near
    /// ones.
    #[param(unit = "rad", default = PI, range = 0.0..=3.2)]
    max_view_angle: f32,
    /// Wheels: rows of `[x, y, length, width]` in metres, in the frame of the container, whose origin is its centre.
    /// Those with the smallest x are the near side.
    #[param(unit = "m")]
    boxes: &'static [[f32; 4]],
    /// Areas in which points count neither for nor against the model, such as the boards under a pallet: rows as in
    /// `boxes`.
    #[param(unit = "m", default = &[])]
    boards: &'static [[f32; 4]],
    /// Number of this model in the detections.
    #[param(default = 0)]
    model: u16,
    /// Points of the scan by beam; NaN where nothing was measured.
    points: PerBeam<Point2>,
    /// Segments, seen as wheels.
    views: Vec<View, MAX_SEGMENTS>,
    directions: BeamDirections,
}

/// Distance along x within which a wheel belongs to the near side, in m.
const SAME_SIDE: f32 = 0.01;
/// Maximum number of wheels that a pose is fitted to.
const MAX_WHEELS: usize = 16;

#[node]
impl ContainerSearch {
    fn process(&mut self, scan: &Scan, segments: &Segments) -> Option<Container> {
        self.points.clear();
        self.points.extend(scan.ranges.iter().map(|_| Point2::new(f32::NAN, f32::NAN)));
        for (beam, point) in self.directions.points(scan) {
            self.points[beam] = point;
        }
        let shape = self.shape();
        self.views.clear();
        self.views.extend(segments.iter().map(|segment| shape.view(segment, scan)));
        let mut best: Option<Container> = None;
        for (i, a) in self.views.iter().enumerate() {
            for b in &self.views[i + 1..] {
                self.hypotheses(scan, [a, b], &mut best);
            }
        }
        best
    }

    fn shape(&self) -> WheelShape {
        WheelShape { length: self.wheel_length, width: self.wheel_width, trail: self.trail }
    }

    fn model(&self) -> BoxModel {
        BoxModel {
            length: self.length,
            width: self.width,
            wheels: self.boxes,
            boards: self.boards,
            clearance: self.clearance,
        }
    }

    /// Centres of the wheels on the near side, in the frame of the container.
    fn near_side(&self) -> impl Iterator<Item = Point2> + Clone {
        let front = self.boxes.iter().map(|b| b[0]).fold(f32::INFINITY, f32::min);
        self.boxes.iter().filter(move |b| b[0] - front <= SAME_SIDE).map(|b| Point2::new(b[0], b[1]))
    }

    /// Tests the containers that have the two segments as wheels of their near side, and keeps the best.
    fn hypotheses(&self, scan: &Scan, pair: [&View; 2], best: &mut Option<Container>) {
        let can_be_near = |view: &View| view.is_whole && view.points >= self.min_points;
        let distance = (pair[1].centre - pair[0].centre).norm();
        if distance == 0.0 || !pair.into_iter().any(can_be_near) {
            return;
        }
        for (i, p) in self.near_side().enumerate() {
            for q in self.near_side().skip(i + 1) {
                let deviation = (q - p).norm() - distance;
                if deviation.abs() > self.width_tolerance {
                    continue;
                }
                for [a, b] in [pair, [pair[1], pair[0]]] {
                    let found = self.pose([(p, a.centre), (q, b.centre)]);
                    let found = found.and_then(|pose| self.verify(scan, [a, b], pose, deviation * deviation));
                    if let Some(found) = found.filter(|one| best.is_none_or(|best| one.is_better_than(&best))) {
                        *best = Some(found);
                    }
                }
            }
        }
    }

    /// Pose of a container with two wheels at the given points (thesis eqs. 6.12–6.16), or `None` if the view is too
    /// oblique.
    fn pose(&self, wheels: [(Point2, Point2); 2]) -> Option<Pose2> {
        let mut sums = Sums::default();
        wheels.into_iter().for_each(|(place, image)| sums.add(place, image, 1.0));
        let (pose, _) = sums.pose()?;
        let centre = pose.position();
        let along = centre.dot(Point2::polar(1.0, pose.theta));
        let faces = along >= libm::cosf(self.max_view_angle) * centre.norm();
        (faces || self.max_view_angle >= PI).then_some(pose)
    }

    /// The container at `pose`, or `None` if the scan does not agree with it.
    fn verify(&self, scan: &Scan, pair: [&View; 2], pose: Pose2, error: f32) -> Option<Container> {
        let model = self.model();
        let beams = model.beams(&pose, scan);
        let Consensus { inliers, outliers } = model.consensus(&pose, &self.points[beams], self.max_outliers);
        if inliers < self.min_inliers || outliers >= self.max_outliers {
            return None;
        }
        let mut wheels: Vec<(Point2, View), MAX_WHEELS> = Vec::new();
        let Sighting { seen, missing } = model.sighting(&pose, &self.views, scan, |index, view| {
            if view.is_whole {
                // The fit can do without those that find no room.
                let _ = wheels.push((Point2::new(self.boxes[index][0], self.boxes[index][1]), *view));
            }
        });
        let agrees =
            seen >= self.min_wheels && missing <= self.max_missing && model.passing(pair, scan) >= self.min_passing;
        if !agrees {
            return None;
        }
        // Without two whole wheels, the pose is that of the pair.
        let (pose, residual) = self.shape().fit(&wheels, &pose).unwrap_or((pose, 0.0));
        let model = self.model;
        (residual <= self.max_residual).then_some(Container { pose, error, inliers, outliers, wheels: seen, model })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::{JumpDistance, Segment, SegmentFilter};
    use apex_rt::Out;

    /// Four wheels of a container of 1.2 m × 0.7 m.
    const BOXES: &[[f32; 4]] =
        &[[-0.5375, 0.33, 0.2, 0.2], [-0.5375, -0.33, 0.2, 0.2], [0.5375, 0.33, 0.2, 0.2], [0.5375, -0.33, 0.2, 0.2]];

    fn node() -> ContainerSearch {
        ContainerSearch {
            directions: BeamDirections::default(),
            width: 0.7,
            length: 1.2,
            // Squares about the discs of the scans.
            wheel_width: 0.08,
            wheel_length: 0.08,
            trail: 0.0,
            width_tolerance: 0.15,
            min_points: 1,
            min_inliers: 6,
            max_outliers: 5,
            min_wheels: 3,
            max_missing: 0,
            clearance: 0.0,
            min_passing: 0.8,
            max_residual: 0.05,
            max_view_angle: 0.5 * PI,
            boxes: BOXES,
            boards: &[],
            model: 7,
            points: PerBeam::new(),
            views: Vec::new(),
        }
    }

    /// A scan of discs of 4 cm radius before a wall at 8 m, with a field of view of 180°.
    fn scan(discs: &[Point2]) -> Scan {
        let mut scan = Scan { angle_min: -0.5 * PI, angle_increment: PI / 720.0, ..Scan::default() };
        for beam in 0..=720 {
            let direction = Point2::polar(1.0, scan.angle(beam));
            let ranges = discs.iter().filter_map(|disc| {
                let (along, across) = (direction.dot(*disc), direction.perpendicular().dot(*disc));
                (along > 0.0 && across.abs() < 0.04).then(|| along - (0.04 * 0.04 - across * across).sqrt())
            });
            scan.ranges.push(ranges.fold(8.0, f32::min)).expect("room for a beam");
        }
        scan
    }

    fn wheels(pose: &Pose2) -> [Point2; 4] {
        core::array::from_fn(|i| pose.to_outer(Point2::new(BOXES[i][0], BOXES[i][1])))
    }

    fn search(mut node: ContainerSearch, discs: &[Point2]) -> Option<Container> {
        use apex_rt::Construct;
        let scan = scan(discs);
        let mut segments = Out::new();
        let mut small = Out::new();
        JumpDistance::construct((0.15, 1)).process(&scan, &mut segments).expect("few segments");
        SegmentFilter::construct((0.3, 10.0, 1)).process(segments.get().expect("segments"), &mut small);
        node.process(&scan, small.get().expect("segments"))
    }

    #[test]
    fn finds_a_container_at_its_pose() {
        for theta in [-0.6, 0.0, 0.3, 0.9] {
            let pose = Pose2::new(2.5, 0.4, theta);
            let found = search(node(), &wheels(&pose)).expect("a container");
            let off = found.pose.relative_to(&pose);
            assert!(off.position().norm() < 0.02 && off.theta.abs() < 0.03, "{off:?} at {theta}");
            // One wheel may hide behind another.
            assert!(found.wheels >= 3 && found.outliers == 0, "{found:?} at {theta}");
            assert!(found.error < 1e-3 && found.inliers >= 6);
        }
    }

    #[test]
    fn the_heading_leads_away_when_seen_from_the_front_only() {
        // Rotated by 180°, the same wheels are there: the near ones are those at the scanner.
        let pose = Pose2::new(2.5, 0.0, PI);
        let found = search(node(), &wheels(&pose)).expect("a container");
        assert!(found.pose.theta.abs() < 0.02);
    }

    #[test]
    fn one_hidden_wheel_is_forgiven_one_missing_wheel_is_not() {
        let pose = Pose2::new(2.5, 0.0, 0.2);
        let three = &wheels(&pose)[..3];
        assert_eq!(search(node(), three), None);
        assert!(search(ContainerSearch { max_missing: 1, ..node() }, three).is_some());
        let leg = wheels(&pose)[3].scaled(0.6);
        let found = search(node(), &[three, &[leg]].concat()).expect("a container");
        assert!(found.pose.relative_to(&pose).position().norm() < 0.02);
        assert_eq!(search(ContainerSearch { min_wheels: 4, ..node() }, &[three, &[leg]].concat()), None);
    }

    #[test]
    fn something_inside_or_before_it_refutes_it() {
        let pose = Pose2::new(2.5, 0.0, 0.0);
        let with = |x, y| [&wheels(&pose)[..], &[pose.to_outer(Point2::new(x, y))]].concat();
        assert_eq!(search(node(), &with(0.0, 0.0)), None);
        assert!(search(node(), &with(-0.8, 0.15)).is_some());
        assert_eq!(search(ContainerSearch { clearance: 0.4, ..node() }, &with(-0.8, 0.15)), None);
    }

    #[test]
    fn a_container_around_the_scanner_is_found_if_it_may_be_anywhere() {
        // Two wheels in front, the others outside the field of view.
        let pose = Pose2::new(0.1, 0.0, PI);
        assert_eq!(search(node(), &wheels(&pose)), None);
        let found = search(ContainerSearch { max_view_angle: PI, min_wheels: 2, ..node() }, &wheels(&pose));
        assert!(found.expect("a container").pose.relative_to(&pose).position().norm() < 0.05);
    }

    #[test]
    fn a_wrong_width_is_no_container() {
        let pose = Pose2::new(2.5, 0.0, 0.0);
        let stretched = wheels(&pose).map(|w| Point2::new(w.x, w.y * 1.4));
        assert_eq!(search(node(), &stretched), None);
    }

    #[test]
    fn a_wall_is_no_wheel() {
        let pose = Pose2::new(2.5, 0.0, 0.2);
        let [a, b, far, _] = wheels(&pose);
        // A row of posts through the place of the far wheel, so close to each other that they are one segment.
        let wall: std::vec::Vec<Point2> = (-12..=12).map(|i| far + Point2::new(0.0, 0.06 * i as f32)).collect();
        let node = || ContainerSearch { max_outliers: 100, max_missing: 1, ..node() };
        assert!(search(node(), &[a, b, far]).is_some());
        assert_eq!(search(node(), &[&[a, b], &wall[..]].concat()), None);
    }

    #[test]
    fn near_wheels_need_enough_points() {
        let pose = Pose2::new(2.5, 0.0, 0.2);
        assert!(search(ContainerSearch { min_points: 4, ..node() }, &wheels(&pose)).is_some());
        assert_eq!(search(ContainerSearch { min_points: 40, ..node() }, &wheels(&pose)), None);
    }

    #[test]
    fn from_the_side_only_if_allowed() {
        let pose = Pose2::new(2.5, 0.0, 1.2);
        // Beams that hit the wheels themselves are before the line that joins their centres.
        let node = || ContainerSearch { min_passing: 0.3, ..node() };
        assert!(search(node(), &wheels(&pose)).is_some());
        assert_eq!(search(ContainerSearch { max_view_angle: 0.3, ..node() }, &wheels(&pose)), None);
    }

    #[test]
    fn the_best_model_explains_the_most_points() {
        let pose = Pose2::new(2.5, 0.4, 0.3);
        let found = search(node(), &wheels(&pose)).expect("a container");
        assert_eq!(found.model, 7);
        let worse = Container { inliers: found.inliers - 1, model: 1, ..found };
        let tighter = Container { error: 0.5 * found.error, model: 2, ..found };
        assert_eq!(best_container([Some(&worse), None, Some(&found)]), Some(found));
        assert_eq!(best_container([Some(&found), Some(&tighter)]), Some(tighter));
        assert_eq!(best_container([None, None]), None);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert_eq!(search(node(), &[]), None);
        assert_eq!(node().process(&Scan::default(), &Segments::new()), None);
        // Two segments at the same place, and a model that would accept them.
        let mut same = Segments::new();
        let segment = Segment { first: 0, last: 0, points: 1, min: Point2::default(), max: Point2::default() };
        same.extend([segment, segment]);
        let mut lax = ContainerSearch { width: 0.1, min_inliers: 0, min_wheels: 0, boxes: &[], ..node() };
        assert_eq!(lax.process(&Scan::default(), &same), None);
    }
}

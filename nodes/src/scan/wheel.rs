use super::{Point2, Pose2, Scan, Segment, wrap_angle};
use core::f32::consts::FRAC_PI_2;

/// Maximum number of castors whose directions are searched together. Each has four possible pivots.
const MAX_CASTORS: usize = 4;
/// Standard deviation of the estimated centre of a wheel, in m.
const SIGMA: f32 = 0.015;

/// Rectangle that a wheel covers in the plane of the scanner, and the trail of its castor.
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelShape {
    /// Size along the rolling direction, in m.
    pub length: f32,
    /// Size across, in m.
    pub width: f32,
    /// Distance from the pivot to the axle, in m: 0 for a wheel or a foot that does not turn.
    pub trail: f32,
}

/// Appearance of a segment as a wheel, by its points that lie within the size of a wheel behind the nearest one.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct View {
    /// Direction of the middle of the segment, in rad.
    pub bearing: f32,
    /// Mean range of the points, in m.
    pub range: f32,
    /// Size across the line of sight, in m.
    pub extent: f32,
    /// Number of points.
    pub points: u16,
    /// Middle of the segment if it is a wheel of any direction, in m.
    pub centre: Point2,
    /// First and last point of the whole segment, in m.
    pub ends: [Point2; 2],
    /// `true` if the beams on both sides measure beyond the segment, or nothing: nothing hides a part of it.
    pub is_whole: bool,
}

impl WheelShape {
    /// View of a segment.
    pub fn view(&self, segment: &Segment, scan: &Scan) -> View {
        // Counted on beyond the seam of a full turn.
        let beams = segment.counted(scan.ranges.len());
        let measured = |beam: usize| scan.beam_around(beam as isize).and_then(|beam| scan.range(beam));
        let ranges = || beams.clone().filter_map(|beam| measured(beam).map(|range| (beam, range)));
        let nearest = ranges().map(|(_, range)| range).fold(f32::INFINITY, f32::min);
        let (mut first, mut last, mut sum, mut points) = (None, 0, 0.0, 0_u16);
        for (beam, range) in ranges().filter(|(_, range)| range - nearest <= self.diagonal()) {
            first = first.or(Some(beam));
            (last, sum, points) = (beam, sum + range, points + 1);
        }
        let Some(first) = first else { return View::default() };
        let (bearing, range) = (0.5 * (scan.angle(first) + scan.angle(last)), sum / f32::from(points));
        let extent = range * (last - first + 1) as f32 * scan.angle_increment.abs();
        let centre = Point2::polar(range + self.depth(self.turn(extent)), bearing);
        let beside = |beam: isize| scan.beam_around(beam).and_then(|beam| scan.range(beam));
        let beyond = |beam: isize| beside(beam).is_none_or(|r| r > nearest);
        let is_whole = beyond(first as isize - 1) && beyond(last as isize + 1);
        let end = |beam: usize| Point2::polar(measured(beam).unwrap_or(range), scan.angle(beam));
        let ends = [end(*beams.start()), end(*beams.end())];
        View { bearing, range, extent, points, centre, ends, is_whole }
    }

    fn diagonal(&self) -> f32 {
        libm::hypotf(self.length, self.width)
    }

    /// Angle between the rolling direction and the line of sight at which a wheel is `extent` m wide, in rad, from 0
    /// to π/2: the solution of l·sin α + w·cos α = extent.
    fn turn(&self, extent: f32) -> f32 {
        let sine = (extent / self.diagonal().max(f32::MIN_POSITIVE)).min(1.0);
        (libm::asinf(sine) - libm::atan2f(self.width, self.length)).clamp(0.0, FRAC_PI_2)
    }

    /// Distance along the line of sight from the mean of the visible points to the centre, in m, if the angle between
    /// the rolling direction and the line of sight is `turn` rad. Points are spread evenly across the line of sight.
    fn depth(&self, turn: f32) -> f32 {
        let (sin, cos) = libm::sincosf(turn);
        let (sin, cos) = (sin.abs(), cos.abs());
        let across = (self.length * sin + self.width * cos).max(f32::MIN_POSITIVE);
        let diagonal = self.diagonal();
        0.5 * (self.length * cos + self.width * sin) - 0.5 * sin * cos * diagonal * diagonal / across
    }

    /// Centre of a wheel that rolls in the direction `heading` rad.
    fn centre(&self, view: &View, heading: f32) -> Point2 {
        Point2::polar(view.range + self.depth(heading - view.bearing), view.bearing)
    }

    /// Possible pivots of a castor: its wheel is turned to either side, and trails in either direction.
    fn pivots(&self, view: &View) -> [Point2; 4] {
        let turn = self.turn(view.extent);
        let [left, right] = [turn, -turn].map(|turn| Point2::polar(self.trail, view.bearing + turn));
        [view.centre + left, view.centre - left, view.centre + right, view.centre - right]
    }

    /// Pose of a container whose wheels at the places `model`, in its frame, are seen as `views`; `prior` is a first
    /// estimate. Also returns the root mean square of the remaining distances, in m. Needs two wheels.
    ///
    /// Wheels that do not turn are fitted by least squares. Castors are fitted for each combination of their possible
    /// pivots, and the result is the mean of these poses, weighted by their likelihood. If all castors point in the
    /// same direction, nothing tells on which side their pivots are: the mean is then in the middle.
    pub fn fit(&self, wheels: &[(Point2, View)], prior: &Pose2) -> Option<(Pose2, f32)> {
        if wheels.len() < 2 {
            return None;
        }
        if self.trail > 0.0 {
            return self.fit_castors(&wheels[..wheels.len().min(MAX_CASTORS)]);
        }
        let mut sums = Sums::default();
        for (place, view) in wheels {
            sums.add(*place, self.centre(view, prior.theta), 1.0);
        }
        sums.pose().map(|(pose, error)| (pose, libm::sqrtf(error / wheels.len() as f32)))
    }

    fn fit_castors(&self, wheels: &[(Point2, View)]) -> Option<(Pose2, f32)> {
        let mut pivots = [[Point2::default(); 4]; MAX_CASTORS];
        for (pivots, (_, view)) in pivots.iter_mut().zip(wheels) {
            *pivots = self.pivots(view);
        }
        let (mut first, mut sum, mut total, mut smallest) = (None, [0.0; 3], 0.0, f32::INFINITY);
        for combination in 0..4_usize.pow(wheels.len() as u32) {
            let mut sums = Sums::default();
            for (i, (place, _)) in wheels.iter().enumerate() {
                sums.add(*place, pivots[i][(combination >> (2 * i)) & 3], 1.0);
            }
            let (pose, error) = sums.pose()?;
            let (reference, least) = *first.get_or_insert((pose, error));
            // Relative to the first combination, so that the exponential does not underflow.
            let weight = libm::expf(((least - error) / (2.0 * SIGMA * SIGMA)).clamp(-80.0, 80.0));
            let turn = wrap_angle(pose.theta - reference.theta);
            for (sum, value) in sum.iter_mut().zip([pose.x, pose.y, turn]) {
                *sum += weight * value;
            }
            total += weight;
            smallest = smallest.min(error);
        }
        let (reference, _) = first?;
        let [x, y, turn] = sum.map(|sum| sum / total);
        let pose = Pose2::new(x, y, reference.theta + turn);
        pose.is_finite().then(|| (pose, libm::sqrtf(smallest / wheels.len() as f32)))
    }
}

/// Sums of a weighted least-squares fit of a pose to pairs of points (Arun, Huang, Blostein 1987, in the plane).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    weight: f32,
    place: Point2,
    image: Point2,
    /// Sums of the squares of places and images.
    squares: f32,
    dot: f32,
    cross: f32,
}

impl Sums {
    /// Adds a point at `place` in the inner frame and at `image` in the outer frame.
    pub fn add(&mut self, place: Point2, image: Point2, weight: f32) {
        self.weight += weight;
        self.place = self.place + place.scaled(weight);
        self.image = self.image + image.scaled(weight);
        self.squares += weight * (place.norm_squared() + image.norm_squared());
        self.dot += weight * place.dot(image);
        self.cross += weight * place.perpendicular().dot(image);
    }

    /// Pose of the inner frame in the outer frame, and the sum of the squared distances that remain, in m², or `None`
    /// if it is undetermined.
    pub fn pose(&self) -> Option<(Pose2, f32)> {
        if self.weight <= 0.0 {
            return None;
        }
        let (place, image) = (self.place.scaled(1.0 / self.weight), self.image.scaled(1.0 / self.weight));
        let dot = self.dot - self.weight * place.dot(image);
        let cross = self.cross - self.weight * place.perpendicular().dot(image);
        let length = libm::hypotf(dot, cross);
        // Also false for NaN.
        let is_determined = length > 0.0 && length.is_finite();
        is_determined.then(|| {
            let theta = libm::atan2f(cross, dot);
            let centre = image - Pose2::new(0.0, 0.0, theta).to_outer(place);
            let squares = self.squares - self.weight * (place.norm_squared() + image.norm_squared());
            (Pose2::new(centre.x, centre.y, theta), (squares - 2.0 * length).max(0.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    const WHEEL: WheelShape = WheelShape { length: 0.125, width: 0.04, trail: 0.04 };

    /// View of a wheel with its axle at `axle`, in a scan of 0.1°.
    fn view(axle: &Pose2) -> View {
        let mut scan = Scan { angle_min: -0.5, angle_increment: PI / 1800.0, range_max: 20.0, ..Scan::default() };
        let corners = [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)]
            .map(|(x, y)| axle.to_outer(Point2::new(x * WHEEL.length, y * WHEEL.width)));
        for beam in 0..=570 {
            let direction = Point2::polar(1.0, scan.angle(beam));
            let hits = (0..4).filter_map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                let normal = (b - a).perpendicular();
                let distance = a.dot(normal) / direction.dot(normal);
                let share = (direction.scaled(distance) - a).dot(b - a) / (b - a).norm_squared();
                (0.0..=1.0).contains(&share).then_some(distance)
            });
            scan.ranges.push(hits.fold(9.0, f32::min)).expect("room for a beam");
        }
        let hit: std::vec::Vec<u16> = (0..=570).filter(|beam| scan.ranges[usize::from(*beam)] < 8.0).collect();
        let (first, last) = (hit[0], hit[hit.len() - 1]);
        let segment = Segment { first, last, points: last - first + 1, min: Point2::default(), max: Point2::default() };
        WHEEL.view(&segment, &scan)
    }

    #[test]
    fn the_centre_of_a_wheel_is_estimated_at_any_direction() {
        for i in 0..16 {
            let axle = Pose2::new(2.0, 0.3, i as f32 * 0.2);
            let view = view(&axle);
            assert!((view.centre - axle.position()).norm() < 0.02, "{:?} for {axle:?}", view.centre);
            assert!(view.is_whole && view.points > 10);
            let pivot = axle.to_outer(Point2::new(WHEEL.trail, 0.0));
            let nearest = WHEEL.pivots(&view).map(|p| (p - pivot).norm()).into_iter().fold(f32::MAX, f32::min);
            assert!(nearest < 0.035, "{nearest} for {axle:?}");
        }
    }

    #[test]
    fn castors_in_one_direction_leave_the_middle_and_others_tell_the_pose() {
        let places = [(-0.5, 0.3), (-0.5, -0.3), (0.5, 0.3), (0.5, -0.3)].map(|(x, y)| Point2::new(x, y));
        let pose = Pose2::new(2.2, 0.0, 0.1);
        let fit = |directions: [f32; 4]| {
            let views = core::array::from_fn::<_, 4, _>(|i| {
                let pivot = pose.to_outer(places[i]);
                let axle = pivot - Point2::polar(WHEEL.trail, directions[i]);
                (places[i], view(&Pose2::new(axle.x, axle.y, directions[i])))
            });
            WHEEL.fit(&views, &pose).expect("four wheels").0.relative_to(&pose)
        };
        let trailing = fit([0.1; 4]);
        assert!((trailing.x + WHEEL.trail).abs() < 0.01, "{trailing:?}");
        let mixed = fit([0.1, 2.0, -1.2, 0.9]);
        assert!(mixed.position().norm() < 0.02 && mixed.theta.abs() < 0.03, "{mixed:?}");
    }

    #[test]
    fn a_fit_needs_two_wheels_at_different_places() {
        let one = (Point2::new(0.5, 0.3), View { centre: Point2::new(2.0, 0.0), points: 3, ..View::default() });
        for shape in [WHEEL, WheelShape { trail: 0.0, ..WHEEL }] {
            assert_eq!(shape.fit(&[], &Pose2::default()), None);
            assert_eq!(shape.fit(&[one], &Pose2::default()), None);
        }
        assert_eq!(Sums::default().pose(), None);
        let nothing = WheelShape { length: 0.0, width: 0.0, trail: 0.0 };
        assert_eq!((nothing.turn(0.1), nothing.depth(0.3)), (core::f32::consts::FRAC_PI_2, 0.0));
    }
}

use super::{Detections, MAX_DETECTIONS, View, shape::leg_features};
use crate::{
    learn::{BadForest, Forest},
    scan::{Point2, Pose2, Scan, Segment, Segments},
};
use apex_rt::{Out, Time, node};
use heapless::Vec;

/// Segment of a scan that may be a leg.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Leg {
    /// Mid-range of the points, in m, in the frame of the scanner.
    pub position: Point2,
    /// Probability that this is a leg, from 0 to 1.
    pub probability: f32,
}

/// Possible legs in one scan, in the order of their beams.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "record", derive(serde::Serialize, serde::Deserialize))]
pub struct Legs {
    /// Time of the scan.
    pub stamp: Time,
    /// Possible legs. Those beyond the capacity are left out.
    pub list: Vec<Leg, MAX_DETECTIONS>,
}

/// Detects legs of persons in a laser scan: a random forest classifies the shape of each segment (thesis 6.8.1; Arras
/// et al. 2007).
///
/// The segments must be those of the same scan, for example from `JumpDistance(gap = 10cm)`. Fails if the model cannot
/// be read, or if it has another number of inputs than [`LEG_FEATURES`](super::LEG_FEATURES).
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct LegDetector {
    /// Bytes of a [`Forest`]: a constant such as [`LEGS`](super::LEGS), or `include_bytes!` of a file.
    #[param]
    model: &'static [u8],
    /// Minimum probability.
    #[param(default = 0.5, range = 0.0..=1.0)]
    threshold: f32,
    /// Minimum number of points of a segment.
    #[param(default = 3, range = 1..=1000)]
    min_points: u16,
    /// Maximum diagonal of the bounding box of a segment.
    #[param(unit = "m", default = 0.5, range = 0.0..=10.0)]
    max_size: f32,
    loaded: Option<Forest<'static>>,
}

#[node]
impl LegDetector {
    fn process(&mut self, scan: &Scan, segments: &Segments, legs: &mut Out<Legs>) -> Result<(), BadForest> {
        let forest = match self.loaded {
            Some(forest) => forest,
            None => *self.loaded.insert(Forest::from_bytes(self.model)?.with_inputs(super::LEG_FEATURES)?),
        };
        let legs = legs.get_mut();
        legs.stamp = scan.stamp;
        legs.list.clear();
        let fits = |s: &Segment| s.points >= self.min_points && s.size() <= self.max_size;
        for (at, segment) in segments.iter().enumerate().filter(|(_, segment)| fits(segment)) {
            let probability = leg_features(scan, segments, at).and_then(|features| forest.probability(&features));
            if let Some(probability) = probability.filter(|p| *p >= self.threshold) {
                let full = legs.list.push(Leg { position: segment.mid_range(), probability }).is_err();
                if full {
                    break;
                }
            }
        }
        Ok(())
    }
}

/// Detects persons by their legs: the nearest two legs are those of one person. A leg without another one near it is a
/// person, too.
///
/// `pose` is that of the scanner in the fixed frame of the tracker, for example the pose of odometry composed with the
/// mounting. ⊥ if it is not finite.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct LegPairs {
    /// Maximum distance between the legs of a person.
    #[param(unit = "m", default = 0.6, range = 0.0..=2.0)]
    max_step: f32,
    /// Angle of the sector that the scanner sees.
    #[param(unit = "rad", default = 6.2831855, range = 0.0..=6.2831855)]
    view_angle: f32,
    /// Distance up to which legs are detected.
    #[param(unit = "m", default = 5.0, range = 0.0..=100.0)]
    view_range: f32,
}

#[node]
impl LegPairs {
    fn process(&mut self, legs: &Legs, pose: &Pose2, persons: &mut Out<Detections>) {
        if !pose.is_usable() {
            return;
        }
        let persons = persons.get_mut();
        persons.stamp = legs.stamp;
        persons.view = View { pose: *pose, angle: self.view_angle, nearest: 0.0, range: self.view_range };
        persons.positions.clear();
        let mut rest: Vec<Point2, MAX_DETECTIONS> = legs.list.iter().map(|leg| leg.position).collect();
        while let Some((a, b)) = self.nearest_pair(&rest) {
            // `b` is behind `a`, so that its removal does not move `a`.
            let (second, first) = (rest.remove(b), rest.remove(a));
            // Cannot fail: there are at most as many persons as legs.
            let _ = persons.positions.push(pose.to_outer((first + second).scaled(0.5)));
        }
        persons.positions.extend(rest.iter().map(|leg| pose.to_outer(*leg)));
    }

    fn nearest_pair(&self, legs: &[Point2]) -> Option<(usize, usize)> {
        let pairs = (0..legs.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let distance = |(a, b): (usize, usize)| (legs[a] - legs[b]).norm_squared();
        let near = pairs.filter(|pair| distance(*pair) <= self.max_step * self.max_step);
        near.min_by(|x, y| distance(*x).total_cmp(&distance(*y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::LEGS, scan::JumpDistance};
    use apex_rt::Construct;
    use core::f32::consts::{FRAC_PI_2, TAU};

    /// Scan of a round room of radius 3 m, with cylinders of these positions and radii.
    fn room(cylinders: &[(f32, f32, f32)]) -> Scan {
        let mut scan = Scan { angle_min: -1.5, angle_increment: 0.006, stamp: Time::from_millis(7), ..Scan::default() };
        for beam in 0..500 {
            let direction = Point2::polar(1.0, scan.angle(beam));
            let hit = |(x, y, radius): &(f32, f32, f32)| {
                let along = direction.dot(Point2::new(*x, *y));
                let aside = x * x + y * y - along * along;
                (along > 0.0 && aside < radius * radius).then(|| along - libm::sqrtf(radius * radius - aside))
            };
            let range = cylinders.iter().filter_map(hit).fold(3.0, f32::min);
            scan.ranges.push(range).expect("few beams");
        }
        scan
    }

    fn detect(model: &'static [u8], scan: &Scan, segments: &Segments) -> Result<Legs, BadForest> {
        let mut out = Out::new();
        LegDetector::construct((model, 0.5, 3, 0.5)).process(scan, segments, &mut out)?;
        Ok(out.get().cloned().expect("legs"))
    }

    fn split(scan: &Scan) -> Segments {
        let mut out = Out::new();
        JumpDistance::construct((0.1, 2)).process(scan, &mut out).expect("few segments");
        out.get().cloned().expect("segments")
    }

    #[test]
    fn a_pair_of_legs_is_a_person() {
        let scan = room(&[(1.5, 0.15, 0.06), (1.5, -0.12, 0.06)]);
        let legs = detect(LEGS, &scan, &split(&scan)).expect("a model");
        assert_eq!((legs.list.len(), legs.stamp), (2, scan.stamp), "{legs:?}");
        let mut out = Out::new();
        let pose = Pose2::new(1.0, 2.0, FRAC_PI_2);
        LegPairs::construct((0.6, TAU, 5.0)).process(&legs, &pose, &mut out);
        let persons = out.get().expect("persons");
        assert_eq!((persons.positions.len(), persons.stamp), (1, scan.stamp));
        assert!((persons.positions[0] - Point2::new(1.0, 3.46)).norm() < 0.1, "{persons:?}");
        let mut out = Out::new();
        LegPairs::construct((0.1, TAU, 5.0)).process(&legs, &pose, &mut out);
        assert_eq!(out.get().map(|persons| persons.positions.len()), Some(2));
        let mut out = Out::new();
        LegPairs::construct((0.6, TAU, 5.0)).process(&legs, &Pose2::new(f32::NAN, 0.0, 0.0), &mut out);
        assert_eq!(out.get(), None);
    }

    #[test]
    fn nothing_gives_an_empty_list() {
        let empty = Scan::default();
        assert!(detect(LEGS, &empty, &Segments::new()).expect("a model").list.is_empty());
        let scan = room(&[(1.5, 0.15, 0.06)]);
        // Segments of another scan.
        assert!(detect(LEGS, &empty, &split(&scan)).expect("a model").list.is_empty());
        assert!(detect(LEGS, &room(&[]), &split(&room(&[]))).expect("a model").list.is_empty());
    }

    #[test]
    fn another_model_is_an_error() {
        assert_eq!(detect(b"nothing", &Scan::default(), &Segments::new()), Err(BadForest::Magic));
    }
}

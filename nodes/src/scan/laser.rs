use super::{Point2, Ranges};
use apex_rt::Time;
use core::{f32::consts::TAU, time::Duration};

/// One sweep of a plane laser scanner, in the frame of the scanner.
#[derive(Debug, PartialEq)]
pub struct Scan {
    /// Direction of beam 0, in rad, counter-clockwise from the x axis.
    pub angle_min: f32,
    /// Angle between consecutive beams, in rad; negative for a clockwise scan.
    pub angle_increment: f32,
    /// Minimum range that counts as measured, in m.
    pub range_min: f32,
    /// Maximum range that counts as measured, in m.
    pub range_max: f32,
    /// Time of the measurement, of beam 0 if they are one after the other.
    pub stamp: Time,
    /// Time between consecutive beams, in s: 0 if all measure at once, or if it is not known. What moves on in that
    /// time bends the scan, which [`CatchUp`](super::CatchUp) undoes.
    pub time_increment: f32,
    /// Ranges in m, by beam, with the values of REP 117 of ROS: infinity means that nothing is within range, NaN that
    /// nothing was measured, because the beam is covered, broken or filtered away. A range outside
    /// `range_min..=range_max` (minus infinity: too near) counts as not measured, too.
    pub ranges: Ranges,
}

impl Scan {
    /// Range of a beam in m, or `None` if nothing was measured.
    #[inline]
    pub fn range(&self, beam: usize) -> Option<f32> {
        self.ranges.get(beam).copied().filter(|&r| self.is_measured(r))
    }

    /// Range of a beam as far as it is known, in m: infinity if nothing is within range, and NaN if nothing was
    /// measured.
    #[inline]
    pub fn sight(&self, beam: usize) -> f32 {
        let range = self.ranges.get(beam).copied().unwrap_or(f32::NAN);
        if self.is_measured(range) || range == f32::INFINITY { range } else { f32::NAN }
    }

    /// Returns `true` if the scan is a full turn: its first beam is next to its last one.
    pub fn is_full_turn(&self) -> bool {
        let step = self.angle_increment.abs();
        // Up to a beam more, as some scanners repeat the first direction at the end, or less.
        self.ranges.len() > 2 && (self.ranges.len() as f32 * step - TAU).abs() <= 1.5 * step
    }

    /// Index of a beam that is counted on beyond either end of the scan: across the seam of a full turn, or `None`
    /// outside the field of view.
    pub fn beam_around(&self, beam: isize) -> Option<usize> {
        let count = self.ranges.len() as isize;
        let is_inside = (0..count).contains(&beam);
        (is_inside || self.is_full_turn()).then(|| beam.rem_euclid(count) as usize)
    }

    /// Returns `true` if a range is finite and between `range_min` and `range_max`.
    #[inline]
    pub fn is_measured(&self, range: f32) -> bool {
        // False for NaN.
        range.is_finite() && range >= self.range_min && range <= self.range_max
    }

    /// Returns `true` if a beam has measured something, or that nothing is within range (infinity). A scan without
    /// beams, or of NaN only, is that of a scanner that has failed.
    pub fn measures_anything(&self) -> bool {
        (0..self.ranges.len()).any(|beam| !self.sight(beam).is_nan())
    }

    /// Direction of a beam, in rad.
    pub fn angle(&self, beam: usize) -> f32 {
        self.angle_min + beam as f32 * self.angle_increment
    }

    /// Time of the measurement of a beam.
    pub fn time(&self, beam: usize) -> Time {
        // No time for a number that is none, which is what other programs may send.
        self.stamp + Duration::try_from_secs_f32(beam as f32 * self.time_increment).unwrap_or_default()
    }

    /// Index of the beam nearest to a direction in rad, or `None` outside the field of view.
    pub fn beam_towards(&self, angle: f32) -> Option<usize> {
        let turn = TAU;
        // Relative to the middle of the field of view, so that multiples of a full turn in `angle` do not matter.
        let middle = self.angle(self.ranges.len()) * 0.5 + self.angle_min * 0.5;
        let beam = (middle + libm::remainderf(angle - middle, turn) - self.angle_min) / self.angle_increment;
        let beam = libm::roundf(beam);
        // False for NaN, which results from a scan without beams or without an angle increment.
        (beam >= 0.0 && beam < self.ranges.len() as f32).then_some(beam as usize)
    }

    /// Measured points in the frame of the scanner with the indices of their beams, in order.
    ///
    /// Rotates one direction vector from beam to beam, which is several times faster than two trigonometric functions
    /// per beam. In double precision, the error after a full turn is below 10⁻¹² rad.
    ///
    /// Whatever turns scans into points again and again keeps [`BeamDirections`](super::BeamDirections).
    pub fn points(&self) -> impl Iterator<Item = (usize, Point2)> + '_ {
        self.points_in(directions(self.angle_min, self.angle_increment))
    }

    /// Measured points, given the directions of the beams.
    #[inline]
    pub(super) fn points_in(&self, directions: impl Iterator<Item = Point2>) -> impl Iterator<Item = (usize, Point2)> {
        let beams = self.ranges.iter().zip(directions).enumerate();
        let measured = beams.filter(|(_, (range, _))| self.is_measured(**range));
        measured.map(|(beam, (range, direction))| (beam, direction.scaled(*range)))
    }
}

/// Directions of beams as vectors of length 1, without end.
pub(super) fn directions(angle_min: f32, angle_increment: f32) -> impl Iterator<Item = Point2> {
    let (mut sin, mut cos) = libm::sincos(f64::from(angle_min));
    let (step_sin, step_cos) = libm::sincos(f64::from(angle_increment));
    core::iter::repeat_with(move || {
        let direction = Point2::new(cos as f32, sin as f32);
        (cos, sin) = (cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin);
        direction
    })
}

/// Copies into a scan use the memory of its ranges again.
impl Clone for Scan {
    fn clone(&self) -> Self {
        Self { ranges: self.ranges.clone(), ..*self }
    }

    fn clone_from(&mut self, other: &Self) {
        let mut ranges = core::mem::take(&mut self.ranges);
        ranges.clone_from(&other.ranges);
        *self = Self { ranges, ..*other };
    }
}

/// A scan without beams. Any positive finite range counts as measured.
impl Default for Scan {
    fn default() -> Self {
        Self {
            angle_min: 0.0,
            angle_increment: 0.0,
            range_min: f32::MIN_POSITIVE,
            range_max: f32::MAX,
            stamp: Time::ZERO,
            time_increment: 0.0,
            ranges: Ranges::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    #[test]
    fn only_measured_ranges_are_points() {
        let mut scan = Scan { angle_increment: 0.1, range_max: 10.0, ..Scan::default() };
        scan.ranges.extend([1.0, 0.0, f32::NAN, f32::INFINITY, 10.5, -1.0, 2.0]);
        let beams: std::vec::Vec<usize> = scan.points().map(|(beam, _)| beam).collect();
        assert_eq!(beams, [0, 6]);
        assert_eq!((scan.range(0), scan.range(1), scan.range(99)), (Some(1.0), None, None));
    }

    #[test]
    fn nothing_in_range_is_a_measurement_and_no_number_is_none() {
        let measures = |ranges: &[f32]| {
            let mut scan = Scan { range_min: 0.1, range_max: 10.0, ..Scan::default() };
            scan.ranges.extend(ranges.iter().copied());
            scan.measures_anything()
        };
        assert!([[f32::NAN, 1.0], [f32::NAN, f32::INFINITY]].iter().all(|ranges| measures(ranges)));
        let failed: [&[f32]; 3] = [&[], &[f32::NAN; 3], &[0.0, -1.0, f32::NEG_INFINITY]];
        assert!(!failed.iter().any(|ranges| measures(ranges)));
    }

    #[test]
    fn nothing_in_range_is_not_the_same_as_no_measurement() {
        let mut scan = Scan { range_min: 0.1, range_max: 10.0, ..Scan::default() };
        scan.ranges.extend([1.0, f32::INFINITY, f32::NAN, f32::NEG_INFINITY, 11.0, 0.05]);
        let seen: std::vec::Vec<f32> = (0..7).map(|beam| scan.sight(beam)).collect();
        assert_eq!(seen[..2], [1.0, f32::INFINITY]);
        assert!(seen[2..].iter().all(|range| range.is_nan()), "{seen:?}");
    }

    #[test]
    fn beams_are_counted_across_the_seam_of_a_full_turn_alone() {
        for step in [1.0_f32, -1.0, 0.25] {
            for (angle, is_full) in [(360.0, true), (361.0, true), (360.0 - step.abs(), true), (270.0, false)] {
                let count = (angle / step.abs()) as usize;
                let mut scan = Scan { angle_increment: step.to_radians(), ..Scan::default() };
                scan.ranges.extend((0..count).map(|_| 1.0));
                // One beam more is the first direction again; 361° at a quarter of a degree is more than a turn.
                let is_full = is_full && (step != 0.25 || angle != 361.0);
                assert_eq!(scan.is_full_turn(), is_full, "{count} beams of {step}°");
                let ends = [-1, 0, count as isize].map(|beam| scan.beam_around(beam));
                assert_eq!(ends, if is_full { [Some(count - 1), Some(0), Some(0)] } else { [None, Some(0), None] });
            }
        }
        assert!(!Scan::default().is_full_turn() && Scan::default().beam_around(0).is_none());
    }

    #[test]
    fn points_agree_with_trigonometry() {
        let mut scan = Scan { angle_min: -PI, angle_increment: 2.0 * PI / 1440.0, ..Scan::default() };
        scan.ranges.extend([5.0; 1440]);
        for (beam, point) in scan.points() {
            assert!((point - Point2::polar(5.0, scan.angle(beam))).norm() < 1e-5, "beam {beam}");
        }
    }

    #[test]
    fn beams_are_found_by_direction_in_any_turn() {
        let mut scan = Scan { angle_min: -2.0, angle_increment: 0.1, ..Scan::default() };
        assert_eq!(scan.beam_towards(0.0), None);
        scan.ranges.extend([1.0; 41]);
        for beam in 0..41 {
            for turn in [-2.0 * PI, 0.0, 2.0 * PI] {
                assert_eq!(scan.beam_towards(scan.angle(beam) + turn), Some(beam));
            }
        }
        assert_eq!((scan.beam_towards(3.0), scan.beam_towards(f32::NAN)), (None, None));
    }
}

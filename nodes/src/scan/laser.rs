use super::Point2;
use apex_rt::Time;
use heapless::Vec;

/// Maximum number of beams of a [`Scan`]. Holds a full turn at 0.25° (1440 beams) and common 270° scanners (1081
/// beams).
pub const MAX_BEAMS: usize = 1536;

/// One sweep of a plane laser scanner, in the frame of the scanner.
#[derive(Debug, Clone, PartialEq)]
pub struct Scan {
    /// Direction of beam 0, in rad, counter-clockwise from the x axis.
    pub angle_min: f32,
    /// Angle between consecutive beams, in rad; negative for a clockwise scan.
    pub angle_increment: f32,
    /// Minimum range that counts as measured, in m.
    pub range_min: f32,
    /// Maximum range that counts as measured, in m.
    pub range_max: f32,
    /// Time of the measurement.
    pub stamp: Time,
    /// Ranges in m, by beam. NaN, infinite, or outside `range_min..=range_max` means that nothing was measured.
    pub ranges: Vec<f32, MAX_BEAMS>,
}

impl Scan {
    /// Range of a beam in m, or `None` if nothing was measured.
    #[inline]
    pub fn range(&self, beam: usize) -> Option<f32> {
        self.ranges.get(beam).copied().filter(|&r| self.is_measured(r))
    }

    /// Returns `true` if a range is finite and between `range_min` and `range_max`.
    #[inline]
    pub fn is_measured(&self, range: f32) -> bool {
        // False for NaN.
        range.is_finite() && range >= self.range_min && range <= self.range_max
    }

    /// Returns `true` if a beam has measured something, or that nothing is in its range (∞, or beyond `range_max`). A
    /// scan without beams, or of NaN only, is that of a scanner that has failed.
    pub fn measures_anything(&self) -> bool {
        self.ranges.iter().any(|range| *range >= self.range_min)
    }

    /// Direction of a beam, in rad.
    pub fn angle(&self, beam: usize) -> f32 {
        self.angle_min + beam as f32 * self.angle_increment
    }

    /// Index of the beam nearest to a direction in rad, or `None` outside the field of view.
    pub fn beam_towards(&self, angle: f32) -> Option<usize> {
        let turn = core::f32::consts::TAU;
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
    pub fn points(&self) -> impl Iterator<Item = (usize, Point2)> + '_ {
        let (sin, cos) = libm::sincos(f64::from(self.angle_min));
        let (step_sin, step_cos) = libm::sincos(f64::from(self.angle_increment));
        let mut direction = (cos, sin);
        self.ranges.iter().enumerate().filter_map(move |(beam, &range)| {
            let (c, s) = direction;
            direction = (c * step_cos - s * step_sin, s * step_cos + c * step_sin);
            self.is_measured(range).then(|| (beam, Point2::new(range * c as f32, range * s as f32)))
        })
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
            ranges: Vec::new(),
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
        assert!([[f32::NAN, 1.0], [f32::NAN, f32::INFINITY], [0.0, 11.0]].iter().all(|ranges| measures(ranges)));
        let failed: [&[f32]; 3] = [&[], &[f32::NAN; 3], &[0.0, -1.0, f32::NEG_INFINITY]];
        assert!(!failed.iter().any(|ranges| measures(ranges)));
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

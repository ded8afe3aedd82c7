use super::{Point2, Scan};
use apex_rt::{Out, node};
use core::fmt;
use heapless::Vec;

/// Maximum number of segments of a scan.
pub const MAX_SEGMENTS: usize = 512;

/// Segments of one scan, in the order of their beams.
pub type Segments = Vec<Segment, MAX_SEGMENTS>;

/// Segment of a scan: neighbouring points that belong together, with the range of their beams and their bounding box.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Segment {
    /// First beam.
    pub first: u16,
    /// Last beam, included.
    pub last: u16,
    /// Number of these beams with a measurement.
    pub points: u16,
    /// Smallest coordinates of the points, in m, in the frame of the scanner.
    pub min: Point2,
    /// Largest coordinates of the points, in m, in the frame of the scanner.
    pub max: Point2,
}

impl Segment {
    /// Creates the segment of one point.
    fn of(beam: u16, point: Point2) -> Self {
        Self { first: beam, last: beam, points: 1, min: point, max: point }
    }

    /// Appends a point.
    fn push(&mut self, beam: u16, point: Point2) {
        self.last = beam;
        self.points += 1;
        self.min = Point2::new(self.min.x.min(point.x), self.min.y.min(point.y));
        self.max = Point2::new(self.max.x.max(point.x), self.max.y.max(point.y));
    }

    /// Mid-range of the points: the centre of their bounding box (thesis eq. 6.11).
    ///
    /// The equation is printed with a minus between maximum and minimum, which would be half the extent; the text calls
    /// it the mid-range, which is half the sum.
    #[inline]
    pub fn mid_range(&self) -> Point2 {
        (self.min + self.max).scaled(0.5)
    }

    /// Diagonal of the bounding box, in m.
    pub fn size(&self) -> f32 {
        (self.max - self.min).norm()
    }
}

/// Error of a scan with more than [`MAX_SEGMENTS`] segments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooManySegments;

impl fmt::Display for TooManySegments {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the scan falls into more than {MAX_SEGMENTS} segments")
    }
}

impl core::error::Error for TooManySegments {}

/// Splits a scan into segments where neighbouring ranges jump (thesis 6.6.1).
///
/// Fails on a scan of more than [`MAX_SEGMENTS`] segments.
#[node]
#[derive(Debug, Clone)]
pub struct JumpDistance {
    /// Minimum difference of neighbouring ranges that begins a new segment (δ_s).
    #[param(unit = "m", default = 0.15, range = 0.0..=2.0)]
    gap: f32,
    /// Maximum number of consecutive beams without a measurement inside a segment.
    #[param(default = 1, range = 0..=100)]
    max_gap_beams: usize,
}

#[node]
impl JumpDistance {
    fn process(&mut self, scan: &Scan, segments: &mut Out<Segments>) -> Result<(), TooManySegments> {
        let list = segments.get_mut();
        list.clear();
        let mut last: Option<(usize, f32)> = None;
        for (beam, point) in scan.points() {
            let range = scan.ranges[beam];
            let joins =
                last.is_some_and(|(before, r)| beam - before <= self.max_gap_beams + 1 && (range - r).abs() < self.gap);
            last = Some((beam, range));
            match list.last_mut() {
                Some(segment) if joins => segment.push(beam as u16, point),
                _ => {
                    if list.push(Segment::of(beam as u16, point)).is_err() {
                        segments.clear();
                        return Err(TooManySegments);
                    }
                }
            }
        }
        Ok(())
    }
}

/// Keeps the segments that could be a wheel: small, near and with enough points (thesis 6.6.1).
#[node]
#[derive(Debug, Clone)]
pub struct SegmentFilter {
    /// Maximum diagonal of the bounding box of a segment.
    #[param(unit = "m", default = 0.3, range = 0.0..=100.0)]
    max_size: f32,
    /// Maximum distance of the mid-range from the scanner.
    #[param(unit = "m", default = 6.0, range = 0.0..=1000.0)]
    max_distance: f32,
    /// Minimum number of points of a segment.
    #[param(default = 2, range = 1..=1000)]
    min_points: u16,
}

#[node]
impl SegmentFilter {
    fn process(&mut self, segments: &Segments, kept: &mut Out<Segments>) {
        let kept = kept.get_mut();
        kept.clear();
        kept.extend(segments.iter().filter(|s| self.keeps(s)).copied());
    }

    fn keeps(&self, segment: &Segment) -> bool {
        segment.points >= self.min_points
            && segment.size() <= self.max_size
            && segment.mid_range().norm() <= self.max_distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn split(ranges: &[f32], gap: f32, max_gap_beams: usize) -> std::vec::Vec<(u16, u16, u16)> {
        let scan = Scan { angle_increment: 0.01, ranges: ranges.iter().copied().collect(), ..Scan::default() };
        let mut out = Out::new();
        JumpDistance::construct((gap, max_gap_beams)).process(&scan, &mut out).expect("few segments");
        out.get().expect("segments").iter().map(|s| (s.first, s.last, s.points)).collect()
    }

    #[test]
    fn splits_where_ranges_jump() {
        assert_eq!(split(&[1.0, 1.1, 1.2, 2.0, 2.1, 1.0], 0.15, 0), [(0, 2, 3), (3, 4, 2), (5, 5, 1)]);
    }

    #[test]
    fn a_jump_of_exactly_the_gap_splits() {
        assert_eq!(split(&[1.0, 1.5], 0.5, 0).len(), 2);
        assert_eq!(split(&[1.0, 1.5], 0.51, 0).len(), 1);
    }

    #[test]
    fn bridges_only_short_holes() {
        let ranges = [1.0, f32::NAN, 1.0, 0.0, 0.0, 1.0];
        assert_eq!(split(&ranges, 0.15, 1), [(0, 2, 2), (5, 5, 1)]);
        assert_eq!(split(&ranges, 0.15, 0).len(), 3);
    }

    #[test]
    fn an_empty_scan_has_no_segments() {
        assert_eq!(split(&[], 0.15, 1), []);
        assert_eq!(split(&[f32::NAN; 5], 0.15, 1), []);
    }

    #[test]
    fn too_many_segments_are_an_error() {
        let ranges: std::vec::Vec<f32> = (0..=MAX_SEGMENTS).map(|i| 1.0 + (i % 2) as f32).collect();
        let scan = Scan { ranges: ranges.iter().copied().collect(), ..Scan::default() };
        let mut out = Out::new();
        assert_eq!(JumpDistance::construct((0.15, 1)).process(&scan, &mut out), Err(TooManySegments));
        assert!(out.get().is_none());
    }

    #[test]
    fn mid_range_is_the_middle_of_the_box() {
        let mut segment = Segment::of(0, Point2::new(1.0, 1.0));
        segment.push(1, Point2::new(1.2, 0.8));
        segment.push(2, Point2::new(1.2, 0.6));
        assert!((segment.mid_range() - Point2::new(1.1, 0.8)).norm() < 1e-6);
        assert!((segment.size() - 0.2_f32.hypot(0.4)).abs() < 1e-6);
    }

    #[test]
    fn filter_drops_large_far_and_thin_segments() {
        let segment = |x: f32, size: f32, points: u16| Segment {
            first: 0,
            last: points - 1,
            points,
            min: Point2::new(x, 0.0),
            max: Point2::new(x, size),
        };
        let all: Segments = [segment(1.0, 0.1, 5), segment(1.0, 0.5, 5), segment(9.0, 0.1, 5), segment(1.0, 0.1, 1)]
            .into_iter()
            .collect();
        let mut out = Out::new();
        SegmentFilter::construct((0.3, 6.0, 2)).process(&all, &mut out);
        assert_eq!(out.get().expect("segments").as_slice(), &all[..1]);
    }
}

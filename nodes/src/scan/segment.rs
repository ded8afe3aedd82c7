use super::{BeamDirections, Point2, Scan};
use apex_rt::{Out, node};
use core::{fmt, ops::RangeInclusive};
use heapless::Vec;

/// Maximum number of segments of a scan.
pub const MAX_SEGMENTS: usize = 512;

/// Segments of one scan, in the order of their beams.
pub type Segments = Vec<Segment, MAX_SEGMENTS>;

/// Segment of a scan: neighbouring points that belong together, with the range of their beams and their bounding box.
///
/// In a scan that is a full turn, a segment may cross the seam from the last beam to the first one. Then its first beam
/// has a greater index than its last one.
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

    /// Takes the points of the segment that follows across the seam of a full turn.
    fn join(&mut self, next: &Self) {
        self.last = next.last;
        self.points = self.points.saturating_add(next.points);
        self.min = Point2::new(self.min.x.min(next.min.x), self.min.y.min(next.min.y));
        self.max = Point2::new(self.max.x.max(next.max.x), self.max.y.max(next.max.y));
    }

    /// Beams of the segment in a scan of `count` beams, in their order. They are counted on beyond the last beam of the
    /// scan if the segment crosses the seam of a full turn: their indices are the remainders of a division by `count`.
    pub fn counted(&self, count: usize) -> RangeInclusive<usize> {
        let (first, last) = (usize::from(self.first), usize::from(self.last));
        first..=if first <= last { last } else { last + count }
    }

    /// Beams of the segment in a scan of `count` beams, in their order.
    pub fn beams(&self, count: usize) -> impl Iterator<Item = usize> + Clone + use<> {
        self.counted(count).map(move |beam| if beam < count { beam } else { beam - count })
    }

    /// Returns `true` if a beam belongs to the segment, with or without a measurement.
    pub fn contains(&self, beam: usize) -> bool {
        let (is_behind, is_before) = (beam >= usize::from(self.first), beam <= usize::from(self.last));
        if self.first <= self.last { is_behind && is_before } else { is_behind || is_before }
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

/// Splits a scan into segments where neighbouring ranges jump (thesis 6.6.1). What stands across the seam of a full
/// turn, between its last and its first beam, is one segment, which is the last one.
///
/// Fails on a scan of more than [`MAX_SEGMENTS`] segments.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct JumpDistance {
    /// Minimum difference of neighbouring ranges that begins a new segment (δ_s).
    #[param(unit = "m", default = 0.15, range = 0.0..=2.0)]
    gap: f32,
    /// Maximum number of consecutive beams without a measurement inside a segment.
    #[param(default = 1, range = 0..=100)]
    max_gap_beams: usize,
    directions: BeamDirections,
}

#[node]
impl JumpDistance {
    fn process(&mut self, scan: &Scan, segments: &mut Out<Segments>) -> Result<(), TooManySegments> {
        let mut directions = core::mem::take(&mut self.directions);
        let split = self.split(scan, directions.points(scan), segments.get_mut());
        self.directions = directions;
        if split.is_err() {
            segments.clear();
        }
        split
    }

    /// Splits the measured points of a scan.
    fn split(
        &self,
        scan: &Scan,
        points: impl Iterator<Item = (usize, Point2)>,
        list: &mut Segments,
    ) -> Result<(), TooManySegments> {
        list.clear();
        let mut last: Option<(usize, f32)> = None;
        for (beam, point) in points {
            let range = scan.ranges[beam];
            let joins = last.is_some_and(|(before, r)| self.joins(beam - before, range - r));
            last = Some((beam, range));
            match list.last_mut() {
                Some(segment) if joins => segment.push(beam as u16, point),
                _ => list.push(Segment::of(beam as u16, point)).map_err(|_| TooManySegments)?,
            }
        }
        self.close(scan, list);
        Ok(())
    }

    /// Returns `true` if two points belong together whose beams and ranges differ by so much.
    fn joins(&self, beams: usize, ranges: f32) -> bool {
        beams <= self.max_gap_beams + 1 && ranges.abs() < self.gap
    }

    /// Joins the last segment of a full turn with the first one, if they belong together.
    fn close(&self, scan: &Scan, list: &mut Segments) {
        let [first, .., last] = &**list else { return };
        let ends = scan.range(first.first.into()).zip(scan.range(last.last.into()));
        let beams = usize::from(first.first) + scan.ranges.len() - usize::from(last.last);
        if scan.is_full_turn() && ends.is_some_and(|(a, b)| self.joins(beams, a - b)) {
            let first = list.remove(0);
            list.last_mut().into_iter().for_each(|last| last.join(&first));
        }
    }
}

/// Keeps the segments that could be a wheel: small, near and with enough points (thesis 6.6.1).
#[node]
#[keeps_frame]
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

    /// Scan of a full turn.
    fn turn(ranges: &[f32]) -> Scan {
        let angle_increment = core::f32::consts::TAU / ranges.len() as f32;
        Scan { angle_increment, ranges: ranges.iter().copied().collect(), ..Scan::default() }
    }

    #[test]
    fn what_stands_across_the_seam_is_one_segment() {
        let split = |ranges: &[f32]| {
            let mut out = Out::new();
            JumpDistance::construct((0.15, 1)).process(&turn(ranges), &mut out).expect("few segments");
            out.get().expect("segments").clone()
        };
        let parts =
            |ranges: &[f32]| split(ranges).iter().map(|s| (s.first, s.last, s.points)).collect::<std::vec::Vec<_>>();
        assert_eq!(parts(&[1.0, 1.0, 2.0, 2.0, 1.0, 1.0]), [(2, 3, 2), (4, 1, 4)]);
        // A beam without a measurement at the seam; a gap of two; another range; one thing all around.
        assert_eq!(parts(&[f32::NAN, 1.0, 2.0, 2.0, 1.0, 1.0]), [(2, 3, 2), (4, 1, 3)]);
        assert_eq!(parts(&[f32::NAN, 1.0, 2.0, 2.0, 1.0, f32::NAN]).len(), 3);
        assert_eq!(parts(&[3.0, 3.0, 2.0, 2.0, 1.0, 1.0]).len(), 3);
        assert_eq!(parts(&[1.0; 6]), [(0, 5, 6)]);
        let across = split(&[1.0, 1.0, 2.0, 2.0, 1.0, 1.0])[1];
        assert!(across.beams(6).eq([4, 5, 0, 1]) && across.counted(6).eq(4..=7));
        assert!((0..6).map(|beam| across.contains(beam)).eq([true, true, false, false, true, true]));
        assert!((across.max.y - 0.866).abs() < 1e-3 && (across.min.y + 0.866).abs() < 1e-3, "{across:?}");
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

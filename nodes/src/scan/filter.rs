use super::{Point2, Scan, Segment, Segments};
use apex_rt::{Out, node};
use heapless::Vec;

/// Marks invalid ranges as not measured (NaN): zero, minus infinity, outside the limits of the scanner, or less than
/// the minimum of this node. A range beyond the maximum of this node becomes infinity, as nothing is within range, and
/// infinity stays.
///
/// Beams keep their index, so that their angles stay right.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct RangeFilter {
    /// Minimum range that is kept.
    #[param(unit = "m", default = 0.05, range = 0.0..=100.0)]
    min: f32,
    /// Maximum range that is kept.
    #[param(unit = "m", default = 30.0, range = 0.0..=1000.0)]
    max: f32,
}

#[node]
impl RangeFilter {
    fn process(&mut self, scan: &Scan, filtered: &mut Out<Scan>) {
        let filtered = filtered.get_mut();
        filtered.clone_from(scan);
        for (beam, range) in filtered.ranges.iter_mut().enumerate() {
            *range = match scan.sight(beam) {
                seen if seen < self.min => f32::NAN,
                seen if seen > self.max => f32::INFINITY,
                seen => seen,
            };
        }
    }
}

/// Marks the beams of short segments as not measured (NaN): those whose ends are less than `min_length` apart (thesis
/// 4.3.5).
///
/// Walls remain. After `JumpDistance`, this removes other robots from a scan, so that they do not enter a map. The
/// segments must be those of the same scan.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct ShortSegmentFilter {
    /// Minimum distance between the first and the last point of a segment that is kept (S_min).
    #[param(unit = "m", default = 1.2, range = 0.0..=100.0)]
    min_length: f32,
}

#[node]
impl ShortSegmentFilter {
    fn process(&mut self, scan: &Scan, segments: &Segments, filtered: &mut Out<Scan>) {
        let filtered = filtered.get_mut();
        filtered.clone_from(scan);
        for segment in segments.iter().filter(|segment| length(scan, segment) < self.min_length) {
            for beam in segment.beams(scan.ranges.len()) {
                if let Some(range) = filtered.ranges.get_mut(beam) {
                    *range = f32::NAN;
                }
            }
        }
    }
}

/// Distance between the ends of a segment, in m. One that surrounds the scanner has none: it is as long as its bounding
/// box.
fn length(scan: &Scan, segment: &Segment) -> f32 {
    let end = |beam: u16| scan.range(beam.into()).map(|r| Point2::polar(r, scan.angle(beam.into())));
    let ends = end(segment.first).zip(end(segment.last)).map_or(0.0, |(a, b)| (a - b).norm());
    let is_around = segment.counted(scan.ranges.len()).count() + 1 >= scan.ranges.len() && scan.is_full_turn();
    if is_around { ends.max(segment.size()) } else { ends }
}

/// Passes a scan in which enough beams have measured something, or that nothing is within range (infinity); ⊥
/// otherwise. So a covered or broken scanner is not taken for free space, and the robot may drive in the open.
///
/// Some scanners report infinity when they are covered. Where walls are always within range, `min_seen` detects that.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct EnoughBeams {
    /// Minimum share of beams with a measurement, also of nothing in range.
    #[param(default = 0.3, range = 0.0..=1.0)]
    min_share: f32,
    /// Minimum share of beams that see something within range.
    #[param(default = 0.0, range = 0.0..=1.0)]
    min_seen: f32,
}

#[node]
impl EnoughBeams {
    fn process(&mut self, scan: &Scan, seen: &mut Out<Scan>) {
        let (mut answered, mut near) = (0, 0);
        for sight in (0..scan.ranges.len()).map(|beam| scan.sight(beam)) {
            answered += u32::from(!sight.is_nan());
            near += u32::from(sight.is_finite());
        }
        let share = |count: u32| count as f32 / scan.ranges.len() as f32;
        if answered > 0 && share(answered) >= self.min_share && share(near) >= self.min_seen {
            seen.get_mut().clone_from(scan);
        }
    }
}

/// Maximum window of a [`MedianFilter`], in beams.
const MAX_WINDOW: usize = 15;

/// Replaces each measured range by the median of the measured ranges in a window of beams around it.
///
/// Removes single wrong beams and keeps edges. Beams without a measurement, and those that see nothing within range,
/// stay as they are. With an even number of ranges in the window, the lower of the two middle ones is taken, so that
/// every range is a measured one. The window crosses the seam of a full turn.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct MedianFilter {
    /// Number of beams on each side in the window: 1 gives a window of 3.
    #[param(default = 1, range = 0..=7)]
    reach: usize,
}

#[node]
impl MedianFilter {
    fn process(&mut self, scan: &Scan, filtered: &mut Out<Scan>) {
        let filtered = filtered.get_mut();
        filtered.clone_from(scan);
        let reach = self.reach.min(MAX_WINDOW / 2) as isize;
        for (beam, range) in filtered.ranges.iter_mut().enumerate() {
            if scan.is_measured(*range) {
                let window = (-reach..=reach).filter_map(|i| scan.beam_around(beam as isize + i));
                *range = median(window.filter_map(|b| scan.range(b))).unwrap_or(*range);
            }
        }
    }
}

/// Lower median of at most [`MAX_WINDOW`] values, or `None` without values.
fn median(values: impl Iterator<Item = f32>) -> Option<f32> {
    let mut sorted: Vec<f32, MAX_WINDOW> = values.take(MAX_WINDOW).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blind_scanner_sends_nothing() {
        let passes = |min_seen: f32, measured: usize, other: f32| {
            let mut node = EnoughBeams::construct((0.3, min_seen));
            let mut scan = Scan { range_min: 0.05, range_max: 20.0, ..Scan::default() };
            scan.ranges.extend((0..100).map(|beam| if beam < measured { 3.0 } else { other }));
            let mut out = Out::new();
            node.process(&scan, out.begin());
            let bits = |scan: &Scan| scan.ranges.iter().map(|r| r.to_bits()).collect::<std::vec::Vec<_>>();
            assert!(out.get().is_none_or(|passed| bits(passed) == bits(&scan)));
            out.get().is_some()
        };
        for (min_seen, other) in [(0.0, f32::NAN), (0.0, f32::NEG_INFINITY), (0.0, 0.0), (0.3, f32::INFINITY)] {
            let passed = [0, 29, 31, 100].map(|measured| passes(min_seen, measured, other));
            assert_eq!(passed, [false, false, true, true], "{min_seen}, {other}");
        }
        // Nothing is within range, in all directions: the robot is in the open.
        assert_eq!([0, 29, 31, 100].map(|measured| passes(0.0, measured, f32::INFINITY)), [true; 4]);
    }
    use apex_rt::Construct;

    fn scan(ranges: &[f32]) -> Scan {
        Scan { range_min: 0.1, range_max: 20.0, ranges: ranges.iter().copied().collect(), ..Scan::default() }
    }

    fn measured(out: &Out<Scan>) -> std::vec::Vec<Option<f32>> {
        let scan = out.get().expect("the filter sends a scan");
        (0..scan.ranges.len()).map(|beam| scan.range(beam)).collect()
    }

    #[test]
    fn range_filter_marks_everything_unusable() {
        let mut node = RangeFilter::construct((0.5, 10.0));
        let mut out = Out::new();
        node.process(&scan(&[0.0, 0.4, 0.5, 10.0, 11.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0]), &mut out);
        let mut expected = [None; 9];
        expected[2] = Some(0.5);
        expected[3] = Some(10.0);
        assert_eq!(measured(&out), expected);
        // Nothing within range, as seen by the scanner or up to the maximum.
        let infinite = out.get().expect("a scan").ranges.iter().map(|range| *range == f32::INFINITY);
        assert!(infinite.eq([false, false, false, false, true, false, true, false, false]));
    }

    #[test]
    fn the_limits_of_the_scanner_count_too() {
        let mut node = RangeFilter::construct((0.0, 1000.0));
        let mut out = Out::new();
        node.process(&scan(&[0.05, 0.2, 25.0]), &mut out);
        assert_eq!(measured(&out), [None, Some(0.2), None]);
    }

    #[test]
    fn median_removes_a_spike_and_keeps_an_edge() {
        let mut node = MedianFilter::construct((1,));
        let mut out = Out::new();
        node.process(&scan(&[1.0, 1.0, 9.0, 1.0, 1.0, 5.0, 5.0, 5.0]), &mut out);
        assert_eq!(measured(&out), [1.0, 1.0, 1.0, 1.0, 1.0, 5.0, 5.0, 5.0].map(Some));
    }

    #[test]
    fn the_median_crosses_the_seam_of_a_full_turn() {
        let mut node = MedianFilter::construct((1,));
        let mut out = Out::new();
        let turn =
            Scan { angle_increment: 0.25 * core::f32::consts::PI, ..scan(&[9.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]) };
        node.process(&turn, &mut out);
        assert_eq!(measured(&out), [Some(1.0); 8]);
    }

    #[test]
    fn a_wall_across_the_seam_is_kept_and_one_thing_all_around_too() {
        use super::super::JumpDistance;
        let kept = |distance: &dyn Fn(f32) -> f32| {
            let mut turn =
                Scan { angle_increment: 0.5_f32.to_radians(), angle_min: -core::f32::consts::PI, ..Scan::default() };
            turn.ranges
                .extend((0..720).map(|beam| distance(-core::f32::consts::PI + 0.5_f32.to_radians() * beam as f32)));
            let (mut segments, mut out) = (Out::new(), Out::new());
            JumpDistance::construct((0.3, 1)).process(&turn, &mut segments).expect("few segments");
            let segments = segments.get().expect("segments");
            ShortSegmentFilter::construct((1.2,)).process(&turn, segments, &mut out);
            measured(&out).iter().flatten().count()
        };
        // A wall of 2 m, 1.5 m behind the scanner.
        let wall = |angle: f32| {
            let distance = -1.5 / libm::cosf(angle);
            if distance > 0.0 && (distance * libm::sinf(angle)).abs() <= 1.0 { distance } else { f32::INFINITY }
        };
        assert_eq!((kept(&wall), kept(&|_| 2.0)), (135, 720));
    }

    #[test]
    fn median_invents_nothing() {
        let mut node = MedianFilter::construct((2,));
        let mut out = Out::new();
        node.process(&scan(&[f32::NAN, 2.0, f32::NAN, 3.0]), &mut out);
        assert_eq!(measured(&out), [None, Some(2.0), None, Some(2.0)]);
        node.process(&scan(&[]), &mut out);
        assert_eq!(measured(&out), []);
    }

    #[test]
    fn short_segments_are_not_measured() {
        use super::super::JumpDistance;
        // A wall at x = 2 m, and a robot 40 cm wide before it.
        let mut wall = Scan { angle_min: -0.6, angle_increment: 0.05, ..Scan::default() };
        for beam in 0..25 {
            let distance = if (9..=15).contains(&beam) { 1.2 } else { 2.0 };
            wall.ranges.push(distance / libm::cosf(wall.angle(beam))).expect("few beams");
        }
        let mut segments = Out::new();
        JumpDistance::construct((0.1, 1)).process(&wall, &mut segments).expect("three segments");
        let segments = segments.get().expect("segments");
        assert_eq!(segments.len(), 3);
        for (min_length, kept) in [(0.3, 25), (0.5, 18), (1.2, 0)] {
            let mut out = Out::new();
            ShortSegmentFilter::construct((min_length,)).process(&wall, segments, &mut out);
            assert_eq!(measured(&out).iter().flatten().count(), kept, "{min_length}");
        }
        // Segments of another scan.
        let mut out = Out::new();
        let empty = Scan::default();
        ShortSegmentFilter::construct((9.0,)).process(&empty, segments, &mut out);
        assert_eq!(measured(&out), []);
    }
}

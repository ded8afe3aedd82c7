use crate::scan::{Point2, Scan, Segment, Segments};

/// Number of features of a segment.
pub const LEG_FEATURES: usize = 17;

/// Largest value of a distance or radius, in m: the value if there is none.
const FAR: f32 = 5.0;

/// Largest diagonal of a segment that may be the other leg, in m.
const LEG_SIZE: f32 = 0.4;

/// Number of beams next to a segment that are searched for the background.
const MARGIN: usize = 5;

/// Features of the shape of a segment, for a forest that detects legs (after Arras et al. 2007).
///
/// In order: number of points; share of the beams with a point; distance; width; diagonal; deviation from the centre;
/// deviation from a line; extent along it; radius of a circle, and deviation from it; length of the contour, and
/// deviation of its steps; bulge towards the scanner; mean turn between steps; how much farther the background is
/// before and behind it; distance of the nearest other small segment. Lengths are in m, angles in rad.
///
/// `None` if the segment does not exist or is not of this scan.
pub fn leg_features(scan: &Scan, segments: &Segments, at: usize) -> Option<[f32; LEG_FEATURES]> {
    let segment = segments.get(at)?;
    let points = || points(scan, segment);
    let count = points().count() as f32;
    let (first, last) = (points().next()?, points().last()?);
    let centre = points().fold(Point2::default(), |sum, p| sum + p).scaled(1.0 / count);
    let width = (last - first).norm();
    let [across, along] = spread(points().map(|p| p - centre));
    let [radius, roundness] = circle(points().map(|p| p - centre));
    let [contour, unevenness, turn] = contour(points());
    let [before, behind] = background(scan, segment);
    let beams = segment.counted(scan.ranges.len()).count() as f32;
    Some([
        count,
        count / beams,
        centre.norm(),
        width,
        segment.size(),
        libm::sqrtf(across * across + along * along),
        across,
        along,
        radius,
        roundness,
        contour,
        unevenness,
        bulge(points(), first, last),
        turn,
        before,
        behind,
        neighbour(segments, at),
    ])
}

fn points<'a>(scan: &'a Scan, segment: &Segment) -> impl Iterator<Item = Point2> + Clone + use<'a> {
    let beams = segment.beams(scan.ranges.len());
    beams.filter_map(|beam| scan.range(beam).map(|range| Point2::polar(range, scan.angle(beam))))
}

/// Standard deviations across and along the main axis of centred points.
fn spread(points: impl Iterator<Item = Point2>) -> [f32; 2] {
    let (mut count, mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0, 0.0);
    for p in points {
        (count, xx, xy, yy) = (count + 1.0, xx + p.x * p.x, xy + p.x * p.y, yy + p.y * p.y);
    }
    let (half_sum, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let root = libm::sqrtf(half_difference * half_difference + xy * xy);
    [half_sum - root, half_sum + root].map(|value: f32| libm::sqrtf(value.max(0.0) / f32::max(count, 1.0)))
}

/// Radius of the circle through centred points (Kåsa 1976), and their standard deviation from it.
fn circle(points: impl Iterator<Item = Point2> + Clone) -> [f32; 2] {
    let (mut count, mut xx, mut xy, mut yy, mut right) = (0.0_f32, 0.0, 0.0, 0.0, Point2::default());
    for p in points.clone() {
        (count, xx, xy, yy) = (count + 1.0, xx + p.x * p.x, xy + p.x * p.y, yy + p.y * p.y);
        right = right + p.scaled(0.5 * p.norm_squared());
    }
    let determinant = xx * yy - xy * xy;
    // Points on a line have a circle without end.
    if determinant <= 1e-6 * (xx + yy) * (xx + yy) {
        return [FAR, FAR];
    }
    let middle = Point2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x).scaled(1.0 / determinant);
    let radius = libm::sqrtf(middle.norm_squared() + (xx + yy) / count);
    let error = |p: Point2| (p - middle).norm() - radius;
    let squares: f32 = points.map(|p| error(p) * error(p)).sum();
    [radius.min(FAR), libm::sqrtf(squares / count).min(FAR)]
}

/// Length of the contour, standard deviation of its steps, and mean turn between steps.
fn contour(points: impl Iterator<Item = Point2>) -> [f32; 3] {
    let (mut steps, mut length, mut squares, mut turn) = (0.0, 0.0, 0.0, 0.0);
    let mut last: Option<(Point2, Option<Point2>)> = None;
    for p in points {
        let step = last.map(|(before, _)| p - before);
        if let Some(step) = step {
            (steps, length, squares) = (steps + 1.0, length + step.norm(), squares + step.norm_squared());
            if let Some((_, Some(before))) = last {
                turn += libm::atan2f(before.x * step.y - before.y * step.x, before.dot(step));
            }
        }
        last = Some((p, step));
    }
    let count = f32::max(steps, 1.0);
    let mean = length / count;
    [length, libm::sqrtf((squares / count - mean * mean).max(0.0)), turn / count]
}

/// Mean distance of points from the chord of a segment, positive towards the scanner.
fn bulge(points: impl Iterator<Item = Point2>, first: Point2, last: Point2) -> f32 {
    let chord = last - first;
    let length = chord.norm().max(1e-6);
    // On the side of the scanner, which is the origin, the sign is that of the origin.
    let side = |p: Point2| (chord.x * (p.y - first.y) - chord.y * (p.x - first.x)) / length;
    let sign = if side(Point2::default()) < 0.0 { -1.0 } else { 1.0 };
    let (count, sum) = points.fold((0.0, 0.0), |(count, sum), p| (count + 1.0, sum + side(p)));
    sign * sum / f32::max(count, 1.0)
}

/// Distances by which the points next to a segment are farther than its ends.
fn background(scan: &Scan, segment: &Segment) -> [f32; 2] {
    let (first, last) = (usize::from(segment.first), usize::from(segment.last));
    let beside = |beam: isize| scan.beam_around(beam).and_then(|beam| scan.range(beam));
    let before = (1..=MARGIN as isize).find_map(|i| beside(first as isize - i));
    let behind = (1..=MARGIN as isize).find_map(|i| beside(last as isize + i));
    let jump = |end: usize, other: Option<f32>| match (scan.range(end), other) {
        (Some(end), Some(other)) => (other - end).clamp(-FAR, FAR),
        _ => FAR,
    };
    [jump(first, before), jump(last, behind)]
}

/// Distance of the nearest other segment of at most the size of a leg.
fn neighbour(segments: &Segments, at: usize) -> f32 {
    let middle = segments[at].mid_range();
    let others = segments.iter().enumerate().filter(|(i, s)| *i != at && s.points > 1 && s.size() <= LEG_SIZE);
    others.map(|(_, s)| (s.mid_range() - middle).norm()).fold(FAR, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::JumpDistance;
    use apex_rt::{Construct, Out};

    fn features(ranges: impl IntoIterator<Item = f32>, at: usize) -> Option<[f32; LEG_FEATURES]> {
        let ranges = ranges.into_iter().collect();
        let scan = Scan { angle_min: -0.05, angle_increment: 0.005, ranges, ..Scan::default() };
        let mut out = Out::new();
        JumpDistance::construct((0.2, 2)).process(&scan, &mut out).expect("few segments");
        leg_features(&scan, out.get().expect("segments"), at)
    }

    #[test]
    fn a_circle_is_measured() {
        // A cylinder of radius 0.08 m in 2 m, before a background in 4 m.
        let ranges = (0..21).map(|beam| {
            let angle = -0.05 + 0.005 * beam as f32;
            let aside = 2.0 * libm::sinf(angle);
            if aside.abs() < 0.078 { 2.0 * libm::cosf(angle) - libm::sqrtf(0.0064 - aside * aside) } else { 4.0 }
        });
        let f = features(ranges, 1).expect("a segment");
        assert!((f[8] - 0.08).abs() < 0.01 && f[9] < 0.003, "{f:?}");
        assert!((f[2] - 1.94).abs() < 0.02 && f[12] > 0.01 && f[13].abs() > 0.05, "{f:?}");
        assert!((f[14] - 2.0).abs() < 0.1 && (f[15] - 2.0).abs() < 0.1, "{f:?}");
    }

    #[test]
    fn a_wall_is_straight() {
        let f = features((0..21).map(|beam| 2.0 / libm::cosf(-0.05 + 0.005 * beam as f32)), 0).expect("a segment");
        assert!(f[6] < 1e-3 && f[8] > 1.0 && f[13].abs() < 1e-2 && f[16] == FAR, "{f:?}");
    }

    #[test]
    fn odd_segments_do_no_harm() {
        assert_eq!(features([], 0), None);
        assert_eq!(features([1.0], 1), None);
        for ranges in [&[1.0][..], &[1.0; 2], &[1.0, f32::NAN, 1.0]] {
            let f = features(ranges.iter().copied(), 0).expect("a segment");
            assert!(f.iter().all(|x| x.is_finite()), "{f:?}");
        }
    }
}

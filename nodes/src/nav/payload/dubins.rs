use crate::scan::Pose2;
use core::f32::consts::TAU;
use libm::{acosf, atan2f, cosf, sinf, sqrtf};

/// Path of arcs and straight lines. All curvatures have the same magnitude, or are 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::nav) struct Curve {
    /// Pose at its beginning.
    pub start: Pose2,
    /// Curvature in 1/m, positive to the left, and length in m of each part.
    pub parts: [(f32, f32); 4],
}

impl Curve {
    /// Length, in m.
    pub fn length(&self) -> f32 {
        self.parts.iter().map(|(_, length)| length).sum()
    }

    /// Pose and curvature at `distance` m from the start. Beyond the end, the last part goes on.
    pub fn at(&self, distance: f32) -> (Pose2, f32) {
        let (mut pose, mut left) = (self.start, distance.max(0.0));
        for (i, &(curvature, length)) in self.parts.iter().enumerate() {
            if left <= length || i + 1 == self.parts.len() {
                return (advanced(&pose, curvature, left), curvature);
            }
            pose = advanced(&pose, curvature, length);
            left -= length;
        }
        (pose, 0.0)
    }
}

/// Pose after `length` m along an arc.
pub(in crate::nav) fn advanced(pose: &Pose2, curvature: f32, length: f32) -> Pose2 {
    pose.compose(&arc(curvature, length))
}

/// Pose at the end of an arc, in the frame of its start.
pub(in crate::nav) fn arc(curvature: f32, length: f32) -> Pose2 {
    let turn = curvature * length;
    if turn.abs() < 1e-4 {
        Pose2::new(length, 0.5 * turn * length, turn)
    } else {
        Pose2::new(sinf(turn) / curvature, (1.0 - cosf(turn)) / curvature, turn)
    }
}

/// Shortest curves of the six kinds between two poses, for a vehicle that only drives forward with at least this radius
/// in m (Dubins 1957; formulas of Shkel and Lumelsky 2001). A kind that does not connect the poses is left out. Each
/// ends with a straight line of `straight` m beyond `to`.
pub(in crate::nav) fn curves(from: &Pose2, to: &Pose2, radius: f32, straight: f32) -> impl Iterator<Item = Curve> {
    let way = to.position() - from.position();
    let (d, direction) = (way.norm() / radius, if way.norm() > 0.0 { way.angle() } else { 0.0 });
    let (from, to) = (*from, *to);
    words(turn(from.theta - direction), turn(to.theta - direction), d).into_iter().flatten().filter_map(
        move |(signs, lengths)| {
            let mut curve = Curve { start: from, parts: [(0.0, straight); 4] };
            for ((part, sign), length) in curve.parts.iter_mut().zip(signs).zip(lengths) {
                *part = (f32::from(sign) / radius, length * radius);
            }
            let (end, _) = curve.at(curve.length() - straight);
            let off = end.relative_to(&to);
            // Also false for NaN.
            (off.position().norm() < 0.01 && off.theta.abs() < 0.01).then_some(curve)
        },
    )
}

/// Length of the shortest of these curves, without a straight line at its end, in m.
pub(in crate::nav) fn shortest(from: &Pose2, to: &Pose2, radius: f32) -> f32 {
    let way = to.position() - from.position();
    let direction = if way.norm() > 0.0 { way.angle() } else { 0.0 };
    let words = words(turn(from.theta - direction), turn(to.theta - direction), way.norm() / radius);
    let lengths = words.into_iter().flatten().map(|(_, lengths)| lengths.iter().sum::<f32>());
    radius * lengths.fold(f32::INFINITY, f32::min)
}

/// Signs of the curvatures of three parts, and their lengths in radii.
type Word = Option<([i8; 3], [f32; 3])>;

fn words(a: f32, b: f32, d: f32) -> [Word; 6] {
    let ([sa, ca], [sb, cb]) = ([sinf(a), cosf(a)], [sinf(b), cosf(b)]);
    let cab = cosf(a - b);
    let root = |square: f32| (square >= 0.0).then(|| sqrtf(square));
    let lsl = root(2.0 + d * d - 2.0 * cab + 2.0 * d * (sa - sb)).map(|p| {
        let t = atan2f(cb - ca, d + sa - sb);
        ([1, 0, 1], [turn(t - a), p, turn(b - t)])
    });
    let rsr = root(2.0 + d * d - 2.0 * cab + 2.0 * d * (sb - sa)).map(|p| {
        let t = atan2f(ca - cb, d - sa + sb);
        ([-1, 0, -1], [turn(a - t), p, turn(t - b)])
    });
    let lsr = root(d * d - 2.0 + 2.0 * cab + 2.0 * d * (sa + sb)).map(|p| {
        let t = atan2f(-ca - cb, d + sa + sb) - atan2f(-2.0, p);
        ([1, 0, -1], [turn(t - a), p, turn(t - b)])
    });
    let rsl = root(d * d - 2.0 + 2.0 * cab - 2.0 * d * (sa + sb)).map(|p| {
        let t = atan2f(ca + cb, d - sa - sb) - atan2f(2.0, p);
        ([-1, 0, 1], [turn(a - t), p, turn(b - t)])
    });
    let middle = |c: f32| (c.abs() <= 1.0).then(|| TAU - acosf(c));
    let rlr = middle((6.0 - d * d + 2.0 * cab + 2.0 * d * (sa - sb)) / 8.0).map(|p| {
        let t = turn(a - atan2f(ca - cb, d - sa + sb) + 0.5 * p);
        ([-1, 1, -1], [t, p, turn(a - b - t + p)])
    });
    let lrl = middle((6.0 - d * d + 2.0 * cab + 2.0 * d * (sb - sa)) / 8.0).map(|p| {
        let t = turn(-a + atan2f(cb - ca, d + sa - sb) + 0.5 * p);
        ([1, -1, 1], [t, p, turn(b - a - t + p)])
    });
    [lsl, rsr, lsr, rsl, rlr, lrl]
}

/// Angle in [0, 2π). Almost a full turn counts as none, so that rounding does not add a circle.
fn turn(angle: f32) -> f32 {
    let angle = libm::fmodf(angle, TAU);
    let angle = if angle < 0.0 { angle + TAU } else { angle };
    if angle > TAU - 1e-4 { 0.0 } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_end_at_the_goal() {
        let mut kinds = 0;
        for i in 0..200 {
            let f = i as f32;
            let from = Pose2::new(sinf(f), cosf(1.7 * f), f);
            let to = Pose2::new(2.0 * sinf(2.3 * f), 2.0 * cosf(0.9 * f), 1.3 * f);
            let all: std::vec::Vec<Curve> = curves(&from, &to, 0.7, 0.5).collect();
            assert!(all.len() >= 2, "{} curves from {from:?} to {to:?}", all.len());
            kinds += all.len();
            let least = all.iter().map(|curve| curve.length() - 0.5).fold(f32::INFINITY, f32::min);
            assert!((shortest(&from, &to, 0.7) - least).abs() < 1e-3, "{least} m from {from:?} to {to:?}");
            for curve in all {
                let (end, _) = curve.at(curve.length());
                let off = end.relative_to(&to);
                assert!((off.x - 0.5).abs() < 0.02 && off.y.abs() < 0.02, "{off:?}");
            }
        }
        assert!(kinds > 800, "{kinds}");
    }

    #[test]
    fn straight_ahead_is_straight() {
        let best = curves(&Pose2::default(), &Pose2::new(2.0, 0.0, 0.0), 0.5, 1.0)
            .min_by(|a, b| a.length().total_cmp(&b.length()))
            .expect("a curve");
        assert!((best.length() - 3.0).abs() < 1e-3, "{best:?}");
    }

    #[test]
    fn what_is_not_a_pose_has_no_curve() {
        let nowhere = Pose2::new(f32::NAN, 0.0, 0.0);
        assert_eq!(curves(&nowhere, &Pose2::default(), 0.5, 1.0).count(), 0);
        assert_eq!(curves(&Pose2::default(), &nowhere, 0.5, 1.0).count(), 0);
    }
}

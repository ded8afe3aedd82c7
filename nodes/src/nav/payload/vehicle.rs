use crate::{
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_rt::Units;
use libm::{fmaxf, sincosf, sqrtf};

/// Tractor with two driven wheels and a trailer with one axis, which follows passively. All lengths in m.
#[derive(Debug, Clone, Copy, PartialEq, Units)]
pub struct Articulated {
    /// Distance from the axis of the tractor back to the hitch.
    #[unit("m")]
    pub hitch: f32,
    /// Distance from the hitch back to the axis of the trailer.
    #[unit("m")]
    pub drawbar: f32,
    /// Distance from the axis of the tractor to its front.
    #[unit("m")]
    pub front: f32,
    /// Distance from the axis of the trailer back to its rear.
    #[unit("m")]
    pub rear: f32,
    /// Width of both.
    #[unit("m")]
    pub width: f32,
}

impl Articulated {
    /// A vehicle of the size of PATSY, of which the thesis gives no dimensions: 1.05 m × 0.4 m fit beneath a container
    /// of 1.2 m × 0.7 m.
    pub const PATSY: Self = Self { hitch: 0.1, drawbar: 0.55, front: 0.25, rear: 0.15, width: 0.4 };

    /// Length of the straight vehicle, in m.
    pub const fn length(&self) -> f32 {
        self.front + self.hitch + self.drawbar + self.rear
    }

    /// Distance from the middle of the straight vehicle forward to the axis of the tractor, in m.
    pub const fn axis(&self) -> f32 {
        0.5 * self.length() - self.front
    }

    /// Distance from the axis of the trailer forward to the middle of the straight vehicle, above which its load is, in
    /// m.
    pub const fn lift(&self) -> f32 {
        0.5 * self.length() - self.rear
    }

    /// Rear-most point of the trailer whose axis is at `trailer`.
    pub fn rear_most(&self, trailer: &Pose2) -> Point2 {
        trailer.to_outer(Point2::new(-self.rear, 0.0))
    }

    /// Pose of the axis of a trailer with this heading, in rad, behind a tractor.
    pub fn trailer(&self, base: &Pose2, heading: f32) -> Pose2 {
        let hitch = base.to_outer(Point2::new(-self.hitch, 0.0));
        let axis = hitch - Point2::polar(self.drawbar, heading);
        Pose2::new(axis.x, axis.y, heading)
    }

    /// Points on the outline: the sides of the tractor and those of the trailer.
    pub fn outline(&self, base: &Pose2, heading: f32) -> [Point2; 10] {
        let (trailer, half) = (self.trailer(base, heading), 0.5 * self.width);
        let tractor = |x: f32, y: f32| base.to_outer(Point2::new(x, y));
        let behind = |x: f32, y: f32| trailer.to_outer(Point2::new(x, y));
        let middle = 0.5 * self.drawbar;
        [
            tractor(self.front, half),
            tractor(self.front, -half),
            tractor(-self.hitch, half),
            tractor(-self.hitch, -half),
            behind(middle, half),
            behind(middle, -half),
            behind(0.0, half),
            behind(0.0, -half),
            behind(-self.rear, half),
            behind(-self.rear, -half),
        ]
    }

    /// Angular velocity of the trailer, in rad/s (off-axle hitching; Lamiraux et al. 1998). The tractor moves at
    /// `speed` m/s and turns at `rotation` rad/s; `bend` is its heading relative to the trailer, in rad. With `speed` 1
    /// and the curvature as `rotation`, the result is in rad per metre of the path.
    pub fn trailer_rotation(&self, speed: f32, rotation: f32, bend: f32) -> f32 {
        let (sin, cos) = sincosf(bend);
        (speed * sin - self.hitch * rotation * cos) / self.drawbar()
    }

    /// Angular velocity, in rad/s, of a tractor that drives backward at `speed` m/s, so that its `bend`, its heading
    /// relative to the trailer in rad, changes by `rate` rad/s (feedback linearization of the off-axle hitch; Lamiraux
    /// et al. 1998).
    pub(in crate::nav) fn backing_rotation(&self, speed: f32, bend: f32, rate: f32) -> f32 {
        let ((sin, cos), drawbar) = (sincosf(bend), self.drawbar());
        (rate - speed * sin / drawbar) / (1.0 + self.hitch * cos / drawbar)
    }

    /// Length of the drawbar, by which angles can be divided: at least 1 cm, also of one that is not a number.
    fn drawbar(&self) -> f32 {
        fmaxf(self.drawbar, 0.01)
    }
}

/// Speed at `distance` m before a stop under constant deceleration, between a minimum and a maximum, in m/s.
pub(super) fn approach_speed(distance: f32, deceleration: f32, [least, most]: [f32; 2]) -> f32 {
    sqrtf(2.0 * deceleration * distance.max(0.0)).clamp(least.min(most), most)
}

/// Twist of a tractor that backs up and stops after `left` m. Its angle `bend` to the trailer, in rad, changes at the
/// rate that `rate` returns for a speed. `most` is the maximum speed.
pub(super) fn backing_twist(
    left: f32,
    most: f32,
    bend: f32,
    rate: impl FnOnce(f32) -> f32,
    vehicle: &Articulated,
) -> Twist {
    const DECELERATION: f32 = 0.3;
    const SLOWEST: f32 = 0.03;
    let speed = approach_speed(left, DECELERATION, [SLOWEST, most]);
    Twist::new(-speed, 0.0, vehicle.backing_rotation(speed, bend, rate(speed)))
}

/// Outcome of the comparison of a vehicle with its goal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arrival {
    /// The goal is ahead.
    Ahead,
    /// The vehicle is beneath the container.
    Reached,
    /// The vehicle is beside the goal, or past it.
    Missed,
}

/// Compares a vehicle with its goal: `base` is the pose of the tractor and `rear` the rear-most point, both in the
/// frame of the container, and `goal` is the x coordinate of the goal. The tolerances are those along and across, in m.
pub(super) fn arrival(base: &Pose2, rear: Point2, goal: f32, [along, across]: [f32; 2]) -> Arrival {
    if base.x < goal - 0.5 * along {
        return Arrival::Ahead;
    }
    let is_there = base.x <= goal + along && base.y.abs() <= across && rear.y.abs() <= across;
    if is_there { Arrival::Reached } else { Arrival::Missed }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_vehicle_lies_on_a_line() {
        let v = Articulated::PATSY;
        let base = Pose2::new(v.axis(), 0.0, 0.0);
        let rear = v.rear_most(&v.trailer(&base, 0.0));
        assert!((rear.x + 0.5 * v.length()).abs() < 1e-6 && rear.y == 0.0);
        let xs = v.outline(&base, 0.0).map(|p| p.x);
        assert!((xs.into_iter().fold(f32::MIN, f32::max) - 0.5 * v.length()).abs() < 1e-6);
    }

    #[test]
    fn a_trailer_turns_towards_the_tractor() {
        let vehicle = Articulated { drawbar: 0.5, ..Articulated::PATSY };
        assert_eq!(vehicle.trailer_rotation(1.0, 0.0, 0.0), 0.0);
        assert!(vehicle.trailer_rotation(1.0, 0.0, 0.5) > 0.9);
        // The hitch swings to the other side when the tractor turns on the spot.
        assert!((vehicle.trailer_rotation(0.0, 1.0, 0.0) + 0.2).abs() < 1e-6);
        for drawbar in [0.0, f32::NAN] {
            assert!(Articulated { drawbar, ..vehicle }.trailer_rotation(1.0, 0.1, 0.2).is_finite());
        }
    }

    #[test]
    fn the_goal_is_ahead_reached_or_missed() {
        let at = |x, y, rear| arrival(&Pose2::new(x, y, 0.0), Point2::new(x - 0.8, rear), 0.3, [0.04; 2]);
        assert_eq!(at(0.2, 0.5, 0.5), Arrival::Ahead);
        assert_eq!(at(0.3, 0.0, 0.0), Arrival::Reached);
        assert_eq!([at(0.3, 0.1, 0.0), at(0.3, 0.0, 0.1), at(0.5, 0.0, 0.0)], [Arrival::Missed; 3]);
    }
}

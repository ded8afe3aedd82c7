use super::{Articulated, Twist};
use crate::{
    math::normalize_angle,
    scan::{Point2, Pose2},
};
use libm::{fabsf, fmaxf, fminf, hypotf, sincosf};

/// Largest angle between tractor and trailer that is predicted, in rad.
const JACKKNIFE: f32 = 1.4;

/// Poses of the axes of tractor and trailer.
pub(super) type Axes = [Pose2; 2];

/// Rectangle of a part of a vehicle in the frame of its axis: x from and to, and half of the width, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    pub from: f32,
    pub to: f32,
    pub half: f32,
}

impl Part {
    pub fn grown(self, by: f32) -> Self {
        Self { from: self.from - by, to: self.to + by, half: self.half + by }
    }

    /// Points of the part, about a step apart.
    pub fn points(self, step: f32) -> impl Iterator<Item = Point2> {
        let [columns, rows] = [self.to - self.from, 2.0 * self.half].map(|size| libm::ceilf(size / step).max(1.0));
        (0..=columns as u16).flat_map(move |i| {
            let x = self.from + (self.to - self.from) * f32::from(i) / columns;
            (0..=rows as u16).map(move |k| Point2::new(x, self.half * (2.0 * f32::from(k) / rows - 1.0)))
        })
    }

    /// Points on the border of the part, at most a step apart.
    pub fn border(self, step: f32) -> impl Iterator<Item = Point2> {
        let [columns, rows] = [self.to - self.from, 2.0 * self.half].map(|size| libm::ceilf(size / step).max(1.0));
        let Self { from, to, half } = self;
        let sides = (0..=columns as u16).flat_map(move |i| {
            let x = from + (to - from) * f32::from(i) / columns;
            [half, -half].map(|y| Point2::new(x, y))
        });
        let ends = (1..rows as u16).flat_map(move |i| {
            let y = half * (2.0 * f32::from(i) / rows - 1.0);
            [from, to].map(|x| Point2::new(x, y))
        });
        sides.chain(ends)
    }

    /// Distance of a point in m: negative inside.
    fn distance(&self, point: Point2) -> f32 {
        let along = fmaxf(self.from - point.x, point.x - self.to);
        let across = fabsf(point.y) - self.half;
        let outside = hypotf(fmaxf(along, 0.0), fmaxf(across, 0.0));
        outside + fminf(fmaxf(along, across), 0.0)
    }
}

/// Area that a tractor and its trailer cover, with the load on the trailer if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outline {
    vehicle: Articulated,
    load: Option<Part>,
}

impl Outline {
    /// Outline of a vehicle with a load of this length and width, in m, whose middle is above that of the straight
    /// vehicle. A load of width 0 is none.
    pub fn new(vehicle: Articulated, [length, width]: [f32; 2]) -> Self {
        let middle = vehicle.lift();
        let load = Part { from: middle - 0.5 * length, to: middle + 0.5 * length, half: 0.5 * width };
        Self { vehicle, load: (width > 0.0).then_some(load) }
    }

    /// The outline with a tractor whose front is `by` m longer.
    pub fn with_front(self, by: f32) -> Self {
        Self { vehicle: Articulated { front: self.vehicle.front + by, ..self.vehicle }, ..self }
    }

    /// Parts of the vehicle at a place, each with its axis: tractor, trailer with drawbar, and load.
    pub fn parts<'a>(&self, axes: &'a Axes) -> impl Iterator<Item = (Part, &'a Pose2)> + use<'a> {
        let [tractor, trailer] = self.vehicle.whole();
        let load = self.load.map(|load| (load, &axes[1]));
        [(tractor, &axes[0]), (trailer, &axes[1])].into_iter().chain(load)
    }

    /// The outline at a place.
    pub fn at(&self, axes: &Axes) -> Stance {
        let turned = |axis: &Pose2| (axis.position(), sincosf(axis.theta));
        Stance { parts: self.vehicle.whole(), load: self.load, axes: [turned(&axes[0]), turned(&axes[1])] }
    }

    /// Distance of a point from the vehicle at a place, in m: negative inside. The drawbar belongs to the vehicle.
    pub fn distance(&self, axes: &Axes, point: Point2) -> f32 {
        self.at(axes).distance(point)
    }
}

/// Outline of a vehicle at a place, for many points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stance {
    parts: [Part; 2],
    load: Option<Part>,
    /// Positions of the axes, and sines and cosines of their headings.
    axes: [(Point2, (f32, f32)); 2],
}

impl Stance {
    /// Distance of a point from the vehicle, in m: negative inside.
    pub fn distance(&self, point: Point2) -> f32 {
        let [base, behind] = self.axes.map(|(axis, (sin, cos))| {
            let d = point - axis;
            Point2::new(cos * d.x + sin * d.y, cos * d.y - sin * d.x)
        });
        let load = self.load.map_or(f32::INFINITY, |load| load.distance(behind));
        fminf(fminf(self.parts[0].distance(base), self.parts[1].distance(behind)), load)
    }
}

impl Articulated {
    /// Rectangles of tractor and trailer in the frames of their axes.
    pub(super) const fn parts(&self) -> [Part; 2] {
        let half = 0.5 * self.width;
        [Part { from: -self.hitch, to: self.front, half }, Part { from: -self.rear, to: 0.5 * self.drawbar, half }]
    }

    /// Parts of the vehicle with the drawbar between them: what is beside it is neither before one part nor behind the
    /// other.
    pub(super) const fn whole(&self) -> [Part; 2] {
        let [tractor, trailer] = self.parts();
        [tractor, Part { to: self.drawbar, ..trailer }]
    }

    /// Places of the vehicle after each `step` m on the curve of a twist that drives it. They do not end.
    pub(super) fn places(&self, now: &Axes, twist: &Twist, step: f32) -> impl Iterator<Item = Axes> {
        let (vehicle, [mut base, Pose2 { theta: mut heading, .. }]) = (*self, *now);
        let (curvature, step) = (twist.omega / twist.x, step.copysign(twist.x));
        core::iter::repeat_with(move || {
            let bend = normalize_angle(&(base.theta - heading)).clamp(-JACKKNIFE, JACKKNIFE);
            heading += vehicle.trailer_rotation(1.0, curvature, bend) * step;
            base = base.compose(&Pose2::new(step, 0.0, step * curvature));
            [base, vehicle.trailer(&base, heading)]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_from_the_nearest_part() {
        let vehicle = Articulated::PATSY;
        let straight = [Pose2::default(), vehicle.trailer(&Pose2::default(), 0.0)];
        let distance = |load, x, y| Outline::new(vehicle, load).distance(&straight, Point2::new(x, y));
        let near = |a: f32, b: f32| assert!((a - b).abs() < 1e-6, "{a} {b}");
        near(distance([0.0; 2], 0.55, 0.6), 0.5);
        near(distance([0.0; 2], -0.3, 0.5), 0.3);
        near(distance([0.0; 2], -0.3, 0.1), -0.1);
        // The load stands out, by 7.5 cm at both ends.
        near(distance([1.2, 0.7], 0.425, 0.0), 0.1);
        near(distance([1.2, 0.7], -0.975, 0.35), 0.1);
        near(distance([1.2, 0.7], 0.0, -0.45), 0.1);
    }

    #[test]
    fn a_bent_vehicle_swings_its_load_out() {
        let vehicle = Articulated::PATSY;
        let now = [Pose2::default(), vehicle.trailer(&Pose2::default(), 0.0)];
        let end = vehicle.places(&now, &Twist::new(0.5, 0.0, 0.5), 0.02).nth(24).expect("no end");
        assert!((end[0].theta - 0.5).abs() < 1e-4 && (0.0..0.5).contains(&end[1].theta), "{end:?}");
        // Its corner is farther right of the tractor than it is wide.
        let corner = end[1].to_outer(Point2::new(0.975, -0.35));
        assert!(end[0].to_inner(corner).y < -0.4);
    }
}

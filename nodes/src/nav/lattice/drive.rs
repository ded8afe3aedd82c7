use super::{CurveDrive, Ground, footing::Footing, room::Room, vehicle::MAX_BEND};
use crate::{
    nav::payload::dubins::{Curve, advanced, arc},
    scan::{Point2, Pose2, wrap_angle},
};

/// Distance between places that are checked on a step, in m.
pub(super) const CHECK: f32 = 0.1;

/// Look at a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    /// Costs of the tractor alone.
    Glance,
    /// Everything that is touched, and all costs.
    Check,
}

/// Vehicle on a map.
pub(super) struct Drive<'a> {
    pub ground: &'a Ground<'a>,
    pub vehicle: &'a CurveDrive,
    pub room: &'a Room,
    /// Floor that the vehicle may drive over, if it has to be known.
    pub footing: Option<&'a Footing>,
}

impl Drive<'_> {
    /// Length of an arc with costs, and the heading of the trailer at its end, or `None` if something is touched on it.
    pub fn arc(&self, from: &Pose2, trailer: f32, curvature: f32, length: f32, look: Look) -> Option<(f32, f32)> {
        let part = arc(curvature, places(length).1);
        let step =
            |pose: &Pose2, trailer: f32, step: f32| (pose.compose(&part), self.towed(pose, trailer, curvature, step));
        self.along(from, trailer, length, (false, look), step).map(|(cost, _, trailer)| (cost, trailer))
    }

    /// Length of a step backward with costs, and the pose and the heading of the trailer at its end, or `None` if
    /// something is touched on it. The angle to the trailer approaches `wanted`, in rad.
    pub fn back(&self, from: &Pose2, trailer: f32, wanted: f32, length: f32, look: Look) -> Option<(f32, Pose2, f32)> {
        let CurveDrive { shape, backing_gain, .. } = *self.vehicle;
        self.along(from, trailer, length, (true, look), |pose, trailer, step| {
            let angle = wrap_angle(pose.theta - trailer);
            let turn = shape.backing_rotation(1.0, angle, -backing_gain * (angle - wanted));
            let trailer = trailer + step * shape.trailer_rotation(-1.0, turn, angle);
            (advanced(pose, -turn, -step), trailer)
        })
    }

    /// Length of a way with costs, and the pose and the heading of the trailer at its end, or `None` if something is
    /// touched on it. `step` returns both after a distance in m.
    fn along(
        &self,
        from: &Pose2,
        mut trailer: f32,
        length: f32,
        (is_backward, look): (bool, Look),
        step: impl Fn(&Pose2, f32, f32) -> (Pose2, f32),
    ) -> Option<(f32, Pose2, f32)> {
        let (count, distance) = places(length);
        let (mut cost, mut pose) = (0.0, *from);
        for _ in 0..count {
            let before = bend(&pose, trailer);
            (pose, trailer) = step(&pose, trailer, distance);
            // A trailer that is bent too far at the start may come into line.
            if bend(&pose, trailer) > MAX_BEND.max(before) {
                return None;
            }
            let ground = match look {
                Look::Glance => self.cost(pose.position()),
                Look::Check => self.fits(&pose, trailer, is_backward)?,
            };
            cost += distance * (1.0 + ground);
        }
        Some((cost, pose, trailer))
    }

    /// Heading of the trailer at the end of a curve.
    pub fn trailer_at_end(&self, curve: &Curve, mut trailer: f32) -> f32 {
        let mut pose = curve.start;
        for (curvature, length) in arcs(curve) {
            let (count, step) = places(length);
            for _ in 0..count {
                trailer = self.towed(&pose, trailer, curvature, step);
                pose.theta += step * curvature;
            }
        }
        trailer
    }

    /// Returns `true` if nothing is touched on a curve.
    pub fn is_free(&self, curve: &Curve, mut trailer: f32) -> bool {
        let mut pose = curve.start;
        arcs(curve).all(|(curvature, length)| {
            let arc = self.arc(&pose, trailer, curvature, length, Look::Check);
            pose = advanced(&pose, curvature, length);
            arc.is_some_and(|(_, end)| {
                trailer = end;
                true
            })
        })
    }

    /// Heading of the trailer after a step.
    fn towed(&self, pose: &Pose2, trailer: f32, curvature: f32, step: f32) -> f32 {
        trailer + step * self.vehicle.shape.trailer_rotation(1.0, curvature, pose.theta - trailer)
    }

    /// Highest cost of the axes of the vehicle and of the middle of its load, or `None` if something is touched there.
    fn fits(&self, pose: &Pose2, trailer: f32, is_backward: bool) -> Option<f32> {
        let Self { vehicle, room, footing, .. } = self;
        let axes = vehicle.axes(pose, trailer);
        let is_safe = || footing.is_none_or(|footing| footing.fits(vehicle, &axes, is_backward));
        if !(room.fits(vehicle, &axes) && is_safe()) {
            return None;
        }
        let middle = axes[1].to_outer(Point2::new(vehicle.shape.lift(), 0.0));
        Some([pose.position(), axes[1].position(), middle].into_iter().map(|at| self.cost(at)).fold(0.0, f32::max))
    }

    fn cost(&self, point: Point2) -> f32 {
        let terrain = &self.ground.terrain;
        terrain.map.raster().cell(point).map_or(0.0, |cell| terrain.cost(cell))
    }
}

/// Curvatures and lengths of the parts of a curve that have a length.
pub(super) fn arcs(curve: &Curve) -> impl Iterator<Item = (f32, f32)> + use<> {
    curve.parts.into_iter().filter(|(_, length)| *length > 0.0)
}

/// Number of places that are checked on a way, and the distance between them, in m.
pub(super) fn places(length: f32) -> (u32, f32) {
    let count = libm::ceilf(length / CHECK);
    (count as u32, length / count)
}

/// Angle between a vehicle and its trailer, in rad.
pub(super) fn bend(pose: &Pose2, trailer: f32) -> f32 {
    wrap_angle(pose.theta - trailer).abs()
}

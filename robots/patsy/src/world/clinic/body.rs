use super::site::area;
use crate::{
    LENGTH, WIDTH,
    world::{Cart, tractor},
};
use apex_nodes::{
    math::normalize_angle,
    nav::Twist,
    scan::{Point2, Pose2},
};
use apex_sim::{Footprint, Lift, Tractor, World};
use core::f32::consts::PI;

/// Time that the lift takes, in s.
const LIFT: f32 = 3.0;
/// Greatest distance and angle of a container from the middle of the lift at which it is lifted.
const CATCH: [f32; 2] = [0.12, 0.2];

/// The vehicle: tractor, trailer and lift, with or without a container.
#[derive(Debug, Clone)]
pub(super) struct Body {
    pub tractor: Tractor,
    pub lift: Lift,
    /// Number of the container on the lift, and its pose in the frame of the trailer.
    pub load: Option<(usize, Pose2)>,
}

impl Body {
    pub fn new(pose: Pose2) -> Self {
        Self { tractor: tractor(pose), lift: Lift::lowered(LIFT), load: None }
    }

    /// Areas of tractor and trailer, and of the container on the lift.
    pub fn areas(&self) -> impl Iterator<Item = Footprint> + '_ {
        let parts = self.tractor.footprints();
        let load = self.load_pose().map(|pose| Footprint { pose, length: LENGTH, width: WIDTH });
        parts.into_iter().chain(load)
    }

    pub fn load_pose(&self) -> Option<Pose2> {
        self.load.map(|(_, place)| self.tractor.trailer_pose().compose(&place))
    }

    /// Drives for `dt` s, unless something of the world is in the way. Returns the vehicle as
    /// it would have been inside of what holds it.
    pub fn drive(&mut self, command: &Twist, dt: f32, world: &World) -> Option<Self> {
        let (before, free) = (self.tractor.clone(), self.clearance(world));
        self.tractor.step(command, dt);
        let after = self.clearance(world);
        // Away from an obstacle is always possible.
        let touches = after <= 0.0 && after <= free && self.tractor.base.pose != before.base.pose;
        let leaves = free <= 0.0 && !self.approaches(&before, world);
        if touches && !leaves {
            let inside = self.clone();
            self.tractor = before;
            self.tractor.base.twist = Twist::ZERO;
            return Some(inside);
        }
        None
    }

    fn clearance(&self, world: &World) -> f32 {
        self.areas().map(|area| area.clearance(world)).fold(f32::INFINITY, f32::min)
    }

    /// Returns `true` if the middle of the vehicle comes nearer to the nearest object than it was before.
    fn approaches(&self, before: &Tractor, world: &World) -> bool {
        let distance = |tractor: &Tractor| {
            let middle = (tractor.base.pose.position() + tractor.trailer_pose().position()).scaled(0.5);
            world.clearance(middle)
        };
        distance(&self.tractor) < distance(before)
    }

    /// Takes a container that is above the lift when it begins to rise.
    pub fn catch(&mut self, carts: &[Cart]) {
        let trailer = self.tractor.trailer_pose();
        let middle = Pose2::new(self.tractor.shape.lift(), 0.0, 0.0);
        self.load = carts.iter().enumerate().find_map(|(number, cart)| {
            let place = area(cart).pose.relative_to(&trailer);
            let off = place.relative_to(&middle);
            let turn = normalize_angle(&(2.0 * off.theta)) / 2.0;
            let fits = off.position().norm() <= CATCH[0] && turn.abs() <= CATCH[1];
            fits.then_some((number, place))
        });
    }

    /// Points on the outline of tractor and trailer.
    pub fn outline(&self) -> [Point2; 10] {
        let Tractor { base, shape, .. } = &self.tractor;
        shape.outline(&base.pose, self.tractor.trailer_pose().theta)
    }

    pub fn speed(&self) -> f32 {
        self.tractor.base.twist.velocity().norm()
    }

    /// Points on the floor where the wheels stand.
    pub fn wheels(&self) -> [Point2; 4] {
        let (base, trailer) = (self.tractor.base.pose, self.tractor.trailer_pose());
        let half = 0.4 * self.tractor.shape.width;
        [(base, half), (base, -half), (trailer, half), (trailer, -half)]
            .map(|(pose, y)| pose.to_outer(Point2::new(0.0, y)))
    }
}

/// Direction of a container from which the vehicle comes, modulo half a turn.
pub(super) fn along(theta: f32, like: f32) -> f32 {
    let off = normalize_angle(&(theta - like));
    if off.abs() > 0.5 * PI { normalize_angle(&(theta + PI)) } else { theta }
}

use super::CurveDrive;
use crate::scan::Pose2;

/// Additional cost per metre of the sharpest curve, and of a change from straight to that curve, in m.
const BENDING: [f32; 2] = [0.15, 0.1];
/// Cost per metre backward, and of each change of the direction, in m: what a vehicle would drive forward in that time.
const BACKWARD: [f32; 2] = [2.6, 2.0];
/// Additional cost per metre backward and radian of the angle to the trailer, and per radian of its change, in m.
const ANGLED: [f32; 2] = [0.33, 0.3];
/// Number of the node before the start: there is none.
pub(super) const NONE: u32 = u32::MAX;

/// State on a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub pose: Pose2,
    /// Heading of the trailer, in rad.
    pub trailer: f32,
    pub cost: f32,
    /// Length of the way to it from the node before, in m.
    pub length: f32,
    /// Curvature of the way to it, in 1/m; 0 if that was backward.
    pub curvature: f32,
    /// Angle to the trailer on the way to it if that was backward, in rad.
    pub back: Option<f32>,
    /// Number of the node before.
    pub before: u32,
    /// Number of the ending that leads from here to a goal.
    pub ending: Option<u32>,
    /// `true` if nothing is touched on the way to it, and its cost is known.
    pub is_checked: bool,
}

impl Node {
    /// Cost of a change of the direction, in m.
    pub const TURN: f32 = BACKWARD[1];
    /// Node after a step, without that step.
    pub const NEXT: Self = Self {
        pose: Pose2 { x: 0.0, y: 0.0, theta: 0.0 },
        trailer: 0.0,
        cost: 0.0,
        length: 0.0,
        curvature: 0.0,
        back: None,
        before: NONE,
        ending: None,
        is_checked: false,
    };

    /// Cost of the way beyond the node, after a step of a length with the costs `way`: with a curvature, or backward.
    pub fn cost_after(
        &self,
        vehicle: &CurveDrive,
        way: f32,
        (curvature, back): (f32, Option<f32>),
        length: f32,
    ) -> f32 {
        if let Some(bend) = back {
            let angles = [bend.abs(), (bend - self.back.unwrap_or(0.0)).abs()];
            let angled = ANGLED[0] * length * angles[0] + ANGLED[1] * angles[1];
            return self.cost + BACKWARD[0] * way + angled + self.turn(true);
        }
        let bend = [curvature.abs(), (curvature - self.curvature).abs()].map(|c| c * vehicle.radius);
        self.cost + way + BENDING[0] * length * bend[0] + BENDING[1] * bend[1] + self.turn(false)
    }

    /// Cost of going on in a direction.
    pub fn turn(&self, backward: bool) -> f32 {
        let changes = self.before != NONE && self.back.is_some() != backward;
        if changes { BACKWARD[1] } else { 0.0 }
    }
}

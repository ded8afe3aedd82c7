use crate::{
    nav::{
        Articulated,
        outline::{Axes, Outline},
    },
    scan::Pose2,
};
use libm::{fmaxf, fminf, sinf};

/// Maximum angle between the vehicle and its trailer, in rad.
pub(super) const MAX_BEND: f32 = 1.2;

/// Vehicle that drives in curves: a tractor with a trailer and a load on it, if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveDrive {
    /// Smallest radius of a curve, in m.
    pub radius: f32,
    /// Vehicle and trailer on the floor.
    pub shape: Articulated,
    /// Length and width of the load, in m, whose middle is above that of the straight vehicle; a width of 0 for none.
    pub load: [f32; 2],
    /// Distance of the outline from obstacles, in m.
    pub margin: f32,
    /// Rate at which the angle to the trailer approaches the wanted one when the vehicle backs up, in 1/m; 0 for a
    /// vehicle that only drives forward.
    pub backing_gain: f32,
    /// Longest straight line before a goal, in m, on which the trailer comes into line; 0 if it may be bent there.
    pub straight: f32,
    /// `true` if there has to be such a line: the trailer may also come into line in a curve.
    pub comes_straight: bool,
    /// Distance before a goal, in m, up to which a way may end if something stands at the goal.
    pub short: f32,
}

impl CurveDrive {
    /// Returns `true` if the vehicle backs up with its trailer.
    pub(super) fn backs_up(&self) -> bool {
        self.backing_gain > 0.0
    }

    /// Distance in m that the vehicle, or its load, reaches from the axis of the tractor to all sides, however it is
    /// bent.
    pub(super) fn girth(&self) -> f32 {
        let Articulated { hitch, drawbar, width, .. } = self.shape;
        let [length, across] = self.load.map(|size| 0.5 * size);
        let beneath = fminf(across - hitch * sinf(MAX_BEND), self.shape.lift() + length - drawbar - hitch);
        fmaxf(0.5 * width, beneath)
    }

    pub(super) fn outline(&self) -> Outline {
        Outline::new(self.shape, self.load)
    }

    /// Poses of the axes at a pose and with this heading of the trailer, in rad.
    pub(super) fn axes(&self, pose: &Pose2, trailer: f32) -> Axes {
        [*pose, self.shape.trailer(pose, trailer)]
    }
}

use crate::{
    map::Raster,
    math::normalize_angle,
    scan::{Point2, Pose2},
};
use core::f32::consts::TAU;

/// Length of a step, in m, and of one near the start of a fine search.
const STEP: f32 = 0.3;
const FINE_STEP: f32 = 0.1;
/// Number of headings of the states.
const HEADINGS: usize = 32;
/// Distance from the start, along both axes, up to which a fine search has finer states, in m.
const REACH: f32 = 1.5;
/// Side of a finer state, in m, and number of angles to the trailer that it tells apart.
const FINE_SIDE: f32 = 0.1;
const FINE_BENDS: usize = 5;
/// Distance between these angles, in rad.
const BEND: f32 = 0.5;

/// Least costs with which states were expanded: those of position and heading, and near the start of a fine search of
/// smaller cells, with the angle to the trailer.
#[derive(Debug, Clone, Default)]
pub(super) struct States {
    raster: Raster,
    fine: Option<Raster>,
    best: Vec<f32>,
}

impl States {
    /// Forgets all states: those on a raster, and finer ones about the place where a fine search starts.
    pub fn reset(&mut self, raster: &Raster, start: Option<Point2>) {
        let side = (2.0 * REACH / FINE_SIDE) as usize;
        let around = |start: Point2| Raster {
            corner: start - Point2::new(REACH, REACH),
            resolution: FINE_SIDE,
            width: side,
            height: side,
        };
        (self.raster, self.fine) = (*raster, start.map(around));
        let fine = self.fine.map_or(0, |fine| fine.width * fine.height * FINE_BENDS);
        self.best.clear();
        self.best.resize((raster.width * raster.height + fine) * HEADINGS, f32::INFINITY);
    }

    /// Returns `true` if no state at a pose was expanded at this cost or less, whatever the heading of the trailer.
    pub fn may_be_best(&mut self, pose: &Pose2, cost: f32) -> bool {
        self.fine.is_some() || self.best(pose, pose.theta).is_some_and(|best| cost < *best)
    }

    /// Least cost of the state of a vehicle at a pose, whose trailer has a heading; `None` outside of the raster.
    pub fn best(&mut self, pose: &Pose2, trailer: f32) -> Option<&mut f32> {
        let turn = libm::floorf(pose.theta / TAU * HEADINGS as f32 + 0.5);
        let heading = (turn as i32).rem_euclid(HEADINGS as i32) as usize;
        let coarse = self.raster.cell(pose.position())?;
        let place = match self.fine_cell(pose) {
            Some(fine) => {
                let bend = libm::floorf(normalize_angle(&(pose.theta - trailer)) / BEND + 0.5);
                let bend = (bend + 0.5 * (FINE_BENDS - 1) as f32).clamp(0.0, (FINE_BENDS - 1) as f32) as usize;
                self.raster.width * self.raster.height + fine * FINE_BENDS + bend
            }
            None => coarse.y * self.raster.width + coarse.x,
        };
        self.best.get_mut(place * HEADINGS + heading)
    }

    /// Length of a step from a pose, in m.
    pub fn step(&self, pose: &Pose2) -> f32 {
        if self.fine_cell(pose).is_some() { FINE_STEP } else { STEP }
    }

    fn fine_cell(&self, pose: &Pose2) -> Option<usize> {
        let raster = self.fine?;
        raster.cell(pose.position()).map(|cell| cell.y * raster.width + cell.x)
    }
}

use super::{Contest, Fault, RIVALS, Report, Robot};
use crate::{camera, world::Arena};
use apex_nodes::{nav::Twist, scan::Pose2};
use apex_rt::Time;
use apex_sim::{CameraSim, NotLevel, Shared, Simulation as _};
use std::{sync::MutexGuard, time::Duration};

/// Hall of a [`Contest`]: a handle that all participants share.
#[derive(Debug, Clone)]
pub struct Hall {
    contest: Shared<Contest>,
    camera: CameraSim,
}

impl Hall {
    /// Creates the hall of a seed, with these faults of our robot.
    ///
    /// # Errors
    /// If the [`camera`] is not level.
    pub fn new(seed: u64, faults: Vec<Fault>) -> Result<Self, NotLevel> {
        let camera = CameraSim::new(camera())?;
        Ok(Self { contest: Shared::new(Contest::new(seed, faults)), camera })
    }

    /// Events up to now.
    pub fn report(&self) -> Report {
        self.contest().report().clone()
    }

    /// True states of all robots, ours first.
    pub fn robots(&self) -> [Robot; 1 + RIVALS] {
        self.contest().robots()
    }

    /// Arena with the rivals at their present places.
    pub fn arena(&self) -> Arena {
        self.contest().arena().clone()
    }

    /// Moves our robot to another place, where it stands still. Its odometry does not change.
    pub fn place(&self, pose: Pose2) {
        self.contest().place(pose);
    }

    /// Advances the simulation to a time. Drivers call this before they read.
    pub fn advance(&self, now: Time) {
        self.contest().advance(now);
    }

    /// Sets the twist of our motors at a time.
    pub fn drive(&self, now: Time, twist: Twist) {
        self.at(now).drive(twist);
    }

    /// Sets the command time-out of our motors, which is 0.3 s at first. Without one they keep the last twist.
    pub fn set_command_timeout(&self, timeout: Option<Duration>) {
        self.contest().set_command_timeout(timeout);
    }

    /// Switches our lamp at a time.
    pub fn set_lamp(&self, now: Time, on: bool) {
        self.at(now).set_lamp(on);
    }

    /// The competition at a time.
    pub(super) fn at(&self, now: Time) -> MutexGuard<'_, Contest> {
        self.contest.at(now)
    }

    /// The competition in its present state.
    pub(super) fn contest(&self) -> MutexGuard<'_, Contest> {
        self.contest.present()
    }

    pub(super) fn camera(&self) -> CameraSim {
        self.camera.clone()
    }
}

use super::{Contest, Fault, RIVALS, Report, Robot};
use crate::{Arena, camera};
use apex_nodes::{nav::Twist, scan::Pose2};
use apex_rt::Time;
use apex_sim::{NotLevel, Photographer};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The hall in which a [`Contest`] takes place: a handle that all who take part in it share.
#[derive(Debug, Clone)]
pub struct Hall {
    contest: Arc<Mutex<Contest>>,
    photographer: Photographer,
}

impl Hall {
    /// The hall of a seed, with these faults of our robot.
    ///
    /// # Errors
    /// The [`camera`] is not level.
    pub fn new(seed: u64, faults: Vec<Fault>) -> Result<Self, NotLevel> {
        let photographer = Photographer::new(camera())?;
        Ok(Self { contest: Arc::new(Mutex::new(Contest::new(seed, faults))), photographer })
    }

    /// What happened so far.
    pub fn report(&self) -> Report {
        self.contest().report().clone()
    }

    /// All robots as they really are, ours first.
    pub fn robots(&self) -> [Robot; 1 + RIVALS] {
        self.contest().robots()
    }

    /// The arena, with the rivals where they are.
    pub fn arena(&self) -> Arena {
        self.contest().arena().clone()
    }

    /// Puts our robot elsewhere, where it stands still; its wheels do not notice.
    pub fn place(&self, pose: Pose2) {
        self.contest().place(pose);
    }

    /// Lets the time pass: drivers do so before they read.
    pub fn advance(&self, now: Time) {
        self.contest().advance(now);
    }

    /// What our motors are told at a time.
    pub fn drive(&self, now: Time, twist: Twist) {
        self.at(now).drive(twist);
    }

    /// Switches our lamp at a time.
    pub fn set_lamp(&self, now: Time, on: bool) {
        self.at(now).set_lamp(on);
    }

    /// The competition at a time.
    pub(super) fn at(&self, now: Time) -> MutexGuard<'_, Contest> {
        let mut contest = self.contest();
        contest.advance(now);
        contest
    }

    /// The competition as it is. One that panicked elsewhere can still be looked at.
    pub(super) fn contest(&self) -> MutexGuard<'_, Contest> {
        self.contest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn photographer(&self) -> Photographer {
        self.photographer.clone()
    }
}

//! Progress of a vehicle on its path, and how its drive may end: what all followers of paths have in common.

use apex_rt::{Event, Time};

/// Minimum progress along the path, in m. A smaller change does not count as progress.
const PROGRESS: f32 = 0.02;
/// Longest pause between two paths after which a vehicle still goes on at its speed, in s.
pub const RESUMES: f32 = 0.3;

/// Progress of a vehicle on its path.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    /// Segment of the path on which the vehicle is.
    pub segment: usize,
    /// Smallest length that was left, in m, and the time when it was reached.
    least: Option<(f32, Time)>,
    obstructed_since: Option<Time>,
}

/// Outcome of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    Reached,
    Blocked,
    OffPath,
}

impl Progress {
    /// Forgets the times: that of a vehicle that has to stand does not count as time without progress.
    pub fn pause(&mut self) {
        (self.least, self.obstructed_since) = (None, None);
    }

    /// Notes that an obstacle is on the path ahead, or that there is none.
    pub fn obstruct(&mut self, is_obstructed: bool, now: Time) {
        let since = self.obstructed_since.unwrap_or(now);
        self.obstructed_since = is_obstructed.then_some(since);
    }

    /// Notes the length that is left, in m.
    pub fn advance(&mut self, left: f32, now: Time) {
        if self.least.is_none_or(|(least, _)| left < least - PROGRESS) {
            self.least = Some((left, now));
        }
    }

    /// Returns `true` if an obstacle has been on the path for more than `obstructed` s, or the vehicle has made no
    /// progress for more than `patience` s.
    pub fn is_blocked(&self, obstructed: f32, patience: f32, now: Time) -> bool {
        let is_longer = |since: Option<Time>, most: f32| since.is_some_and(|t| now.since(t).as_secs_f32() > most);
        is_longer(self.obstructed_since, obstructed) || is_longer(self.least.map(|(_, since)| since), patience)
    }
}

impl End {
    /// Triggers the event of the outcome among `reached`, `blocked` and `off_path`.
    pub fn tell(self, [reached, blocked, off_path]: [Event<'_, ()>; 3]) {
        match self {
            Self::Reached => reached.emit(()),
            Self::Blocked => blocked.emit(()),
            Self::OffPath => off_path.emit(()),
        }
    }
}

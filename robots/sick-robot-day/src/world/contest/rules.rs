use apex_rt::Time;
use std::time::Duration;

/// Time of the start command, at which the rivals start.
pub const START: Time = Time::from_secs(1);

/// Duration of the competition from the start on.
pub const DURATION: Duration = Duration::from_secs(600);

/// Number of the other robots.
pub const RIVALS: usize = 3;

/// Number of all robots, with ours.
pub(super) const ROBOTS: usize = 1 + RIVALS;

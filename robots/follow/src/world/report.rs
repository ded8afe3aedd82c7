use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;

/// Events of a run, by the true state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Contacts of the robot with something, while it drove.
    pub contacts: Vec<Contact>,
    /// Time from which on the robot knew where the runner is.
    pub found: Option<Time>,
    /// Spells in which it did not know that, after it had.
    pub losses: Vec<Loss>,
    /// Beliefs about the runner, each with the time from which on the robot had it.
    pub beliefs: Vec<(Time, Belief)>,
    /// Reason for the end of the run.
    pub ending: Option<Ending>,
    /// Distances to the runner, ten in a second, from the time at which the runner was found on, in m.
    pub distances: Vec<f32>,
    /// Distance that the runner ran, in m, and that the robot drove.
    pub ran: f32,
    /// Distance that the robot drove, in m.
    pub driven: f32,
    /// Highest speed of the robot, in m/s.
    pub fastest: f32,
    /// Largest share of the load that went over to the wheels of one side.
    pub load_transfer: f32,
    /// Poses of the robot, two in a second, with their times.
    pub trajectory: Vec<(Time, Pose2)>,
    /// Positions of the runner at the same times.
    pub runner: Vec<Point2>,
    /// Errors of the pose in the world while the robot knew one: of the position, in m, and of the heading, in rad.
    pub located: Vec<[f32; 2]>,
}

/// Contact of the robot with something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Time.
    pub at: Time,
    /// Place of the robot.
    pub place: Point2,
    /// Speed of the robot, in m/s.
    pub speed: f32,
    /// `true` for a person.
    pub is_person: bool,
}

impl Contact {
    /// Name of what was touched.
    pub const fn what(&self) -> &'static str {
        if self.is_person { "a person" } else { "a thing" }
    }
}

/// Spell in which the robot did not know where the runner is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    /// Beginning.
    pub from: Time,
    /// Duration, in s.
    pub lasted: f32,
    /// Place of the robot at the beginning.
    pub place: Point2,
}

/// Belief of the robot about the runner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Belief {
    /// The runner is where he is.
    Right,
    /// Another person is the runner.
    Another,
    /// The runner is where no person is.
    Elsewhere,
    /// None.
    Unknown,
}

impl Belief {
    /// Words for it.
    pub const fn what(self) -> &'static str {
        match self {
            Self::Right => "the robot knows where the runner is",
            Self::Another => "the robot takes another person for the runner",
            Self::Elsewhere => "the robot believes the runner to be where no person is",
            Self::Unknown => "the robot does not know where the runner is",
        }
    }
}

/// Reason for the end of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The runner arrived, and the robot with him.
    Arrived,
    /// The runner arrived, but the robot is elsewhere.
    LeftBehind,
    /// The robot tipped over.
    Tipped,
    /// The robot fell into a ditch.
    Fell,
    /// The robot did not know for a minute where the runner is.
    Lost,
    /// The time was over.
    Time,
}

impl Ending {
    /// Words for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Arrived => "arrived",
            Self::LeftBehind => "left behind",
            Self::Tipped => "tipped",
            Self::Fell => "fell",
            Self::Lost => "lost",
            Self::Time => "time over",
        }
    }
}

impl Report {
    /// Longest loss, in s.
    pub fn longest_loss(&self) -> f32 {
        self.losses.iter().map(|loss| loss.lasted).fold(0.0, f32::max)
    }

    /// Number of losses of more than 1 s.
    pub fn times_lost(&self) -> usize {
        self.losses.iter().filter(|loss| loss.lasted > 1.0).count()
    }

    /// Root of the mean square error of the position in the world, in m, and of the heading, in rad. `None` if the
    /// robot never knew where it was.
    pub fn located(&self) -> Option<[f32; 2]> {
        let count = self.located.len() as f32;
        let error = |i: usize| (self.located.iter().map(|errors| errors[i] * errors[i]).sum::<f32>() / count).sqrt();
        (count > 0.0).then(|| [0, 1].map(error))
    }

    /// Part of the distances at this quantile, in m.
    pub fn distance(&self, quantile: f32) -> f32 {
        let mut sorted = self.distances.clone();
        sorted.sort_unstable_by(f32::total_cmp);
        let index = (quantile * sorted.len().saturating_sub(1) as f32) as usize;
        sorted.get(index).copied().unwrap_or(f32::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_losses_are_not_counted_but_the_longest_is_known() {
        let loss = |lasted| Loss { from: Time::ZERO, lasted, place: Point2::default() };
        let report = Report { losses: vec![loss(0.4), loss(3.0), loss(1.2)], ..Report::default() };
        assert_eq!((report.times_lost(), report.longest_loss()), (2, 3.0));
        let report = Report { distances: vec![3.0, 1.0, 2.0], ..Report::default() };
        assert_eq!((report.distance(0.0), report.distance(0.5), report.distance(1.0)), (1.0, 2.0, 3.0));
    }
}

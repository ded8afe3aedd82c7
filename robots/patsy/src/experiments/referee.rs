use super::evaluate::pose_error;
use crate::world::Truth;
use apex_nodes::scan::{Container, Pose2};
use apex_rt::{Ctx, Time, node};
use core::{fmt, time::Duration};

/// Counts the ends of the searches, and compares them with the truth: stopped at a container, stopped at nothing, given
/// up rightly, and given up although a container was there.
#[node]
#[derive(Debug)]
pub struct Referee {
    /// Maximum distance of a detection from the centre of the container at which the robot has stopped.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    max_distance: f32,
    /// Maximum heading error of such a detection.
    #[param(unit = "rad", default = 0.35, range = 0.0..=3.2)]
    max_angle: f32,
    container: Option<Pose2>,
    searching_since: Option<Time>,
    ends: Ends,
    total: Duration,
    longest: Duration,
}

/// Numbers of searches, by their end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Ends {
    /// Started searches.
    pub searches: u32,
    /// Searches that stopped at a container.
    pub at_container: u32,
    /// Searches that stopped where no container was.
    pub at_nothing: u32,
    /// Searches that were given up while no container was there.
    pub rightly_given_up: u32,
    /// Searches that were given up while a container was there.
    pub wrongly_given_up: u32,
}

#[node]
impl Referee {
    fn process(&mut self, truth: &Truth) {
        self.container = truth.container;
    }

    /// Begins a search. A search in progress has no end.
    #[slot]
    fn go(&mut self, ctx: &Ctx) {
        self.searching_since = Some(ctx.now());
        self.ends.searches += 1;
    }

    /// Ends the search at a container.
    #[slot]
    fn stop(&mut self, container: &Container, ctx: &Ctx) {
        let Some(since) = self.searching_since.take() else { return };
        let error = self.container.map(|truth| pose_error(&container.pose, &truth));
        if error.is_some_and(|e| e.position().norm() <= self.max_distance && e.theta.abs() <= self.max_angle) {
            let took = ctx.now().since(since);
            self.ends.at_container += 1;
            self.total += took;
            self.longest = self.longest.max(took);
        } else {
            self.ends.at_nothing += 1;
        }
    }

    /// Ends the search without a container.
    #[slot]
    fn give_up(&mut self) {
        if self.searching_since.take().is_some() {
            match self.container {
                Some(_) => self.ends.wrongly_given_up += 1,
                None => self.ends.rightly_given_up += 1,
            }
        }
    }

    /// Numbers of searches, by their end.
    pub fn ends(&self) -> Ends {
        self.ends
    }
}

impl fmt::Display for Referee {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Ends { searches, at_container, at_nothing, rightly_given_up, wrongly_given_up } = self.ends;
        let mean = self.total.checked_div(at_container).unwrap_or_default();
        write!(
            f,
            "{searches} searches: {at_container} stopped at a container (after {:.2} s on average, {:.2} s at most), \
             {at_nothing} at nothing; given up {rightly_given_up} without and {wrongly_given_up} with a container",
            mean.as_secs_f64(),
            self.longest.as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CONTAINER_AHEAD, world::Scenario};
    use apex_rt::Construct;

    #[test]
    fn each_end_is_counted_apart() {
        let mut referee = Referee::construct((0.3, 0.35));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        let truth = |container| Truth { scenario: Scenario::Random, container };
        let here = Some(CONTAINER_AHEAD.pose);
        for (container, is_given_up) in
            [(here, false), (None, false), (Some(Pose2::new(3.0, 0.0, 0.0)), false), (here, true), (None, true)]
        {
            referee.process(&truth(container));
            referee.go(&at(100));
            if is_given_up { referee.give_up() } else { referee.stop(&CONTAINER_AHEAD, &at(300)) }
        }
        // No search is in progress.
        referee.stop(&CONTAINER_AHEAD, &at(400));
        referee.give_up();
        let ends = Ends { searches: 5, at_container: 1, at_nothing: 2, rightly_given_up: 1, wrongly_given_up: 1 };
        assert_eq!(referee.ends(), ends);
        assert!(referee.to_string().contains("after 0.20 s on average, 0.20 s at most"), "{referee}");
    }
}

use apex_nodes::scan::Container;
use apex_rt::{Ctx, Event, Time, node};
use core::{fmt, time::Duration};

/// Wheels of the robot: it turns on the spot to look for a container, and stops in front of it. Counts the searches.
#[node]
#[derive(Debug, Default)]
pub struct Drive {
    searching_since: Option<Time>,
    searches: u32,
    found: u32,
    total: Duration,
    longest: Duration,
}

#[node]
impl Drive {
    /// Begins a search. A search in progress is abandoned.
    #[slot]
    fn go(&mut self, ctx: &Ctx) {
        self.searching_since = Some(ctx.now());
        self.searches += 1;
    }

    /// Stops in front of the container.
    #[slot]
    fn stop(&mut self, _container: &Container, ctx: &Ctx, stopped: Event<()>) {
        if let Some(since) = self.searching_since.take() {
            let took = ctx.now().since(since);
            self.found += 1;
            self.total += took;
            self.longest = self.longest.max(took);
        }
        stopped.emit(());
    }

    /// Numbers of started searches, and of searches that ended at a container.
    pub fn counts(&self) -> (u32, u32) {
        (self.searches, self.found)
    }
}

impl fmt::Display for Drive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mean = self.total.checked_div(self.found).unwrap_or_default();
        write!(
            f,
            "mission: stopped before a container in {} of {} searches, after {:.2} s on average and {:.2} s at most",
            self.found,
            self.searches,
            mean.as_secs_f64(),
            self.longest.as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_ends_with_the_first_container() {
        let mut drive = Drive::default();
        let at = |ms| Ctx::new(Time::from_millis(ms));
        drive.go(&at(0));
        drive.go(&at(100));
        let container = crate::CONTAINER_AHEAD;
        drive.stop(&container, &at(300), Event::unconnected());
        drive.stop(&container, &at(400), Event::unconnected());
        assert_eq!(drive.counts(), (2, 1));
        assert!(drive.to_string().ends_with("1 of 2 searches, after 0.20 s on average and 0.20 s at most"));
    }
}

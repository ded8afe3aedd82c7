use super::Parts;
use crate::run_report::Phase;
use apex_rt::{Info, Observer, Time};
use std::fmt;

/// Records the active parts of the mission and the failures in the robot.
#[derive(Debug)]
pub struct ActivityLog {
    /// Time of the present reaction.
    pub now: Time,
    info: &'static Info,
    parts: Parts,
    /// Number of active nodes of each part, and the time since when one is active.
    active: Vec<(u32, Time)>,
    phases: Vec<Phase>,
    failures: Vec<Failure>,
}

/// Failure in the robot, with the number of its occurrences.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Description of the failure.
    pub what: String,
    /// Time of the first occurrence.
    pub at: Time,
    /// Number of occurrences.
    pub count: u32,
}

impl ActivityLog {
    pub fn new(info: &'static Info) -> Self {
        let parts = Parts::new(info);
        let active = vec![(0, Time::ZERO); parts.names().len()];
        Self { now: Time::ZERO, info, parts, active, phases: vec![], failures: vec![] }
    }

    /// Active parts of the mission.
    pub fn active(&self) -> Vec<String> {
        let active = self.parts.names().iter().zip(&self.active).filter(|(_, (count, _))| *count > 0);
        active.map(|(name, _)| name.clone()).collect()
    }

    /// All phases and failures of a run that ends now.
    pub fn finish(mut self, now: Time) -> (Vec<Phase>, Vec<Failure>) {
        self.now = now;
        for part in 0..self.active.len() {
            if self.active[part].0 > 0 {
                self.end(part);
            }
        }
        (self.phases, self.failures)
    }

    fn end(&mut self, part: usize) {
        let (name, from) = (self.parts.names()[part].clone(), self.active[part].1);
        // Activity that passes at once is not a phase.
        if from == self.now {
            return;
        }
        // Activity may pass from one node to the next of the same part at once: the phase continues.
        match self.phases.iter_mut().rev().find(|phase| phase.name == name) {
            Some(phase) if phase.until == from => phase.until = self.now,
            _ => self.phases.push(Phase { name, from, until: self.now }),
        }
    }

    fn fail(&mut self, what: String) {
        match self.failures.iter_mut().find(|failure| failure.what == what) {
            Some(failure) => failure.count += 1,
            None => self.failures.push(Failure { what, at: self.now, count: 1 }),
        }
    }
}

impl Observer for ActivityLog {
    fn activity(&mut self, node: usize, active: bool) {
        let part = self.parts.of(node);
        if !self.parts.is_of_mission(part) {
            return;
        }
        let (count, since) = self.active[part];
        self.active[part] = match (count, active) {
            (0, true) => (1, self.now),
            (_, true) => (count + 1, since),
            (_, false) => (count.saturating_sub(1), since),
        };
        if count == 1 && !active {
            self.end(part);
        }
    }

    fn failed(&mut self, node: usize, error: &impl fmt::Display) {
        self.fail(format!("`{}` failed: {error}", self.info.nodes[node].name));
    }

    fn endless(&mut self, nodes: &[usize], _counts: &[u32]) {
        let names: Vec<&str> = nodes.iter().map(|node| self.info.nodes[*node].name).collect();
        self.fail(format!("endless cycle of tokens at one point in time: `{}`", names.join("`, `")));
    }

    fn claim_failed(&mut self, claim: usize) {
        self.fail(format!("the claim `{}` does not hold", self.info.claims[claim]));
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, at, count } = self;
        write!(f, "{what} (at {:.2} s", at.as_secs_f64())?;
        if *count > 1 { write!(f, ", {count} times)") } else { write!(f, ")") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::programs::Competition;
    use apex_rt::Program as _;

    /// Phases of a robot in which these nodes become active or inactive.
    fn written(run_report: &[(i64, &str, bool)]) -> Vec<Phase> {
        let info = const { &Competition::INFO };
        let mut activity_log = ActivityLog::new(info);
        for (second, name, active) in run_report {
            let node = info.nodes.iter().position(|node| node.name == *name).expect("a node");
            activity_log.now = Time::from_secs(*second);
            activity_log.activity(node, *active);
        }
        activity_log.finish(Time::from_secs(100)).0
    }

    #[test]
    fn phases_go_on_from_node_to_node() {
        let phases = written(&[
            (0, "mission.wait.compare", true),
            (1, "mission.wait.compare", false),
            (1, "mission.fetch.choose", true),
            (1, "mission.fetch.choose", false),
            (1, "mission.fetch.navigate.request", true),
            (2, "mission.fetch.navigate.request", false),
            (2, "mission.fetch.navigate.follow", true),
            (7, "mission.fetch.navigate.follow", false),
            (9, "mission.fetch.navigate.follow", true),
        ]);
        let phase = |name: &str, from, until| Phase {
            name: name.to_owned(),
            from: Time::from_secs(from),
            until: Time::from_secs(until),
        };
        let navigate = "fetch / navigate";
        assert_eq!(phases, [phase("wait", 0, 1), phase(navigate, 1, 7), phase(navigate, 9, 100)]);
    }

    #[test]
    fn the_same_failure_is_counted() {
        let mut activity_log = ActivityLog::new(const { &Competition::INFO });
        activity_log.now = Time::from_millis(1500);
        ["no light", "no light", "no ink"].iter().for_each(|error| activity_log.failed(0, error));
        let texts: Vec<String> = activity_log.finish(Time::from_secs(2)).1.iter().map(Failure::to_string).collect();
        let expected = ["`front` failed: no light (at 1.50 s, 2 times)", "`front` failed: no ink (at 1.50 s)"];
        assert_eq!(texts, expected);
    }
}

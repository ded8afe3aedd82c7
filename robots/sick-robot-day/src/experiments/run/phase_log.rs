use super::Parts;
use crate::experiments::run_report::Phase;
use apex_rt::{Info, Observer, Parameters, Time};

/// Records the active parts of the mission.
#[derive(Debug)]
pub struct PhaseLog {
    /// Time of the present reaction.
    now: Time,
    parts: Parts,
    /// Number of active nodes of each part, and the time since when one is active.
    active: Vec<(u32, Time)>,
    phases: Vec<Phase>,
}

impl PhaseLog {
    pub fn new(info: &Info) -> Self {
        let parts = Parts::new(info);
        let active = vec![(0, Time::ZERO); parts.names().len()];
        Self { now: Time::ZERO, parts, active, phases: vec![] }
    }

    /// Active parts of the mission.
    pub fn active(&self) -> Vec<String> {
        let active = self.parts.names().iter().zip(&self.active).filter(|(_, (count, _))| *count > 0);
        active.map(|(name, _)| name.clone()).collect()
    }

    /// All phases of a run that ends now.
    pub fn finish(mut self, now: Time) -> Vec<Phase> {
        self.now = now;
        for part in 0..self.active.len() {
            if self.active[part].0 > 0 {
                self.end(part);
            }
        }
        self.phases
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
}

impl Observer for PhaseLog {
    fn before_reaction(&mut self, now: Time, _params: &mut impl Parameters) {
        self.now = now;
    }

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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::programs::Competition;
    use apex_rt::Program as _;

    /// Phases of a robot in which these nodes become active or inactive.
    fn written(run_report: &[(i64, &str, bool)]) -> Vec<Phase> {
        let info = const { &Competition::INFO };
        let mut phase_log = PhaseLog::new(info);
        for (second, name, active) in run_report {
            let node = info.nodes.iter().position(|node| node.name == *name).expect("a node");
            phase_log.now = Time::from_secs(*second);
            phase_log.activity(node, *active);
        }
        phase_log.finish(Time::from_secs(100))
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
}

#[cfg(feature = "studio")]
use apex_rt::studio::Studio;
use apex_rt::{Clock as _, Info, Next, Observer, Parameters, Program, SimClock, Time, UntilStopped};
use std::{cmp::Reverse, fmt, time::Duration};

/// Activity and failures of a robot in a run.
#[derive(Debug)]
pub struct RunLog {
    /// Time of the last reaction.
    pub now: Time,
    /// Times in which nodes were active without a break, in the order of their ends.
    pub spells: Vec<Spell>,
    /// Failures of nodes, endless cycles, and claims that did not hold.
    pub failures: Vec<Failure>,
    info: &'static Info,
    /// Time for which each node was active before, and since when it is now.
    nodes: Vec<(Duration, Option<Time>)>,
}

/// Time in which a node was active without a break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spell {
    /// Name of the node.
    pub node: &'static str,
    /// Beginning.
    pub from: Time,
    /// End.
    pub until: Time,
}

/// Failure in a robot, with the number of its occurrences.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// Description of the failure.
    pub what: String,
    /// Time of the first occurrence.
    pub at: Time,
    /// Number of occurrences.
    pub count: u32,
}

/// Runs a robot in simulated time until `end`, or until `goes_on` returns `false` after a reaction. A robot that could
/// always react does so with the period `step`. With the feature `studio`, viewers see it at the address in the
/// environment variable `APEX_STUDIO` (`apex_rt::studio`).
///
/// # Errors
/// If it is stopped by a signal, or the address for viewers cannot be opened.
pub fn run<P: Program, O: Observer>(
    robot: &mut P,
    end: Time,
    step: Duration,
    observer: &mut O,
    mut goes_on: impl FnMut(Time, &mut O) -> bool,
) -> Result<RunLog, String> {
    let mut log = RunLog::new(const { &P::INFO });
    #[cfg(feature = "studio")]
    let studio = Studio::of_environment::<P>(true).map_err(|e| format!("cannot open the address for viewers: {e}"))?;
    #[cfg(feature = "studio")]
    let mut viewers = studio.as_ref().and_then(|studio| studio.stream(0));
    #[cfg(not(feature = "studio"))]
    let mut viewers = ();
    let mut clock = UntilStopped::ctrl_c(SimClock::until(end).with_step(step))?;
    loop {
        let now = clock.now();
        let mut observers = (&mut log, (&mut viewers, &mut *observer));
        observers.before_reaction(now, robot);
        let next = robot.react_with(now, &mut observers);
        let time = if let Next::At(time) = next { time } else { now };
        if !goes_on(now, observer) || !clock.wait_until(time) {
            break;
        }
    }
    robot.stop();
    if clock.is_stopped() {
        return Err(format!("stopped by a signal after {} of the run", clock.now()));
    }
    Ok(log)
}

impl RunLog {
    fn new(info: &'static Info) -> Self {
        let nodes = vec![(Duration::ZERO, None); info.nodes.len()];
        Self { now: Time::ZERO, spells: vec![], failures: vec![], info, nodes }
    }

    /// Nodes that were active in a run up to `end`, and for how long, in the order of the program.
    pub fn activity(&self, end: Time) -> Vec<(&'static str, Duration)> {
        let total =
            |(before, since): &(Duration, Option<Time>)| *before + since.map_or(Duration::ZERO, |t| end.since(t));
        let names = self.info.nodes.iter().map(|node| node.name);
        names.zip(self.nodes.iter().map(total)).filter(|(_, time)| !time.is_zero()).collect()
    }

    fn fail(&mut self, what: String) {
        match self.failures.iter_mut().find(|failure| failure.what == what) {
            Some(failure) => failure.count += 1,
            None => self.failures.push(Failure { what, at: self.now, count: 1 }),
        }
    }
}

impl Observer for RunLog {
    fn before_reaction(&mut self, now: Time, _params: &mut impl Parameters) {
        self.now = now;
    }

    fn activity(&mut self, node: usize, active: bool) {
        let (before, since) = &mut self.nodes[node];
        if active {
            since.get_or_insert(self.now);
        } else if let Some(from) = since.take() {
            *before += self.now.since(from);
            self.spells.push(Spell { node: self.info.nodes[node].name, from, until: self.now });
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

/// Table of the nodes that were active in a run, and for how long, the longest time first.
pub fn activity_table(activity: &[(&'static str, Duration)]) -> String {
    let mut sorted = activity.to_vec();
    sorted.sort_by_key(|(_, time)| Reverse(*time));
    let rows = sorted.iter().map(|(name, time)| format!("{name:<40}{:>8.1} s\n", time.as_secs_f32()));
    rows.collect()
}

/// Number of node instances of a robot that are of these types, whose names have no path.
pub fn instances_of(info: &Info, types: &[&str]) -> usize {
    let name = |kind: usize| info.kinds[kind].name.rsplit("::").next().unwrap_or_default();
    info.nodes.iter().filter(|node| types.contains(&name(node.kind))).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{NodeInfo, Place};

    const fn node(name: &'static str) -> NodeInfo {
        let place = Place { file: 0, line: 1, column: 1 };
        NodeInfo { name, kind: 0, place, required: false, siblings: false, every: None }
    }

    static INFO: Info = Info {
        name: "Robot",
        docs: "",
        files: &[],
        nodes: &[node("front"), node("search"), node("wait")],
        kinds: &[],
        graphs: &[],
        connections: &[],
        clusters: &[],
        groups: &[],
        end_if_hung: None,
        claims: &["exclusive(search, wait)"],
    };

    #[test]
    fn activity_is_added_up_to_the_end() {
        let mut log = RunLog::new(&INFO);
        for (second, node, active) in [(1, 0, true), (3, 0, false), (4, 1, true), (5, 0, true), (5, 1, false)] {
            log.now = Time::from_secs(second);
            Observer::activity(&mut log, node, active);
        }
        let seconds = Duration::from_secs;
        let activity = log.activity(Time::from_secs(9));
        assert_eq!(activity, [("front", seconds(6)), ("search", seconds(1))]);
        let table = activity_table(&[activity[1], activity[0]]);
        let rows = table.lines().map(|row| row.split_whitespace().collect::<Vec<_>>());
        assert!(rows.eq([["front", "6.0", "s"], ["search", "1.0", "s"]]), "{table}");
        let spell = |node, from, until| Spell { node, from: Time::from_secs(from), until: Time::from_secs(until) };
        assert_eq!(log.spells, [spell("front", 1, 3), spell("search", 4, 5)]);
    }

    #[test]
    fn the_same_failure_is_counted() {
        let mut log = RunLog::new(&INFO);
        log.now = Time::from_millis(1500);
        ["no light", "no light", "no ink"].iter().for_each(|error| log.failed(0, error));
        log.endless(&[1, 2], &[9, 9]);
        log.claim_failed(0);
        let expected = [
            "`front` failed: no light (at 1.50 s, 2 times)",
            "`front` failed: no ink (at 1.50 s)",
            "endless cycle of tokens at one point in time: `search`, `wait` (at 1.50 s)",
            "the claim `exclusive(search, wait)` does not hold (at 1.50 s)",
        ];
        assert_eq!(log.failures.iter().map(Failure::to_string).collect::<Vec<_>>(), expected);
    }
}

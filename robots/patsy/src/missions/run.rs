use super::{
    budget::Budget,
    losses::{Limits, Losses},
};
use crate::{
    clinic::{Clinic, Drivers, Options, Report, Snapshot},
    vehicle::{Patsy, PatsyParts},
};
use apex_nodes::map::VectorMap;
use apex_rt::{
    Clock as _, Next, Observer, Program, SimClock, Time, UntilStopped,
    record::{Codec, Recorder, Tap, WhenFull},
};
use std::{
    fmt,
    path::Path,
    time::{Duration, Instant},
};

/// Period of the reactions of a robot that could always react. It is the step of the simulation.
const STEP: Duration = Duration::from_millis(20);

/// Finished run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Options of the simulation.
    pub options: Options,
    /// Events of the vehicle.
    pub report: Report,
    /// Failures of nodes and claims that did not hold, each once.
    pub failures: Vec<String>,
    /// Nodes that were active, and for how long, in the order of the program.
    pub activity: Vec<(&'static str, Duration)>,
    /// Activity of the nodes in the order in which it ended.
    pub timeline: Vec<Spell>,
    /// Time lost to each cause.
    pub losses: Losses,
    /// Time by what the vehicle does.
    pub budget: Budget,
    /// State at the beginning and at the end.
    pub ends: [Snapshot; 2],
    /// Walls of the building.
    pub plan: VectorMap,
    /// Computing time.
    pub took: Duration,
}

/// Runs the vehicle for some time, and records it to a file if there is one.
///
/// # Errors
/// If the plan of the building cannot be read, or the file cannot be written.
pub fn run(options: &Options, duration: Duration, record: Option<&Path>) -> Result<Run, String> {
    run_seen(options, duration, record, |_, _| ())
}

/// As [`run`]; `see` sees the clinic after each reaction.
pub(super) fn run_seen(
    options: &Options,
    duration: Duration,
    record: Option<&Path>,
    mut see: impl FnMut(Time, &Clinic),
) -> Result<Run, String> {
    let began = Instant::now();
    let clinic = Clinic::new(options).map_err(|e| e.to_string())?;
    let first = clinic.snapshot();
    let mut robot = Box::new(vehicle(&clinic));
    let cannot = |path: &Path, error: &dyn fmt::Display| format!("cannot record to {}: {error}", path.display());
    let tap = match record {
        Some(path) => Some(Recorder::to_file::<Patsy>(path, WhenFull::Wait).map_err(|e| cannot(path, &e))?),
        None => None,
    };
    let end = Time::ZERO + duration;
    let mut watch = Watch::new(tap.map(Tap::Record));
    let mut clock = UntilStopped::ctrl_c(SimClock::until(end).with_step(STEP))?;
    loop {
        let now = clock.now();
        watch.activity.now = now;
        let next = robot.react_with(now, &mut watch);
        see(now, &clinic);
        let time = if let Next::At(time) = next { time } else { now };
        if !clock.wait_until(time) {
            break;
        }
    }
    robot.stop();
    if let (Some(Tap::Record(recorder)), Some(path)) = (watch.tap, record) {
        recorder.finish().map_err(|e| cannot(path, &e))?;
    }
    if clock.is_stopped() {
        return Err(format!("stopped by a signal after {} of the run", clock.now()));
    }
    clinic.advance(end);
    let activity = watch.activity.at(end);
    Ok(Run {
        options: options.clone(),
        report: clinic.report(),
        losses: watch.limits.losses(&activity),
        budget: watch.limits.budget(&activity, &watch.activity.spells),
        activity,
        timeline: watch.activity.spells,
        failures: watch.failures,
        ends: [first, clinic.snapshot()],
        plan: clinic.building().plan,
        took: began.elapsed(),
    })
}

/// The vehicle in a clinic.
fn vehicle(clinic: &Clinic) -> Patsy {
    let Drivers { scanner, rear, wheels, camera, motors, lift, dispatch } = Drivers::new(clinic);
    Patsy::new(PatsyParts { scanner, rear, wheels, camera, motors, lift, dispatch })
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

/// Notes failures and activity, and records.
struct Watch {
    failures: Vec<String>,
    activity: Activity,
    limits: Limits,
    tap: Option<Tap>,
}

/// Time for which each node was active.
struct Activity {
    now: Time,
    /// Time for which each node was active before, and since when it is now.
    nodes: Vec<(Duration, Option<Time>)>,
    spells: Vec<Spell>,
}

impl Activity {
    fn change(&mut self, node: usize, active: bool) {
        let (before, since) = &mut self.nodes[node];
        if active {
            since.get_or_insert(self.now);
        } else if let Some(since) = since.take() {
            *before += self.now.since(since);
            let node = <Patsy as Program>::INFO.nodes[node].name;
            self.spells.push(Spell { node, from: since, until: self.now });
        }
    }

    /// Nodes that were active up to the end of a run.
    fn at(&self, end: Time) -> Vec<(&'static str, Duration)> {
        let total =
            |(before, since): &(Duration, Option<Time>)| *before + since.map_or(Duration::ZERO, |t| end.since(t));
        let nodes =
            <Patsy as Program>::INFO.nodes.iter().zip(&self.nodes).map(|(node, times)| (node.name, total(times)));
        nodes.filter(|(_, time)| !time.is_zero()).collect()
    }
}

impl Watch {
    fn new(tap: Option<Tap>) -> Self {
        let nodes = vec![(Duration::ZERO, None); <Patsy as Program>::INFO.nodes.len()];
        let limits = Limits::new(&<Patsy as Program>::channels());
        Self { failures: vec![], activity: Activity { now: Time::ZERO, nodes, spells: vec![] }, limits, tap }
    }

    fn note(&mut self, failure: String) {
        if !self.failures.contains(&failure) {
            self.failures.push(failure);
        }
    }
}

impl Observer for Watch {
    fn activity(&mut self, node: usize, active: bool) {
        self.activity.change(node, active);
        if active {
            self.limits.activated(node);
        }
    }

    fn failed(&mut self, node: usize, error: &impl fmt::Display) {
        self.note(format!("`{}` failed: {error}", <Patsy as Program>::INFO.nodes[node].name));
    }

    fn endless(&mut self, _nodes: &[usize], _counts: &[u32]) {
        self.note("endless cycle of tokens at one point in time".to_owned());
    }

    fn claim_failed(&mut self, claim: usize) {
        self.note(format!("the claim `{}` does not hold", <Patsy as Program>::INFO.claims[claim]));
    }

    fn wants(&mut self, channel: usize) -> bool {
        self.limits.wants(channel) || self.tap.as_mut().is_some_and(|tap| tap.wants(channel))
    }

    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        self.limits.sent(self.activity.now, channel, codec, token);
        if let Some(tap) = self.tap.as_mut()
            && tap.wants(channel)
        {
            tap.sent(channel, codec, token);
        }
    }

    fn tap(&mut self) -> Option<&mut Tap> {
        self.tap.as_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn activity_is_added_up_to_the_end() {
        let mut activity = Activity { now: Time::ZERO, nodes: vec![(Duration::ZERO, None); 3], spells: vec![] };
        for (second, node, active) in [(1, 0, true), (3, 0, false), (4, 1, true), (5, 0, true), (5, 1, false)] {
            activity.now = Time::from_secs(second);
            activity.change(node, active);
        }
        let times: Vec<Duration> = activity.at(Time::from_secs(9)).into_iter().map(|(_, time)| time).collect();
        assert_eq!(times, [6, 1].map(Duration::from_secs));
    }
}

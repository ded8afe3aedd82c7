//! Knowledge about a running robot.

use crate::{
    lane::{Drawn, Lane, Window},
    steps::{Step, Steps, What},
    waits::Waits,
};
use apex_rt::studio::message::{About, NodeTimes, Report};
use serde::Serialize;
use std::{
    collections::{BTreeMap, VecDeque},
    sync::Arc,
};

/// Number of problems that are kept. The newest come first.
const MAX_PROBLEMS: usize = 10_000;
/// Number of tokens of a channel that are kept.
const MAX_TOKENS: usize = 20_000;

/// State of a run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Run {
    /// The robot is built, started or looked for.
    Starting(String),
    /// Messages come.
    Running,
    /// The program has ended.
    Ended,
    /// There is no connection, for this reason.
    Lost(String),
}

/// A robot, as far as its messages tell.
pub struct Live {
    /// Number of runs so far.
    pub runs: u64,
    pub run: Run,
    pub about: Option<Arc<About>>,
    /// Time of the last reaction in ns.
    pub now: i64,
    pub nodes: Vec<Node>,
    /// Number of tokens that each connection has brought to a slot.
    pub handled: Vec<u64>,
    /// Number of messages that did not reach the studio.
    pub lost: u64,
    /// Number of all problems so far.
    pub problem_count: u64,
    pub problems: VecDeque<Problem>,
    pub params: BTreeMap<String, Param>,
    pub tokens: BTreeMap<u32, Tokens>,
    /// `true` if the robot is halted.
    pub paused: bool,
    /// Simulated seconds per second.
    pub speed: f64,
    /// Times of all reactions in ns.
    pub times: Vec<i64>,
    /// Parameters that were set, with the numbers of reactions before.
    pub sets: Vec<(u64, String, String)>,
    /// Times of the calls of each node, as far as they were measured.
    pub calls: Vec<NodeTimes>,
    /// Number of messages with times.
    pub measured: u64,
    /// `true` if this run repeats an earlier one up to a point.
    pub repeats: bool,
    /// Number of times that this run went back to a checkpoint.
    pub returns: u64,
    /// Reason why there are no checkpoints.
    pub no_checkpoints: Option<String>,
    /// States at the robot's checkpoints.
    checkpoints: Vec<Checkpoint>,
    /// The last steps.
    pub steps: Steps,
    /// Nodes that wait for others.
    pub waits: Waits,
    lanes: Vec<Lane>,
    /// The earlier run.
    before: Option<Before>,
}

/// A state at a checkpoint, as far as it does not follow from the history.
struct Checkpoint {
    reactions: u64,
    now: i64,
    nodes: Vec<Node>,
    handled: Vec<u64>,
    problem_count: u64,
    lost: u64,
}

/// A run before this one, for comparison.
struct Before {
    /// Lanes by node of this run; `None` for nodes that the earlier one did not have.
    lanes: Vec<Option<Lane>>,
    /// Nodes of the earlier run.
    about: Arc<About>,
    times: Vec<i64>,
    now: i64,
}

/// State of a node.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Node {
    pub active: bool,
    /// Time in ns since which it is active or inactive.
    pub since: i64,
    pub fired: u64,
    /// Time of the last firing in ns.
    pub last: i64,
    /// Number of failures, missed deadlines and the like.
    pub problems: u64,
}

/// Something that should not have happened.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problem {
    /// Its time in s.
    pub at: f64,
    /// The node, if it concerns one.
    pub node: Option<u32>,
    pub text: String,
}

/// A parameter.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Param {
    /// Value at the first look.
    pub initial: String,
    pub value: String,
    /// Reason why the last attempt to set it failed.
    pub error: Option<String>,
    /// `true` if it can only be set in the source.
    pub fixed: bool,
    /// Number of messages about it.
    #[serde(skip)]
    pub version: u64,
}

/// The newest tokens of a channel, as time in ns and text.
#[derive(Default)]
pub struct Tokens {
    /// Number of all tokens so far.
    pub count: u64,
    pub newest: VecDeque<(i64, String)>,
    /// The newest token as a message in CDR.
    pub bytes: Vec<u8>,
}

impl Before {
    /// Gives the lanes the numbers of the same nodes in a robot whose source may have changed.
    fn map_to(&mut self, about: &Arc<About>) {
        let known = self.about.nodes.iter().map(|node| node.name.as_str());
        let mut lanes: BTreeMap<&str, Option<Lane>> = known.zip(self.lanes.drain(..)).collect();
        let lanes = about.nodes.iter().map(|node| lanes.remove(node.name.as_str()).flatten()).collect();
        (self.lanes, self.about) = (lanes, Arc::clone(about));
    }
}

impl Default for Live {
    fn default() -> Self {
        Self {
            runs: 0,
            run: Run::Starting("starting".to_owned()),
            about: None,
            now: 0,
            nodes: vec![],
            handled: vec![],
            lost: 0,
            problem_count: 0,
            problems: VecDeque::new(),
            params: BTreeMap::new(),
            tokens: BTreeMap::new(),
            paused: false,
            speed: f64::INFINITY,
            times: vec![],
            sets: vec![],
            calls: vec![],
            measured: 0,
            repeats: false,
            returns: 0,
            no_checkpoints: None,
            checkpoints: vec![],
            steps: Steps::default(),
            waits: Waits::default(),
            lanes: vec![],
            before: None,
        }
    }
}

impl Live {
    /// Begins a run of the robot that a message describes.
    pub fn begin(&mut self, about: About) {
        let (runs, repeats) = (self.runs + 1, self.repeats);
        let mut before = self.before.take().filter(|_| repeats);
        let about = Arc::new(about);
        before.iter_mut().for_each(|before| before.map_to(&about));
        *self = Self { runs, repeats, before, run: Run::Running, ..Self::default() };
        self.nodes = vec![Node::default(); about.nodes.len()];
        self.lanes = about.nodes.iter().map(|_| Lane::default()).collect();
        self.handled = vec![0; about.connections.len()];
        self.waits = Waits::new(&about);
        self.about = Some(about);
    }

    /// Takes note of a message. Numbers that do not fit the description of the robot are ignored.
    pub fn note(&mut self, report: Report) {
        match report {
            Report::About(about) => self.begin(about),
            Report::Active(nodes) => nodes.into_iter().for_each(|node| self.activity(node, true)),
            Report::Reaction { now, .. } => {
                self.now = self.now.max(now);
                self.times.push(now);
                self.step(What::Begins);
            }
            Report::Fired(node) => {
                self.step(What::Fires(node));
                self.waits.fired(node);
                self.fire(node);
            }
            Report::Handled(connection) => {
                self.step(What::Takes(connection));
                self.handle(connection);
            }
            Report::Sent(channel) => {
                self.step(What::Sends(channel));
                self.waits.sent(channel);
            }
            Report::Activity { node, active } => self.activity(node, active),
            Report::Failed { node, error } => self.problem(Some(node), error),
            Report::Late { node, age } => {
                let late = format!("missed its deadline: it finished {} ms after its source fired", age / 1_000_000);
                self.problem(Some(node), late);
            }
            Report::Hung { node, running } => {
                self.problem(Some(node), format!("hangs: it has been running for {} ms", running / 1_000_000));
            }
            Report::Refused { node, parameter, value } => {
                self.problem(Some(node), format!("keeps its `{parameter}`: {value} is out of range"));
            }
            Report::Waits(connection) => self.deadlock(connection),
            Report::Endless(nodes) => {
                let node = nodes.iter().max_by_key(|(_, count)| *count).map(|(node, _)| *node);
                self.problem(node, "tokens cycle without time passing".to_owned());
            }
            Report::ClaimFailed(claim) => {
                let claims = self.about.as_ref().map_or(&[][..], |about| &about.claims);
                let claim = claims.get(claim as usize).map_or("?", String::as_str);
                self.problem(None, format!("the claim `{claim}` does not hold"));
            }
            Report::Value { channel, now, text, bytes } if self.has_channel(channel) => {
                let tokens = self.tokens.entry(channel).or_default();
                tokens.count += 1;
                tokens.bytes = bytes;
                tokens.newest.push_back((now, text));
                if tokens.newest.len() > MAX_TOKENS {
                    tokens.newest.pop_front();
                }
            }
            Report::Value { .. } => {}
            Report::Times(times) => {
                self.measured += 1;
                for times in times.into_iter().filter(|times| (times.node as usize) < self.nodes.len()) {
                    match self.calls.iter_mut().find(|known| known.node == times.node) {
                        Some(known) => *known = times,
                        None => self.calls.push(times),
                    }
                }
            }
            Report::Lost(count) => self.lost += count,
            Report::Param { name, value, reactions } => self.param(name, value, reactions),
            Report::Pace { paused, speed, .. } => (self.paused, self.speed) = (paused, speed),
            Report::Checkpoints(all) => self.keep(&all),
            Report::NoCheckpoints(why) => (self.no_checkpoints, self.checkpoints) = (Some(why), vec![]),
            Report::Ended => self.run = Run::Ended,
        }
    }

    fn step(&mut self, what: What) {
        let reaction = u32::try_from(self.times.len()).unwrap_or(u32::MAX);
        self.steps.push(Step { now: self.now, reaction, what });
    }

    fn has_channel(&self, channel: u32) -> bool {
        self.about.as_ref().is_some_and(|about| (channel as usize) < about.channels.len())
    }

    fn fire(&mut self, node: u32) {
        if let Some(state) = self.nodes.get_mut(node as usize) {
            state.fired += 1;
            state.last = self.now;
            self.lanes[node as usize].fire(self.now);
        }
    }

    fn handle(&mut self, connection: u32) {
        if let Some(count) = self.handled.get_mut(connection as usize) {
            *count += 1;
        }
        let to = self.about.as_ref().and_then(|about| Some(about.connections.get(connection as usize)?.to));
        if let Some(to) = to {
            self.fire(to);
        }
    }

    fn activity(&mut self, node: u32, active: bool) {
        if let Some(state) = self.nodes.get_mut(node as usize) {
            let changes = state.active != active;
            if changes {
                (state.active, state.since) = (active, self.now);
            }
            self.lanes[node as usize].activity(self.now, active);
            if changes {
                self.step(if active { What::Starts(node) } else { What::Stops(node) });
            }
        }
    }

    fn deadlock(&mut self, connection: u32) {
        let Some(about) = self.about.clone() else { return };
        let Some(connection) = about.connections.get(connection as usize) else { return };
        let from = about.nodes.get(connection.from as usize).map_or("?", |node| &node.name);
        let event = &connection.output;
        let text = format!("waits for the event `{from}.{event}`, which can no longer be triggered");
        self.problem(Some(connection.to), text);
    }

    fn problem(&mut self, node: Option<u32>, text: String) {
        if let Some((state, lane)) =
            node.and_then(|node| self.nodes.get_mut(node as usize).zip(self.lanes.get_mut(node as usize)))
        {
            state.problems += 1;
            lane.mark(self.now);
        }
        self.problem_count += 1;
        self.problems.push_back(Problem { at: self.now as f64 / 1e9, node, text });
        if self.problems.len() > MAX_PROBLEMS {
            self.problems.pop_front();
        }
    }

    fn param(&mut self, name: String, value: Result<String, String>, reactions: Option<u64>) {
        let is_new = !self.params.contains_key(&name);
        let param = self.params.entry(name.clone()).or_default();
        param.version += 1;
        match value {
            Ok(value) => {
                if is_new {
                    param.initial.clone_from(&value);
                } else if let Some(reactions) = reactions {
                    self.sets.push((reactions, name, value.clone()));
                }
                (param.value, param.error) = (value, None);
            }
            Err(error) => (param.error, param.fixed) = (Some(error), is_new),
        }
    }

    /// The parameters that differ from their initial values, as TOML for `--params`.
    pub fn changed_params(&self) -> String {
        let changed = self.params.iter().filter(|(_, param)| param.value != param.initial);
        changed.map(|(name, param)| format!("{name} = {}\n", param.value)).collect()
    }

    /// Takes note of the robot's checkpoints. The last one may be new.
    fn keep(&mut self, all: &[u64]) {
        self.checkpoints.retain(|checkpoint| all.contains(&checkpoint.reactions));
        let now = self.times.len() as u64;
        let is_new = self.checkpoints.last().is_none_or(|last| last.reactions < now);
        if is_new && all.last() == Some(&now) {
            let Self { nodes, handled, problem_count, lost, now: time, .. } = self;
            self.checkpoints.push(Checkpoint {
                reactions: now,
                now: *time,
                nodes: nodes.clone(),
                handled: handled.clone(),
                problem_count: *problem_count,
                lost: *lost,
            });
        }
    }

    /// `true` if there is a checkpoint that has at most this number of reactions before it.
    pub fn has_checkpoint(&self, reactions: u64) -> bool {
        self.checkpoints.first().is_some_and(|first| first.reactions <= reactions)
    }

    /// Goes back to the checkpoint with this number of reactions before it. Returns `false` if it is not known.
    pub fn go_back(&mut self, reactions: u64) -> bool {
        let Some(at) = self.checkpoints.iter().position(|checkpoint| checkpoint.reactions == reactions) else {
            return false;
        };
        self.checkpoints.truncate(at + 1);
        let Checkpoint { now, nodes, handled, problem_count, lost, .. } = &self.checkpoints[at];
        for (lane, node) in self.lanes.iter_mut().zip(nodes) {
            *lane = lane.until(*now, node.active, node.fired);
        }
        let known = self.problem_count - self.problems.len() as u64;
        self.problems.truncate(usize::try_from(problem_count.saturating_sub(known)).unwrap_or(usize::MAX));
        (self.now, self.problem_count, self.lost) = (*now, *problem_count, *lost);
        (self.nodes, self.handled) = (nodes.clone(), handled.clone());
        self.times.truncate(usize::try_from(reactions).unwrap_or(usize::MAX));
        self.sets.retain(|(at, ..)| *at < reactions);
        self.steps.take_back(reactions);
        for tokens in self.tokens.values_mut() {
            tokens.newest.retain(|(at, _)| *at <= self.now);
            tokens.count = tokens.newest.len() as u64;
        }
        (self.returns, self.run, self.repeats) = (self.returns + 1, Run::Running, true);
        true
    }

    /// Keeps this run for comparison with the next one, which repeats it up to a point.
    pub fn depart(&mut self) {
        let Some(about) = self.about.clone() else { return };
        let goes_further = |before: &Before| before.now >= self.now && self.differs().is_none();
        if !self.before.as_ref().is_some_and(goes_further) {
            let lanes = self.lanes.iter().cloned().map(Some).collect();
            self.before = Some(Before { lanes, about, times: self.times.clone(), now: self.now });
        }
        self.repeats = true;
    }

    /// Number of reactions up to a time in ns, also in the future if that is known.
    pub fn reactions_until(&self, time: i64) -> u64 {
        let known = self.before.as_ref().filter(|before| before.times.len() > self.times.len());
        let times = known.map_or(&self.times, |before| &before.times);
        times.partition_point(|at| *at <= time) as u64
    }

    /// Time in ns at which this run begins to differ from the one that it repeats.
    pub fn differs(&self) -> Option<i64> {
        let before = self.before.as_ref()?;
        let until = self.now.min(before.now);
        let both = self.lanes.iter().zip(&before.lanes).filter_map(|(lane, other)| Some((lane, other.as_ref()?)));
        both.filter_map(|(lane, other)| lane.differs(other, until)).min()
    }

    /// The lanes of the run that this one repeats, for the nodes of `lanes`.
    pub fn draw_before(&self, window: Window, lanes: &[Drawn]) -> Vec<Drawn> {
        let Some(before) = &self.before else { return vec![] };
        let drawn = |node: usize| Some(before.lanes.get(node)?.as_ref()?.draw(node, window, before.now));
        lanes.iter().filter_map(|lane| drawn(lane.node)).collect()
    }

    /// History of each node.
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// The lanes of all nodes that were active or had problems, and of those in `also`.
    pub fn draw(&self, window: Window, also: &[usize]) -> Vec<Drawn> {
        let was =
            |at: usize| self.before.as_ref().and_then(|b| b.lanes.get(at)?.as_ref()).is_some_and(Lane::is_of_interest);
        let is_drawn = |(at, lane): &(usize, &Lane)| lane.is_of_interest() || was(*at) || also.contains(at);
        self.lanes.iter().enumerate().filter(is_drawn).map(|(at, lane)| lane.draw(at, window, self.now)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::studio::message::AboutNode;

    fn begun() -> Live {
        let node = |name: &str| AboutNode {
            name: name.to_owned(),
            kind: String::new(),
            docs: String::new(),
            file: 0,
            line: 1,
            column: 1,
            ports: vec![],
        };
        let mut live = Live::default();
        live.begin(About {
            version: 0,
            name: String::new(),
            docs: String::new(),
            files: vec![],
            simulated: true,
            nodes: ["a", "b"].map(node).into(),
            connections: vec![],
            groups: vec![],
            claims: vec![],
            channels: vec![],
            params: vec![],
        });
        live
    }

    fn react(live: &mut Live, ms: i64) {
        live.note(Report::Reaction { group: 0, now: ms * 1_000_000 });
        live.note(Report::Fired(0));
        live.note(Report::Activity { node: 1, active: ms % 2 == 0 });
        live.note(Report::Failed { node: 0, error: ms.to_string() });
    }

    #[test]
    fn a_run_goes_back_to_a_checkpoint_and_is_compared_with_what_it_was() {
        let mut live = begun();
        (0..4).for_each(|ms| react(&mut live, ms));
        live.note(Report::Checkpoints(vec![2]));
        live.note(Report::Checkpoints(vec![2, 4]));
        let (nodes, steps) = (live.nodes.clone(), live.steps.until(i64::MAX));
        (4..9).for_each(|ms| react(&mut live, ms));
        // The first list came too late for the state then.
        assert!(!live.has_checkpoint(3) && live.has_checkpoint(5) && !live.go_back(2));
        live.depart();
        assert!(live.go_back(4));
        assert_eq!((live.now, live.times.len(), live.problems.len(), live.problem_count), (3_000_000, 4, 4, 4));
        assert_eq!((&live.nodes, live.steps.until(i64::MAX)), (&nodes, steps));
        assert_eq!(live.reactions_until(7_000_000), 8);
        (4..6).for_each(|ms| react(&mut live, ms));
        assert_eq!(live.differs(), None);
        [6, 8, 9].into_iter().for_each(|ms| react(&mut live, ms));
        assert_eq!(live.differs(), Some(7_000_000));
    }
}

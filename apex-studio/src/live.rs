//! Knowledge about a running robot.

use crate::{
    detail,
    lane::{Drawn, Lane, Window, limited},
    passes::Passes,
    pulse::Pulse,
    steps::{State, Step, Steps, What},
    tokens::Tokens,
    waits::Waits,
    words::{is_name, is_value},
};
use apex_rt::studio::message::{About, NodeTimes, Report};
use serde::Serialize;
use std::{
    borrow::Cow,
    collections::{BTreeMap, VecDeque},
    sync::Arc,
    time::Instant,
};

/// Number of problems that are kept. The newest come first.
const MAX_PROBLEMS: usize = 10_000;
/// Maximum length of the text of a problem in bytes.
const MAX_WORDS: usize = 1000;

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
    /// Time of the last reaction in ns, and of the first one that is known.
    pub now: i64,
    began: Option<i64>,
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
    /// Number of ways of this run that are over.
    pub ways: u64,
    /// Number of reactions.
    pub reactions: u64,
    /// Parameters that were set, with the numbers of reactions before.
    pub sets: Vec<(u64, String, String)>,
    /// Times of the calls of each node, as far as they were measured.
    pub calls: Vec<NodeTimes>,
    /// Number of messages with times.
    pub measured: u64,
    /// `true` if this run repeats an earlier one up to a point.
    pub repeats: bool,
    /// `true` while it repeats that one: the robot does not obey pages meanwhile.
    pub travels: bool,
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
    /// Ways of activity, and the last time for each.
    pub passes: Passes,
    /// `true` if the robot lets viewers only look.
    pub readonly: bool,
    pulse: Pulse,
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
    steps: Steps,
    reactions: u64,
    now: i64,
}

/// State of a node.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Node {
    pub active: bool,
    /// Time in ns since which it is active or inactive.
    pub since: i64,
    /// Number of firings, and of tokens that its slots took.
    pub fired: u64,
    pub taken: u64,
    /// Time of the last of these in ns.
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
            began: None,
            nodes: vec![],
            handled: vec![],
            lost: 0,
            problem_count: 0,
            problems: VecDeque::new(),
            params: BTreeMap::new(),
            tokens: BTreeMap::new(),
            paused: false,
            speed: f64::INFINITY,
            ways: 0,
            reactions: 0,
            sets: vec![],
            calls: vec![],
            measured: 0,
            repeats: false,
            travels: false,
            returns: 0,
            no_checkpoints: None,
            checkpoints: vec![],
            steps: Steps::new(Arc::default()),
            waits: Waits::default(),
            passes: Passes::default(),
            readonly: false,
            pulse: Pulse::default(),
            lanes: vec![],
            before: None,
        }
    }
}

impl Live {
    /// Begins a run of the robot that a message describes. Returns the run before it.
    pub fn begin(&mut self, about: About) -> Self {
        let (runs, repeats, travels) = (self.runs + 1, self.repeats, self.travels);
        let mut before = self.before.take().filter(|_| repeats);
        let about = Arc::new(about);
        before.iter_mut().for_each(|before| before.map_to(&about));
        let steps = Steps::new(self.steps.store());
        let (readonly, run) = (self.readonly, Run::Running);
        let next = Self { runs, repeats, travels, before, steps, readonly, run, ..Self::default() };
        let last = std::mem::replace(self, next);
        self.nodes = vec![Node::default(); about.nodes.len()];
        self.lanes = about.nodes.iter().map(|_| Lane::of(about.nodes.len())).collect();
        self.handled = vec![0; about.connections.len()];
        (self.waits, self.passes) = (Waits::new(&about), Passes::new(&about));
        self.about = Some(about);
        last
    }

    /// Takes note of a message. Numbers that do not fit the description of the robot are ignored.
    pub fn note(&mut self, report: Report) {
        self.pulse.hear(Instant::now());
        match report {
            Report::About(about) => drop(self.begin(about)),
            Report::Active(nodes) => nodes.into_iter().for_each(|node| self.activity(node, true)),
            Report::Reaction { now, .. } => {
                self.now = self.now.max(limited(now));
                self.reactions += 1;
                self.began.get_or_insert(limited(now));
                self.step(What::Begins);
            }
            Report::Fired(node) => {
                self.step(What::Fires(node));
                self.waits.fired(node);
                self.run(node, |state| state.fired += 1);
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
            Report::Waits(connection) => self.deadlock(connection, |event| {
                format!("waits for the event `{event}`, which can no longer be triggered")
            }),
            Report::Stuck(connection) => self.deadlock(connection, |event| {
                format!("never takes the token of `{event}`, which waits for one that waits for it")
            }),
            Report::Endless(nodes) => {
                let node = nodes.iter().max_by_key(|(_, count)| *count).map(|(node, _)| *node);
                self.problem(node, "tokens cycle without time passing".to_owned());
            }
            Report::Beside(text) => self.problem(None, text),
            Report::ClaimFailed(claim) => {
                let claims = self.about.as_ref().map_or(&[][..], |about| &about.claims);
                let claim = claims.get(claim as usize).map_or("?", String::as_str);
                self.problem(None, format!("the claim `{claim}` does not hold"));
            }
            Report::Value { channel, now, text, bytes } if self.has_channel(channel) => {
                self.tokens.entry(channel).or_default().push(limited(now), text, bytes);
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
            Report::Lost(count) => self.lost = self.lost.saturating_add(count),
            Report::Param { name, value, reactions } => self.param(name, value, reactions),
            Report::Pace { paused, speed, ways, .. } => (self.paused, self.speed, self.ways) = (paused, speed, ways),
            Report::Checkpoints(all) => self.keep(&all),
            Report::NoCheckpoints(why) => (self.no_checkpoints, self.checkpoints) = (Some(why), vec![]),
            Report::Ended => self.end(Run::Ended),
            Report::Alive(groups) => self.pulse.beat(groups, Instant::now()),
            Report::ReadOnly => self.readonly = true,
            Report::Dismissed(why) => self.end(Run::Lost(why)),
        }
    }

    /// Reason to believe that the robot stands still, or the connection to it.
    pub fn silence(&self) -> Option<String> {
        self.pulse.silence(self.about.as_ref().map_or(&[], |about| &about.groups), Instant::now())
    }

    /// Lets the last message have come at this time.
    #[cfg(test)]
    pub fn hear(&mut self, at: Instant) {
        self.pulse.hear(at);
    }

    fn step(&mut self, what: What) {
        self.steps.push(Step { now: self.now, reaction: self.reactions, what });
    }

    fn has_channel(&self, channel: u32) -> bool {
        self.about.as_ref().is_some_and(|about| (channel as usize) < about.channels.len())
    }

    /// A node fires, or one of its slots takes a token.
    fn run(&mut self, node: u32, count: fn(&mut Node)) {
        if let Some(state) = self.nodes.get_mut(node as usize) {
            count(state);
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
            self.run(to, |state| state.taken += 1);
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
                let state = |node: u32| self.nodes.get(node as usize).map_or((false, 0), |n| (n.active, n.since));
                self.passes.change(node, self.now, state);
                self.step(if active { What::Starts(node) } else { What::Stops(node) });
            }
        }
    }

    /// Notes that the node at the end of a connection stands still. `text` gets the name of the event.
    fn deadlock(&mut self, connection: u32, text: fn(&str) -> String) {
        let Some(about) = self.about.clone() else { return };
        let Some(connection) = about.connections.get(connection as usize) else { return };
        let from = about.nodes.get(connection.from as usize).map_or("?", |node| &node.name);
        self.problem(Some(connection.to), text(&format!("{from}.{}", connection.output)));
    }

    fn problem(&mut self, node: Option<u32>, mut text: String) {
        text.truncate((0..=MAX_WORDS.min(text.len())).rfind(|end| text.is_char_boundary(*end)).unwrap_or(0));
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
        let is_known = |about: &Arc<About>| about.params.iter().any(|param| param.name == name);
        // Names and values are written into files.
        if !is_name(&name) || !self.about.as_ref().is_some_and(is_known) {
            return;
        }
        let value = value.and_then(|value| {
            if is_value(&value) { Ok(value) } else { Err("the robot tells something that is not a value".to_owned()) }
        });
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

    /// Names and values of the parameters that differ from their initial values.
    pub fn changed(&self) -> impl Iterator<Item = (&str, &str)> {
        let changed = self.params.iter().filter(|(_, param)| param.value != param.initial);
        changed.map(|(name, param)| (name.as_str(), param.value.as_str()))
    }

    /// The parameters that differ from their initial values, as TOML for `--params`.
    pub fn changed_params(&self) -> String {
        self.changed().map(|(name, value)| format!("{name} = {value}\n")).collect()
    }

    /// Names and values of the parameters that have other values in another run.
    pub fn changed_from(&self, other: &Self) -> Vec<(String, String)> {
        let is_other = |(name, param): &(&String, &Param)| {
            other.params.get(*name).is_some_and(|other| !other.fixed && other.value != param.value)
        };
        let changed = self.params.iter().filter(is_other);
        changed.map(|(name, param)| (name.clone(), param.value.clone())).collect()
    }

    /// Takes note of the robot's checkpoints. The last one may be new.
    fn keep(&mut self, all: &[u64]) {
        self.checkpoints.retain(|checkpoint| all.contains(&checkpoint.reactions));
        let now = self.reactions;
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

    /// The robot has ended, and its checkpoints with it.
    pub fn end(&mut self, run: Run) {
        (self.run, self.checkpoints, self.travels) = (run, vec![], false);
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
            *lane = lane.until(*now, node.active, node.fired + node.taken);
        }
        let known = self.problem_count - self.problems.len() as u64;
        self.problems.truncate(usize::try_from(problem_count.saturating_sub(known)).unwrap_or(usize::MAX));
        (self.now, self.problem_count, self.lost) = (*now, *problem_count, *lost);
        (self.nodes, self.handled) = (nodes.clone(), handled.clone());
        self.reactions = reactions;
        self.sets.retain(|(at, ..)| *at < reactions);
        let active = (0..).zip(&self.nodes).filter(|(_, node)| node.active).map(|(node, _)| node).collect();
        self.steps.take_back(State { now: self.now, reaction: reactions, active });
        self.tokens.values_mut().for_each(|tokens| tokens.take_back(self.now));
        self.passes.take_back(self.now);
        (self.returns, self.run, self.repeats) = (self.returns + 1, Run::Running, true);
        true
    }

    /// Keeps this run for comparison with the next one, which repeats it up to a point.
    pub fn depart(&mut self) {
        let Some(about) = self.about.clone() else { return };
        let goes_further = |before: &Before| before.now >= self.now && self.differs().is_none();
        if !self.before.as_ref().is_some_and(goes_further) {
            let lanes = self.lanes.iter().cloned().map(Some).collect();
            let (steps, reactions) = (self.steps.clone(), self.reactions);
            self.before = Some(Before { lanes, about, steps, reactions, now: self.now });
        }
        (self.repeats, self.travels) = (true, true);
    }

    /// The run that this one repeats, as long as it has gone further.
    fn ahead(&self) -> Option<&Before> {
        self.before.as_ref().filter(|before| before.reactions > self.reactions)
    }

    /// Number of reactions up to a time in ns, also in the future if that is known.
    pub fn reactions_until(&self, time: i64) -> u64 {
        self.ahead().map_or(&self.steps, |before| &before.steps).reactions_until(time)
    }

    /// `true` if it is not known what the robot does at a time in ns, because it is in the future.
    pub fn is_unknown(&self, time: i64) -> bool {
        time > self.ahead().map_or(self.now, |before| before.now)
    }

    /// Time in ns at which this run begins to differ from the one that it repeats.
    pub fn differs(&self) -> Option<i64> {
        let before = self.before.as_ref()?;
        let until = self.now.min(before.now);
        let both = self.lanes.iter().zip(&before.lanes).filter_map(|(lane, other)| Some((lane, other.as_ref()?)));
        both.filter_map(|(lane, other)| lane.differs(other, i64::MIN, until)).min()
    }

    /// Time in ns at which this run begins to differ from another one with the same inputs that runs at the same time.
    /// Programs with several threads have no known order, and are not compared.
    pub fn differs_from(&self, other: &Self) -> Option<i64> {
        let (about, since) = (self.about.as_ref()?, self.began?.max(other.began?));
        let is_same = |about: &About, other: &About| about.nodes == other.nodes && about.groups.len() < 2;
        if !is_same(about, other.about.as_ref()?) {
            return None;
        }
        let until = self.now.min(other.now);
        self.lanes.iter().zip(&other.lanes).filter_map(|(lane, other)| lane.differs(other, since, until)).min()
    }

    /// The lanes of these nodes in another run.
    pub fn draw_of(&self, window: Window, nodes: &[usize]) -> Vec<Drawn> {
        let drawn = |node: &usize| Some(self.lanes.get(*node)?.draw(*node, window, self.now));
        nodes.iter().filter_map(drawn).collect()
    }

    /// The lanes of these nodes in the run that this one repeats.
    pub fn draw_before(&self, window: Window, nodes: &[usize]) -> Vec<Drawn> {
        let Some(before) = &self.before else { return vec![] };
        let drawn = |node: &usize| Some(before.lanes.get(*node)?.as_ref()?.draw(*node, window, before.now));
        nodes.iter().filter_map(drawn).collect()
    }

    /// History of each node.
    pub fn lanes(&self) -> &[Lane] {
        &self.lanes
    }

    /// Exact history of each node between two times in ns, and perhaps before and after; `None` if it is not known any
    /// more.
    pub fn exact_lanes(&self, from: i64, to: i64) -> Option<Cow<'_, [Lane]>> {
        if self.lanes.iter().all(Lane::is_exact) {
            return Some(Cow::Borrowed(&self.lanes));
        }
        detail::lanes(&self.steps, self.about.as_deref()?, from, to, to.saturating_sub(from).max(1)).map(Cow::Owned)
    }

    /// The lanes of all nodes that were active or had problems, and of those in `also`. Only those that are seen have
    /// contents.
    pub fn draw(&self, window: Window, also: &[usize], is_seen: &dyn Fn(usize) -> bool) -> Vec<Drawn> {
        let was =
            |at: usize| self.before.as_ref().and_then(|b| b.lanes.get(at)?.as_ref()).is_some_and(Lane::is_of_interest);
        let is_drawn = |(at, lane): &(usize, &Lane)| lane.is_of_interest() || was(*at) || also.contains(at);
        let is_coarse = self.lanes.iter().any(|lane| lane.is_coarser_than(window));
        let about = self.about.as_deref().filter(|_| is_coarse);
        let fine = about
            .and_then(|about| detail::lanes(&self.steps, about, window.from, window.to, window.column_width()))
            .unwrap_or_default();
        let drawn = |(at, lane): (usize, &Lane)| {
            if !is_seen(at) {
                return Drawn { node: at, ..Drawn::default() };
            }
            let drawn = lane.draw(at, window, self.now);
            fine.get(at)
                .map(|fine| Drawn { marks: drawn.marks.clone(), ..fine.draw(at, window, self.now) })
                .unwrap_or(drawn)
        };
        self.lanes.iter().enumerate().filter(is_drawn).map(drawn).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::robot;

    fn begun() -> Live {
        let mut live = Live::default();
        live.begin(About { simulated: true, ..robot(&["a", "b"]) });
        live
    }

    fn react(live: &mut Live, ms: i64) {
        live.note(Report::Reaction { group: 0, now: ms * 1_000_000 });
        live.note(Report::Fired(0));
        live.note(Report::Activity { node: 1, active: ms % 2 == 0 });
        live.note(Report::Failed { node: 0, error: ms.to_string() });
    }

    #[test]
    fn a_problem_beside_the_program_is_one_of_no_node() {
        let mut live = begun();
        react(&mut live, 7);
        live.note(Report::Beside("no node publishes `/scan`".to_owned()));
        let last = live.problems.back().map(|problem| (problem.at, problem.node, &*problem.text));
        assert_eq!((last, live.problem_count), (Some((0.007, None, "no node publishes `/scan`")), 2));
        assert!(live.nodes.iter().all(|node| node.problems <= 1));
    }

    #[test]
    fn a_run_goes_back_to_a_checkpoint_and_is_compared_with_what_it_was() {
        let mut live = begun();
        (0..4).for_each(|ms| react(&mut live, ms));
        live.note(Report::Checkpoints(vec![2]));
        live.note(Report::Checkpoints(vec![2, 4]));
        let (nodes, steps) = (live.nodes.clone(), live.steps.around(i64::MAX).len());
        (4..9).for_each(|ms| react(&mut live, ms));
        // The first list came too late for the state then.
        assert!(!live.has_checkpoint(3) && live.has_checkpoint(5) && !live.go_back(2));
        live.depart();
        assert!(live.go_back(4));
        assert_eq!((live.now, live.reactions, live.problems.len(), live.problem_count), (3_000_000, 4, 4, 4));
        assert_eq!((&live.nodes, live.steps.around(i64::MAX).len()), (&nodes, steps));
        assert_eq!(live.reactions_until(7_000_000), 8);
        (4..6).for_each(|ms| react(&mut live, ms));
        assert_eq!(live.differs(), None);
        [6, 8, 9].into_iter().for_each(|ms| react(&mut live, ms));
        assert_eq!(live.differs(), Some(7_000_000));
    }
}

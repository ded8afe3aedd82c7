//! One page: answers to what it asks for, and what has changed since it was told.

use crate::{
    drawn::drawn,
    editor::Editor,
    lane::{Window, nanos},
    live::{Live, Node, Param, Run},
    messages::{AboutRun, Asked, Drawing, NewTokens, Tick, Told},
    moment,
    picture::{Picture, View},
    robot::{Earlier, Shared, locked},
    source::{ParamChange, Source},
    why::{Line, why},
};
use apex_rt::studio::message::Command;
use base64::{Engine as _, prelude::BASE64_STANDARD};
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::{Arc, MutexGuard},
};

/// A page.
pub struct Session {
    shared: Arc<Shared>,
    /// The run that is shown instead of the current one.
    earlier: Option<Earlier>,
    /// The robot beside it, if it has a shadow or is one.
    beside: Option<Beside>,
    source: Arc<dyn Source>,
    readonly: bool,
    travels: bool,
    seen: Seen,
    picture: Option<Picture>,
    editor: Editor,
    watched: BTreeSet<u32>,
    /// Channels of the last answer to why.
    explained: BTreeSet<u32>,
    measures: bool,
    /// The view that the user has chosen, and the open graphs of each view, from the first choice on.
    view: Option<View>,
    open: BTreeMap<View, BTreeSet<String>>,
}

/// Knowledge of the page.
#[derive(Default)]
struct Seen {
    runs: u64,
    /// Numbers of the runs that can be looked at.
    all_runs: Vec<u64>,
    returns: u64,
    no_checkpoints: Option<String>,
    nodes: Vec<Node>,
    handled: Vec<u64>,
    passed: Vec<Option<i64>>,
    problems: u64,
    params: BTreeMap<String, u64>,
    tokens: BTreeMap<u32, u64>,
    /// Number of tokens of the robot beside it, and of the run that they belong to.
    beside: (u64, BTreeMap<u32, u64>),
    errors: Option<String>,
    /// Number of messages with times.
    measured: u64,
}

/// The other one of a robot and its shadow, which gets the same inputs.
#[derive(Clone)]
pub struct Beside {
    pub shared: Arc<Shared>,
    /// `true` if it is the shadow.
    pub is_shadow: bool,
}

impl Session {
    pub fn new(
        shared: Arc<Shared>,
        beside: Option<Beside>,
        source: Arc<dyn Source>,
        readonly: bool,
        travels: bool,
    ) -> Self {
        let (seen, watched) = (Seen::default(), BTreeSet::new());
        let editor = Editor::new(Arc::clone(&source));
        let (earlier, picture, measures, view, open) = (None, None, false, None, BTreeMap::new());
        Self {
            shared,
            earlier,
            beside,
            source,
            readonly,
            travels,
            seen,
            picture,
            editor,
            watched,
            explained: BTreeSet::new(),
            measures,
            view,
            open,
        }
    }

    /// Shows what another session of the same page has shown: the activity, or the wiring.
    pub fn look_like(&mut self, other: &Self) {
        self.view = other.view;
    }

    /// The run that is shown.
    fn live(&self) -> MutexGuard<'_, Live> {
        self.earlier.as_ref().map_or_else(|| self.shared.live(), |earlier| locked(earlier))
    }

    /// The run that is shown, and that of the robot beside it while this one is shown as it is now. The robot is always
    /// locked before its shadow: pages of both work at the same time.
    fn both(&self) -> (MutexGuard<'_, Live>, Option<MutexGuard<'_, Live>>) {
        match self.beside.as_ref().filter(|_| self.earlier.is_none()) {
            None => (self.live(), None),
            Some(shadow) if shadow.is_shadow => {
                let own = self.live();
                (own, Some(shadow.shared.live()))
            }
            Some(robot) => {
                let other = robot.shared.live();
                (self.live(), Some(other))
            }
        }
    }

    /// Gives the robot the parameters of its shadow, if this is the shadow.
    fn take_over(&self) {
        let Some(robot) = self.beside.as_ref().filter(|beside| !beside.is_shadow) else { return };
        let (own, other) = self.both();
        let changed = other.as_ref().map(|other| own.changed_from(other)).unwrap_or_default();
        drop((own, other));
        robot.shared.set_all(changed);
    }

    /// Shows the run with this number; the current one if it is none of the earlier ones.
    fn look(&mut self, run: u64) {
        self.earlier = self.shared.earlier().into_iter().find(|earlier| locked(earlier).runs == run);
        self.seen = Seen::default();
    }

    /// Answers the page.
    pub fn answer(&mut self, asked: Asked) -> Option<Told> {
        let command = match asked {
            Asked::Watch(_) | Asked::Measure(_) if self.readonly => return None,
            Asked::Edit { file, version, text } if self.readonly => {
                return self.editor.colours(file, version, &text).map(Told::Written);
            }
            Asked::Open { view, open } => {
                self.view = Some(view);
                open.and_then(|open| self.open.insert(view, open));
                return self.draw();
            }
            Asked::Watch(channels) => {
                self.watch(&channels);
                self.unwatch(&self.watched);
                self.watched = channels;
                return None;
            }
            Asked::Measure(measures) => {
                if measures != self.measures {
                    self.shared.measure(measures);
                    self.measures = measures;
                }
                return None;
            }
            Asked::Lanes { from, to, columns, also, seen } => {
                let window = Window::new(from, to, columns);
                let (live, other) = self.both();
                let is_seen = |node: usize| seen.as_ref().is_none_or(|seen| seen.contains(&node));
                let lanes = live.draw(window, &also, &is_seen);
                let nodes: Vec<usize> = lanes.iter().map(|lane| lane.node).filter(|node| is_seen(*node)).collect();
                let (before, differs) = match other {
                    Some(other) => (other.draw_of(window, &nodes), live.differs_from(&other)),
                    None => (live.draw_before(window, &nodes), live.differs()),
                };
                return Some(Told::Lanes { from, to, columns, lanes, before, differs: differs.map(seconds) });
            }
            Asked::Why { node, at } => {
                let live = self.live();
                let time = at.map_or(live.now, nanos);
                let lines = why(&live, node, time);
                drop(live);
                self.explain(&lines);
                return Some(Told::Why(lines));
            }
            Asked::Edit { file, version, text } => return self.editor.edit(file, version, text).map(Told::Written),
            Asked::Hover(place) => {
                self.editor.hover(place);
                return None;
            }
            Asked::Complete(place) => {
                self.editor.complete(place);
                return None;
            }
            // Another page shows it.
            Asked::Robot(_) => return None,
            Asked::Look(run) => {
                self.look(run);
                return None;
            }
            _ if self.readonly || self.earlier.is_some() => return None,
            Asked::Keep { file, text, over } => return Some(Told::Written(self.editor.keep(file, &text, over))),
            Asked::Restart => {
                self.shared.restart();
                return None;
            }
            Asked::Back | Asked::Goto(_) if !self.travels || self.shared.live().travels => return None,
            Asked::Back => {
                let last = self.shared.live().reactions.saturating_sub(1);
                self.shared.travel(last);
                return None;
            }
            Asked::Goto(time) => {
                self.shared.go_to(nanos(time));
                return None;
            }
            Asked::Break(text) => return Some(Told::Break(self.shared.halt_when(&text).err())),
            Asked::Take => {
                self.take_over();
                return None;
            }
            Asked::Save => {
                let changed = self.shared.live().changed_params();
                return Some(Told::Saved(self.source.save_params(&changed)));
            }
            Asked::Test(from, to) => return Some(Told::Test(self.write_test(from, to))),
            Asked::Write(name) => return Some(Told::Saved(self.write(&name))),
            Asked::Set { name, value } => Command::Set { name, value },
            Asked::Pause => Command::Pause,
            Asked::Step => Command::Step,
            Asked::Run { speed } => Command::Run { speed: speed.unwrap_or(f64::INFINITY) },
        };
        if !self.shared.live().travels {
            self.shared.tell(&command);
        }
        None
    }

    /// Asks for the tokens of channels, also of the robot beside this one.
    fn watch(&self, channels: &BTreeSet<u32>) {
        self.robots().for_each(|robot| channels.iter().for_each(|channel| robot.watch(*channel)));
    }

    fn unwatch(&self, channels: &BTreeSet<u32>) {
        self.robots().for_each(|robot| channels.iter().for_each(|channel| robot.unwatch(*channel)));
    }

    fn robots(&self) -> impl Iterator<Item = &Arc<Shared>> {
        [&self.shared].into_iter().chain(self.beside.as_ref().map(|beside| &beside.shared))
    }

    /// Asks from now on for the tokens of an answer, so that the next answer about the same has their values.
    fn explain(&mut self, lines: &[Line]) {
        if self.readonly {
            return;
        }
        let channels = lines.iter().filter_map(|line| line.channel).collect();
        self.watch(&channels);
        self.unwatch(&self.explained);
        self.explained = channels;
    }

    /// Writes a test of an interval. Returns the path of its file.
    fn write_test(&self, from: f64, to: f64) -> Result<String, String> {
        let replayed = self.source.replayed()?;
        let live = self.shared.live();
        let test = moment::test(&live, nanos(from), nanos(to), replayed.as_ref())?;
        let name = live.about.as_ref().map_or_else(String::new, |about| about.name.clone());
        drop(live);
        self.source.write_test(&name, &test)
    }

    /// Writes a parameter into the source. Returns the place.
    fn write(&self, name: &str) -> Result<String, String> {
        let live = self.shared.live();
        let about = live.about.clone().ok_or("there is no robot yet")?;
        let value = live.params.get(name).map(|param| param.value.clone()).ok_or("its value is not known")?;
        drop(live);
        let nodes =
            about.nodes.iter().filter_map(|node| Some((node, name.strip_prefix(&node.name)?.strip_prefix('.')?)));
        let (node, param) = nodes.max_by_key(|(node, _)| node.name.len()).ok_or("it belongs to no node")?;
        self.source.write_param(&ParamChange {
            file: about.files.get(node.file as usize).map_or("", String::as_str),
            line: node.line as usize,
            node: node.name.rsplit('.').next().unwrap_or_default(),
            param,
            unit: about.params.iter().find(|info| info.name == name).and_then(|info| info.unit.as_deref()),
            value: &value,
        })
    }

    /// All that has happened since the last call.
    pub fn news(&mut self) -> Vec<Told> {
        let mut told = self.runs();
        let (shared, earlier) = (Arc::clone(&self.shared), self.earlier.clone());
        let shown = || earlier.as_ref().map_or_else(|| shared.live(), |earlier| locked(earlier));
        let live = shown();
        let new = live.about.clone().filter(|_| live.runs != self.seen.runs);
        drop(live);
        // Nobody waits for the compiler but this page.
        let new = new.map(|about| {
            let picture = self.source.picture(&about.name).unwrap_or_else(|| drawn(&about));
            (self.editor.begin(&about.files), Picture::new(picture), about)
        });
        let live = shown();
        // If yet another run has begun meanwhile, that comes the next time.
        let new = new.filter(|(.., about)| live.about.as_ref().is_some_and(|now| Arc::ptr_eq(now, about)));
        if let Some(((texts, editable), picture, about)) = new {
            self.seen = Seen { all_runs: std::mem::take(&mut self.seen.all_runs), ..Seen::of(&live) };
            self.picture = Some(picture);
            let is_over = self.earlier.is_some();
            let (looks, rebuilds) = (self.readonly, self.travels);
            let readonly = looks || is_over || live.readonly;
            let travels = self.travels && about.simulated && !is_over;
            let (run, repeats) = (live.runs, live.repeats);
            let beside = self.beside.as_ref().filter(|_| !is_over);
            let beside = beside.map(|beside| if beside.is_shadow { "shadow" } else { "robot" });
            let about = AboutRun { run, about, texts, editable, rebuilds, readonly, looks, travels, repeats, beside };
            told.push(Told::About(about));
            drop(live);
            told.extend(self.draw());
            told.extend(self.since(&shown()));
        } else {
            told.extend(self.since(&live));
            drop(live);
        }
        told.extend(self.tokens_beside().map(Told::Beside));
        let errors = self.source.errors();
        if errors != self.seen.errors {
            self.seen.errors.clone_from(&errors);
            if errors.is_some() {
                self.editor.check();
            }
            told.push(Told::Errors(errors));
        }
        told.extend(self.editor.news(self.picture.as_ref()).into_iter().map(Told::Written));
        told
    }

    /// The runs that can be looked at, if they are others than before.
    fn runs(&mut self) -> Vec<Told> {
        let of = |run: &Live| (run.runs, seconds(run.now));
        let earlier: Vec<(u64, f64)> = self.shared.earlier().iter().map(|run| of(&locked(run))).collect();
        let last = self.shared.live().runs;
        let all: Vec<u64> = earlier.iter().map(|(run, _)| *run).chain([last]).collect();
        if all == self.seen.all_runs {
            return vec![];
        }
        self.seen.all_runs = all;
        let shown = self.live().runs;
        vec![Told::Runs { earlier, last, shown }]
    }

    fn draw(&mut self) -> Option<Told> {
        let about = self.live().about.clone()?;
        let picture = self.picture.as_ref()?;
        let (first, states) = (picture.first_view(), picture.states(&about));
        let has_activity = first == View::Activity;
        let view = self.view.filter(|_| has_activity).unwrap_or(first);
        let open = self.open.get(&view).cloned().unwrap_or_else(|| picture.first_open(view));
        let (svg, lines) = picture.drawn(view, &open, &about);
        Some(Told::Picture(Drawing { view, has_activity, svg, graphs: picture.graphs(view), open, lines, states }))
    }

    fn since(&mut self, live: &Live) -> Vec<Told> {
        if live.runs != self.seen.runs {
            return vec![];
        }
        let mut told = vec![];
        if live.returns != self.seen.returns {
            let Seen { errors, no_checkpoints, all_runs, .. } = std::mem::take(&mut self.seen);
            self.seen = Seen { errors, no_checkpoints, all_runs, ..Seen::of(live) };
            told.push(Told::Back(live.returns));
        }
        told.push(Told::Tick(self.seen.tick(live)));
        if live.no_checkpoints != self.seen.no_checkpoints {
            self.seen.no_checkpoints.clone_from(&live.no_checkpoints);
            told.push(Told::Checkpoints(live.no_checkpoints.clone()));
        }
        let new = usize::try_from(live.problem_count - self.seen.problems).unwrap_or(usize::MAX);
        if new > 0 {
            self.seen.problems = live.problem_count;
            let problems = live.problems.iter().skip(live.problems.len().saturating_sub(new)).cloned().collect();
            told.push(Told::Problems { count: live.problem_count, problems });
        }
        let params = self.seen.params(live);
        if !params.is_empty() {
            told.push(Told::Params(params));
        }
        if live.measured != self.seen.measured {
            self.seen.measured = live.measured;
            told.push(Told::Times(live.calls.iter().map(|t| (t.node, t.calls, t.total, t.worst)).collect()));
        }
        let tokens = new_tokens(&mut self.seen.tokens, live, &self.watched);
        if !tokens.is_empty() {
            told.push(Told::Tokens(tokens));
        }
        told
    }

    /// New tokens of the robot beside this one.
    fn tokens_beside(&mut self) -> Option<BTreeMap<u32, NewTokens>> {
        let shared = &self.beside.as_ref().filter(|_| self.earlier.is_none())?.shared;
        let (live, (run, seen)) = (shared.live(), &mut self.seen.beside);
        if *run != live.runs {
            (*run, *seen) = (live.runs, BTreeMap::new());
        }
        Some(new_tokens(seen, &live, &self.watched)).filter(|tokens| !tokens.is_empty())
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        if self.measures {
            self.shared.measure(false);
        }
        self.unwatch(&self.watched);
        self.unwatch(&self.explained);
    }
}

fn seconds(nanos: i64) -> f64 {
    nanos as f64 / 1e9
}

impl Seen {
    /// Knowledge of a page that knows nothing but the robot.
    fn of(live: &Live) -> Self {
        let (nodes, handled) = (vec![Node::default(); live.nodes.len()], vec![0; live.handled.len()]);
        let passed = vec![None; live.handled.len()];
        Self { runs: live.runs, returns: live.returns, nodes, handled, passed, ..Self::default() }
    }

    fn tick(&mut self, live: &Live) -> Tick {
        let mut nodes = vec![];
        for (at, (node, seen)) in live.nodes.iter().zip(&mut self.nodes).enumerate() {
            if node != seen {
                let (since, last) = (seconds(node.since), seconds(node.last));
                nodes.push((at, node.active, since, node.fired, node.taken, last, node.problems));
                *seen = *node;
            }
        }
        let mut handled = vec![];
        for (at, (count, seen)) in live.handled.iter().zip(&mut self.handled).enumerate() {
            if count != seen {
                handled.push((at, *count));
                *seen = *count;
            }
        }
        let mut passed = vec![];
        for (at, (time, seen)) in live.passes.times().iter().zip(&mut self.passed).enumerate() {
            if time != seen {
                passed.extend(time.map(|time| (at, seconds(time))));
                *seen = *time;
            }
        }
        let speed = live.speed.is_finite().then_some(live.speed);
        let travels = live.travels && live.run == Run::Running;
        let run = if travels { Run::Starting("repeating the run".to_owned()) } else { live.run.clone() };
        let now = seconds(live.now);
        let (paused, forgotten) = (live.paused, live.steps.forgotten().map(seconds));
        let silence = live.silence().filter(|_| live.run == Run::Running);
        Tick {
            run,
            now,
            paused,
            speed,
            lost: live.lost,
            silence,
            forgotten,
            nodes,
            handled,
            passed,
            awaited: live.waits.awaited(),
        }
    }

    fn params(&mut self, live: &Live) -> BTreeMap<String, Param> {
        let is_new = |(name, param): &(&String, &Param)| self.params.get(*name) != Some(&param.version);
        let new: BTreeMap<String, Param> =
            live.params.iter().filter(is_new).map(|(name, param)| (name.clone(), param.clone())).collect();
        self.params.extend(new.iter().map(|(name, param)| (name.clone(), param.version)));
        new
    }
}

/// Tokens of watched channels of which a page has `seen` only so many.
fn new_tokens(seen: &mut BTreeMap<u32, u64>, live: &Live, watched: &BTreeSet<u32>) -> BTreeMap<u32, NewTokens> {
    let mut new = BTreeMap::new();
    for (channel, tokens) in live.tokens.iter().filter(|(channel, _)| watched.contains(channel)) {
        let before = seen.insert(*channel, tokens.count).unwrap_or(0);
        let count = usize::try_from(tokens.count.saturating_sub(before)).unwrap_or(usize::MAX);
        let newest = tokens.newest.iter().skip(tokens.newest.len().saturating_sub(count));
        let texts: Vec<(f64, String)> = newest.map(|(now, text)| (seconds(*now), text.clone())).collect();
        if !texts.is_empty() {
            new.insert(*channel, NewTokens { texts, bytes: BASE64_STANDARD.encode(&tokens.bytes) });
        }
    }
    new
}

//! Why a node is active and fired, or why not: the way back through the steps of the robot.

use crate::{
    kinds::is_silent,
    live::Live,
    steps::{Part, What},
    words::one_line,
};
use apex_rt::studio::message::{About, AboutConnection, PortRole};
use serde::Serialize;
use std::{collections::BTreeSet, ops::Range};

/// Maximum number of lines of an answer.
const MAX_LINES: usize = 80;
/// Maximum number of causes one behind the other.
const MAX_DEPTH: u32 = 24;
/// Maximum number of characters of the value of a token.
const MAX_VALUE: usize = 60;

/// A line of an answer: a fact, and below it, deeper by one, its causes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    pub depth: u32,
    pub text: String,
    /// The node that it is about.
    pub node: u32,
    /// Its time in s.
    pub at: f64,
    /// The channel of the token that it is about.
    #[serde(skip)]
    pub channel: Option<u32>,
}

/// Explains the activity of a node and its firing, or why there was none, at a time in ns.
pub fn why(live: &Live, node: usize, time: i64) -> Vec<Line> {
    let Some(about) = live.about.as_deref().filter(|about| node < about.nodes.len()) else { return vec![] };
    let steps = live.steps.around(time);
    let (node, end) = (node as u32, steps.until(time));
    let is_forgotten = steps.is_forgotten;
    let mut answer = Answer { live, about, steps: &steps, lines: vec![], told: BTreeSet::new() };
    if end == 0 {
        let why = match is_forgotten {
            true => "what happened then is not known any more: go there, and ask again",
            false => "nothing has happened yet",
        };
        answer.say(0, why.to_owned(), node, time);
        return answer.lines;
    }
    answer.activity(node, end);
    answer.firing(node, end);
    answer.lines
}

struct Answer<'a> {
    live: &'a Live,
    about: &'a About,
    steps: &'a Part<'a>,
    lines: Vec<Line>,
    /// Steps that are explained already.
    told: BTreeSet<usize>,
}

/// A port from which tokens come to an input.
struct Origin<'a> {
    node: u32,
    output: &'a str,
    /// `true` if the tokens are those of the iteration before.
    delayed: bool,
}

impl<'a> Answer<'a> {
    fn say(&mut self, depth: u32, text: String, node: u32, now: i64) {
        if self.lines.len() < MAX_LINES {
            self.lines.push(Line { depth, text, node, at: now as f64 / 1e9, channel: None });
        }
    }

    fn name(&self, node: u32) -> &'a str {
        self.about.nodes.get(node as usize).map_or("?", |node| &node.name)
    }

    fn kind(&self, node: u32) -> &'a str {
        self.about.nodes.get(node as usize).map_or("", |node| &node.kind)
    }

    fn connection(&self, number: u32) -> Option<&'a AboutConnection> {
        self.about.connections.get(number as usize)
    }

    fn has_role(&self, node: u32, port: &str, role: PortRole) -> bool {
        let ports = self.about.nodes.get(node as usize).map_or(&[][..], |node| &node.ports);
        ports.iter().any(|(name, is, _)| name == port && *is == role)
    }

    /// `true` if a connection ends at a slot.
    fn is_to_slot(&self, c: &AboutConnection) -> bool {
        let declared = self.about.nodes.get(c.to as usize).map_or(&[][..], |node| &node.ports);
        let is_standard = matches!(c.input.as_str(), "enable" | "disable" | "cancel" | "resume");
        self.has_role(c.to, &c.input, PortRole::Slot)
            || is_standard && declared.iter().all(|(name, ..)| *name != c.input)
    }

    /// `true` if the tokens of a connection are taken one by one.
    fn is_asynchronous(&self, c: &AboutConnection) -> bool {
        self.is_to_slot(c) || self.has_role(c.from, &c.output, PortRole::Event)
    }

    /// The ports of real nodes from which the tokens of a connection come.
    fn origins(&self, c: &'a AboutConnection) -> Vec<Origin<'a>> {
        let (mut origins, mut seen) = (vec![], BTreeSet::new());
        let mut open = vec![(c, false)];
        while let Some((c, delayed)) = open.pop() {
            if !is_silent(self.kind(c.from)) {
                origins.push(Origin { node: c.from, output: &c.output, delayed });
            } else if seen.insert(c.from) {
                let delayed = delayed || self.kind(c.from) == "delay";
                open.extend(self.about.connections.iter().filter(|other| other.to == c.from).map(|c| (c, delayed)));
            }
        }
        origins
    }

    /// The last of the first `end` steps in which a port sent a token.
    fn sending(&self, node: u32, port: &str, end: usize) -> Option<usize> {
        let is_port = |name: &str| {
            name.strip_prefix(self.name(node)).and_then(|rest| rest.strip_prefix('.')).is_some_and(|name| name == port)
        };
        let channel = self.about.channels.iter().position(|c| c.node == node && is_port(&c.name))?;
        self.steps.last(end, |what| what == What::Sends(channel as u32))
    }

    /// `true` if in this step a node fires, or one of its slots takes a token.
    fn runs(&self, node: u32, what: What) -> bool {
        match what {
            What::Fires(fired) => fired == node,
            What::Takes(number) => self.connection(number).is_some_and(|c| c.to == node),
            _ => false,
        }
    }

    /// The connections by which tokens come to a node.
    fn incoming(&self, node: u32) -> impl Iterator<Item = &'a AboutConnection> + use<'a> {
        self.about.connections.iter().filter(move |c| c.to == node)
    }

    fn activity(&mut self, node: u32, end: usize) {
        let connections = &self.about.connections;
        let passes = |c: &AboutConnection| c.activity && (c.to == node || c.from == node);
        let change = self.steps.last(end, |what| what == What::Starts(node) || what == What::Stops(node));
        let (name, now) = (self.name(node), self.steps[end - 1].now);
        match change {
            Some(at) if self.steps[at].what == What::Starts(node) => {
                let since = self.steps[at].now;
                self.say(0, format!("`{name}` is active since {}", shown(since)), node, since);
                self.starts(node, at);
            }
            Some(at) => {
                let since = self.steps[at].now;
                self.say(0, format!("`{name}` is not active since {}", shown(since)), node, since);
                self.stops(node, at);
                self.lacks_activity(node, end);
            }
            None if !connections.iter().any(passes) => {}
            None => {
                let far = if self.steps.before.reaction > 0 { " in the last steps" } else { "" };
                self.say(0, format!("`{name}` did not become active or inactive{far}"), node, now);
                self.lacks_activity(node, end);
            }
        }
    }

    /// Why a node became active.
    fn starts(&mut self, node: u32, at: usize) {
        let now = self.steps[at].now;
        let ways: Vec<_> = self.incoming(node).filter(|c| c.activity).collect();
        match self.passing(&ways, at) {
            Some((c, step)) => {
                self.say(1, format!("{} brought activity", way(self, c)), c.from, now);
                self.cause(step, 2);
            }
            None if ways.iter().any(|c| self.kind(c.from) == "start") => {
                self.say(1, "it is active from the start, or after `reset`".to_owned(), node, now);
            }
            None => self.say(1, "its activity came back (`resume`), or from outside".to_owned(), node, now),
        }
    }

    /// Why a node became inactive.
    fn stops(&mut self, node: u32, at: usize) {
        let now = self.steps[at].now;
        let ways: Vec<_> = self.about.connections.iter().filter(|c| c.from == node && c.activity).collect();
        match self.passing(&ways, at) {
            Some((c, step)) => {
                self.say(1, format!("{} took its activity along", way(self, c)), c.to, now);
                self.cause(step, 2);
            }
            None => self.say(1, "its activity was taken away: `cancel`, `reset`, or the end".to_owned(), node, now),
        }
    }

    /// Of these ways of activity the one over which a token came nearest to step `at`, and that step.
    fn passing(&self, ways: &[&'a AboutConnection], at: usize) -> Option<(&'a AboutConnection, usize)> {
        let reaction = self.steps.reaction(at);
        let come = ways.iter().filter_map(|c| {
            let is_taken =
                |what| matches!(what, What::Takes(number) if self.connection(number).is_some_and(|o| same(o, c)));
            let taken = self.steps.last(reaction.end, is_taken);
            let sent = || self.origins(c).iter().filter_map(|o| self.sending(o.node, o.output, reaction.end)).max();
            let step = taken.or_else(sent).filter(|step| reaction.contains(step))?;
            Some((*c, step))
        });
        come.min_by_key(|(_, step)| step.abs_diff(at))
    }

    /// From where a node could become active.
    fn lacks_activity(&mut self, node: u32, end: usize) {
        let now = self.steps[end - 1].now;
        for c in self.incoming(node).filter(|c| c.activity) {
            for origin in self.origins(c) {
                let change =
                    self.steps.last(end, |what| what == What::Starts(origin.node) || what == What::Stops(origin.node));
                let is_active = change.is_some_and(|at| self.steps[at].what == What::Starts(origin.node));
                let (from, port) = (self.name(origin.node), origin.output);
                let text = match (is_active, self.sending(origin.node, port, end)) {
                    (true, Some(at)) if change.is_some_and(|change| at > change) => {
                        format!("{}: `{from}` sent `{port}`, but has kept its activity", way(self, c))
                    }
                    (true, _) => format!("{}: `{from}` is active, but has not sent `{port}` since", way(self, c)),
                    (false, _) => format!("{}: `{from}` is not active", way(self, c)),
                };
                self.say(1, text, origin.node, now);
            }
        }
    }

    fn firing(&mut self, node: u32, end: usize) {
        if is_silent(self.kind(node)) {
            return;
        }
        let reaction = self.steps.reaction(end - 1);
        let reaction = reaction.start..reaction.end.min(end);
        let now = self.steps[end - 1].now;
        let last = self.steps.last(end, |what| self.runs(node, what));
        if let Some(at) = last.filter(|at| reaction.contains(at)) {
            self.cause(at, 0);
            return;
        }
        let (name, now_shown) = (self.name(node), shown(now));
        let before = last.map_or("never before".to_owned(), |at| format!("before at {}", shown(self.steps[at].now)));
        self.say(0, format!("`{name}` did not fire in the reaction at {now_shown}; {before}"), node, now);
        let mut seen = BTreeSet::from([node]);
        self.lacks(node, &reaction, 1, &mut seen);
    }

    /// Adds the reasons for which a node did not fire in a reaction.
    fn lacks(&mut self, node: u32, reaction: &Range<usize>, depth: u32, seen: &mut BTreeSet<u32>) {
        let now = self.steps[reaction.end - 1].now;
        let mut ways = self.incoming(node).peekable();
        if ways.peek().is_none() {
            let why = "it has no input: it fires by itself (`every`), or when the program around it calls it";
            self.say(depth, why.to_owned(), node, now);
            return;
        }
        if let Some(at) = self.disabled(node, reaction.end) {
            let since = self.steps[at].now;
            self.say(depth, format!("it is disabled since {}", shown(since)), node, since);
            self.cause(at, depth + 1);
        }
        for c in ways.filter(|c| !matches!(c.input.as_str(), "enable" | "disable" | "cancel" | "resume")) {
            let origins = self.origins(c);
            if origins.is_empty() {
                self.say(depth, format!("nothing came from outside by {}", way(self, c)), c.from, now);
            }
            for origin in origins {
                self.lacks_token(c, &origin, reaction, depth, seen);
            }
        }
    }

    /// Says whether a token came to an input, and if not, why.
    fn lacks_token(
        &mut self,
        c: &'a AboutConnection,
        origin: &Origin<'a>,
        reaction: &Range<usize>,
        depth: u32,
        seen: &mut BTreeSet<u32>,
    ) {
        let (now, from, port) = (self.steps[reaction.end - 1].now, self.name(origin.node), origin.output);
        let sent = self.sending(origin.node, port, reaction.end);
        let last = sent.map_or("never before".to_owned(), |at| format!("last at {}", shown(self.steps[at].now)));
        let ran = self.steps.last(reaction.end, |what| self.runs(origin.node, what));
        let ran = ran.is_some_and(|at| reaction.contains(&at));
        let (input, is_slot) = (&c.input, self.is_asynchronous(c));
        let text = match sent {
            Some(at) if reaction.contains(&at) || origin.delayed => format!("`{input}` has a token of `{from}.{port}`"),
            _ if is_slot => format!("`{input}` waits for a token of `{from}.{port}` ({last})"),
            _ if ran => format!("`{input}` has no token: `{from}` fired, but sent ⊥ at `{port}` ({last})"),
            _ => format!("`{input}` has no token: `{from}` did not fire"),
        };
        let is_missing = !sent.is_some_and(|at| reaction.contains(&at)) && !origin.delayed && !is_slot && !ran;
        self.say(depth, text, origin.node, now);
        if is_missing && depth < MAX_DEPTH && seen.insert(origin.node) {
            self.lacks(origin.node, reaction, depth + 1, seen);
        }
    }

    /// The step that has disabled a node, if it is disabled.
    fn disabled(&self, node: u32, end: usize) -> Option<usize> {
        let changes = |what, port: &str| match what {
            What::Takes(number) => self.connection(number).is_some_and(|c| c.to == node && c.input == port),
            _ => false,
        };
        let last = self.steps.last(end, |what| changes(what, "enable") || changes(what, "disable"))?;
        changes(self.steps[last].what, "disable").then_some(last)
    }

    /// The value of a token that was sent over a channel at a time in ns, if it is known: `: 0.4`.
    fn value(&self, channel: u32, time: i64) -> Option<String> {
        let text = one_line(self.live.tokens.get(&channel)?.at(time)?);
        let short: String = text.chars().take(MAX_VALUE).collect();
        Some(if short.len() < text.len() { format!(": {short}…") } else { format!(": {short}") })
    }

    /// The last token that each slot of a node took before step `at`: it may count still.
    fn taken(&self, node: u32, at: usize) -> Vec<usize> {
        let slots: BTreeSet<&str> =
            self.incoming(node).filter(|c| self.is_to_slot(c)).map(|c| c.input.as_str()).collect();
        let takes = |what, slot: &str| match what {
            What::Takes(number) => self.connection(number).is_some_and(|c| c.to == node && c.input == slot),
            _ => false,
        };
        slots.into_iter().filter_map(|slot| self.steps.last(at, |what| takes(what, slot))).collect()
    }

    /// Explains a step, and its causes below it.
    fn cause(&mut self, at: usize, depth: u32) {
        if self.tell(at, depth) && depth < MAX_DEPTH {
            for cause in self.causes(at) {
                self.cause(cause, depth + 1);
            }
            let What::Fires(node) = self.steps[at].what else { return };
            for taken in self.taken(node, at) {
                // How a token came about before is a question of its own, which leads round through the robot.
                if self.steps[taken].now == self.steps[at].now {
                    self.cause(taken, depth + 1);
                } else if self.tell(taken, depth + 1) {
                    for sent in self.causes(taken) {
                        self.tell(sent, depth + 2);
                    }
                }
            }
        }
    }

    /// Says what happens in a step. Returns `true` the first time.
    fn tell(&mut self, at: usize, depth: u32) -> bool {
        let step = self.steps[at];
        let (text, node) = match step.what {
            What::Fires(node) => (format!("`{}` fired", self.name(node)), node),
            What::Takes(number) => match self.connection(number) {
                Some(c) => (format!("`{}.{}` took a token", self.name(c.to), c.input), c.to),
                None => return false,
            },
            What::Sends(channel) => match self.about.channels.get(channel as usize) {
                Some(channel) => (format!("`{}` was sent", channel.name), channel.node),
                None => return false,
            },
            What::Starts(node) => (format!("`{}` became active", self.name(node)), node),
            What::Stops(node) => (format!("`{}` became inactive", self.name(node)), node),
            What::Begins => return false,
        };
        let is_new = self.told.insert(at);
        let again = if is_new { "" } else { " (see above)" };
        let channel = if let What::Sends(channel) = step.what { Some(channel) } else { None };
        let value = channel.and_then(|channel| self.value(channel, step.now)).unwrap_or_default();
        self.say(depth, format!("{text}{value} at {}{again}", shown(step.now)), node, step.now);
        if let Some(line) = self.lines.last_mut() {
            line.channel = line.channel.or(channel);
        }
        is_new
    }

    /// The steps that led to a step.
    fn causes(&self, at: usize) -> Vec<usize> {
        match self.steps[at].what {
            What::Fires(node) => {
                let start = self.steps.reaction(at).start;
                let mut causes = vec![];
                for c in self.incoming(node).filter(|c| !self.is_to_slot(c)) {
                    for origin in self.origins(c) {
                        let end = if origin.delayed { start } else { at };
                        let sent = self.sending(origin.node, origin.output, end);
                        let may_be_old = origin.delayed || self.is_asynchronous(c);
                        causes.extend(sent.filter(|sent| may_be_old || *sent >= start));
                    }
                }
                causes
            }
            What::Takes(number) => {
                let Some(c) = self.connection(number) else { return vec![] };
                self.origins(c).iter().filter_map(|o| self.sending(o.node, o.output, at)).max().into_iter().collect()
            }
            What::Sends(channel) => {
                let Some(channel) = self.about.channels.get(channel as usize) else { return vec![] };
                let (node, port) = (channel.node, channel.name.rsplit('.').next().unwrap_or_default());
                let cause = self.steps.last(at, |what| match port {
                    "activated" | "timeout" => what == What::Starts(node),
                    "deactivated" => what == What::Stops(node),
                    _ => self.runs(node, what),
                });
                cause.into_iter().collect()
            }
            What::Starts(node) => {
                let ways: Vec<_> = self.incoming(node).filter(|c| c.activity).collect();
                self.passing(&ways, at).map(|(_, step)| step).into_iter().collect()
            }
            What::Stops(node) => {
                let ways: Vec<_> = self.about.connections.iter().filter(|c| c.from == node && c.activity).collect();
                self.passing(&ways, at).map(|(_, step)| step).into_iter().collect()
            }
            What::Begins => vec![],
        }
    }
}

fn same(one: &AboutConnection, other: &AboutConnection) -> bool {
    (one.from, &one.output, one.to, &one.input) == (other.from, &other.output, other.to, &other.input)
}

/// A connection as it is written.
fn way(answer: &Answer<'_>, c: &AboutConnection) -> String {
    let arrow = if c.activity { "=>" } else { "->" };
    let from = match is_silent(answer.kind(c.from)) {
        true => answer.name(c.from).to_owned(),
        false => format!("{}.{}", answer.name(c.from), c.output),
    };
    format!("`{from} {arrow} {}.{}`", answer.name(c.to), c.input)
}

fn shown(now: i64) -> String {
    format!("{:.3} s", now as f64 / 1e9)
}

//! Replay of a recorded run on the net of its graph.
//!
//! Only firings and slot calls are recorded. All other transitions of the net (notifications, unobserved ⊥, tokens at
//! the boundaries of nested graphs) occur here as soon as they can: their order makes no difference. There is one
//! exception: a node that takes activity but does not run because of ⊥ waits until the activity is recorded.

use super::{
    Net, Origin, PlaceId, Script, State, Token, Transition, TransitionId, TransitionKind, connection_name,
    demand_driven::demand_driven,
    expected::{Change, Expected},
    side_name,
    state::{Preview, unsupported},
};
use apex_dsl::{
    catalog::Catalog,
    graph::{ConnectionId, Graph, NodeId, NodeKind},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
    time::Duration,
};

/// A record that is not a firing sequence of the net.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wrong {
    /// Number of the record, counted from 1.
    pub step: usize,
    /// The recorded event.
    pub what: String,
    /// Reason why the event is not possible.
    pub why: String,
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "step {}: {}: {}", self.step, self.what, self.why)
    }
}

/// Nodes whose unrecorded transitions may occur early or late: nodes with slots, which take ⊥, delays, which send, and
/// relays, which take activity. Events may be blocked in one order and not in the other, and `cancel` may find activity
/// before a relay or not.
pub fn undecided(graph: &Graph, net: &Net) -> BTreeSet<NodeId> {
    let takes_activity = |node: NodeId| graph.connections.iter().any(|c| c.to.node == node && c.active);
    let undecided = net.transitions.iter().filter_map(|t| match t.kind {
        TransitionKind::Handle(connection) => Some(graph.connections[connection].to.node),
        TransitionKind::Release(node) => Some(node),
        TransitionKind::Take(node) => {
            let is_relay = matches!(graph.nodes[node].kind, NodeKind::Relay);
            (is_relay && takes_activity(node)).then_some(node)
        }
        _ => None,
    });
    undecided.collect()
}

/// Undecided nodes that act as late as possible from a step on.
#[derive(Default)]
struct Hesitation {
    nodes: BTreeSet<NodeId>,
    from: usize,
}

impl Hesitation {
    fn has(&self, node: NodeId, step: usize) -> bool {
        step >= self.from && self.nodes.contains(&node)
    }
}

/// A replay.
pub struct Replay<'a> {
    graph: &'a Graph,
    net: &'a Net,
    state: State<'a>,
    step: usize,
    now: Duration,
    /// Transitions that may have become enabled.
    agenda: BTreeSet<TransitionId>,
    by_kind: BTreeMap<TransitionKind, TransitionId>,
    /// For each source the number of its firings, and `true` if it has fired in this reaction.
    sources: BTreeMap<NodeId, (u32, bool)>,
    /// Sources that may fire when and as often as their consumers need their tokens.
    demand_driven: BTreeSet<NodeId>,
    expected: Expected,
    /// Changes of activity that were recorded before their cause.
    bypass: Vec<(NodeId, bool)>,
    /// Tokens that the last recorded call has taken.
    last: Vec<Token>,
    /// `true` if the nodes run in several thread groups.
    has_groups: bool,
    /// Nodes that take ⊥ and delays that send only when something else needs it.
    hesitation: Hesitation,
}

impl<'a> Replay<'a> {
    /// A replay from the beginning of the program.
    ///
    /// # Errors
    /// Fails if the graph has a feature that cannot be replayed.
    pub fn new(graph: &'a Graph, catalog: &Catalog, net: &'a Net, script: &'a Script<'a>) -> Result<Self, String> {
        if let Some(what) = unsupported(graph) {
            return Err(format!("{what}, which cannot be replayed"));
        }
        let state = State::new(graph, catalog, net, script);
        let mut replay = Self {
            graph,
            net,
            sources: state.sources().iter().map(|n| (*n, (0, false))).collect(),
            demand_driven: demand_driven(graph, state.sources()),
            state,
            step: 0,
            now: Duration::ZERO,
            agenda: net.transitions.ids().collect(),
            by_kind: net.transitions.iter_enumerated().map(|(i, t)| (t.kind, i)).collect(),
            expected: Expected::default(),
            bypass: vec![],
            last: vec![],
            has_groups: graph.has_several_groups(),
            hesitation: Hesitation::default(),
        };
        replay.expect_changes(true);
        Ok(replay)
    }

    /// The same replay in which these of the undecided nodes act as late as possible from a step on (counted from 1),
    /// and the others as early as possible. A run is legal if it is legal for one choice.
    #[must_use]
    pub fn hesitating(mut self, nodes: BTreeSet<NodeId>, from: usize) -> Self {
        self.hesitation = Hesitation { nodes, from };
        self
    }

    fn hesitates(&self, node: NodeId) -> bool {
        self.hesitation.has(node, self.step)
    }

    /// Begins a reaction.
    pub fn begin(&mut self, now: Duration) {
        self.step += 1;
        self.now = now;
        self.state.set_time(now);
        for (node, (_, fired)) in &mut self.sources {
            // An iteration that is still under way counts as the one of this reaction.
            let notify = self.by_kind.get(&TransitionKind::Notify(*node));
            let notify = notify.filter(|_| self.hesitation.has(*node, self.step));
            let waits = notify.and_then(|t| self.net.transitions[*t].takes.first());
            let is_delay = matches!(self.graph.nodes[*node].kind, NodeKind::Delay(_));
            *fired = is_delay && waits.is_some_and(|place| self.state.is_marked(*place));
        }
        // Time has passed, so that any transition may have become enabled.
        self.agenda = self.net.transitions.ids().collect();
        self.settle();
    }

    /// Replays a firing: `process` of `node` runs.
    ///
    /// # Errors
    /// Fails if it may not run.
    pub fn fired(&mut self, node: NodeId) -> Result<(), Wrong> {
        self.step += 1;
        let what = format!("fired {}", self.name(node));
        let Some(take) = self.by_kind.get(&TransitionKind::Take(node)).copied() else {
            return Err(self.wrong(&what, "it has no transition that could fire".to_owned()));
        };
        self.prepare(take, &what)?;
        if !self.state.preview(node).reported {
            return Err(self.wrong(&what, "a mandatory input holds ⊥".to_owned()));
        }
        if !self.is_due(node) {
            return Err(self.wrong(&what, "a source fires once per reaction, or at its times".to_owned()));
        }
        self.check_early(&what, |bypass| bypass == node)?;
        self.forget_optional();
        self.run(take);
        self.last = self.state.tokens_of(node);
        self.settle();
        self.match_early(&what)
    }

    /// Replays a slot call: the slot at the end of `connection` takes the token on it.
    ///
    /// # Errors
    /// Fails if it may not take the token.
    pub fn handled(&mut self, connection: ConnectionId) -> Result<(), Wrong> {
        self.step += 1;
        let Some(handle) = self.by_kind.get(&TransitionKind::Handle(connection)).copied() else {
            return Err(self.wrong(&format!("handled {}", connection.index()), "it does not end at a slot".to_owned()));
        };
        let what = format!("handled {}", connection_name(self.graph, connection));
        self.pay_debts(&what)?;
        self.prepare(handle, &what)?;
        let node = self.graph.connections[connection].to.node;
        let changes = |other: NodeId| match self.graph.nodes[node].kind {
            NodeKind::Reset => true,
            NodeKind::Interrupt(subject) => self.graph.nodes_of(subject).contains(&other),
            _ => other == node,
        };
        self.check_early(&what, changes)?;
        self.forget_optional();
        self.run(handle);
        // Nodes whose tokens carry activity no more may take them without a record.
        if matches!(self.graph.nodes[node].kind, NodeKind::Reset | NodeKind::Interrupt(_)) {
            self.agenda = self.net.transitions.ids().collect();
        }
        self.last = self.state.tokens_of(node);
        self.settle();
        self.match_early(&what)
    }

    /// Compares the tokens that the last recorded call found at its connected inputs (or its slot), in the order of the
    /// ports; `None` is ⊥.
    ///
    /// # Errors
    /// Fails if other tokens should have been there.
    pub fn took(&mut self, found: &[Option<Origin>]) -> Result<(), Wrong> {
        let what = format!("took {found:?}");
        if found.len() != self.last.len() {
            return Err(self.wrong(&what, format!("it has {} tokens to take", self.last.len())));
        }
        for (token, found) in self.last.iter().zip(found) {
            // Initial tokens have no origin: only values and ⊥ can be told apart.
            let same = match (token.value, token.origin) {
                (true, Some(origin)) => *found == Some(origin),
                (value, _) => value == found.is_some(),
            };
            if !same {
                let there = if token.value { format!("{:?}", token.origin) } else { "⊥".to_owned() };
                return Err(self.wrong(&what, format!("the net holds {there} instead of {found:?}")));
            }
        }
        Ok(())
    }

    /// Replays a change of activity of `node`.
    ///
    /// # Errors
    /// A change without a cause is reported by the next call, unless that is its cause.
    pub fn activity(&mut self, node: NodeId, active: bool) -> Result<(), Wrong> {
        self.step += 1;
        if self.expected.takes(node, active) {
            return Ok(());
        }
        // The activity may have come to a node that does not run because of ⊥, after nodes that remain as they are.
        while let Some(take) = self.deferred_for(node, active) {
            self.run(take);
            self.settle();
            if self.expected.takes(node, active) {
                return Ok(());
            }
        }
        // A timeout takes the activity of its node along.
        let own = self.by_kind.get(&TransitionKind::TimeOut(node)).copied();
        while self.time_out(|timeout| Some(timeout) == own) {
            if self.expected.takes(node, active) {
                return Ok(());
            }
        }
        self.bypass.push((node, active));
        Ok(())
    }

    /// Ends the reaction, after which nothing may be left to do.
    ///
    /// # Errors
    /// Fails if a transition can still occur, or if a change of activity was not recorded.
    pub fn end(&mut self) -> Result<(), Wrong> {
        self.step += 1;
        let what = "the reaction ends";
        self.flush_deferred();
        while self.time_out(|_| true) {}
        self.check_debts(what)?;
        self.check_early(what, |_| false)?;
        for (transition, t) in self.net.transitions.iter_enumerated() {
            if !self.state.is_enabled(transition) {
                continue;
            }
            if self.is_open(t.kind) {
                return Err(self.wrong(what, format!("`{}` could still occur", t.name)));
            }
        }
        if let Some((node, change)) = self.expected.open() {
            let word = if change.active { "active" } else { "inactive" };
            let why = format!("`{}` became {word} in step {}, which is not recorded", self.name(node), change.step);
            return Err(self.wrong(what, why));
        }
        self.expected = Expected::default();
        Ok(())
    }

    /// Returns `true` if an enabled transition has to occur before the reaction ends: sources may remain enabled if
    /// they are not due, or if they fire on demand.
    fn is_open(&self, kind: TransitionKind) -> bool {
        match kind {
            TransitionKind::Take(node) | TransitionKind::Release(node) => {
                self.is_due(node) && !self.demand_driven.contains(&node)
            }
            _ => true,
        }
    }

    /// Lets the first timeout occur if nothing else is left to do. With several thread groups, each group waits for its
    /// own nodes alone: the first timeout that `serves`. Returns `false` if none occurs.
    fn time_out(&mut self, serves: impl Fn(TransitionId) -> bool) -> bool {
        let enabled = self.net.transitions.iter_enumerated().filter(|(id, _)| self.state.is_enabled(*id));
        let (due, others): (Vec<_>, Vec<_>) = enabled.partition(|(_, t)| matches!(t.kind, TransitionKind::TimeOut(_)));
        let first = match self.has_groups {
            true => due.into_iter().find(|(id, _)| serves(*id)),
            false => due.into_iter().next().filter(|_| !others.iter().any(|(_, t)| self.is_open(t.kind))),
        };
        let Some((id, _)) = first else { return false };
        self.run(id);
        self.settle();
        true
    }

    /// Lets the timeout occur that `transition` waits for, over as few transitions as possible, or else any.
    fn time_out_for(&mut self, transition: TransitionId) -> bool {
        self.before(transition).into_iter().any(|end| self.time_out(|timeout| timeout == end))
            || self.time_out(|_| true)
    }

    /// A transition, those that give it what it lacks, those that give these what they lack, and so on.
    fn before(&self, transition: TransitionId) -> Vec<TransitionId> {
        let (mut before, mut seen) = (vec![transition], BTreeSet::from([transition]));
        let mut next = 0;
        while let Some(end) = before.get(next) {
            let missing = self.state.missing(*end);
            let gives = |t: &Transition| t.gives.iter().any(|p| missing.contains(p) && !t.takes.contains(p));
            let givers = self.net.transitions.iter_enumerated().filter(|(_, t)| gives(t));
            before.extend(givers.map(|(id, _)| id).filter(|id| seen.insert(*id)));
            next += 1;
        }
        before
    }

    /// Returns `true` if `node` is active now.
    pub fn is_active(&self, node: NodeId) -> bool {
        self.state.is_active(node)
    }

    fn name(&self, node: NodeId) -> String {
        self.graph.path(node)
    }

    fn wrong(&self, what: &str, why: String) -> Wrong {
        Wrong { step: self.step, what: what.to_owned(), why }
    }

    /// Returns `true` if `node` may fire now: a source with a timer at its times, any other source once per reaction.
    fn is_due(&self, node: NodeId) -> bool {
        let Some((count, fired)) = self.sources.get(&node) else { return true };
        let modifiers = &self.graph.nodes[node].modifiers;
        let Some(passed) = self.now.checked_sub(modifiers.after.unwrap_or_default()) else { return false };
        match modifiers.every {
            // The firings are at `after`, `after + period`, `after + 2 · period` and so on.
            Some(period) => period.saturating_mul(*count) <= passed,
            None => !fired || self.demand_driven.contains(&node),
        }
    }

    /// Enables `transition` by unrecorded transitions, if that is possible.
    fn prepare(&mut self, transition: TransitionId, what: &str) -> Result<(), Wrong> {
        // If nothing else is left to do, it waits for a timeout.
        while !self.has_groups && !self.state.is_enabled(transition) && self.time_out(|_| true) {}
        if !self.state.is_enabled(transition) {
            self.bring_all(transition, &mut BTreeSet::new());
        }
        // A deferred transition may be the one that blocks it.
        if !self.state.is_enabled(transition) {
            self.flush_for(transition);
        }
        while !self.state.is_enabled(transition) && self.time_out_for(transition) {
            self.bring_all(transition, &mut BTreeSet::new());
        }
        if self.state.is_enabled(transition) {
            return Ok(());
        }
        let missing = self.state.missing(transition);
        let places: Vec<&str> = missing.iter().map(|p| self.net.places[*p].name.as_str()).collect();
        Err(self.wrong(what, format!("no token at: {}", places.join("; "))))
    }

    /// Brings tokens to the places where `transition` lacks them.
    fn bring_all(&mut self, transition: TransitionId, seen: &mut BTreeSet<PlaceId>) {
        self.state.missing(transition).into_iter().for_each(|place| self.bring(place, seen));
    }

    /// Brings a token to `place`, if only other tokens hold it back at boundaries of nested graphs. Nodes on the way
    /// that pass ⊥ on without running do so.
    fn bring(&mut self, place: PlaceId, seen: &mut BTreeSet<PlaceId>) {
        if self.state.is_marked(place) || !seen.insert(place) {
            return;
        }
        if let Some(before) = self.state.before(place) {
            self.bring(before, seen);
            self.state.advance(place);
            return;
        }
        let sends = |t: &&Transition| matches!(t.kind, TransitionKind::Send(_) | TransitionKind::Release(_));
        let sender = self.net.transitions.iter().filter(sends).find(|t| t.gives.contains(&place));
        match sender.map(|t| t.kind) {
            Some(TransitionKind::Send(node)) => {
                let take = self.by_kind[&TransitionKind::Take(node)];
                self.bring_all(take, seen);
                if self.state.is_enabled(take) && self.is_silent(take) {
                    self.run(take);
                    self.settle();
                }
            }
            // The delays of a loop send once its other tokens are there, or as these are about to come.
            Some(release @ TransitionKind::Release(node)) => {
                let release = self.by_kind[&release];
                self.bring_all(release, seen);
                if self.is_due(node) {
                    self.state.lend(release);
                }
                self.release(release);
            }
            _ => {}
        }
    }

    /// Lets the delays of a loop send, if they can.
    fn release(&mut self, transition: TransitionId) {
        let TransitionKind::Release(node) = self.net.transitions[transition].kind else { return };
        if self.state.is_enabled(transition) && self.is_due(node) {
            self.run(transition);
            self.settle();
        }
    }

    /// Nodes that could fire without running, but are deferred because they take activity or have slots.
    fn deferred(&self) -> Vec<(NodeId, Preview)> {
        let nodes = self.graph.nodes.ids();
        nodes
            .filter(|n| self.by_kind.get(&TransitionKind::Take(*n)).is_some_and(|t| self.state.is_enabled(*t)))
            .map(|n| (n, self.state.preview(n)))
            .filter(|(n, p)| !p.reported && (p.modifies || self.hesitates(*n)))
            .collect()
    }

    /// A deferred transition with which `node` becomes active or inactive, or else one on which that waits and which
    /// changes no activity.
    fn deferred_for(&self, node: NodeId, active: bool) -> Option<TransitionId> {
        let take = self.by_kind.get(&TransitionKind::Take(node)).copied()?;
        let (turning, remaining): (Vec<_>, Vec<_>) =
            self.deferred().into_iter().partition(|(n, p)| p.active != self.state.is_active(*n));
        if turning.iter().any(|(n, p)| *n == node && p.active == active) {
            return Some(take);
        }
        let before = self.before(take);
        remaining.iter().map(|(n, _)| self.by_kind[&TransitionKind::Take(*n)]).find(|take| before.contains(take))
    }

    /// Executes everything that is deferred: delays on loops send, then nodes take ⊥.
    fn flush_deferred(&mut self) {
        self.release_all();
        while self.take_deferred(None) {}
    }

    /// Executes deferred transitions until `transition` is enabled. Those of its own node come last, because they may
    /// need the places that `transition` occupies.
    fn flush_for(&mut self, transition: TransitionId) {
        let own = match self.net.transitions[transition].kind {
            TransitionKind::Handle(connection) => Some(self.graph.connections[connection].to.node),
            _ => None,
        };
        self.release_all();
        self.bring_all(transition, &mut BTreeSet::new());
        while !self.state.is_enabled(transition) && self.take_deferred(own) {
            self.bring_all(transition, &mut BTreeSet::new());
        }
    }

    fn release_all(&mut self) {
        self.net.transitions.ids().for_each(|transition| self.release(transition));
    }

    /// Lets one deferred node take its tokens: `last` only if there is no other, and nodes whose activity does not
    /// change first. Returns `false` if nothing is deferred.
    fn take_deferred(&mut self, last: Option<NodeId>) -> bool {
        let deferred = self.deferred();
        let rank =
            |(node, preview): &&(NodeId, Preview)| (Some(*node) == last, preview.active != self.state.is_active(*node));
        let Some((node, _)) = deferred.iter().min_by_key(rank) else { return false };
        self.run(self.by_kind[&TransitionKind::Take(*node)]);
        self.settle();
        true
    }

    /// Executes a transition, and records its effects on sources, agenda and activity.
    fn run(&mut self, transition: TransitionId) {
        if let TransitionKind::Take(node) | TransitionKind::Release(node) = self.net.transitions[transition].kind
            && let Some((count, fired)) = self.sources.get_mut(&node)
        {
            let modifiers = &self.graph.nodes[node].modifiers;
            let passed = self.now.checked_sub(modifiers.after.unwrap_or_default());
            // A late source makes up for what it has missed, or not.
            *count = match (modifiers.every, passed) {
                (Some(period), Some(passed)) if modifiers.skip => (passed.as_nanos() / period.as_nanos()) as u32 + 1,
                _ => *count + 1,
            };
            *fired = true;
        }
        self.state.occur(transition);
        self.agenda.extend(self.state.behind(transition));
        self.expect_changes(false);
    }

    /// Executes unrecorded transitions until none of them is enabled.
    fn settle(&mut self) {
        loop {
            while let Some(transition) = self.agenda.pop_first() {
                while self.is_silent(transition) && self.state.is_enabled(transition) {
                    self.run(transition);
                }
            }
            // Tokens that follow early ones may enable further transitions.
            for passed in self.state.follow() {
                self.agenda.extend(self.state.behind(passed));
            }
            if self.agenda.is_empty() {
                return;
            }
        }
    }

    /// Lets the tokens follow that have to, by deferred transitions and timeouts.
    fn pay_debts(&mut self, what: &str) -> Result<(), Wrong> {
        while let Err(wrong) = self.check_debts(what) {
            if !self.take_deferred(None) && !self.time_out(|_| true) {
                return Err(wrong);
            }
        }
        Ok(())
    }

    /// Reports tokens that have crossed a boundary of a nested graph, or left the delays of a loop, without the others:
    /// they belong to the same firing.
    fn check_debts(&self, what: &str) -> Result<(), Wrong> {
        if let Some(side) = self.state.owes() {
            let side = side_name(self.graph, side);
            return Err(self.wrong(what, format!("only some of the tokens have passed the boundary `{side}`")));
        }
        match self.state.borrowed() {
            Some(place) => Err(self.wrong(what, format!("delays have sent before `{}`", self.net.places[place].name))),
            None => Ok(()),
        }
    }

    fn is_silent(&self, transition: TransitionId) -> bool {
        match self.net.transitions[transition].kind {
            TransitionKind::Take(node) => {
                let preview = self.state.preview(node);
                // Relays have no activity, so that they pass activity on without a record.
                let waits = preview.modifies && !self.state.is_agnostic(node);
                !preview.reported && !waits && !self.hesitates(node) && self.is_due(node)
            }
            TransitionKind::Release(node) => !self.hesitates(node) && self.is_due(node),
            TransitionKind::Handle(_) | TransitionKind::TimeOut(_) => false,
            _ => true,
        }
    }

    fn expect_changes(&mut self, optional: bool) {
        for (node, active) in self.state.take_changes() {
            self.expected.add(node, Change { active, step: self.step, optional });
        }
    }

    /// Drops initial activity that was not recorded. With several thread groups it is kept, because each group begins
    /// on its own.
    fn forget_optional(&mut self) {
        if !self.has_groups {
            self.expected.forget_optional();
        }
    }

    /// Reports activity that was recorded too early: it may be recorded just before the call that causes it, but not
    /// earlier.
    fn check_early(&self, what: &str, belongs: impl Fn(NodeId) -> bool) -> Result<(), Wrong> {
        match self.bypass.iter().find(|(n, _)| !belongs(*n)) {
            Some((node, active)) => {
                let word = if *active { "active" } else { "inactive" };
                Err(self.wrong(what, format!("`{}` was recorded to become {word}, but did not", self.name(*node))))
            }
            None => Ok(()),
        }
    }

    fn match_early(&mut self, what: &str) -> Result<(), Wrong> {
        for (node, active) in std::mem::take(&mut self.bypass) {
            if !self.expected.takes(node, active) {
                self.bypass = vec![(node, active)];
                return self.check_early(what, |_| false);
            }
        }
        Ok(())
    }
}

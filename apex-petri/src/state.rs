//! A net with coloured tokens: each token has an origin, is a value or ⊥, and has an effect on activity.

use super::{
    Net, PlaceId, TransitionId, TransitionKind,
    build::has_process,
    bypass::Bypass,
    clocks::{self, Clocks},
    lent::Lent,
    route::{self, SegmentEnd, Side},
    token::{Marking, Origin, Token},
    token_on,
};
use apex_dsl::{
    catalog::Catalog,
    graph::{Connection, ConnectionId, Flow, Graph, NodeId, NodeKind, PortId, Standard, Subject},
    index::IdVec,
    syntax::tree::PortKind,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

/// A call of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Call {
    /// The node.
    pub node: NodeId,
    /// Number of previous calls of `process` and slots of the node.
    pub nth: usize,
    /// The port of the slot; `None` is `process`.
    pub slot: Option<usize>,
}

/// Behaviour of the nodes: returns `true` if a call sends a value at a port, or triggers the event there.
pub type Script<'a> = dyn Fn(Call, usize) -> bool + 'a;

/// Tokens that a call has taken.
#[derive(Debug, Clone, Default)]
struct Taken {
    slot: Option<usize>,
    runs: bool,
    /// Tokens by port.
    tokens: BTreeMap<usize, Token>,
}

/// Effects of a firing that has not occurred yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preview {
    /// `true` if `process` will run: no mandatory input holds ⊥.
    pub runs: bool,
    /// `true` if a program reports the firing: `process` runs, or the node handles ⊥.
    pub reported: bool,
    /// Activity of the node after the firing.
    pub active: bool,
    /// `true` if some token carries a modifier.
    pub modifies: bool,
}

/// A coloured marking of a net.
#[derive(Clone)]
pub struct State<'a> {
    graph: &'a Graph,
    net: &'a Net,
    script: &'a Script<'a>,
    marking: Marking,
    active: IdVec<NodeId, bool>,
    calls: IdVec<NodeId, usize>,
    taken: BTreeMap<NodeId, Taken>,
    /// Decisions of undecided ports: `None` for silence, else a token for each leg.
    decided: BTreeMap<PortId, Option<BTreeMap<PlaceId, Token>>>,
    changes: Vec<(NodeId, bool)>,
    /// For each node that interrupts, those from which its last `cancel` took activity.
    remembered: BTreeMap<NodeId, BTreeSet<NodeId>>,
    told: IdVec<NodeId, bool>,
    deactivates: IdVec<NodeId, bool>,
    into: BTreeMap<SegmentEnd, Vec<Link>>,
    from: BTreeMap<SegmentEnd, Vec<Link>>,
    consumers: IdVec<PlaceId, Vec<TransitionId>>,
    /// Nodes without connected inputs, and the first delays of loops without entries.
    sources: BTreeSet<NodeId>,
    /// The delays of each loop, by the first one.
    loops: BTreeMap<NodeId, Vec<NodeId>>,
    bypass: Bypass,
    lent: Lent,
    clocks: Clocks,
}

/// A leg with its token place.
#[derive(Debug, Clone, Copy)]
struct Link {
    connection: ConnectionId,
    token: PlaceId,
    synchronous: bool,
}

/// A feature of the graph that the coloured net does not support, if there is one.
pub fn unsupported(graph: &Graph) -> Option<String> {
    for (id, node) in graph.nodes.iter_enumerated() {
        if let NodeKind::Boundary(_) = node.kind {
            return Some(format!("`{}` is a port of the program", node.name));
        }
        if node.ports.iter().any(|port| port.comes_with_time) {
            return Some(format!("`{}` leaves states after a time", graph.path(id)));
        }
        for port in &node.ports {
            if port.standard.is_some_and(|s| !matches!(s, Standard::Processed | Standard::Timeout)) {
                return Some(format!("`{}.{}` is used", graph.path(id), port.name));
            }
        }
    }
    None
}

impl<'a> State<'a> {
    /// The initial state of `graph`, whose nodes behave as `script` says. `net` is its net.
    pub fn new(graph: &'a Graph, catalog: &Catalog, net: &'a Net, script: &'a Script<'a>) -> Self {
        let library = |node: NodeId| match &graph.nodes[node].kind {
            NodeKind::Library(library) => Some(&catalog.signatures[library.signature]),
            _ => None,
        };
        let nodes = graph.nodes.ids();
        let (mut into, mut from) = (BTreeMap::<_, Vec<_>>::new(), BTreeMap::<_, Vec<_>>::new());
        let segments = route::segments(graph);
        for (i, segment) in segments.iter().enumerate() {
            let flow = graph.flow(&graph.connections[segment.connection]);
            let link =
                Link { connection: segment.connection, token: token_on(i), synchronous: flow == Flow::Synchronous };
            from.entry(segment.from).or_default().push(link);
            if flow != Flow::ToSlot {
                into.entry(segment.to).or_default().push(link);
            }
        }
        let mut consumers = IdVec::from_elem(vec![], net.places.len());
        for (id, transition) in net.transitions.iter_enumerated() {
            transition.takes.iter().for_each(|p| consumers[*p].push(id));
        }
        let initial = Token { value: true, ..Token::default() };
        let is_source = |n: &NodeId| has_process(graph, catalog, *n) && !into.contains_key(&SegmentEnd::Node(*n));
        let mut sources: BTreeSet<NodeId> = nodes.clone().filter(is_source).collect();
        let loops = route::loops(graph, &segments);
        // A loop without entries iterates on its own. Its first delay stands for it.
        sources.extend(loops.iter().filter(|on_loop| on_loop.entries.is_empty()).map(|on_loop| on_loop.delays[0]));
        Self {
            graph,
            net,
            script,
            marking: net.places.iter().map(|p| std::iter::repeat_n(initial, p.initial).collect()).collect(),
            active: graph.nodes.iter().map(|n| n.starts_active).collect(),
            calls: IdVec::from_elem(0, graph.nodes.len()),
            taken: BTreeMap::new(),
            decided: BTreeMap::new(),
            changes: nodes.clone().filter(|n| graph.nodes[*n].starts_active).map(|n| (n, true)).collect(),
            remembered: BTreeMap::new(),
            told: nodes.clone().map(|n| library(n).is_some_and(|s| s.no_message.is_some())).collect(),
            deactivates: nodes.clone().map(|n| library(n).is_some_and(|s| s.deactivates)).collect(),
            into,
            from,
            consumers,
            clocks: Clocks::new(graph, &sources),
            sources,
            lent: Lent::new(&segments, &loops),
            bypass: Bypass::new(&segments, &loops, net),
            loops: loops.into_iter().map(|on_loop| (on_loop.delays[0], on_loop.delays)).collect(),
        }
    }

    /// The time of a reaction, which may be the end of that of a `timeout`.
    pub fn set_time(&mut self, now: Duration) {
        self.clocks.set(now);
    }

    /// Nodes that fire on their own: nodes without connected inputs, and the first delays of loops without entries.
    pub fn sources(&self) -> &BTreeSet<NodeId> {
        &self.sources
    }

    /// Returns `true` if a node is active.
    pub fn is_active(&self, node: NodeId) -> bool {
        self.active[node]
    }

    /// Changes of activity since the previous call.
    pub fn take_changes(&mut self) -> Vec<(NodeId, bool)> {
        std::mem::take(&mut self.changes)
    }

    /// Transitions that take from the places that `transition` gives to.
    pub fn behind(&self, transition: TransitionId) -> impl Iterator<Item = TransitionId> + '_ {
        self.net.transitions[transition].gives.iter().flat_map(|p| self.consumers[*p].iter().copied())
    }

    /// Returns `true` if there is a token at a place.
    pub fn is_marked(&self, place: PlaceId) -> bool {
        !self.marking[place].is_empty()
    }

    /// The places that lack a token for `transition`.
    pub fn missing(&self, transition: TransitionId) -> Vec<PlaceId> {
        let takes = &self.net.transitions[transition].takes;
        takes.iter().copied().filter(|p| self.marking[*p].is_empty()).collect()
    }

    /// Lets the token that `place` lacks cross a boundary of a nested graph before the others have arrived, if it can.
    pub fn advance(&mut self, place: PlaceId) {
        self.bypass.advance(place, &mut self.marking);
        self.lent.take_back(&mut self.marking);
    }

    /// The place before the boundary, if tokens reach `place` through the boundary of a nested graph.
    pub fn before(&self, place: PlaceId) -> Option<PlaceId> {
        self.bypass.before(place)
    }

    /// Lets the remaining tokens cross boundaries where all of them have arrived. Returns the transitions that this
    /// replaces.
    pub fn follow(&mut self) -> Vec<TransitionId> {
        let passed = self.bypass.follow(&mut self.marking);
        self.lent.take_back(&mut self.marking);
        passed
    }

    /// A boundary that some token crossed early and that others have yet to cross.
    pub fn owes(&self) -> Option<Side> {
        self.bypass.owes()
    }

    /// Lets the delays of a loop send before all tokens that lead into the loop have come, or after events on it have
    /// been triggered, if nothing else holds them back: other nodes may fire first. The tokens have to follow.
    pub fn lend(&mut self, release: TransitionId) {
        let missing = self.missing(release);
        self.lent.lend(missing, &mut self.marking);
    }

    /// A place of a token that delays have used before it came.
    pub fn borrowed(&self) -> Option<PlaceId> {
        self.lent.borrowed()
    }

    /// Returns `true` if `transition` may occur.
    pub fn is_enabled(&self, transition: TransitionId) -> bool {
        let t = &self.net.transitions[transition];
        let decided = |end: PortId| self.decided.get(&end).is_some_and(Option::is_some);
        t.takes.iter().all(|p| !self.marking[*p].is_empty())
            && match t.kind {
                // The call has already decided if the port sends: only one of the two transitions is enabled.
                TransitionKind::Trigger(end) => decided(end),
                TransitionKind::Suppress(end) => !decided(end),
                TransitionKind::TimeOut(node) => self.clocks.is_due(self.graph, node),
                _ => true,
            }
    }

    /// Effects of `node` taking the tokens at its inputs.
    pub fn preview(&self, node: NodeId) -> Preview {
        let mut runs = true;
        let mut modifiers = vec![];
        for link in self.into.get(&SegmentEnd::Node(node)).into_iter().flatten() {
            // A missing token does not matter, because the transition is not enabled then.
            let Some(token) = self.marking[link.token].front() else { continue };
            modifiers.push(token.modifier);
            runs &= token.value || !self.is_mandatory(node, self.graph.connections[link.connection].to.port);
        }
        let is_visible = matches!(self.graph.nodes[node].kind, NodeKind::Library(_) | NodeKind::Each(_));
        Preview {
            runs,
            reported: is_visible && (runs || self.told[node]),
            active: if self.is_agnostic(node) { self.active[node] } else { after(self.active[node], &modifiers) },
            modifies: modifiers.iter().any(|m| *m != 0),
        }
    }

    fn is_mandatory(&self, node: NodeId, port: usize) -> bool {
        match self.graph.nodes[node].kind {
            NodeKind::Library(_) => !self.graph.nodes[node].ports[port].optional,
            NodeKind::Each(_) => true,
            _ => false,
        }
    }

    /// The tokens that the current call of `node` has taken, in the order of its ports.
    pub fn tokens_of(&self, node: NodeId) -> Vec<Token> {
        self.taken.get(&node).map(|t| t.tokens.values().copied().collect()).unwrap_or_default()
    }

    /// Executes an enabled transition.
    pub fn occur(&mut self, transition: TransitionId) {
        let t = &self.net.transitions[transition];
        let mut tokens: BTreeMap<PlaceId, Token> = BTreeMap::new();
        for place in &t.takes {
            if let Some(token) = self.marking[*place].pop_front() {
                tokens.insert(*place, token);
            }
        }
        let colours = match t.kind {
            TransitionKind::Take(node) => self.take(node, &tokens),
            TransitionKind::Send(node) => self.send(node),
            TransitionKind::Trigger(end) => self.decide(end),
            TransitionKind::Suppress(end) => {
                self.decided.remove(&end);
                BTreeMap::new()
            }
            TransitionKind::Handle(connection) => self.handle(connection, &tokens),
            TransitionKind::Handled(node) => self.handled(node),
            TransitionKind::Pass(side) => self.pass(side, &tokens),
            // The first places that it takes from are those where the delays hold tokens.
            TransitionKind::Release(first) => {
                let delays = self.loops.get(&first).cloned().unwrap_or_default();
                let held: Vec<_> =
                    delays.into_iter().zip(&t.takes).filter_map(|(d, p)| Some((d, *tokens.get(p)?))).collect();
                held.into_iter().flat_map(|(delay, oldest)| self.forward(delay, oldest)).collect()
            }
            TransitionKind::Hold(_) => {
                let token = t.takes.first().and_then(|p| tokens.get(p)).copied().unwrap_or_default();
                self.net.held(transition).map(|place| (place, token)).into_iter().collect()
            }
            TransitionKind::Start(node) => self.start(node),
            TransitionKind::TimeOut(node) => self.time_out(node),
            TransitionKind::Notify(_) | TransitionKind::NotifySide(_) | TransitionKind::Return(_) => BTreeMap::new(),
        };
        for place in &t.gives {
            self.marking[*place].push_back(colours.get(place).copied().unwrap_or_default());
        }
        self.lent.take_back(&mut self.marking);
    }

    fn set_active(&mut self, node: NodeId, active: bool) {
        if self.active[node] != active {
            self.active[node] = active;
            self.clocks.turned(node, active);
            self.changes.push((node, active));
        }
    }

    /// Updates the activity of a node (A1): +1 wins over −1.
    fn activate(&mut self, node: NodeId, tokens: &BTreeMap<usize, Token>) {
        let modifiers: Vec<i8> = tokens.values().map(|t| t.modifier).collect();
        self.set_active(node, after(self.active[node], &modifiers));
    }

    /// Returns `true` if a node passes activity on without becoming active.
    pub fn is_agnostic(&self, node: NodeId) -> bool {
        matches!(self.graph.nodes[node].kind, NodeKind::Relay)
    }

    fn take(&mut self, node: NodeId, tokens: &BTreeMap<PlaceId, Token>) -> BTreeMap<PlaceId, Token> {
        let runs = self.preview_taken(node, tokens);
        let mut by_port = BTreeMap::new();
        for link in self.into.get(&SegmentEnd::Node(node)).into_iter().flatten() {
            let token = tokens.get(&link.token).copied().unwrap_or_default();
            by_port.insert(self.graph.connections[link.connection].to.port, token);
        }
        if !self.is_agnostic(node) {
            self.activate(node, &by_port);
        }
        self.taken.insert(node, Taken { slot: None, runs, tokens: by_port });
        BTreeMap::new()
    }

    fn preview_taken(&self, node: NodeId, tokens: &BTreeMap<PlaceId, Token>) -> bool {
        let links = self.into.get(&SegmentEnd::Node(node)).into_iter().flatten();
        links
            .filter(|l| self.is_mandatory(node, self.graph.connections[l.connection].to.port))
            .all(|l| tokens.get(&l.token).is_some_and(|t| t.value))
    }

    fn send(&mut self, node: NodeId) -> BTreeMap<PlaceId, Token> {
        let taken = self.taken.remove(&node).unwrap_or_default();
        match &self.graph.nodes[node].kind {
            NodeKind::Relay => {
                let token = taken.tokens.values().next().copied().unwrap_or_default();
                self.forward(node, token)
            }
            _ => self.emit(node, &taken),
        }
    }

    /// Passes `token` on. Its effect on activity is passed on only over active connections.
    fn forward(&mut self, node: NodeId, token: Token) -> BTreeMap<PlaceId, Token> {
        let mut colours = BTreeMap::new();
        for link in self.from.get(&SegmentEnd::Node(node)).cloned().unwrap_or_default() {
            let c = &self.graph.connections[link.connection];
            let sent = Token { modifier: if c.active { token.modifier } else { 0 }, ..token };
            if link.synchronous {
                colours.insert(link.token, sent);
            } else {
                // ⊥ is silence on an asynchronous connection.
                let decided = self.decided.entry(c.from).or_insert_with(|| token.value.then(BTreeMap::new));
                if let Some(tokens) = decided {
                    tokens.insert(link.token, sent);
                }
            }
        }
        colours
    }

    /// Tokens that a call sends, port by port. The first value on a port with an active connection takes the activity
    /// along.
    fn emit(&mut self, node: NodeId, taken: &Taken) -> BTreeMap<PlaceId, Token> {
        let call = Call { node, nth: self.calls[node], slot: taken.slot };
        if taken.runs {
            self.calls[node] += 1;
        }
        let links = self.from.get(&SegmentEnd::Node(node)).cloned().unwrap_or_default();
        let mut colours = BTreeMap::new();
        for (port, p) in self.graph.nodes[node].ports.iter().enumerate() {
            // A slot sends only events.
            if !p.kind.sends() || (taken.slot.is_some() && p.kind != PortKind::Event) {
                continue;
            }
            let end = PortId { node, port };
            let links: Vec<Link> =
                links.iter().copied().filter(|l| self.graph.connections[l.connection].from == end).collect();
            let interrupts = self.graph.nodes[node].interrupts().is_some();
            let value = taken.runs && (interrupts || self.sends(call, port));
            if value && !links.is_empty() && taken.slot.is_none() && p.standard.is_none() {
                self.clocks.sent(node);
            }
            let has_active = links.iter().any(|l| self.graph.connections[l.connection].active);
            // A node that deactivates others sends −1 with its values. Any other node gives its own activity away.
            let modifier = match value && has_active {
                true if self.deactivates[node] => -1,
                // It passes on what it has just taken.
                true if interrupts => 1,
                true if self.active[node] => {
                    self.set_active(node, false);
                    1
                }
                _ => 0,
            };
            // The token of `cancelled` says nothing.
            let origin = (value && !interrupts).then(|| self.origin(call, end, taken));
            for link in links {
                let active = self.graph.connections[link.connection].active;
                let token = Token { origin: origin.flatten(), value, modifier: if active { modifier } else { 0 } };
                if link.synchronous {
                    colours.insert(link.token, token);
                } else {
                    let decided = self.decided.entry(end).or_insert_with(|| value.then(BTreeMap::new));
                    if let Some(tokens) = decided {
                        tokens.insert(link.token, token);
                    }
                }
            }
        }
        colours
    }

    /// Origin of a sent token. An `each` keeps the origin of its list, whose elements it sends on.
    fn origin(&self, call: Call, end: PortId, taken: &Taken) -> Option<Origin> {
        match &self.graph.nodes[end.node].kind {
            NodeKind::Each(each) => taken.tokens.get(&each.list?).and_then(|t| t.origin),
            _ => Some(Origin { end, call: call.nth }),
        }
    }

    fn sends(&self, call: Call, port: usize) -> bool {
        match self.graph.nodes[call.node].kind {
            NodeKind::Each(_) => true,
            _ => match self.graph.nodes[call.node].ports[port].standard {
                Some(Standard::Processed) => call.slot.is_none(),
                Some(Standard::Timeout) => false,
                _ => (self.script)(call, port),
            },
        }
    }

    /// Tokens of the event `timeout`, with the activity of the node.
    fn time_out(&mut self, node: NodeId) -> BTreeMap<PlaceId, Token> {
        self.clocks.expire(node);
        let port = clocks::port(self.graph, node);
        let links = self.from.get(&SegmentEnd::Node(node)).cloned().unwrap_or_default();
        let connection = |link: &Link| &self.graph.connections[link.connection];
        let links: Vec<Link> = links.into_iter().filter(|link| Some(connection(link).from.port) == port).collect();
        let deactivates = self.deactivates[node];
        let passes = self.active[node] && !deactivates && links.iter().any(|link| connection(link).active);
        let effect = if deactivates { -1 } else { i8::from(passes) };
        let token = |link: &Link| {
            let modifier = if connection(link).active { effect } else { 0 };
            (link.token, Token { origin: None, value: true, modifier })
        };
        let colours = links.iter().map(token).collect();
        if passes {
            self.set_active(node, false);
        }
        colours
    }

    fn decide(&mut self, end: PortId) -> BTreeMap<PlaceId, Token> {
        self.decided.remove(&end).flatten().unwrap_or_default()
    }

    fn handle(&mut self, connection: ConnectionId, tokens: &BTreeMap<PlaceId, Token>) -> BTreeMap<PlaceId, Token> {
        let Connection { to, given, .. } = &self.graph.connections[connection];
        let to = *to;
        // A connection to a slot consists of a single leg.
        let link = self.from.values().flatten().find(|l| l.connection == connection);
        let mut token = link.and_then(|l| tokens.get(&l.token)).copied().unwrap_or_default();
        if given.is_some() {
            token.origin = Some(Origin::given(self.graph));
        }
        let tokens = BTreeMap::from([(to.port, token)]);
        match self.graph.nodes[to.node].kind {
            NodeKind::Reset => {
                // Nothing is active, not even tokens, and nothing is remembered. Then it starts again.
                self.remembered.clear();
                self.marking.iter_mut().flatten().for_each(|token| token.modifier = token.modifier.min(0));
                self.graph.nodes.ids().for_each(|node| self.set_active(node, false));
                for node in self.graph.nodes.ids().filter(|node| self.graph.nodes[*node].starts_active) {
                    self.set_active(node, true);
                }
            }
            NodeKind::Exit(_) => {}
            NodeKind::Interrupt(subject) => {
                let brought = token.modifier > 0;
                let resumes = Standard::Resume.is_of_interrupt(to.port);
                // Over `=>`, only activity is given back.
                let is_meant = !resumes || !self.graph.connections[connection].active || brought;
                let taken = is_meant && self.interrupt(to, subject, brought);
                self.taken.insert(to.node, Taken { slot: Some(to.port), runs: taken, tokens });
                return BTreeMap::new();
            }
            _ => self.activate(to.node, &tokens),
        }
        self.taken.insert(to.node, Taken { slot: Some(to.port), runs: true, tokens });
        BTreeMap::new()
    }

    /// Takes the activity of nodes and of the tokens on their way to them, or gives it back. Returns `true` if there
    /// was any to take; `brought` is that of the token.
    fn interrupt(&mut self, slot: PortId, subject: Subject, brought: bool) -> bool {
        if Standard::Resume.is_of_interrupt(slot.port) {
            for node in self.remembered.remove(&slot.node).into_iter().flatten() {
                self.set_active(node, true);
            }
            return false;
        }
        let (mut taken, mut remembered) = (brought, BTreeSet::new());
        let nodes: BTreeSet<NodeId> = self.graph.nodes_of(subject).into_iter().collect();
        for &node in &nodes {
            let mut found = self.active[node];
            for place in self.places_before(node).into_iter().chain(self.held_by(node)) {
                for token in self.marking[place].iter_mut().filter(|token| token.modifier > 0) {
                    token.modifier = 0;
                    found = true;
                }
            }
            // The activity in a delay does not come back.
            if found && !self.graph.nodes[node].is_delay() {
                remembered.extend(
                    self.graph.receivers(node).intersection(&nodes).filter(|n| !self.graph.nodes[**n].is_delay()),
                );
                self.set_active(node, false);
            }
            taken |= found;
        }
        if !remembered.is_empty() {
            self.remembered.insert(slot.node, remembered);
        }
        taken
    }

    /// The places of tokens on their way to a node.
    fn places_before(&self, node: NodeId) -> BTreeSet<PlaceId> {
        let links = self.into.values().chain(self.from.values()).flatten();
        links.filter(|link| self.graph.connections[link.connection].to.node == node).map(|link| link.token).collect()
    }

    /// The place where a node holds tokens, if it is a delay.
    fn held_by(&self, node: NodeId) -> Option<PlaceId> {
        self.net.held(self.net.find(TransitionKind::Hold(node))?)
    }

    fn handled(&mut self, node: NodeId) -> BTreeMap<PlaceId, Token> {
        let taken = self.taken.remove(&node).unwrap_or_default();
        self.emit(node, &taken)
    }

    fn pass(&mut self, side: Side, tokens: &BTreeMap<PlaceId, Token>) -> BTreeMap<PlaceId, Token> {
        let stop = SegmentEnd::Side(side);
        let into = self.into.get(&stop).into_iter().flatten();
        let by_connection: BTreeMap<ConnectionId, Token> =
            into.filter_map(|l| Some((l.connection, *tokens.get(&l.token)?))).collect();
        let from = self.from.get(&stop).into_iter().flatten();
        from.filter_map(|l| Some((l.token, *by_connection.get(&l.connection)?))).collect()
    }

    fn start(&mut self, node: NodeId) -> BTreeMap<PlaceId, Token> {
        let links = self.from.get(&SegmentEnd::Node(node)).into_iter().flatten();
        links
            .map(|l| {
                let c = &self.graph.connections[l.connection];
                let origin = Some(Origin { end: c.from, call: 0 });
                (l.token, Token { origin, value: true, modifier: i8::from(c.active) })
            })
            .collect()
    }
}

/// Activity of a node after it has taken tokens with these modifiers.
fn after(active: bool, modifiers: &[i8]) -> bool {
    if modifiers.contains(&1) { true } else { active && !modifiers.contains(&-1) }
}

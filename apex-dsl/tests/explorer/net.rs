//! Places and steps of activity in a checked graph, as the specification has them.
//!
//! The steps come from these sentences of `docs/language.md` (L) and `docs/model.md` (M):
//!
//! 1. "The search ignores time and values: an active node may pass its activity on at any port with a `=>`, at any
//!    time, and a node that takes activity away may do so at any time." (L, claims) So each node may send, or not
//!    send, on each of its ports in each call.
//! 2. "A node takes tokens. If one of them carries activity, the node becomes active. If none does, but one takes
//!    activity away, the node becomes inactive." (M, A1) A firing takes "one from each" input together (M, flow in
//!    step), a slot "is called with each token that comes to it" (M, events and slots).
//! 3. "If an active node sends a value on a port with `=>`, the tokens on these connections carry activity, and the
//!    node becomes inactive. Several `=>` from one port multiply the activity." (M, A2)
//! 4. "It waits only as long as activity waits on a connection that has to be free for that. Tokens are taken at any
//!    time" (L, claims). A node sends an event only while its events are free, and an output only while its outputs
//!    are free, too (M, nothing is lost).
//! 5. "Only special nodes take activity away" (M, A5): the values that they send over `=>` do. They keep their own.
//! 6. "A token to `reset` removes all activity and starts again." (M, A8)
//! 7. "A token to `x.cancel` removes the activity of `x`, or of all nodes in the nested graph `x`, and of the tokens
//!    on their way to them. If there was any, or if the token brought some, `x.cancelled` is triggered and takes it
//!    along." (M, A9) "Otherwise nothing happens." (L)
//! 8. "A token to `x.resume` over `->`, or one with activity over `=>`, gives the nodes activity from which the last
//!    `cancel` with an effect took it, or to which it was on its way. This happens once." (M, A10) "Activity that
//!    waited in a `delay` does not come back." (L) "If nothing was taken, its activity is lost. […] A `cancel` that
//!    finds no activity changes nothing of what comes back" (L).
//! 9. "`exit` is a slot that ends the program" (L): there is no state after it, and no node waits for its token.
//!
//! A token without activity has no place: it may come at any time over each connection, except over `=>` from `start`.

use apex_dsl::{
    catalog::Catalog,
    graph::{Connection, ConnectionId, Graph, Interrupt, NodeId, NodeKind, PortId, Standard, Subject},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Places with activity, and memories of interrupts, one bit each.
pub type State = u128;

/// Step from one state to the next.
#[derive(Debug, Clone, Copy)]
pub enum Step {
    /// An active node passes its activity on at a port.
    Send(PortId),
    /// A slot is called with a token that carries activity.
    Call(ConnectionId),
    /// A node takes its inputs, at least one of which carries activity.
    Fire(NodeId),
    /// A node receives a token that takes activity away.
    Deactivate(NodeId),
    /// `cancel` is called with a token without activity.
    Cancel(NodeId),
    /// `resume` is called with a token without activity.
    Resume(NodeId),
    /// `reset` is called with a token without activity.
    Reset(NodeId),
}

impl Step {
    /// The step in words.
    pub fn words(self, graph: &Graph) -> String {
        match self {
            Self::Send(port) => format!("send {}", graph.end_name(port)),
            Self::Call(connection) => format!("take {}", graph.connection_text(connection)),
            Self::Fire(node) => format!("fire {}", graph.path(node)),
            Self::Deactivate(node) => format!("deactivate {}", graph.path(node)),
            Self::Cancel(node) => format!("cancel {}", graph.path(node)),
            Self::Resume(node) => format!("resume {}", graph.path(node)),
            Self::Reset(node) => graph.path(node),
        }
    }
}

/// Memory of an interrupt: the bit of each node that `resume` may make active.
struct Memory {
    interrupt: Interrupt,
    of: BTreeMap<NodeId, State>,
}

/// Port over which a node passes its activity on.
struct Way {
    port: PortId,
    /// Tokens for which the node waits first.
    waits_for: State,
    /// Tokens that take the activity along.
    passed: State,
}

/// The places of a graph.
pub struct Net<'a> {
    graph: &'a Graph,
    /// Bits of the activity in each node: one, or for a delay one for each token in it, the oldest first.
    nodes: Vec<Vec<State>>,
    connections: Vec<State>,
    memories: Vec<Memory>,
    deactivating: BTreeSet<NodeId>,
    /// For each node, the ports over which its activity leaves.
    ways: Vec<Vec<Way>>,
    /// For each node, the tokens at its inputs.
    inputs: Vec<State>,
    /// Nodes from which others take activity.
    deactivated: BTreeSet<NodeId>,
}

/// Hands out bits while there are some.
struct Bits(u32);

impl Bits {
    fn next(&mut self) -> Option<State> {
        let bit = State::checked_shl(1, self.0);
        self.0 += 1;
        bit
    }

    fn several(&mut self, count: usize) -> Option<Vec<State>> {
        (0..count).map(|_| self.next()).collect()
    }
}

impl<'a> Net<'a> {
    /// The places of `graph`; `None` if there are too many.
    pub fn new(graph: &'a Graph, catalog: &Catalog) -> Option<Self> {
        let mut bits = Bits(0);
        let width = |kind: &NodeKind| if let NodeKind::Delay(initial) = kind { initial.len() } else { 1 };
        let nodes: Option<Vec<_>> = graph.nodes.iter().map(|node| bits.several(width(&node.kind))).collect();
        let connections = bits.several(graph.connections.len())?;
        let memory = |interrupt: Interrupt, bits: &mut Bits| {
            let is_kept = |node: &&NodeId| !graph.nodes[**node].is_delay();
            let of: Option<_> =
                interrupt.takes.iter().filter(is_kept).map(|node| Some((*node, bits.next()?))).collect();
            Some(Memory { of: of?, interrupt })
        };
        let memories: Option<Vec<_>> = graph.interrupts().map(|interrupt| memory(interrupt, &mut bits)).collect();
        let deactivating = graph.nodes.iter_enumerated().filter_map(|(id, node)| match &node.kind {
            NodeKind::Library(library) if catalog.signatures[library.signature].deactivates => Some(id),
            _ => None,
        });
        let mut made = Self {
            graph,
            nodes: nodes?,
            connections,
            memories: memories?,
            deactivating: deactivating.collect(),
            ways: vec![],
            inputs: vec![],
            deactivated: BTreeSet::new(),
        };
        made.ways = graph.nodes.ids().map(|node| made.ways_from(node)).collect();
        let inputs = |node| made.tokens(|c| c.to.node == node && graph.port(c.to).kind != PortKind::Slot);
        made.inputs = graph.nodes.ids().map(inputs).collect();
        let takes_away = graph.connections.iter().filter(|c| c.active && made.deactivating.contains(&c.from.node));
        made.deactivated = takes_away.flat_map(|c| made.receivers(c.to.node)).collect();
        Some(made)
    }

    /// Ports over which the activity of a node leaves.
    fn ways_from(&self, node: NodeId) -> Vec<Way> {
        let way = |number: usize| {
            let id = PortId { node, port: number };
            let port = self.graph.port(id);
            let waits_for = match port.kind {
                PortKind::Event => self.events(node),
                PortKind::Output => self.sent(node),
                _ => return None,
            };
            let passed = self.passed(id);
            // A node is inactive when it says so.
            let is_late = port.standard == Some(Standard::Deactivated);
            (passed != 0 && !is_late).then_some(Way { port: id, waits_for, passed })
        };
        (0..self.graph.nodes[node].ports.len()).filter_map(way).collect()
    }

    /// The state after `start`: tokens on its `=>`, and nodes that are active from the beginning.
    pub fn start(&self) -> State {
        let is_start = |node: NodeId| matches!(self.graph.nodes[node].kind, NodeKind::Start);
        let tokens = self.graph.connections.iter().enumerate().filter(|(_, c)| c.active && is_start(c.from.node));
        let nodes = self.graph.nodes.iter().enumerate().filter(|(_, node)| node.starts_active);
        tokens.map(|(c, _)| self.connections[c]).sum::<State>() + nodes.map(|(n, _)| self.nodes[n][0]).sum::<State>()
    }

    /// The amount of activity in a state.
    pub fn amount(&self, state: State) -> u32 {
        let places = self.nodes.iter().flatten().chain(&self.connections);
        (state & places.sum::<State>()).count_ones()
    }

    /// Places with the activity of a node, or of a nested graph: its nodes, and the tokens "between two of them".
    pub fn activity_of(&self, subject: Subject) -> State {
        let is_in = |node: NodeId| match subject {
            Subject::Node(of) => node == of,
            Subject::Scope(scope) => self.graph.scopes_of(node).contains(&scope),
        };
        let nodes = self.graph.nodes.ids().filter(|node| is_in(*node)).flat_map(|node| &self.nodes[node.index()]);
        let inner = |from, to| matches!(subject, Subject::Scope(_)) && is_in(from) && is_in(to);
        let connections = self.graph.connections.iter().zip(&self.connections);
        let tokens = connections.filter(|(c, _)| inner(c.from.node, c.to.node)).map(|(_, bit)| bit);
        nodes.chain(tokens).sum()
    }

    /// The places with activity in words.
    pub fn words(&self, state: State) -> String {
        let nodes = self.graph.nodes.ids().filter(|node| self.holds(*node) & state != 0);
        let tokens = self.graph.connections.ids().filter(|c| self.connections[c.index()] & state != 0);
        let nodes = nodes.map(|node| self.graph.path(node));
        let kept = self.memories.iter().flat_map(|memory| {
            let kept = memory.of.iter().filter(|(_, bit)| state & **bit != 0);
            kept.map(|(node, _)| {
                format!("({} keeps {})", self.graph.path(memory.interrupt.node), self.graph.path(*node))
            })
        });
        nodes.chain(tokens.map(|c| self.graph.connection_text(c))).chain(kept).collect::<Vec<_>>().join(", ")
    }

    /// All steps from a state that change it, with the states after them.
    pub fn steps(&self, state: State) -> Vec<(Step, State)> {
        let mut found = vec![];
        for node in self.graph.nodes.ids() {
            match self.graph.nodes[node].kind {
                NodeKind::Delay(_) => self.shift(node, state, &mut found),
                NodeKind::Interrupt(_) => self.interrupt(node, state, &mut found),
                NodeKind::Reset => self.reset(node, state, &mut found),
                _ => {
                    self.send(node, state, &mut found);
                    self.call(node, state, &mut found);
                    self.fire(node, state, &mut found);
                    self.deactivate(node, state, &mut found);
                }
            }
        }
        found.retain(|(_, next)| *next != state);
        found
    }

    fn holds(&self, node: NodeId) -> State {
        self.nodes[node.index()].iter().sum()
    }

    /// The connections that `is_meant` accepts.
    fn tokens(&self, is_meant: impl Fn(&Connection) -> bool) -> State {
        let connections = self.graph.connections.iter().zip(&self.connections);
        connections.filter(|(c, _)| is_meant(c)).map(|(_, bit)| bit).sum()
    }

    /// `true` for a connection whose token ends the program.
    fn ends(&self, connection: &Connection) -> bool {
        matches!(self.graph.nodes[connection.to.node].kind, NodeKind::Exit(_))
    }

    /// Tokens of the node's events for which it waits before it sends an event.
    fn events(&self, node: NodeId) -> State {
        let is_event = |c: &Connection| self.graph.port(c.from).kind == PortKind::Event;
        self.tokens(|c| c.from.node == node && is_event(c) && !self.ends(c))
    }

    /// Tokens of the node's events and outputs for which it waits before it fires.
    fn sent(&self, node: NodeId) -> State {
        self.tokens(|c| c.from.node == node && !self.ends(c))
    }

    /// Tokens with which activity leaves the node at a port.
    fn passed(&self, port: PortId) -> State {
        self.tokens(|c| c.active && c.from == port)
    }

    fn send(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        if state & self.holds(node) == 0 || self.deactivating.contains(&node) {
            return;
        }
        let free = self.ways[node.index()].iter().filter(|way| state & way.waits_for == 0);
        found.extend(free.map(|way| (Step::Send(way.port), state & !self.holds(node) | way.passed)));
    }

    fn call(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        for (id, c) in self.graph.connections.iter_enumerated().filter(|(_, c)| c.to.node == node) {
            let bit = self.connections[id.index()];
            let is_slot = self.graph.port(c.to).kind == PortKind::Slot;
            if is_slot && state & bit != 0 && !self.ends(c) {
                found.push((Step::Call(id), state & !bit | self.receives(node)));
            }
        }
    }

    fn fire(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        let taken = state & self.inputs[node.index()];
        if taken != 0 {
            found.push((Step::Fire(node), state & !taken | self.receives(node)));
        }
    }

    /// Activity of the node after it took some. It leaves the program at a port.
    fn receives(&self, node: NodeId) -> State {
        if matches!(self.graph.nodes[node].kind, NodeKind::Boundary(_)) { 0 } else { self.holds(node) }
    }

    fn deactivate(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        if self.deactivated.contains(&node) {
            found.push((Step::Deactivate(node), state & !self.holds(node)));
        }
    }

    /// The nodes to which tokens go on from `node` over `=>`: relays and delays only pass them on.
    fn receivers(&self, node: NodeId) -> BTreeSet<NodeId> {
        let mut found = BTreeSet::from([node]);
        let passes = |node: NodeId| matches!(self.graph.nodes[node].kind, NodeKind::Relay | NodeKind::Delay(_));
        loop {
            let before = found.len();
            let next = self.graph.connections.iter().filter(|c| c.active && passes(c.from.node));
            let next: Vec<NodeId> = next.filter(|c| found.contains(&c.from.node)).map(|c| c.to.node).collect();
            found.extend(next);
            if found.len() == before {
                found.retain(|node| !passes(*node));
                return found;
            }
        }
    }

    /// A delay takes a token, with activity or without, and sends the oldest that it holds.
    fn shift(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        let queue = &self.nodes[node.index()];
        let taken = state & self.tokens(|c| c.to.node == node);
        if state & self.sent(node) != 0 {
            return;
        }
        let mut next = state & !taken & !self.holds(node);
        for pair in queue.windows(2).filter(|pair| state & pair[1] != 0) {
            next |= pair[0];
        }
        if let Some(last) = queue.last().filter(|_| taken != 0) {
            next |= last;
        }
        if queue.first().is_some_and(|first| state & first != 0) {
            next |= self.tokens(|c| c.active && c.from.node == node);
        }
        found.push((Step::Fire(node), next));
    }

    /// `true` if a token without activity may come to a port.
    fn comes_without(&self, to: PortId, active: impl Fn(bool) -> bool) -> bool {
        let is_start = |node: NodeId| matches!(self.graph.nodes[node].kind, NodeKind::Start);
        self.graph.connections.iter().any(|c| c.to == to && active(c.active) && !(c.active && is_start(c.from.node)))
    }

    fn reset(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        if self.comes_without(PortId { node, port: 0 }, |_| true) {
            found.push((Step::Reset(node), self.start()));
        }
        for (id, c) in self.graph.connections.iter_enumerated() {
            if c.to.node == node && state & self.connections[id.index()] != 0 {
                found.push((Step::Call(id), self.start()));
            }
        }
    }

    fn interrupt(&self, node: NodeId, state: State, found: &mut Vec<(Step, State)>) {
        let Some(memory) = self.memories.iter().find(|memory| memory.interrupt.node == node) else { return };
        let is_free = state & self.events(node) == 0;
        let port = |standard: Standard| PortId { node, port: standard.of_interrupt().unwrap_or_default() };
        let (cancel, resume) = (port(Standard::Cancel), port(Standard::Resume));
        if is_free && self.comes_without(cancel, |_| true) {
            found.push((Step::Cancel(node), self.cancel(memory, state, false)));
        }
        if self.comes_without(resume, |active| !active) {
            found.push((Step::Resume(node), self.resume(memory, state)));
        }
        for (id, c) in self.graph.connections.iter_enumerated().filter(|(_, c)| c.to.node == node) {
            let bit = self.connections[id.index()];
            if state & bit != 0 && (is_free || c.to == resume) {
                let rest = state & !bit;
                let next = if c.to == cancel { self.cancel(memory, rest, true) } else { self.resume(memory, rest) };
                found.push((Step::Call(id), next));
            }
        }
    }

    /// The state after `cancel`, whose token brought activity or not.
    fn cancel(&self, memory: &Memory, state: State, brought: bool) -> State {
        let mut taken = 0;
        let mut kept = 0;
        for node in &memory.interrupt.takes {
            let tokens = self.tokens(|c| c.to.node == *node);
            taken |= state & (self.holds(*node) | tokens);
            // Activity in a relay, which is not in the source file, is on its way to the nodes behind it.
            if state & (self.holds(*node) | tokens) != 0 {
                let nodes = self.graph.receivers(*node);
                kept |= nodes.iter().filter_map(|node| memory.of.get(node)).fold(0, |all, bit| all | bit);
            }
        }
        let state = match (taken, brought) {
            (0, false) => return state,
            (0, true) => state,
            _ => self.forget(memory, state & !taken) | kept,
        };
        let port = Standard::Cancelled.of_interrupt().unwrap_or_default();
        let passed = self.passed(PortId { node: memory.interrupt.node, port });
        state | passed
    }

    /// The state after `resume`.
    fn resume(&self, memory: &Memory, state: State) -> State {
        let given = memory.of.iter().filter(|(_, bit)| state & **bit != 0).map(|(node, _)| self.holds(*node));
        self.forget(memory, state) | given.fold(0, |all, one| all | one)
    }

    fn forget(&self, memory: &Memory, state: State) -> State {
        state & !memory.of.values().sum::<State>()
    }
}

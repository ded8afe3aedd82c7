//! Model of the activity of a graph, without the conditions on which anything happens: the places of activity, and its
//! possible moves. Every run of the program is a run of this model.

use crate::{
    analyse::{active_nodes, takes_activity},
    catalog::Catalog,
    graph::{self, Connection, ConnectionId, Graph, NodeId, NodeKind, PortId, Standard, Subject},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Number of a place in [`Model::places`].
pub type PlaceId = u32;
/// Distribution of activity: active places in ascending order.
pub type State = Vec<PlaceId>;

/// A place that can hold activity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A node: it is active.
    Node(NodeId),
    /// A delay: it holds a token that carries activity, behind so many others.
    Delayed(NodeId, usize),
    /// A connection, by number: it holds a token that carries activity.
    Connection(ConnectionId),
    /// `cancel` has taken activity from the second node, and the first one can give it back. It is not active.
    Remembered(NodeId, NodeId),
}

/// A `cancel` of a node or nested graph.
#[derive(Debug)]
pub struct Interrupt {
    /// The node that stands for it.
    pub node: NodeId,
    /// The node or nested graph from which it takes activity.
    pub subject: Subject,
    /// Places from which it takes activity: nodes, and connections to them.
    takes: Vec<PlaceId>,
    /// For each place from which it takes activity, the places that remember it. Empty without `resume`.
    remembers: BTreeMap<PlaceId, Vec<PlaceId>>,
    /// For each place that remembers, the node that becomes active again.
    gives: BTreeMap<PlaceId, PlaceId>,
    /// The active connections of `cancelled`.
    sends: Vec<PlaceId>,
    /// Those that must be free of activity first.
    waits_for: Vec<PlaceId>,
}

/// A port over which a node passes its activity on.
#[derive(Debug)]
pub struct Emission {
    /// The port.
    pub from: PortId,
    /// Its active connections.
    pub to: Vec<PlaceId>,
    /// Connections that must be free of activity first.
    pub waits_for: Vec<PlaceId>,
}

/// A delay, which keeps activity with its token.
#[derive(Debug)]
pub struct Delay {
    /// The node.
    pub node: NodeId,
    /// The connection into it, if that can carry activity.
    comes: Option<PlaceId>,
    /// The places in it, in the order in which it sends them.
    held: Vec<PlaceId>,
    /// Its active connections.
    pub sends: Vec<PlaceId>,
    /// Those that must be free of activity first.
    waits_for: Vec<PlaceId>,
}

/// Effect of activity that arrives at the end of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    /// The node becomes active.
    Node(PlaceId),
    /// It arrives at a delay, which takes it when it sends another token.
    Waits,
    /// The activity leaves the program through a port.
    Leaves,
    /// The program ends.
    Ends,
    /// The program returns to its initial state.
    Restarts,
    /// It arrives at a `cancel`, by its number in [`Model::interrupts`].
    Cancels(usize),
    /// It arrives at a `resume`.
    Resumes(usize),
}

/// A step of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Move {
    /// `start`
    Start,
    /// The node at this place passes its activity on over its emission of this number.
    Emit(PlaceId, usize),
    /// The token at this place is taken.
    Take(PlaceId),
    /// The connection with this number takes away the activity at this place.
    Away(ConnectionId, PlaceId),
    /// A token without activity arrives at a `cancel`.
    Cancel(usize),
    /// A token without activity arrives at a `resume`.
    Resume(usize),
    /// The delay of this number in [`Model::delays`] takes a token and sends another.
    Shift(usize),
}

/// Places and moves of the activity of a graph.
#[derive(Debug)]
pub struct Model {
    /// All places: the nodes, then the connections.
    pub places: Vec<Place>,
    /// State after `start`.
    pub initial: State,
    /// Amount of activity that `start` gave.
    pub given: usize,
    /// Emissions of each place; none for connections.
    pub emissions: Vec<Vec<Emission>>,
    /// Effect of activity at the end of each connection; `None` for nodes.
    pub arrivals: Vec<Option<Arrival>>,
    /// For each connection to an input, those to the other inputs of the node, whose tokens are taken with it.
    pub together: Vec<Vec<PlaceId>>,
    /// Delays that activity can reach.
    pub delays: Vec<Delay>,
    /// Connections that can take activity away from each place.
    pub removers: Vec<Vec<ConnectionId>>,
    /// Interrupts of the graph.
    pub interrupts: Vec<Interrupt>,
    /// Those to whose `cancel` a token without activity may come.
    cancels: Vec<usize>,
    /// Those to whose `resume` a token without activity may come.
    resumes: Vec<usize>,
}

impl Model {
    /// The model of `graph`.
    pub fn new(graph: &Graph, catalog: &Catalog) -> Self {
        let reached = active_nodes(graph);
        let mut places: Vec<Place> = reached.iter().flat_map(|node| places_of(graph, *node)).collect();
        let carries = |end: PortId| match graph.nodes[end.node].kind {
            NodeKind::Start => true,
            _ => reached.contains(&end.node) && gives_away(graph, catalog, end),
        };
        let connections = graph.connections.iter_enumerated();
        places.extend(connections.filter(|(_, c)| c.active && carries(c.from)).map(|(i, _)| Place::Connection(i)));
        let interrupts: Vec<graph::Interrupt> = graph.interrupts().collect();
        for interrupt in interrupts.iter().filter(|interrupt| is_called(graph, interrupt.node, Standard::Resume)) {
            let remembered = interrupt.takes.iter();
            let remembered = remembered.filter(|node| reached.contains(*node) && !graph.nodes[**node].is_delay());
            places.extend(remembered.map(|node| Place::Remembered(interrupt.node, *node)));
        }
        let number: BTreeMap<Place, PlaceId> = (0..).zip(&places).map(|(i, p)| (*p, i)).collect();
        let interrupts: Vec<Interrupt> =
            interrupts.iter().map(|interrupt| Interrupt::new(graph, &places, &number, interrupt)).collect();
        let plain = |standard: Standard| {
            let is_plain = |interrupt: &Interrupt| has_plain(graph, interrupt.node, standard);
            (0..interrupts.len()).filter(|i| is_plain(&interrupts[*i])).collect()
        };
        let delays = reached.iter().filter(|node| graph.nodes[**node].is_delay());
        let delays = delays.map(|node| Delay::new(graph, &places, *node)).collect();
        let (cancels, resumes) = (plain(Standard::Cancel), plain(Standard::Resume));
        let mut model = Self {
            initial: vec![],
            given: 0,
            emissions: places.iter().map(|_| vec![]).collect(),
            arrivals: vec![None; places.len()],
            together: vec![vec![]; places.len()],
            delays,
            removers: vec![vec![]; places.len()],
            places,
            interrupts,
            cancels,
            resumes,
        };
        for index in 0..model.places.len() {
            match model.places[index] {
                Place::Node(node) if graph.nodes[node].starts_active => model.initial.push(index as PlaceId),
                Place::Node(_) | Place::Delayed(..) | Place::Remembered(..) => {}
                Place::Connection(c) => model.add_connection(graph, &number, index, c),
            }
        }
        model.given = model.initial.len();
        model.add_waits(graph);
        model.add_together(graph);
        model.add_removers(graph, catalog, &number);
        model
    }

    fn add_connection(
        &mut self,
        graph: &Graph,
        number: &BTreeMap<Place, PlaceId>,
        index: usize,
        connection: ConnectionId,
    ) {
        let c = &graph.connections[connection];
        let interrupt = self.interrupts.iter().position(|interrupt| interrupt.node == c.to.node);
        let resumes = Standard::Resume.is_of_interrupt(c.to.port);
        let node = number.get(&Place::Node(c.to.node));
        self.arrivals[index] = Some(match (interrupt, &graph.nodes[c.to.node].kind, node) {
            (Some(interrupt), ..) if resumes => Arrival::Resumes(interrupt),
            (Some(interrupt), ..) => Arrival::Cancels(interrupt),
            (_, _, Some(node)) => Arrival::Node(*node),
            (_, NodeKind::Delay(_), _) => Arrival::Waits,
            (_, NodeKind::Exit(_), _) => Arrival::Ends,
            (_, NodeKind::Reset, _) => Arrival::Restarts,
            _ => Arrival::Leaves,
        });
        let place = index as PlaceId;
        // `cancel` sends at once what it takes, and a delay what it holds.
        if graph.nodes[c.from.node].interrupts().is_some() || graph.nodes[c.from.node].is_delay() {
            return;
        }
        let Some(from) = number.get(&Place::Node(c.from.node)) else {
            self.initial.push(place);
            return;
        };
        let emissions = &mut self.emissions[*from as usize];
        match emissions.iter_mut().find(|e| e.from == c.from) {
            Some(emission) => emission.to.push(place),
            None => emissions.push(Emission { from: c.from, to: vec![place], waits_for: vec![] }),
        }
    }

    /// Adds the connections that must be free before an emission: a node fires only if all its connections are free,
    /// and a slot is served only if all connections from events are (R1, R5).
    fn add_waits(&mut self, graph: &Graph) {
        for emissions in &mut self.emissions {
            let kind = |end: PortId| graph.port(end).kind;
            let all: Vec<(PortKind, Vec<PlaceId>)> = emissions.iter().map(|e| (kind(e.from), e.to.clone())).collect();
            for emission in emissions {
                let own = kind(emission.from);
                let held = all.iter().filter(|(k, _)| own == PortKind::Output || *k == PortKind::Event);
                let held = held.flat_map(|(_, to)| to).copied();
                emission.waits_for = without_exits(graph, &self.places, held);
            }
        }
    }

    /// Joins the inputs of each node: a firing takes one token from each (R2).
    fn add_together(&mut self, graph: &Graph) {
        let mut inputs: BTreeMap<NodeId, Vec<PlaceId>> = BTreeMap::new();
        for (place, what) in (0..).zip(&self.places) {
            if let Place::Connection(c) = *what
                && graph.port(graph.connections[c].to).kind != PortKind::Slot
            {
                inputs.entry(graph.connections[c].to.node).or_default().push(place);
            }
        }
        for places in inputs.values() {
            for place in places {
                self.together[*place as usize] = places.iter().copied().filter(|other| other != place).collect();
            }
        }
    }

    fn add_removers(&mut self, graph: &Graph, catalog: &Catalog, number: &BTreeMap<Place, PlaceId>) {
        for (index, c) in graph.connections.iter_enumerated().filter(|(_, c)| c.active) {
            let passes_on = matches!(graph.nodes[c.from.node].kind, NodeKind::Relay);
            if takes_activity(graph, catalog, c.from.node) && can_fire(graph, catalog, c.from.node) && !passes_on {
                let places = behind(graph, c.to.node).into_iter().filter_map(|node| number.get(&Place::Node(node)));
                places.for_each(|place| self.removers[*place as usize].push(index));
            }
        }
    }

    /// Calls `each` with all moves from a state, and the states that they lead to.
    pub fn moves(&self, state: &State, each: &mut dyn FnMut(Move, State)) {
        let without = |place: PlaceId| state.iter().copied().filter(move |p| *p != place);
        for &place in state {
            match self.arrivals[place as usize] {
                Some(Arrival::Node(node)) => {
                    let rest = without(place).filter(|other| !self.together[place as usize].contains(other));
                    each(Move::Take(place), with(rest, &[node]));
                }
                Some(Arrival::Leaves) => each(Move::Take(place), without(place).collect()),
                Some(Arrival::Restarts) => each(Move::Take(place), self.initial.clone()),
                Some(Arrival::Cancels(number)) => {
                    let before: State = without(place).collect();
                    if let Some(after) = self.interrupts[number].cancel(&before, true) {
                        each(Move::Take(place), after);
                    }
                }
                Some(Arrival::Resumes(number)) => {
                    each(Move::Take(place), self.interrupts[number].resume(&without(place).collect()));
                }
                Some(Arrival::Ends | Arrival::Waits) | None => {}
            }
            for (number, emission) in self.emissions[place as usize].iter().enumerate() {
                if !emission.waits_for.iter().any(|p| state.binary_search(p).is_ok()) {
                    each(Move::Emit(place, number), with(without(place), &emission.to));
                }
            }
            for &remover in &self.removers[place as usize] {
                each(Move::Away(remover, place), without(place).collect());
            }
        }
        for (number, delay) in self.delays.iter().enumerate() {
            if let Some(after) = delay.shift(state).filter(|after| after != state) {
                each(Move::Shift(number), after);
            }
        }
        for &number in &self.cancels {
            if let Some(after) = self.interrupts[number].cancel(state, false).filter(|after| after != state) {
                each(Move::Cancel(number), after);
            }
        }
        for &number in &self.resumes {
            let after = self.interrupts[number].resume(state);
            if after != *state {
                each(Move::Resume(number), after);
            }
        }
    }

    /// Returns `true` if there is activity at the place: it is not only remembered.
    pub fn is_active(&self, place: PlaceId) -> bool {
        !matches!(self.places[place as usize], Place::Remembered(..))
    }

    /// Returns `true` if the token of a connection takes activity away where it arrives.
    fn removes(&self, place: PlaceId) -> bool {
        matches!(self.arrivals[place as usize], Some(Arrival::Cancels(_) | Arrival::Restarts))
    }

    /// For each place, `true` if a path leads from it to one of `goals`. Other activity is ignored. With `memory`,
    /// `cancel` and `resume` are taken to find what they need: an end that cannot be reached then can never be reached.
    /// Without, it can be reached in any case.
    pub fn reaching(&self, goals: &[PlaceId], memory: bool) -> Vec<bool> {
        let mut before: Vec<Vec<PlaceId>> = vec![vec![]; self.places.len()];
        let mut restarts = vec![];
        // A node that waits until its token is taken by `cancel` or `reset` may lose its activity to it.
        let is_open = |waits_for: &[PlaceId]| memory || !waits_for.iter().any(|place| self.removes(*place));
        for place in 0..self.places.len() as PlaceId {
            let emissions = self.emissions[place as usize].iter().filter(|e| is_open(&e.waits_for));
            for to in emissions.flat_map(|e| &e.to) {
                before[*to as usize].push(place);
            }
            match self.arrivals[place as usize] {
                Some(Arrival::Node(node)) => before[node as usize].push(place),
                Some(Arrival::Restarts) => restarts.push(place),
                Some(Arrival::Cancels(number)) if is_open(&self.interrupts[number].waits_for) => {
                    self.interrupts[number].sends.iter().for_each(|to| before[*to as usize].push(place));
                }
                Some(Arrival::Resumes(number)) if memory => {
                    self.interrupts[number].gives.values().for_each(|to| before[*to as usize].push(place));
                }
                _ => {}
            }
        }
        for delay in self.delays.iter().filter(|delay| is_open(&delay.waits_for)) {
            delay.sends.iter().for_each(|to| before[*to as usize].extend(delay.held.first()));
            delay.held.windows(2).for_each(|pair| before[pair[0] as usize].push(pair[1]));
            delay.held.last().into_iter().for_each(|last| before[*last as usize].extend(delay.comes));
        }
        for (number, interrupt) in self.interrupts.iter().enumerate() {
            if memory || self.cancels.contains(&number) && is_open(&interrupt.waits_for) {
                for to in &interrupt.sends {
                    before[*to as usize].extend(&interrupt.takes);
                }
            }
            if memory {
                for (from, all) in &interrupt.remembers {
                    all.iter().for_each(|remembered| before[*remembered as usize].push(*from));
                }
                interrupt.gives.iter().for_each(|(remembered, node)| before[*node as usize].push(*remembered));
            }
        }
        for &place in &self.initial {
            before[place as usize].extend(&restarts);
        }
        let mut reaching = vec![false; self.places.len()];
        let mut stack = goals.to_vec();
        while let Some(place) = stack.pop() {
            if !std::mem::replace(&mut reaching[place as usize], true) {
                stack.extend(&before[place as usize]);
            }
        }
        reaching
    }
}

impl Delay {
    fn new(graph: &Graph, places: &[Place], node: NodeId) -> Self {
        let mut made = Self { node, comes: None, held: vec![], sends: vec![], waits_for: vec![] };
        for (place, of) in (0..).zip(places) {
            match *of {
                Place::Delayed(delay, _) if delay == node => made.held.push(place),
                Place::Connection(c) if graph.connections[c].to.node == node => made.comes = Some(place),
                Place::Connection(c) if graph.connections[c].from.node == node => made.sends.push(place),
                _ => {}
            }
        }
        made.waits_for = without_exits(graph, places, made.sends.iter().copied());
        made
    }

    /// All places that it has to do with.
    pub fn places(&self) -> impl Iterator<Item = PlaceId> + '_ {
        self.comes.iter().chain(&self.held).chain(&self.sends).copied()
    }

    /// The state after the delay has taken a token, with activity if there is any, and has sent the oldest one;
    /// `None` while one of its connections is occupied.
    fn shift(&self, state: &State) -> Option<State> {
        let holds = |place: &PlaceId| state.binary_search(place).is_ok();
        if self.waits_for.iter().any(holds) {
            return None;
        }
        let rest = state.iter().copied().filter(|place| !self.held.contains(place) && self.comes != Some(*place));
        let mut more: Vec<PlaceId> = self.held.windows(2).filter(|pair| holds(&pair[1])).map(|pair| pair[0]).collect();
        if self.comes.as_ref().is_some_and(holds) {
            more.extend(self.held.last());
        }
        if self.sends_next(state) {
            more.extend(&self.sends);
        }
        Some(with(rest, &more))
    }

    /// Returns `true` if the next token that it sends carries activity.
    pub fn sends_next(&self, state: &State) -> bool {
        self.held.first().is_some_and(|place| state.binary_search(place).is_ok())
    }
}

impl Interrupt {
    fn new(graph: &Graph, places: &[Place], number: &BTreeMap<Place, PlaceId>, of: &graph::Interrupt) -> Self {
        let (interrupt, subject) = (of.node, of.subject);
        let nodes: BTreeSet<NodeId> = of.takes.iter().copied().collect();
        let mut made = Self {
            node: interrupt,
            subject,
            takes: vec![],
            remembers: BTreeMap::new(),
            gives: BTreeMap::new(),
            sends: vec![],
            waits_for: vec![],
        };
        for (place, of) in (0..).zip(places) {
            let node = match *of {
                Place::Node(node) | Place::Delayed(node, _) => node,
                Place::Connection(c) if graph.connections[c].from.node == interrupt => {
                    made.sends.push(place);
                    continue;
                }
                Place::Connection(c) => graph.connections[c].to.node,
                Place::Remembered(..) => continue,
            };
            if nodes.contains(&node) {
                made.takes.push(place);
                for node in graph.receivers(node).intersection(&nodes) {
                    if let Some(remembered) = number.get(&Place::Remembered(interrupt, *node)) {
                        made.remembers.entry(place).or_default().push(*remembered);
                        made.gives.extend(number.get(&Place::Node(*node)).map(|node| (*remembered, *node)));
                    }
                }
            }
        }
        made.waits_for = without_exits(graph, places, made.sends.iter().copied());
        made
    }

    /// All places that a `cancel` or `resume` has to do with.
    pub fn places(&self) -> impl Iterator<Item = PlaceId> + '_ {
        let remembered = self.gives.iter().flat_map(|(remembered, node)| [*remembered, *node]);
        self.takes.iter().chain(&self.sends).copied().chain(remembered)
    }

    /// The state after a `cancel`; `None` while a connection of `cancelled` is occupied. `brought` is `true` if the
    /// token carried activity itself.
    fn cancel(&self, state: &State, brought: bool) -> Option<State> {
        if self.waits_for.iter().any(|place| state.binary_search(place).is_ok()) {
            return None;
        }
        let taken: Vec<PlaceId> =
            state.iter().copied().filter(|place| self.takes.binary_search(place).is_ok()).collect();
        // Without activity there is nothing to remember instead.
        let forgets = |place: &PlaceId| !taken.is_empty() && self.gives.contains_key(place);
        let rest = state.iter().copied().filter(|place| !taken.contains(place) && !forgets(place));
        let remembered = taken.iter().filter_map(|place| self.remembers.get(place)).flatten().copied();
        let sent: &[PlaceId] = if brought || !taken.is_empty() { &self.sends } else { &[] };
        Some(with(rest.chain(remembered), sent))
    }

    /// The state after a `resume`.
    fn resume(&self, state: &State) -> State {
        let (remembered, rest): (Vec<PlaceId>, Vec<PlaceId>) =
            state.iter().copied().partition(|place| self.gives.contains_key(place));
        let given: Vec<PlaceId> = remembered.iter().map(|place| self.gives[place]).collect();
        with(rest.into_iter(), &given)
    }
}

/// Connections that must be free of activity before a node sends on `sent`. One to an exit need not be free, as the
/// program ends there.
fn without_exits(graph: &Graph, places: &[Place], sent: impl Iterator<Item = PlaceId>) -> Vec<PlaceId> {
    let ends = |place: &PlaceId| match places[*place as usize] {
        Place::Connection(c) => matches!(graph.nodes[graph.connections[c].to.node].kind, NodeKind::Exit(_)),
        _ => false,
    };
    sent.filter(|place| !ends(place)).collect()
}

/// The places in a node.
fn places_of(graph: &Graph, node: NodeId) -> Vec<Place> {
    match &graph.nodes[node].kind {
        NodeKind::Delay(initial) => (0..initial.len()).map(|number| Place::Delayed(node, number)).collect(),
        _ => vec![Place::Node(node)],
    }
}

/// The nodes that receive the tokens that lead to `node` over `=>`: itself, or those behind it if it only passes them
/// on.
fn behind(graph: &Graph, node: NodeId) -> BTreeSet<NodeId> {
    let (mut found, mut open, mut seen) = (BTreeSet::new(), vec![node], BTreeSet::new());
    while let Some(node) = open.pop() {
        match graph.nodes[node].kind {
            NodeKind::Relay | NodeKind::Delay(_) => {
                let next = graph.connections.iter().filter(|c| c.active && c.from.node == node);
                open.extend(next.map(|c| c.to.node).filter(|node| seen.insert(*node)));
            }
            _ => _ = found.insert(node),
        }
    }
    found
}

/// Returns `true` if a connection leads to a slot of a node that interrupts.
fn is_called(graph: &Graph, interrupt: NodeId, standard: Standard) -> bool {
    calls(graph, interrupt, standard).next().is_some()
}

/// Connections to a slot of a node that interrupts.
fn calls(graph: &Graph, interrupt: NodeId, standard: Standard) -> impl Iterator<Item = &Connection> {
    graph.connections.iter().filter(move |c| c.to.node == interrupt && standard.is_of_interrupt(c.to.port))
}

/// Returns `true` if a token without activity has an effect at a slot of a node that interrupts. Over `=>`, `resume`
/// needs activity, and `start` always brings some.
fn has_plain(graph: &Graph, interrupt: NodeId, standard: Standard) -> bool {
    let is_start = |c: &Connection| matches!(graph.nodes[c.from.node].kind, NodeKind::Start);
    let needs_activity = |c: &Connection| c.active && (standard == Standard::Resume || is_start(c));
    calls(graph, interrupt, standard).any(|c| !needs_activity(c))
}

fn with(state: impl Iterator<Item = PlaceId>, more: &[PlaceId]) -> State {
    let mut state: State = state.chain(more.iter().copied()).collect();
    state.sort_unstable();
    state.dedup();
    state
}

/// Returns `true` if activity can leave a node through a port. `deactivated` is sent only after it has left.
fn gives_away(graph: &Graph, catalog: &Catalog, from: PortId) -> bool {
    graph.port(from).standard != Some(Standard::Deactivated) && !takes_activity(graph, catalog, from.node)
}

/// Returns `true` if a node can ever send: it is a source, or a connection leads to it.
fn can_fire(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    let NodeKind::Library(library) = &graph.nodes[node].kind else { return true };
    catalog.signatures[library.signature].process.is_some() || graph.connections.iter().any(|c| c.to.node == node)
}

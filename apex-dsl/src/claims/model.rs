//! Model of the activity of a graph, without the conditions on which anything happens: the places of activity, and its
//! possible moves. Every run of the program is a run of this model.

use crate::{
    analyse::{active_nodes, takes_activity},
    catalog::Catalog,
    graph::{ConnectionId, Graph, NodeId, NodeKind, PortId, Standard},
    syntax::tree::PortKind,
};
use std::collections::BTreeMap;

/// Number of a place in [`Model::places`].
pub type PlaceId = u32;
/// Distribution of activity: active places in ascending order.
pub type State = Vec<PlaceId>;

/// A place that can hold activity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// A node: it is active.
    Node(NodeId),
    /// A connection, by number: it holds a token that carries activity.
    Connection(ConnectionId),
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

/// Effect of activity that arrives at the end of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrival {
    /// The node becomes active.
    Node(PlaceId),
    /// The activity leaves the program through a port.
    Leaves,
    /// The program ends.
    Ends,
    /// The program returns to its initial state.
    Restarts,
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
    /// Connections that can take activity away from each place.
    pub removers: Vec<Vec<ConnectionId>>,
}

impl Model {
    /// The model of `graph`.
    pub fn new(graph: &Graph, catalog: &Catalog) -> Self {
        let reached = active_nodes(graph);
        let mut places: Vec<Place> = reached.iter().map(|n| Place::Node(*n)).collect();
        let carries = |end: PortId| match graph.nodes[end.node].kind {
            NodeKind::Start => true,
            _ => reached.contains(&end.node) && gives_away(graph, catalog, end),
        };
        let connections = graph.connections.iter_enumerated();
        places.extend(connections.filter(|(_, c)| c.active && carries(c.from)).map(|(i, _)| Place::Connection(i)));
        let number: BTreeMap<Place, PlaceId> = (0..).zip(&places).map(|(i, p)| (*p, i)).collect();
        let mut model = Self {
            initial: vec![],
            given: 0,
            emissions: places.iter().map(|_| vec![]).collect(),
            arrivals: vec![None; places.len()],
            removers: vec![vec![]; places.len()],
            places,
        };
        for index in 0..model.places.len() {
            match model.places[index] {
                Place::Node(node) if graph.nodes[node].starts_active => model.initial.push(index as PlaceId),
                Place::Node(_) => {}
                Place::Connection(c) => model.add_connection(graph, &number, index, c),
            }
        }
        model.given = model.initial.len();
        model.add_waits(graph);
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
        self.arrivals[index] = Some(match (&graph.nodes[c.to.node].kind, number.get(&Place::Node(c.to.node))) {
            (_, Some(node)) => Arrival::Node(*node),
            (NodeKind::Exit(_), _) => Arrival::Ends,
            (NodeKind::Reset, _) => Arrival::Restarts,
            _ => Arrival::Leaves,
        });
        let place = index as PlaceId;
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
                // A connection to an exit need not be free, as the program ends there.
                let waits = held.flat_map(|(_, to)| to).filter(|p| self.arrivals[**p as usize] != Some(Arrival::Ends));
                emission.waits_for = waits.copied().collect();
            }
        }
    }

    fn add_removers(&mut self, graph: &Graph, catalog: &Catalog, number: &BTreeMap<Place, PlaceId>) {
        for (index, c) in graph.connections.iter_enumerated().filter(|(_, c)| c.active) {
            if let Some(place) = number.get(&Place::Node(c.to.node))
                && takes_activity(graph, catalog, c.from.node)
                && can_fire(graph, catalog, c.from.node)
            {
                self.removers[*place as usize].push(index);
            }
        }
    }

    /// Calls `each` with all moves from a state, and the states that they lead to.
    pub fn moves(&self, state: &State, each: &mut dyn FnMut(Move, State)) {
        let without = |place: PlaceId| state.iter().copied().filter(move |p| *p != place);
        for &place in state {
            match self.arrivals[place as usize] {
                Some(Arrival::Node(node)) => each(Move::Take(place), with(without(place), &[node])),
                Some(Arrival::Leaves) => each(Move::Take(place), without(place).collect()),
                Some(Arrival::Restarts) => each(Move::Take(place), self.initial.clone()),
                Some(Arrival::Ends) | None => {}
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
    }

    /// For each place, `true` if a path leads from it to one of `goals`. Other activity is ignored.
    pub fn reaching(&self, goals: &[PlaceId]) -> Vec<bool> {
        let mut before: Vec<Vec<PlaceId>> = vec![vec![]; self.places.len()];
        let mut restarts = vec![];
        for place in 0..self.places.len() as PlaceId {
            for to in self.emissions[place as usize].iter().flat_map(|e| &e.to) {
                before[*to as usize].push(place);
            }
            match self.arrivals[place as usize] {
                Some(Arrival::Node(node)) => before[node as usize].push(place),
                Some(Arrival::Restarts) => restarts.push(place),
                _ => {}
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

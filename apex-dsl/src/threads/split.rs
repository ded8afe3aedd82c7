//! Splits a graph into one graph per thread group.

use super::{Cell, Origin, Part, Split, pace::paced};
use crate::{
    analyse::{self, Analysis},
    catalog::Catalog,
    graph::{
        CellEnd, Connection, ConnectionId, Crossing, Graph, Modifiers, Node, NodeId, NodeKind, Port, PortId, ScopeId,
        Subject,
    },
    index::IdVec,
    report::Diagnostics,
    syntax::tree::PortKind,
};
use std::collections::BTreeMap;

/// Splits a checked graph; `None` if all its nodes are in one group.
pub fn split(whole: &Graph, analysis: &Analysis, catalog: &Catalog) -> Option<Split> {
    let groups = whole.groups();
    if groups.len() < 2 {
        return None;
    }
    let of_node = |node: NodeId| groups.iter().position(|g| *g == whole.group(node));
    let mut splitter = Splitter {
        whole,
        analysis,
        catalog,
        group_of: whole.nodes.ids().map(of_node).collect(),
        drafts: groups.iter().map(|group| Draft::new(whole, group)).collect(),
        placed: IdVec::from_elem(None, whole.nodes.len()),
        cells: vec![],
        shared: BTreeMap::new(),
        ends: BTreeMap::new(),
    };
    // The connections that share a cell must be known before it is made: they decide if it carries activity and stamps.
    splitter.gather();
    splitter.place_nodes();
    for index in whole.connections.ids() {
        splitter.place_connection(index);
    }
    splitter.pace_sources();
    let Splitter { drafts, cells, .. } = splitter;
    let parts =
        groups.iter().zip(drafts).map(|(group, draft)| draft.analysed(group, catalog)).collect::<Option<_>>()?;
    Some(Split { parts, cells })
}

/// A part under construction.
struct Draft {
    graph: Graph,
    origins: IdVec<NodeId, Origin>,
    connections: IdVec<ConnectionId, Option<ConnectionId>>,
}

impl Draft {
    fn new(whole: &Graph, group: &str) -> Self {
        let graph = Graph {
            // The name of the group is not changed to camel case: `a_b` and `aB` are different groups.
            name: format!("{}On_{group}", whole.name),
            nodes: IdVec::default(),
            connections: IdVec::default(),
            wires: vec![],
            claims: vec![],
            ..whole.clone()
        };
        Self { graph, origins: IdVec::default(), connections: IdVec::default() }
    }

    fn add(&mut self, node: Node, origin: Origin) -> NodeId {
        self.origins.push(origin);
        self.graph.nodes.push(node)
    }

    fn connect(&mut self, connection: Connection, number: Option<ConnectionId>) {
        self.graph.connections.push(connection);
        self.connections.push(number);
    }

    /// Analyses the graph. Its diagnostics are dropped, because those of the whole graph have been reported.
    fn analysed(self, group: &str, catalog: &Catalog) -> Option<Part> {
        let Self { graph, origins, connections } = self;
        let analysis = analyse::analyse(&graph, catalog, &mut Diagnostics::default())?;
        Some(Part { group: group.to_owned(), graph, analysis, origins, connections })
    }
}

/// Key of a cell: the port that sends, the group of the receivers, `true` for synchronous connections, which also
/// transmit ⊥, and the boundaries where the tokens wait for others before. Connections with the same key share the
/// cell. A slot beside an input has a cell of its own: the sender is analysed as a node that sends to a slot.
type Way = (PortId, usize, bool, Vec<Crossing>);

struct Splitter<'a> {
    whole: &'a Graph,
    analysis: &'a Analysis,
    catalog: &'a Catalog,
    /// The group of each node; `None` for the watchdog.
    group_of: IdVec<NodeId, Option<usize>>,
    drafts: Vec<Draft>,
    /// The number of each node in its part, once it has been placed.
    placed: IdVec<NodeId, Option<NodeId>>,
    cells: Vec<Cell>,
    /// The connections that share each cell.
    shared: BTreeMap<Way, Vec<ConnectionId>>,
    /// The receiving end of each cell.
    ends: BTreeMap<Way, NodeId>,
}

/// The boundaries that a connection leaves, which it crosses in the sender's group, and those that it enters, in the
/// receiver's.
fn leaving(c: &Connection) -> (&[Crossing], &[Crossing]) {
    let enters = c.crossings.iter().position(|side| matches!(side, Crossing::Enter(_))).unwrap_or(c.crossings.len());
    c.crossings.split_at(enters)
}

impl Splitter<'_> {
    fn gather(&mut self) {
        for (index, c) in self.whole.connections.iter_enumerated() {
            if let Some(receiver) = self.group_of[c.to.node] {
                self.shared.entry(self.way(c, receiver)).or_default().push(index);
            }
        }
    }

    fn way(&self, c: &Connection, receiver: usize) -> Way {
        let is_synchronous = self.whole.is_synchronous(c);
        let leaving = if is_synchronous { leaving(c).0 } else { &[] };
        (c.from, receiver, is_synchronous, leaving.to_vec())
    }

    fn place_nodes(&mut self) {
        for (id, node) in self.whole.nodes.iter_enumerated() {
            if let Some(group) = self.group_of[id] {
                self.placed[id] = Some(self.drafts[group].add(node.clone(), Origin::Node(id)));
            }
        }
        // Those whose activity a node takes away have other numbers now.
        for (id, node) in self.whole.nodes.iter_enumerated() {
            if let (Some(Subject::Node(of)), Some(group), Some(placed)) =
                (node.interrupts(), self.group_of[id], self.placed[id])
                && let Some(of) = self.placed[of]
            {
                self.drafts[group].graph.nodes[placed].kind = NodeKind::Interrupt(Subject::Node(of));
            }
        }
    }

    /// A port in the part of its node; `None` for the watchdog, which is in no part.
    fn place(&self, end: PortId) -> Option<PortId> {
        Some(PortId { node: self.placed[end.node]?, port: end.port })
    }

    fn place_connection(&mut self, index: ConnectionId) {
        let c = &self.whole.connections[index];
        let (Some(receiver), Some(to)) = (self.group_of[c.to.node], self.place(c.to)) else { return };
        let sender = self.group_of[c.from.node];
        if let Some(from) = self.place(c.from).filter(|_| sender == Some(receiver)) {
            let connection = Connection { from, to, ..c.clone() };
            self.drafts[receiver].connect(connection, Some(index));
            return;
        }
        // The watchdog itself ends the program then.
        let ends = matches!(self.whole.nodes[c.to.node].kind, NodeKind::Exit(_));
        if sender.is_none() && ends {
            return;
        }
        let (leaving, entering) = leaving(c);
        let node = match self.ends.get(&self.way(c, receiver)) {
            Some(node) => *node,
            None => self.add_cell(index, receiver, leaving.to_vec()),
        };
        let draft = &mut self.drafts[receiver];
        let mut connection =
            Connection { from: PortId { node, port: 0 }, to, crossings: entering.to_vec(), ..c.clone() };
        if !entering.is_empty() && self.whole.is_synchronous(c) {
            // The inputs of a nested graph are taken together: a relay empties the cell before that.
            let outside = Connection { crossings: vec![], ..connection.clone() };
            connection.from = relay(draft, outside, c.from, self.whole.port(c.from));
        }
        draft.connect(connection, Some(index));
    }

    /// Makes a cell for connection `index` and all that share it. Returns the receiving end.
    fn add_cell(&mut self, index: ConnectionId, receiver: usize, leaving: Vec<Crossing>) -> NodeId {
        let first = self.whole.connections[index].clone();
        let sender = self.group_of[first.from.node];
        let way = self.way(&first, receiver);
        let (shared, keeps_missing) = (&self.shared[&way], way.2);
        let cell = self.cells.len();
        self.cells.push(Cell { from: first.from, sender, receiver });
        let far = CellEnd {
            cell,
            carries_activity: self.carries_activity(first.from.node),
            takes_activity: analyse::takes_activity(self.whole, self.catalog, first.from.node),
            stamped: shared.iter().any(|c| self.is_stamped(*c)),
        };
        let token = self.whole.port(first.from);
        let active = shared.iter().any(|c| self.whole.connections[*c].active);
        let name = format!("{} to {}", self.whole.end_name(first.from), self.whole.group(first.to.node));
        // ⊥ passes the ends of a cell only if they are optional.
        let port = |kind, optional| Port { optional, ..Port::new("token", kind, token.ty.clone()) };
        let (input, output) = (port(PortKind::Input, keeps_missing), port(PortKind::Event, keeps_missing));
        let end = |kind, port| node(&self.whole.nodes[first.from.node], &name, kind, vec![port]);
        let (from, to) = (end(NodeKind::Sender(far), input), end(NodeKind::Receiver(far), output));
        let giver = self.drafts[receiver].add(to, Origin::Token(first.from));
        self.ends.insert(way, giver);
        let (Some(sender), Some(from_end)) = (sender, self.place(first.from)) else { return giver };
        let draft = &mut self.drafts[sender];
        // A value is put in where the token leaves the cell.
        let mut connection = Connection { from: from_end, crossings: leaving, active, given: None, ..first.clone() };
        if keeps_missing && !connection.crossings.is_empty() {
            // The outputs of a nested graph are sent together: a relay waits for that, and then fills the cell.
            connection.from = relay(draft, connection.clone(), first.from, token);
        }
        let consumer = draft.add(from, Origin::Token(first.from));
        let to_cell = PortId { node: consumer, port: 0 };
        // `relayed` makes the connection to the cell asynchronous even if it comes from an output.
        draft.connect(Connection { to: to_cell, crossings: vec![], relayed: true, ..connection }, None);
        giver
    }

    /// Lets the sources of tokens that other threads take together with those of a timer, an input or an event fire
    /// with these, as they would on one thread. Where what sets the pace is on another thread, too, they fire when
    /// there is room, of which `pace::check` warns.
    fn pace_sources(&mut self) {
        for (source, paces) in paced(self.whole, self.analysis, self.catalog) {
            let (Some(group), Some(placed)) = (self.group_of[source], self.placed[source]) else { continue };
            if paces.iter().all(|pace| self.group_of[*pace] == Some(group)) {
                let paces = paces.into_iter().filter_map(|pace| self.placed[pace]).collect();
                self.drafts[group].graph.paced.insert(placed, paces);
            }
        }
    }

    /// Returns `true` if the tokens of a node may carry activity. In its part the receiver does not know it.
    fn carries_activity(&self, node: NodeId) -> bool {
        matches!(self.whole.nodes[node].kind, NodeKind::Start) || self.analysis.active.contains(&node)
    }

    /// Returns `true` if a node at the end of a connection, or downstream of it, needs stamps.
    fn is_stamped(&self, connection: ConnectionId) -> bool {
        let (stamps, to) = (&self.analysis.stamps, self.whole.connections[connection].to.node);
        stamps.number(connection).is_some()
            || self.whole.is_synchronous(&self.whole.connections[connection])
                && stamps.clusters.contains(&self.analysis.cluster_of[to])
    }
}

/// Ends `connection` at a new relay. Returns the output of the relay.
fn relay(draft: &mut Draft, connection: Connection, from: PortId, token: &Port) -> PortId {
    let beside = &draft.graph.nodes[connection.from.node];
    let ports =
        vec![Port::new("in", PortKind::Input, token.ty.clone()), Port::new("out", PortKind::Output, token.ty.clone())];
    let relay = node(beside, &format!("{}.{} relay", beside.name, token.name), NodeKind::Relay, ports);
    let node = draft.add(relay, Origin::Token(from));
    draft.connect(Connection { to: PortId { node, port: 0 }, ..connection }, None);
    PortId { node, port: 1 }
}

fn node(beside: &Node, name: &str, kind: NodeKind, ports: Vec<Port>) -> Node {
    Node {
        name: name.to_owned(),
        // The new node is outside all nested graphs.
        scope: ScopeId::TOP,
        kind,
        ports,
        modifiers: Modifiers::default(),
        span: beside.span,
        docs: String::new(),
        starts_active: false,
    }
}

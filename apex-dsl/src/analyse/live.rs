//! Connections that can ever carry a token. No code is generated for the others, and for nodes that wait for them.

use super::{
    cluster::{Cluster, ClusterId},
    firing::{by_process, fires},
    links::Links,
};
use crate::{
    catalog::Catalog,
    graph::{ConnectionId, Flow, Graph, NodeId, NodeKind, PortId, Standard},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};

/// For each connection, `true` if it can ever carry a token. `causes` lists for each connection the connections on
/// which its token may cause others.
///
/// The search starts at ports that send without a token before, and follows the tokens. A slot needs one token; a
/// firing needs one at each input. With `a.e -> n.x` and `b.e -> n.y`, where `b.e` is never triggered, `n` does not
/// fire, and does not send either.
pub fn live(
    graph: &Graph,
    catalog: &Catalog,
    links: &Links,
    causes: &IdVec<ConnectionId, Vec<ConnectionId>>,
) -> IdVec<ConnectionId, bool> {
    let mut search = Search {
        graph,
        causes,
        live: IdVec::from_elem(false, graph.connections.len()),
        missing: links.inputs.iter().map(Vec::len).collect(),
        found: vec![],
    };
    for node in graph.nodes.ids() {
        let starts = fires(graph, catalog, links, node) && links.inputs[node].is_empty();
        let is_first = |c: &ConnectionId| {
            let from = graph.connections[*c].from;
            begins(graph, from) || starts && is_sent(graph, catalog, from)
        };
        links.from(node).filter(is_first).for_each(|c| search.find(c));
    }
    while let Some(connection) = search.found.pop() {
        search.follow(catalog, links, connection);
    }
    search.live
}

/// A search for live connections.
struct Search<'a> {
    graph: &'a Graph,
    causes: &'a IdVec<ConnectionId, Vec<ConnectionId>>,
    live: IdVec<ConnectionId, bool>,
    /// Number of inputs of each node that no token has reached yet.
    missing: IdVec<NodeId, usize>,
    /// Live connections that have not been followed yet.
    found: Vec<ConnectionId>,
}

impl Search<'_> {
    fn find(&mut self, connection: ConnectionId) {
        if !std::mem::replace(&mut self.live[connection], true) {
            self.found.push(connection);
        }
    }

    /// Follows a token: a slot takes each one, and a node fires when all its inputs have one.
    fn follow(&mut self, catalog: &Catalog, links: &Links, connection: ConnectionId) {
        let c = &self.graph.connections[connection];
        if self.graph.flow(c) == Flow::ToSlot {
            self.causes[connection].iter().for_each(|next| self.find(*next));
            return;
        }
        let node = c.to.node;
        self.missing[node] -= 1;
        if self.missing[node] == 0 {
            let sent = |c: &ConnectionId| is_sent(self.graph, catalog, self.graph.connections[*c].from);
            let sent: Vec<ConnectionId> = links.from(node).filter(sent).collect();
            sent.into_iter().for_each(|c| self.find(c));
        }
    }
}

/// Returns `true` if a port sends tokens without a token before: from outside, at a time, with activity, or from a
/// delay.
fn begins(graph: &Graph, from: PortId) -> bool {
    let node = &graph.nodes[from.node];
    let by_itself = match node.kind {
        NodeKind::Boundary(kind) => matches!(kind, PortKind::Input | PortKind::Slot),
        NodeKind::Start | NodeKind::Watchdog | NodeKind::SetBack | NodeKind::Delay(_) | NodeKind::Receiver(_) => true,
        _ => false,
    };
    let port = graph.port(from);
    by_itself || port.tells_of_activity() || port.comes_with_time || port.standard == Some(Standard::Timeout)
}

/// Returns `true` if a node may send on a port when it fires.
fn is_sent(graph: &Graph, catalog: &Catalog, from: PortId) -> bool {
    match &graph.nodes[from.node].kind {
        NodeKind::Library(library) => {
            graph.port(from).standard.is_some() || by_process(&catalog.signatures[library.signature], graph, from)
        }
        _ => true,
    }
}

/// Marks the clusters that never fire because a token that they wait for never arrives.
pub fn mark(clusters: &mut IdVec<ClusterId, Cluster>, links: &Links, live: &IdVec<ConnectionId, bool>) {
    let lacks = |c: &Cluster| c.nodes.iter().flat_map(|n| &links.inputs[*n]).any(|c| !live[*c]);
    let mut dead: Vec<ClusterId> = clusters.ids().filter(|c| lacks(&clusters[*c])).collect();
    while let Some(index) = dead.pop() {
        if std::mem::replace(&mut clusters[index].fires, false) {
            dead.extend(&clusters[index].downstream);
        }
    }
}

/// Warns of nodes that wait for an event that never comes.
pub fn check_live(graph: &Graph, links: &Links, live: &IdVec<ConnectionId, bool>, diagnostics: &mut Diagnostics) {
    if graph.is_body || graph.is_open {
        return;
    }
    let waits_itself = |node: NodeId| links.inputs[node].iter().any(|c| !live[*c]);
    for (index, c) in graph.connections.iter_enumerated() {
        if live[index] || graph.flow(c) != Flow::ToInput || waits_itself(c.from.node) {
            continue;
        }
        let (node, event) = (graph.path(c.to.node), graph.end_name(c.from));
        let message = format!("`{node}` never fires: the event `{event}` is never triggered");
        let note = format!("only slots of `{}` trigger it, and no token reaches them", graph.path(c.from.node));
        let warning = Diagnostic::warning("never-fires", c.span, message).note(note);
        diagnostics.push(warning.inside(graph.scope_path(graph.nodes[c.to.node].scope)));
    }
}

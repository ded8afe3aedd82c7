//! Properties of single nodes: whether they fire, and when they send ⊥.

use super::links::Links;
use crate::{
    catalog::{ArgSig, Catalog, Signature},
    graph::{Graph, Node, NodeId, NodeKind, Port, PortId},
    syntax::tree::PortKind,
};

/// Returns `true` if a node has a method for ⊥ at its mandatory inputs (`#[no_message]`).
pub fn handles_absence(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    matches!(&graph.nodes[node].kind, NodeKind::Library(library) if catalog.signatures[library.signature].no_message.is_some())
}

/// Returns `true` if a token may be ⊥ although the node that sends it fired.
pub fn may_be_missing(graph: &Graph, catalog: &Catalog, from: PortId) -> bool {
    let node = &graph.nodes[from.node];
    match &node.kind {
        // A node that is disabled, or that failed, sends ⊥.
        NodeKind::Library(_) if graph.nodes[from.node].may_produce_absent() => true,
        NodeKind::Library(_) if graph.port(from).parameter.is_some() => false,
        NodeKind::Library(library) => {
            graph.port(from).optional
                || handles_absence(graph, catalog, from.node)
                || refuses(&catalog.signatures[library.signature], node)
        }
        // The presence of these tokens is stored with them, and tested.
        NodeKind::Delay(_) | NodeKind::Each(_) | NodeKind::Relay => true,
        // In the body of an `each` the element of the list is present. Other inputs may be ⊥ if they are optional.
        NodeKind::Boundary(_) => !graph.is_body || graph.port(from).optional,
        NodeKind::Receiver(_) => graph.port(from).optional,
        NodeKind::Start
        | NodeKind::Watchdog
        | NodeKind::SetBack
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Interrupt(_)
        | NodeKind::Probe
        | NodeKind::Sender(_) => false,
    }
}

/// Returns `true` if a function node has a parameter that arrives as a token and may be out of its range.
fn refuses(signature: &Signature, node: &Node) -> bool {
    let arrives = |p: &Port| p.kind == PortKind::Input && !p.optional;
    signature.is_function
        && node
            .ports
            .iter()
            .filter(|p| arrives(p))
            .any(|p| p.parameter.is_some_and(|i| signature.params[i].range.is_some()))
}

/// Returns `true` if the tokens of a node take activity away: its own, or those that it passes on over `=>`.
pub fn takes_activity(graph: &Graph, catalog: &Catalog, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].deactivates,
        NodeKind::Relay => {
            let mut into = graph.connections.iter().filter(|c| c.active && c.to.node == node);
            into.any(|c| takes_activity(graph, catalog, c.from.node))
        }
        NodeKind::Receiver(far) => far.takes_activity,
        _ => false,
    }
}

/// Returns `true` if a node fires, and so belongs to a cluster. A node that only has slots does not.
pub fn fires(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    match &graph.nodes[node].kind {
        NodeKind::Library(library) => {
            catalog.signatures[library.signature].process.is_some() || !links.inputs[node].is_empty()
        }
        NodeKind::Each(_) | NodeKind::Delay(_) | NodeKind::Relay => true,
        NodeKind::Boundary(kind) => kind.is_synchronous(),
        NodeKind::Probe => !links.inputs[node].is_empty(),
        NodeKind::Start
        | NodeKind::Watchdog
        | NodeKind::SetBack
        | NodeKind::Exit(_)
        | NodeKind::Reset
        | NodeKind::Interrupt(_)
        | NodeKind::Sender(_)
        | NodeKind::Receiver(_) => false,
    }
}

/// Returns `true` if a node is a source: it fires, and no connection leads to its inputs.
pub fn is_source(graph: &Graph, catalog: &Catalog, links: &Links, node: NodeId) -> bool {
    fires(graph, catalog, links, node)
        && links.inputs[node].is_empty()
        && !matches!(graph.nodes[node].kind, NodeKind::Boundary(PortKind::Output))
}

/// Returns `true` if `process` may send on a port.
pub fn by_process(signature: &Signature, graph: &Graph, from: PortId) -> bool {
    let args = signature.process.as_deref().unwrap_or_default();
    graph.port(from).kind == PortKind::Output || args.contains(&ArgSig::Port(from.port))
}

//! Choice of the list among the inputs of an `each`.

use crate::{
    catalog::{Match, Type},
    graph::{Graph, NodeId, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};
use std::collections::BTreeSet;

/// Chooses the list of each `each` by the types, if it is not written.
pub fn resolve(graph: &mut Graph, diagnostics: &mut Diagnostics) {
    for id in graph.nodes.ids() {
        let NodeKind::Each(each) = &mut graph.nodes[id].kind else { continue };
        resolve(&mut each.body, diagnostics);
        if each.list.is_some() {
            continue;
        }
        let inputs: Vec<usize> =
            (0..graph.nodes[id].ports.len()).filter(|p| graph.nodes[id].ports[*p].kind == PortKind::Input).collect();
        let lists: Vec<usize> =
            inputs.iter().copied().filter(|port| is_list(graph, PortId { node: id, port: *port })).collect();
        if let [only] = lists.as_slice() {
            let only = *only;
            if let NodeKind::Each(each) = &mut graph.nodes[id].kind {
                each.list = Some(only);
            }
            graph.nodes[id].require_list();
            continue;
        }
        let node = &graph.nodes[id];
        let message = format!("`{}` has several inputs, and `each` needs the one to iterate over", node.name);
        let names: Vec<String> = inputs.iter().map(|p| format!("`each({})`", node.ports[*p].name)).collect();
        diagnostics
            .push(Diagnostic::error("each-port", node.span, message).note(format!("write {}", names.join(" or "))));
        if let NodeKind::Each(each) = &mut graph.nodes[id].kind {
            each.list = inputs.first().copied();
        }
        graph.nodes[id].require_list();
    }
}

fn is_list(graph: &Graph, input: PortId) -> bool {
    let Some(connection) = graph.incoming(input) else { return false };
    let arriving = token_type(graph, connection.from);
    arriving.list_item().is_some_and(|item| item.compare(&graph.port(input).ty) != Match::Different)
        && arriving.compare(&graph.port(input).ty) != Match::Same
}

/// The type of the tokens that leave a port. An `each` sends lists.
pub fn token_type(graph: &Graph, from: PortId) -> Type {
    let ty = &graph.port(from).ty;
    match &graph.nodes[from.node].kind {
        NodeKind::Each(_) => match first_lists(graph, from.node) {
            Some(Type::Named(name, args)) if args.len() == 1 => Type::Named(name.clone(), vec![ty.clone()]),
            _ => Type::Unknown(format!("list of {ty}")),
        },
        _ => ty.clone(),
    }
}

/// The type of the lists that reach an `each`, where they begin. `None` if they begin nowhere.
fn first_lists(graph: &Graph, each: NodeId) -> Option<&Type> {
    let mut node = each;
    for _ in 0..graph.nodes.len() {
        let from = passed_on(graph, node)?;
        if passed_on(graph, from.node).is_none() {
            return Some(&graph.port(from).ty);
        }
        node = from.node;
    }
    None
}

/// The origin of the lists that an `each` iterates over, or that a delay holds back: both send the kind of list that
/// they take.
fn passed_on(graph: &Graph, node: NodeId) -> Option<PortId> {
    let port = match &graph.nodes[node].kind {
        NodeKind::Each(each) => each.list?,
        NodeKind::Delay(_) => 0,
        _ => return None,
    };
    Some(graph.incoming(PortId { node, port })?.from)
}

/// Reports every `each` whose list is made from its own output of earlier firings and from nothing else: no node says
/// which kind of list it is.
pub fn check_origins(graph: &Graph, diagnostics: &mut Diagnostics) {
    let is_each = |node: &NodeId| matches!(graph.nodes[*node].kind, NodeKind::Each(_));
    let mut seen = BTreeSet::new();
    for id in graph.nodes.ids().filter(is_each) {
        let circle = circle(graph, id, &mut seen);
        // Without a delay, the nodes wait for each other, which is reported as such.
        if !circle.iter().any(|node| graph.nodes[*node].is_delay()) {
            continue;
        }
        let node = &graph.nodes[circle.into_iter().find(is_each).unwrap_or(id)];
        let message = format!("`{}` repeats a list that only it sends, so that its type is not known", node.name);
        let error = Diagnostic::error("each-port", node.span, message);
        diagnostics.push(error.note("connect its input with a node that sends the first list"));
    }
}

/// The nodes that pass lists on in a circle, on the way from `each` back to where its lists begin. Nodes that were
/// `seen` before are left out.
fn circle(graph: &Graph, each: NodeId, seen: &mut BTreeSet<NodeId>) -> Vec<NodeId> {
    let (mut path, mut at) = (vec![], Some(each));
    while let Some(node) = at {
        if !seen.insert(node) {
            let start = path.iter().position(|passed| *passed == node).unwrap_or(path.len());
            return path.split_off(start);
        }
        path.push(node);
        at = passed_on(graph, node).map(|from| from.node);
    }
    vec![]
}

//! Choice of the list among the inputs of an `each`.

use crate::{
    catalog::{Match, Type},
    graph::{Graph, NodeKind, PortId},
    report::{Diagnostic, Diagnostics},
    syntax::tree::PortKind,
};

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
        NodeKind::Each(each) => {
            let list = each.list.and_then(|port| graph.incoming(PortId { node: from.node, port }));
            match list.map(|c| token_type(graph, c.from)) {
                Some(Type::Named(name, args)) if args.len() == 1 => Type::Named(name, vec![ty.clone()]),
                _ => Type::Unknown(format!("list of {ty}")),
            }
        }
        _ => ty.clone(),
    }
}

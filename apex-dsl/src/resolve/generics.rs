//! Inference of type arguments from connections.

use super::{given::own_type, wanted::Wanted};
use crate::{
    catalog::{Catalog, Signature, Type},
    graph::{ConnectionId, Graph, Library, NodeId, NodeKind, Port, PortId, TypeArg},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    syntax::tree::{Expr, ExprKind, PortKind},
};
use std::collections::VecDeque;

/// Infers the type arguments of all generic nodes, and sets the types of their ports.
pub fn infer(graph: &mut Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    settle(graph, catalog);
    // If there are errors, the connections that determine a type may be missing.
    if diagnostics.has_errors() {
        return;
    }
    fit_values(graph, catalog, diagnostics);
    for node in &graph.nodes {
        let NodeKind::Library(library) = &node.kind else { continue };
        let signature = &catalog.signatures[library.signature];
        // Type arguments that the inputs of a function mention need not be known: rustc infers them from the tokens.
        let is_seen = |name: &str| {
            let inputs = signature.ports.iter().filter(|p| p.kind == PortKind::Input).map(|p| &p.ty);
            let given = signature.params.iter().map(|p| &p.ty);
            signature.is_function && inputs.chain(given).any(|ty| ty.may_mention(name))
        };
        let mut open = signature.generics.iter().zip(&library.types).filter(|(_, arg)| matches!(arg, TypeArg::Open));
        if let Some((name, _)) = open.find(|(name, _)| !is_seen(name)) {
            let message = format!("the type `{name}` of `{}` cannot be inferred from the connections", signature.name);
            let arguments = vec!["…"; signature.generics.len()].join(", ");
            diagnostics.push(
                Diagnostic::error("unknown-type", node.span, message)
                    .note(format!("write it: `{}<{arguments}>(…)`", signature.name)),
            );
        }
        let foreign = library.types.iter().find_map(|arg| match arg {
            TypeArg::Known(ty) => Some((ty, catalog.foreign_crate(ty)?)),
            _ => None,
        });
        if let Some((ty, krate)) = foreign.filter(|_| !signature.is_function) {
            let message = format!(
                "`{}` of `{ty}` needs the crate `{krate}`, on which the package does not depend",
                signature.name
            );
            let error = Diagnostic::error("unknown-type", node.span, message);
            diagnostics.push(error.note(format!("add it to the package: `cargo add {krate}`")));
        }
    }
}

/// Fits values to the types of parameters that depend on type arguments.
fn fit_values(graph: &mut Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    for node in &mut graph.nodes {
        let NodeKind::Library(library) = &mut node.kind else { continue };
        let signature = &catalog.signatures[library.signature];
        for (param, declared) in signature.params.iter().enumerate().filter(|(_, p)| p.ty.is_open()) {
            let ty = declared.ty.substitute(&|name| known_argument(signature, &library.types, name));
            let at = Expr { kind: ExprKind::Bool(false), span: node.span };
            let wanted = Wanted {
                name: &declared.name,
                ty: &ty,
                unit: declared.unit.as_deref(),
                range: declared.range,
                declared: format!("`{}` of `{}` is a `{ty}` here", declared.name, signature.name),
            };
            match wanted.fit(library.params[param].clone(), &at) {
                Ok(value) => library.params[param] = value,
                Err(error) => diagnostics.push_once(*error),
            }
        }
    }
}

/// Infers type arguments as far as possible, without errors: the ports of the body of an `each` on one node have no
/// types of their own.
pub fn settle(graph: &mut Graph, catalog: &Catalog) {
    substitute(graph, catalog);
    let mut touching: IdVec<NodeId, Vec<ConnectionId>> = IdVec::from_elem(vec![], graph.nodes.len());
    for (index, connection) in graph.connections.iter_enumerated() {
        touching[connection.from.node].push(index);
        touching[connection.to.node].push(index);
    }
    // First the inputs determine types, then the outputs determine those that are left.
    for only_from_inputs in [true, false] {
        let mut queue: VecDeque<NodeId> = graph.nodes.ids().filter(|n| is_open(graph, *n)).collect();
        while let Some(node) = queue.pop_front() {
            if is_open(graph, node) && settle_node(graph, catalog, node, &touching[node], only_from_inputs) {
                // The types of this node's tokens are known now, so that its neighbours are examined again.
                let neighbours = touching[node]
                    .iter()
                    .flat_map(|c| [graph.connections[*c].from.node, graph.connections[*c].to.node]);
                queue.extend(neighbours.filter(|n| is_open(graph, *n)));
            }
        }
    }
}

fn is_open(graph: &Graph, node: NodeId) -> bool {
    matches!(&graph.nodes[node].kind, NodeKind::Library(l) if l.types.iter().any(|t| matches!(t, TypeArg::Open)))
}

/// Infers arguments of one node. Returns `true` if a new one is known.
fn settle_node(
    graph: &mut Graph,
    catalog: &Catalog,
    node: NodeId,
    touching: &[ConnectionId],
    only_from_inputs: bool,
) -> bool {
    let NodeKind::Library(library) = graph.nodes[node].kind.clone() else { return false };
    let signature = &catalog.signatures[library.signature];
    let mut types = library.types.clone();
    for (index, name) in signature.generics.iter().enumerate() {
        if !matches!(types[index], TypeArg::Open) {
            continue;
        }
        let found = touching.iter().map(|c| &graph.connections[*c]).find_map(|c| {
            if let Some(given) = &c.given {
                let own = own_type(&given.value).filter(|_| c.to.node == node)?;
                let ty = graph.port(c.to).ty.without_unit().bind(name, &own);
                ty.filter(|ty| !ty.is_open()).map(TypeArg::Known)
            } else if c.to.node == node {
                argument_from(graph, catalog, name, c.to, c.from)
            } else if c.from.node == node && !only_from_inputs {
                argument_from(graph, catalog, name, c.from, c.to).filter(|arg| matches!(arg, TypeArg::Known(_)))
            } else {
                None
            }
        });
        if let Some(found) = found {
            types[index] = found;
        }
    }
    let changed =
        types.iter().zip(&library.types).any(|(a, b)| !matches!(a, TypeArg::Open) && matches!(b, TypeArg::Open));
    graph.nodes[node].kind = NodeKind::Library(Library { types, ..library });
    if changed {
        substitute_node(graph, catalog, node);
    }
    changed
}

/// The argument for `name` that follows from the connection between `mine`, whose type mentions `name`, and `other`.
fn argument_from(graph: &Graph, catalog: &Catalog, name: &str, mine: PortId, other: PortId) -> Option<TypeArg> {
    let pattern = graph.port(mine).ty.without_unit();
    let other = graph.origin(other);
    let known = match &graph.nodes[other.node].kind {
        NodeKind::Each(_) => Type::Unknown(String::new()),
        _ => graph.port(other).ty.clone(),
    };
    let bound = pattern.bind(name, &known).filter(|ty| !ty.is_open());
    if let Some(ty) = &bound
        && catalog.can_name(ty)
    {
        return Some(TypeArg::Known(ty.clone()));
    }
    // A node at the other end that is still open has to be settled first.
    if bound.is_none() && is_open(graph, other.node) || !graph.port(other).kind.sends() {
        return bound.map(TypeArg::Known);
    }
    let known = |bound: Option<Type>| bound.unwrap_or_else(|| Type::Unknown(name.to_owned()));
    match pattern {
        Type::Param(param) if param == name => Some(TypeArg::TokenOf(other, known(bound))),
        Type::Named(..) if pattern.list_item() == Some(Type::Param(name.to_owned())) => {
            Some(TypeArg::ItemOf(other, known(bound)))
        }
        _ => bound.map(TypeArg::Known),
    }
}

fn substitute(graph: &mut Graph, catalog: &Catalog) {
    for node in graph.nodes.ids() {
        substitute_node(graph, catalog, node);
    }
}

fn substitute_node(graph: &mut Graph, catalog: &Catalog, node: NodeId) {
    let NodeKind::Library(library) = &graph.nodes[node].kind else { return };
    let (signature, types) = (&catalog.signatures[library.signature], library.types.clone());
    substitute_ports(&mut graph.nodes[node].ports, signature, &types);
}

/// Sets the types of a node's ports according to its type arguments.
pub fn substitute_ports(ports: &mut [Port], signature: &Signature, types: &[TypeArg]) {
    if signature.generics.is_empty() {
        return;
    }
    for port in ports {
        port.ty = port.ty.substitute(&|name| known_argument(signature, types, name));
    }
}

/// The type that a type parameter stands for, as far as it is known.
fn known_argument(signature: &Signature, types: &[TypeArg], name: &str) -> Option<Type> {
    let index = signature.generics.iter().position(|g| g == name)?;
    match types.get(index)? {
        TypeArg::Known(ty) | TypeArg::Verbatim(ty, _) | TypeArg::TokenOf(_, ty) | TypeArg::ItemOf(_, ty) => {
            Some(ty.clone())
        }
        TypeArg::Open => None,
    }
}

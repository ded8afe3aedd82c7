//! Modifiers that wrap an instance: `each` and `delay`.

use super::{
    builder::{Body, Builder},
    flatten, generics,
    lists::token_type,
    suggest::suggest,
    table::Symbol,
    value::evaluate,
    wanted::{Wanted, element_of},
};
use crate::{
    catalog::{SignatureId, Type},
    graph::{Each, Graph, Node, NodeId, NodeKind, Port, PortId, Scope, ScopeId, Value, Wire, WireEnd},
    index::IdVec,
    report::{Diagnostic, Diagnostics},
    source::Span,
    syntax::tree::{Expr, Ident, Instance, Modifier, ModifierKind, PortKind},
};
use std::collections::{BTreeMap, BTreeSet};

impl Builder<'_> {
    /// The body of an `each` on a single node: a graph with only that node and its ports.
    pub fn each_of_node(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        id: SignatureId,
        instance: &Instance,
    ) -> Option<Graph> {
        self.inner(|mut builder| {
            builder.scopes.push(Scope::top(&instance.path.text(), name.span));
            let inside = Body {
                scope: ScopeId::TOP,
                values: body.values.clone(),
                origins: body.origins.clone(),
                fed: body.fed.range((name.text.as_str(), "")..).take_while(|(n, _)| *n == name.text).copied().collect(),
                ..*body
            };
            builder.library(&inside, name, id, instance, "")?;
            // The body runs in the thread group of its `each`.
            let wrapped = NodeId::from(0);
            builder.nodes[wrapped].modifiers.group = None;
            let ports: Vec<Port> =
                builder.nodes[wrapped].ports.iter().filter(|p| p.parameter.is_none()).cloned().collect();
            if let Some(port) = ports.iter().find(|port| port.element_of.is_some()) {
                let (node, port) = (instance.path.text(), &port.name);
                let message =
                    format!("`each` cannot repeat `{node}`: its input `{port}` takes any number of connections");
                let error = Diagnostic::error("each-port", instance.span, message);
                builder.diagnostics.push(error.note(format!(
                    "write a `graph` that contains `{node}` and has one `in` for each of them, and repeat that graph"
                )));
                return None;
            }
            for (port, inner) in ports.into_iter().enumerate() {
                let span = name.span;
                let ident = Ident { text: inner.name.clone(), span };
                let (boundary, kind) = match inner.kind {
                    PortKind::Input => (PortKind::Input, PortKind::Output),
                    PortKind::Output => (PortKind::Output, PortKind::Input),
                    PortKind::Slot | PortKind::Event => continue,
                };
                let outer = Port { kind, optional: true, rate: 1, ..inner };
                let node = builder.node(&ident, ScopeId::TOP, NodeKind::Boundary(boundary), vec![outer], "")?;
                let (library, outside) =
                    (WireEnd::Port(PortId { node: wrapped, port }), WireEnd::Port(PortId { node, port: 0 }));
                let (from, to) = if boundary == PortKind::Input { (outside, library) } else { (library, outside) };
                builder.wires.push(Wire { from, to, active: false, differs: false, given: None, span });
            }
            let (connections, open_pins) = flatten::wires(&mut builder);
            let mut graph = Graph {
                name: instance.path.text(),
                docs: String::new(),
                robot: false,
                is_open: false,
                is_body: true,
                span: name.span,
                nodes: builder.nodes,
                connections,
                scopes: builder.scopes,
                pins: builder.pins,
                wires: builder.wires,
                claims: vec![],
                threads: vec![],
                open_pins,
                suppressed: BTreeSet::new(),
                paced: BTreeMap::new(),
                record: None,
            };
            generics::settle(&mut graph, builder.catalog);
            Some(graph)
        })
    }

    pub fn each(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        mut inner: Graph,
        (parallel, port, span): (bool, Option<&Ident>, Span),
        instance: &Instance,
        docs: &str,
    ) -> Option<Symbol> {
        let mut ports: Vec<Port> = vec![];
        for id in inner.nodes.ids() {
            let takes_missing = takes_missing(&inner, id);
            let node = &mut inner.nodes[id];
            let NodeKind::Boundary(kind) = node.kind else { continue };
            node.ports[0].optional = takes_missing;
            if !kind.is_synchronous() {
                self.diagnostics.push(Diagnostic::error(
                    "each-port",
                    span,
                    format!("`each` runs synchronously, but `{}` is {} {}", node.name, kind.article(), kind.word()),
                ));
                continue;
            }
            let optional = kind == PortKind::Output || takes_missing;
            ports.push(Port { kind, optional, ..node.ports[0].clone() });
        }
        let inputs: Vec<usize> = (0..ports.len()).filter(|p| ports[*p].kind == PortKind::Input).collect();
        let list = match (port, inputs.as_slice()) {
            (Some(port), _) => match inputs.iter().find(|p| ports[**p].name == port.text) {
                Some(list) => Some(*list),
                None => {
                    let error = Diagnostic::error(
                        "unknown-port",
                        port.span,
                        format!("`{}` has no input `{}`", inner.name, port.text),
                    );
                    self.diagnostics.push(suggest(error, port, inputs.iter().map(|p| ports[*p].name.as_str())));
                    return None;
                }
            },
            (None, [only]) => Some(*only),
            (None, []) => {
                self.diagnostics.push(Diagnostic::error(
                    "each-port",
                    span,
                    format!("`{}` has no input to iterate over", inner.name),
                ));
                return None;
            }
            // The list is chosen when the connections are known.
            (None, _) => None,
        };
        let kind = NodeKind::Each(Each { body: Box::new(inner), list, parallel });
        let node = self.node(name, body.scope, kind, ports, docs)?;
        self.nodes[node].require_list();
        self.nodes[node].modifiers.group = instance.modifiers.iter().find_map(Modifier::group);
        Some(Symbol::of_node(node, &self.nodes[node]))
    }

    /// Applies `delay`: a delay follows each output.
    pub fn delayed(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        mut symbol: Symbol,
        modifiers: &[Modifier],
    ) -> Option<Symbol> {
        let Some((expr, span)) = modifiers
            .iter()
            .find_map(|m| if let ModifierKind::Delay(expr) = &m.kind { Some((expr, m.span)) } else { None })
        else {
            return Some(symbol);
        };
        let scope = self.names(&body.values);
        let initial = match expr.as_ref().map(|e| evaluate(e, &scope)) {
            None => vec![None],
            Some(Ok(Value::List(values))) if !values.is_empty() => values.into_iter().map(Some).collect(),
            Some(Ok(Value::List(_))) => {
                self.diagnostics.push(Diagnostic::error("out-of-range", span, "a delay must hold at least one token"));
                return None;
            }
            Some(Ok(value)) => vec![Some(value)],
            Some(Err(error)) => {
                self.diagnostics.push(*error);
                return None;
            }
        };
        for out in symbol.outputs() {
            let ident = Ident { text: format!("{}_{}_delay", name.text, out.name), span };
            let ports = vec![
                Port::new("in", PortKind::Input, out.ty.clone()),
                Port::new("out", PortKind::Output, out.ty.clone()),
            ];
            let node = self.node(&ident, body.scope, NodeKind::Delay(initial.clone()), ports, "")?;
            self.nodes[node].modifiers.group = modifiers.iter().find_map(Modifier::group);
            self.delays.extend(expr.iter().map(|expr| (node, (*expr).clone())));
            self.wires.push(Wire {
                from: out.place,
                to: WireEnd::Port(PortId { node, port: 0 }),
                active: false,
                differs: false,
                given: None,
                span,
            });
            out.place = WireEnd::Port(PortId { node, port: 1 });
        }
        Some(symbol)
    }
}

/// Returns `true` if a node in the body of an `each` handles ⊥ at this input, as `None`.
fn takes_missing(body: &Graph, boundary: NodeId) -> bool {
    let mut leads_to = body.connections.iter().filter(|c| c.from.node == boundary).map(|c| body.port(c.to));
    leads_to.any(|port| port.optional && port.parameter.is_none())
}

/// Fits the initial tokens of delays to the types of their ports, which depend on the connections.
pub fn fit_delays(graph: &mut Graph, delays: &[(NodeId, Expr)], diagnostics: &mut Diagnostics) {
    for (node, expr) in delays {
        let from = graph.incoming(PortId { node: *node, port: 0 }).map(|c| c.from);
        let (Some(from), NodeKind::Delay(initial)) = (from, &graph.nodes[*node].kind) else { continue };
        let origin = graph.origin(from);
        let ty = match token_type(graph, origin) {
            // Some kind of list, for which there are no literals.
            Type::Unknown(_) if matches!(graph.nodes[origin.node].kind, NodeKind::Each(_)) => {
                Type::Named("Vec".to_owned(), vec![graph.port(origin).ty.clone()])
            }
            ty => ty,
        };
        let name = graph.end_name(from);
        let wanted =
            Wanted { name: &name, ty: &ty, unit: None, range: None, declared: format!("`{name}` sends `{ty}`") };
        let fitted = initial.iter().enumerate().map(|(i, value)| match value {
            Some(value) => wanted.fit(value.clone(), element_of(expr, i)).map(Some),
            None => Ok(None),
        });
        match fitted.collect() {
            Ok(fitted) => graph.nodes[*node].kind = NodeKind::Delay(fitted),
            Err(error) => diagnostics.push_once(*error),
        }
    }
}

/// Makes the connection into a delay active if one behind it is: only the latter is written.
pub fn let_activity_into_delays(nodes: &IdVec<NodeId, Node>, wires: &mut [Wire]) {
    let delay = |place: WireEnd| match place {
        WireEnd::Port(end) if nodes[end.node].is_delay() => Some(end.node),
        _ => None,
    };
    let active: BTreeSet<NodeId> = wires.iter().filter(|w| w.active).filter_map(|w| delay(w.from)).collect();
    for wire in wires {
        wire.active |= delay(wire.to).is_some_and(|node| active.contains(&node));
    }
}

//! Values that slots get in place of tokens: `node.slot(value)`.

use super::{
    builder::{Body, Builder},
    value::evaluate,
    wanted::Wanted,
};
use crate::{
    catalog::Type,
    graph::{ConnectionId, Given, Graph, NodeKind, PortId, Value},
    report::{Diagnostic, Diagnostics},
    syntax::tree::{Expr, Ident, Instance, PortKind},
};

impl Builder<'_> {
    /// The value that is given to a port; `None` for an error.
    pub fn given(&mut self, body: &Body<'_>, value: &Expr) -> Option<Given> {
        let evaluated = evaluate(value, &self.names(&body.values));
        let given = evaluated.map(|evaluated| Given { value: evaluated, written: value.clone() });
        given.map_err(|error| self.diagnostics.push(*error)).ok()
    }

    /// Reports a value where tokens are sent.
    pub fn refuse_given(&mut self, given: &Given, text: &str) {
        let message = format!("`{text}` sends tokens here: only a slot that takes them gets a value");
        let note = format!("write the value where the tokens arrive: `… -> slot({})`", given.value.text());
        self.diagnostics.push_once(Diagnostic::error("wrong-direction", given.written.span, message).note(note));
    }
}

/// Fits the given values to the types of their slots, some of which depend on the connections.
pub fn fit(graph: &mut Graph, diagnostics: &mut Diagnostics) {
    let ids: Vec<ConnectionId> = graph.connections.ids().collect();
    for id in ids {
        let connection = &graph.connections[id];
        let Some(given) = &connection.given else { continue };
        match fitted(graph, connection.to, given) {
            Ok(value) => graph.connections[id].given = Some(Box::new(Given { value, ..(**given).clone() })),
            Err(error) => diagnostics.push_once(*error),
        }
    }
}

fn fitted(graph: &Graph, to: PortId, given: &Given) -> Result<Value, Box<Diagnostic>> {
    let (port, node) = (graph.port(to), &graph.nodes[to.node].kind);
    let name =
        if matches!(node, NodeKind::Exit(_) | NodeKind::Reset) { graph.path(to.node) } else { graph.end_name(to) };
    if port.kind != PortKind::Slot {
        return Err(Box::new(no_slot(given, &name)));
    }
    if matches!(node, NodeKind::Exit(_) | NodeKind::Reset | NodeKind::Interrupt(_)) {
        let message = format!("`{name}` does not look at what comes: it takes no value");
        let error = Diagnostic::error("wrong-value", given.written.span, message);
        return Err(Box::new(error.note("write it without the parentheses")));
    }
    let wanted = Wanted {
        name: &name,
        ty: &port.ty,
        unit: None,
        range: None,
        declared: format!("`{name}` takes `{}`", port.ty),
    };
    wanted.fit(given.value.clone(), &given.written)
}

/// The error at `port(…)` with anything but one value.
pub fn no_value(port: &Ident, instance: &Instance) -> Diagnostic {
    let message = match instance.modifiers.is_empty() {
        true => format!("`{0}` is not a type of nodes, and a port gets one value: `{0}(value)`", port.text),
        false => format!("`{}` is not a type of nodes, and a port has no modifiers", port.text),
    };
    Diagnostic::error("unknown-node", instance.span, message)
}

/// The error at a value for an input.
pub fn no_slot(given: &Given, name: &str) -> Diagnostic {
    let message = format!("`{name}` is an input: only a slot gets a value in place of tokens");
    let error = Diagnostic::error("given-to-input", given.written.span, message);
    error.note("each firing needs the tokens of all inputs: connect a node that sends the value")
}

/// The type of a value, where it has one without a slot that asks for it.
pub fn own_type(value: &Value) -> Option<Type> {
    let ty = match value {
        Value::Bool(_) => Some(Type::Primitive("bool".to_owned())),
        Value::Duration(_) => Some(Type::Named("core::time::Duration".to_owned(), vec![])),
        Value::Path(_, ty) => Some(ty.clone()),
        Value::Struct(given) => Some(given.ty.clone()),
        Value::Number(_) | Value::Text(_) | Value::List(_) | Value::Unit | Value::RustDefault => None,
    };
    ty.filter(|ty| !ty.is_open())
}

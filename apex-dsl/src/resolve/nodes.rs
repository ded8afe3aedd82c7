//! Instances of catalog nodes: arguments, types, modifiers and ports.

use super::{
    args,
    builder::{Body, Builder},
    generics,
    names::Constructor,
    origins,
    table::Symbol,
    types,
};
use crate::{
    catalog::{Catalog, ParamSig, Signature, SignatureId, Type},
    graph::{Graph, Library, NodeId, NodeKind, Port, PortId, TypeArg, Value, Wire, WireEnd},
    machine::Machine,
    report::Diagnostic,
    source::Span,
    syntax::tree::{Ident, Instance, Modifier, PortKind, TypeExpr, TypeKind},
    units,
};

impl Builder<'_> {
    /// A node of the catalog.
    pub fn library(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        id: SignatureId,
        instance: &Instance,
        docs: &str,
    ) -> Option<Symbol> {
        let signature = &self.catalog.signatures[id];
        // An incorrect state machine has been reported.
        if signature.name.is_empty() {
            return None;
        }
        let scope = self.names(&body.values);
        let fed = |param: &str| body.fed.contains(&(name.text.as_str(), param));
        let at = instance.span;
        let params = args::of_node(signature, &instance.args, at, &scope, &body.origins, &fed, self.diagnostics);
        let types = self.type_args(body, signature.generics.len(), &instance.types, instance);
        let mut modifiers = args::modifiers(&instance.modifiers, &scope, &body.origins, self.diagnostics);
        // A time limit among the arguments has been reported.
        if args::has_misplaced(&instance.args, signature, "timeout") {
            modifiers.timeout.get_or_insert(args::ANY_TIME);
        }
        if signature.process.is_none() && !signature.is_function && signature.ports.is_empty() {
            let message = format!("`{}` has neither `process` nor a slot", signature.name);
            let error = Diagnostic::error("no-process", instance.path.span, message).note(format!(
                "declared at {}:{}; mark its `impl` with `#[node]` too; if it is marked, run `cargo check` to find the error in its signature",
                signature.file.display(),
                signature.line
            ));
            self.diagnostics.push(error);
        }
        let mut ports = library_ports(signature);
        generics::substitute_ports(&mut ports, signature, &types);
        let ranges = origins::passed_on(signature, &instance.args, &body.origins);
        let kind = NodeKind::Library(Library { signature: id, types, params, ranges, handed_in: false });
        let docs = if docs.is_empty() { &signature.docs } else { docs };
        let node = self.node(name, body.scope, kind, ports, docs)?;
        self.nodes[node].modifiers = modifiers;
        if self.texts.machines.contains_key(&id) {
            self.begin_machine(body, name.span, node)?;
        }
        Some(Symbol::of_node(node, &self.nodes[node]))
    }

    /// Connects `start` to a state machine whose initial state triggers events.
    fn begin_machine(&mut self, body: &Body<'_>, span: Span, node: NodeId) -> Option<()> {
        let Some(port) = self.nodes[node].ports.iter().position(|p| p.name == Machine::BEGIN) else { return Some(()) };
        let start = Ident { text: "start".to_owned(), span };
        let start = self.own_node(body, &start, NodeKind::Start)?;
        let from = WireEnd::Port(PortId { node: start, port: 0 });
        let to = WireEnd::Port(PortId { node, port });
        self.wires.push(Wire { from, to, active: false, differs: false, given: None, span });
        Some(())
    }

    fn type_args(&mut self, body: &Body<'_>, count: usize, given: &[TypeExpr], instance: &Instance) -> Vec<TypeArg> {
        if given.is_empty() {
            return vec![TypeArg::Open; count];
        }
        if given.len() != count {
            let span = given.iter().fold(given[0].span, |all, ty| all.to(ty.span));
            self.diagnostics.push(types::wrong_count(&instance.path, count, given.len(), span));
            return vec![TypeArg::Known(Type::Unknown(String::new())); count];
        }
        given
            .iter()
            .map(|ty| {
                let resolved = self.ty(body.id, ty);
                match &resolved {
                    Type::Param(_) => TypeArg::Open,
                    _ => TypeArg::Verbatim(resolved, self.texts.ty(ty).to_string()),
                }
            })
            .collect()
    }

    /// A node that is made in Rust.
    pub fn handed_in(
        &mut self,
        body: &Body<'_>,
        name: &Ident,
        ty: &TypeExpr,
        modifiers: &[Modifier],
        docs: &str,
    ) -> Option<Symbol> {
        let TypeKind::Path(path, types) = &ty.kind else {
            self.diagnostics.push(Diagnostic::error(
                "unknown-node",
                ty.span,
                "a node that is handed in from Rust must have the type of a struct node",
            ));
            return None;
        };
        let instance =
            Instance { path: path.clone(), types: types.clone(), args: vec![], modifiers: vec![], span: ty.span };
        match self.constructor(path) {
            Ok(Constructor::Node(id)) if !self.catalog.signatures[id].is_function => {
                let signature = &self.catalog.signatures[id];
                let params = vec![Value::RustDefault; signature.params.len()];
                let ranges = vec![vec![]; params.len()];
                let types = self.type_args(body, signature.generics.len(), types, &instance);
                let kind = NodeKind::Library(Library { signature: id, types, params, ranges, handed_in: true });
                let docs = if docs.is_empty() { &signature.docs } else { docs };
                let node = self.node(name, body.scope, kind, library_ports(signature), docs)?;
                let scope = self.names(&body.values);
                self.nodes[node].modifiers = args::modifiers(modifiers, &scope, &body.origins, self.diagnostics);
                Some(Symbol::of_node(node, &self.nodes[node]))
            }
            Ok(_) => {
                let message = "only a struct node can be handed in from Rust";
                self.diagnostics.push(
                    Diagnostic::error("unknown-node", ty.span, message)
                        .note("an instance is written `node name = Type();`"),
                );
                None
            }
            Err(error) => {
                error.into_iter().for_each(|error| self.diagnostics.push(*error));
                None
            }
        }
    }
}

/// Makes connected parameters of functions required inputs, because a function cannot store their values.
pub fn require_function_params(graph: &mut Graph, catalog: &Catalog) {
    for connection in &graph.connections {
        let node = &mut graph.nodes[connection.to.node];
        if matches!(&node.kind, NodeKind::Library(library) if catalog.signatures[library.signature].is_function) {
            let port = &mut node.ports[connection.to.port];
            port.optional &= port.parameter.is_none();
        }
    }
}

/// The type of the tokens at the port of a parameter, whose value is in SI units.
fn in_si(param: &ParamSig) -> Type {
    let dimension = param.unit.as_deref().and_then(|unit| units::parse(unit).ok()).map(|unit| unit.dimension);
    match dimension.filter(|dimension| !dimension.is_none() && param.ty.may_be_a_number()) {
        Some(dimension) => Type::Measured(Box::new(param.ty.clone()), dimension.to_string()),
        None => param.ty.clone(),
    }
}

/// The ports of a node: those of the signature, then an input and an output for each parameter.
fn library_ports(signature: &Signature) -> Vec<Port> {
    let ports = signature.ports.iter().enumerate().map(|(i, p)| Port {
        name: p.name.clone(),
        kind: p.kind,
        ty: p.ty.clone(),
        rate: p.rate,
        optional: p.optional,
        element_of: p.any_number.then_some(i),
        frame: None,
        parameter: None,
        standard: None,
        comes_with_moves: signature.machine.as_ref().is_some_and(|machine| machine.moved.contains(&i)),
        comes_with_time: signature.machine.as_ref().is_some_and(|machine| machine.is_timed(i)),
        docs: p.docs.clone(),
    });
    let params = signature.params.iter().enumerate().flat_map(|(i, p)| {
        [PortKind::Input, PortKind::Output].map(|kind| Port {
            name: p.name.clone(),
            kind,
            ty: in_si(p),
            rate: 1,
            optional: kind == PortKind::Input,
            element_of: None,
            frame: None,
            parameter: Some(i),
            standard: None,
            comes_with_moves: false,
            comes_with_time: false,
            docs: p.docs.clone(),
        })
    });
    ports.chain(params).collect()
}

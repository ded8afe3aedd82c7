//! The script of a `test` or `tune` item, with probes at the ports that it observes.

use super::{
    condition::Conditions,
    record::sending_port,
    scope::Scope,
    structs,
    suggest::suggest,
    time::time,
    value::evaluate,
    wanted::{Wanted, element_of},
};
use crate::{
    catalog::Type,
    graph::{Connection, Graph, Modifiers, NodeId, NodeKind, Port, PortId, ScopeId, Subject, Value},
    machine::machines,
    report::{Diagnostic, Diagnostics},
    script::{Observed, Seen, Step, Until, What},
    source::{Sources, Span},
    syntax::tree::{Condition, Expr, Ident, Limit, PortKind, PortRef, TestItem, TestStep},
};
use std::{collections::BTreeSet, time::Duration};

/// Writer of the script of a test.
pub struct Writer<'a> {
    /// The program.
    pub graph: &'a mut Graph,
    /// Names of the nodes of the graph. Those that cannot be made are missing in `graph`.
    pub declared: BTreeSet<&'a str>,
    /// Meaning of the names in expressions.
    pub scope: &'a Scope<'a>,
    /// Their source files.
    pub sources: &'a Sources,
    /// Messages.
    pub diagnostics: &'a mut Diagnostics,
}

impl Writer<'_> {
    /// Reports replacements of unknown nodes, and nodes made in Rust that are not replaced.
    pub fn check_replaced(&mut self, item: &TestItem) {
        let paths: Vec<String> = self.graph.nodes.ids().map(|n| self.graph.path(n)).collect();
        for (of, _) in &item.replaced {
            if !paths.iter().any(|p| is_or_contains(of, p)) {
                let word = Ident { text: of.text(), span: of.span };
                let message = format!("there is no node `{}` to be replaced", word.text);
                let error = Diagnostic::error("unknown-node", of.span, message);
                self.diagnostics.push(suggest(error, &word, paths.iter().map(String::as_str)));
            }
        }
        for node in &self.graph.nodes {
            if matches!(&node.kind, NodeKind::Library(library) if library.handed_in) {
                let message = format!("`{}` is made in Rust, which a {} cannot do", node.name, item.word());
                let error = Diagnostic::error("not-replaced", item.name.span, message).also(node.span, "this node");
                self.diagnostics
                    .push(error.note(format!("replace it by another node: `replace {} = …();`", node.name)));
            }
        }
    }

    /// Turns the outputs and events of the program into probes, which never block their senders.
    pub fn probe_ports(&mut self) {
        for node in &mut self.graph.nodes {
            if matches!(node.kind, NodeKind::Boundary(PortKind::Output | PortKind::Event)) {
                node.kind = NodeKind::Probe;
            }
        }
    }

    /// One step; `None` for an error.
    pub fn step(&mut self, step: &TestStep) -> Option<Step> {
        match step {
            TestStep::Wait(time) => self.time(time).map(Step::Wait),
            TestStep::Never(condition) => self.seen(condition).map(Step::Never),
            TestStep::Expect(condition, limit) => {
                let seen = self.seen(condition)?;
                let until = match limit {
                    Some((Limit::By, time)) => Some(Until::By(self.time(time)?)),
                    Some((Limit::Within, time)) => Some(Until::Within(self.time(time)?)),
                    None => None,
                };
                Some(Step::Expect(seen, until))
            }
            TestStep::Feed(port, value, every) => self.feed(port, value.as_ref(), every.as_ref()),
            TestStep::FeedRecorded(port, file, channel) => {
                let (file, channel, span) = (file.clone(), channel.clone(), port.span);
                Some(Step::FeedRecorded { port: self.way_in(port)?, file, channel, span })
            }
        }
    }

    /// The port of the graph into which a test feeds tokens.
    fn way_in(&mut self, port: &Ident) -> Option<NodeId> {
        let is_way_in = |n: &crate::graph::Node| matches!(n.kind, NodeKind::Boundary(_));
        let ports: Vec<(NodeId, &str)> = self
            .graph
            .nodes
            .iter_enumerated()
            .filter(|(_, n)| is_way_in(n))
            .map(|(i, n)| (i, n.name.as_str()))
            .collect();
        let Some((node, _)) = ports.iter().find(|(_, name)| *name == port.text) else {
            let message = format!("the graph has no input or slot `{}`", port.text);
            let error = Diagnostic::error("unknown-port", port.span, message)
                .note("to feed a source inside the graph, replace it: `replace source = …();`");
            self.diagnostics.push(suggest(error, port, ports.iter().map(|(_, name)| *name)));
            return None;
        };
        Some(*node)
    }

    fn feed(&mut self, port: &Ident, value: Option<&Expr>, every: Option<&Expr>) -> Option<Step> {
        let node = self.way_in(port)?;
        let ty = self.graph.nodes[node].ports[0].ty.clone();
        let every = match every {
            Some(time) => Some(self.time(time)?),
            None => None,
        };
        let values = match value {
            None if ty.is_unit() => vec![Value::Unit],
            None => {
                let message = format!("`{}` takes `{ty}`: give it a value", port.text);
                self.diagnostics.push(Diagnostic::error("missing-argument", port.span, message));
                return None;
            }
            Some(expr) => {
                let values = match self.value(expr)? {
                    Value::List(values) if every.is_some() => {
                        values.into_iter().enumerate().map(|(i, value)| (value, element_of(expr, i))).collect()
                    }
                    value => vec![(value, expr)],
                };
                values.into_iter().map(|(value, expr)| self.fit(port, &ty, value, expr)).collect::<Option<_>>()?
            }
        };
        Some(Step::Feed { port: node, values, every, span: port.span })
    }

    /// A token for a port; reports one that does not fit the type of the port.
    fn fit(&mut self, port: &Ident, ty: &Type, value: Value, expr: &Expr) -> Option<Value> {
        let declared = format!("`{}` takes `{ty}`", port.text);
        let wanted = Wanted { name: &port.text, ty, unit: None, range: None, declared };
        wanted.fit(value, expr).map_err(|error| self.diagnostics.push(*error)).ok()
    }

    /// The value of an expression.
    pub fn value(&mut self, expr: &Expr) -> Option<Value> {
        evaluate(expr, self.scope).map_err(|error| self.diagnostics.push(*error)).ok()
    }

    fn time(&mut self, expr: &Expr) -> Option<Duration> {
        time(expr, self.scope).map_err(|error| self.diagnostics.push(*error)).ok()
    }

    fn seen(&mut self, condition: &Condition) -> Option<Seen> {
        let what = match condition.active {
            true => self.active(&condition.of)?,
            false => self.token(condition)?,
        };
        Some(Seen { what, text: self.sources.text(condition.span).to_owned(), span: condition.span })
    }

    fn token(&mut self, condition: &Condition) -> Option<What> {
        let (of, name) = (self.observed(&condition.of)?, condition.of.text());
        let conditions = Conditions { name: &name, token: "", ty: &of.ty, scope: self.scope };
        let read = match (&condition.compare, &condition.tolerance) {
            (Some((operator, value)), Some(tolerance)) => conditions.nearness(operator, value, tolerance).map(Some),
            (Some((operator, value)), None) => conditions.comparison(operator, value).map(Some),
            (None, _) if of.fields.is_empty() => Ok(None),
            (None, _) => conditions.truth(condition.span).map(Some),
        };
        let test = read.map_err(|error| self.diagnostics.push(*error)).ok()?;
        Some(What::Token(of, test))
    }

    /// The node, nested graph or state with this name.
    fn active(&mut self, of: &PortRef) -> Option<What> {
        let path = of.text();
        let nodes = self.graph.nodes.ids().map(Subject::Node);
        let subjects = nodes.chain(self.graph.nested().map(Subject::Scope));
        let mut all: Vec<(String, What)> =
            subjects.map(|subject| (self.graph.subject_name(subject), What::Active(subject))).collect();
        for (id, machine) in machines(self.graph, self.scope.rust.catalog) {
            let states = machine.all_states().into_iter();
            all.extend(
                states.map(|(name, inside)| (format!("{}.{name}", self.graph.path(id)), What::InState(id, inside))),
            );
        }
        let found = all.iter().find(|(name, _)| *name == path).map(|(_, what)| what.clone());
        if found.is_none() {
            self.unknown(of.span, &path, all.iter().map(|(name, _)| name.as_str()));
        }
        found
    }

    /// The port with this name, or the field of its tokens: `port.field`, `node.port.field`.
    pub fn observed(&mut self, of: &PortRef) -> Option<Observed> {
        let shorter = |count: usize| PortRef { parts: of.parts[..count].to_vec(), span: of.span };
        let is_sent = |path: &str| self.own_probe(path).is_some() || sending_port(self.graph, path).is_some();
        let all = of.parts.len();
        // An unknown name is reported as a whole.
        let count = (1..=all).rev().find(|count| is_sent(&shorter(*count).text())).unwrap_or(all);
        let (probe, mut ty) = self.probe(&shorter(count))?;
        let fields = &of.parts[count..];
        for (number, field) in fields.iter().enumerate() {
            let Some(declared) = self.scope.rust.catalog.struct_of(&ty) else {
                // More likely the name of a port is wrong.
                if number == 0 {
                    return self.probe(of).and(None);
                }
                let message = format!("a `{ty}` has no fields that a test can use");
                self.diagnostics.push(Diagnostic::error("wrong-field", field.span, message));
                return None;
            };
            let found = structs::field(&declared, field).map_err(|error| self.diagnostics.push(*error)).ok()?;
            ty = found.ty.clone();
        }
        Some(Observed { probe, fields: fields.iter().map(|field| field.text.clone()).collect(), ty })
    }

    /// The probe that a port of the graph has become.
    fn own_probe(&self, name: &str) -> Option<NodeId> {
        self.graph.nodes.position(|n| n.kind.is_probe() && n.scope == ScopeId::TOP && n.name == name)
    }

    /// Reports an unknown node or port, unless it belongs to a node that cannot be made: its cause is reported there.
    fn unknown<'n>(&mut self, span: Span, path: &str, known: impl Iterator<Item = &'n str>) {
        let node = path.split('.').next().unwrap_or(path);
        let is_made = |name: &str| name.split('.').next() == Some(node);
        let mut all = self.graph.nodes.ids().map(Subject::Node).chain(self.graph.nested().map(Subject::Scope));
        if self.declared.contains(node) && !all.any(|subject| is_made(&self.graph.subject_name(subject))) {
            return;
        }
        let word = Ident { text: path.to_owned(), span };
        let error = Diagnostic::error("unknown-node", span, format!("the graph has no node or port `{path}`"));
        self.diagnostics.push(suggest(error, &word, known));
    }

    /// The probe at a port, which is made when it is first used.
    pub fn probe(&mut self, of: &PortRef) -> Option<(NodeId, Type)> {
        let path = of.text();
        let name = format!("probe {path}");
        let known = self.graph.nodes.position(|n| n.kind.is_probe() && n.name == name);
        if let Some(node) = known.or_else(|| self.own_probe(&path)) {
            return Some((node, self.graph.nodes[node].ports[0].ty.clone()));
        }
        let Some(from) = sending_port(self.graph, &path) else {
            let ends = self.graph.nodes.ids().flat_map(|node| {
                let graph = &*self.graph;
                (0..graph.nodes[node].ports.len()).map(move |port| graph.end_name(PortId { node, port }))
            });
            let known: Vec<String> = ends.collect();
            self.unknown(of.span, &path, known.iter().map(String::as_str));
            return None;
        };
        let ty = self.graph.port(from).ty.clone();
        let node = crate::graph::Node {
            name,
            scope: ScopeId::TOP,
            kind: NodeKind::Probe,
            ports: vec![Port::new("probe", probe_kind(self.graph.port(from).kind), ty.clone())],
            // The probe runs in the group of the port, so that no cell is between them.
            modifiers: Modifiers { group: Some(self.graph.group(from.node).to_owned()), ..Modifiers::default() },
            span: of.span,
            docs: String::new(),
            starts_active: false,
        };
        let to = PortId { node: self.graph.nodes.push(node), port: 0 };
        let (crossings, span) = (vec![], of.span);
        self.graph.connections.push(Connection {
            from,
            to,
            active: false,
            differs: false,
            given: None,
            crossings,
            relayed: false,
            span,
        });
        Some((to.node, ty))
    }
}

/// Kind of a probe's port. At an output it is an input, which takes the token of each firing.
fn probe_kind(port: PortKind) -> PortKind {
    if port == PortKind::Output { PortKind::Input } else { PortKind::Slot }
}

/// Returns `true` if `path` is the node that is meant, or a node inside the nested graph that is meant.
fn is_or_contains(meant: &PortRef, path: &str) -> bool {
    path.strip_prefix(&meant.text()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

//! Connections by name: `a.* -> b.*;` connects each port of `a` that sends tokens with the port of `b` that takes them
//! and has the same name.

use super::{
    connect::{End, Made, own_node},
    instance::{Body, Builder},
    table::{Candidate, Owner, Symbol, Table},
};
use crate::{
    catalog::Match,
    graph::WireEnd,
    report::Diagnostic,
    source::Span,
    syntax::tree::{AllPorts, Arrow, PortsOf},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    rc::Rc,
};

/// The ports for which `.*` stands.
#[derive(Debug, Clone)]
pub struct All {
    /// The endpoint as text.
    text: String,
    span: Span,
    owner: PortOwner,
    ports: Vec<Candidate>,
}

/// Owner of the ports, with the name that they follow in a graph.
#[derive(Debug, Clone)]
enum PortOwner {
    /// The graph itself, whose ports are named alone.
    Graph,
    Other(String, Owner),
}

impl All {
    fn sends(&self) -> impl Iterator<Item = &Candidate> {
        self.ports.iter().filter(|port| port.kind.sends())
    }

    /// The ports that take tokens.
    pub fn takes(&self) -> impl Iterator<Item = &Candidate> {
        self.ports.iter().filter(|port| !port.kind.sends())
    }

    /// Number of ports.
    pub fn count(&self) -> usize {
        self.ports.len()
    }

    /// Name of the node or nested graph.
    fn node(&self) -> Option<&str> {
        if let PortOwner::Other(name, _) = &self.owner { Some(name) } else { None }
    }

    /// One of the ports, as if the graph named it here.
    fn end(&self, port: &Candidate) -> End {
        let (symbol, text) = match &self.owner {
            PortOwner::Graph => (Symbol::Own(port.clone()), port.name.clone()),
            PortOwner::Other(name, owner) => {
                (Symbol::Ports(*owner, vec![port.clone()]), format!("{name}.{}", port.name))
            }
        };
        End { symbol, text, span: self.span }
    }
}

impl Builder<'_> {
    /// The ports for which an endpoint with `.*` stands. `None` stands for an error. Parameters are not among them.
    pub fn all_ports(&mut self, body: &Body<'_>, table: &Table, all: &AllPorts) -> Option<All> {
        self.look(body.item.ports.len(), all.span)?;
        let own = |sends: bool| {
            let own = table.own_ports().filter(|port| port.kind.sends() == sends).cloned().collect();
            (PortOwner::Graph, own)
        };
        let (text, (owner, ports)) = match &all.of {
            // Seen from inside, the inputs of the graph send.
            PortsOf::In => ("in.*".to_owned(), own(true)),
            PortsOf::Out => ("out.*".to_owned(), own(false)),
            PortsOf::Node(name) => {
                let Some((symbol, _)) = table.get(&name.text) else {
                    if own_node(&name.text).is_some() {
                        let message = format!("`{}` is a single port: write it without `.*`", name.text);
                        self.diagnostics.push(Diagnostic::error("wrong-wildcard", all.span, message));
                        return None;
                    }
                    self.unknown_name(body, table, name);
                    return None;
                };
                let (owner, ports) = match symbol {
                    Symbol::Broken => return None,
                    Symbol::Ports(owner, ports) => (*owner, ports),
                    Symbol::Own(_) => {
                        let message = format!("`{}` is a port of this graph and has no ports of its own", name.text);
                        let error = Diagnostic::error("unknown-port", all.span, message);
                        self.diagnostics.push(error.note("`in.*` and `out.*` stand for the ports of this graph"));
                        return None;
                    }
                };
                self.look(ports.len(), all.span)?;
                let ports = ports.iter().filter(|port| !port.parameter).cloned().collect();
                (format!("{}.*", name.text), (PortOwner::Other(name.text.clone(), owner), ports))
            }
        };
        Some(All { text, span: all.span, owner, ports })
    }

    /// Makes the connections by name of a graph body, whose wires begin at `first`. Ports to which a connection leads
    /// that names them are left out.
    pub fn connect_by_name(&mut self, body: &Body<'_>, arrows: &[(Rc<All>, Rc<All>, Arrow)], first: usize) {
        if arrows.is_empty() {
            return;
        }
        let named: BTreeSet<WireEnd> = self.wires[first..].iter().map(|wire| wire.to).collect();
        for (from, to, arrow) in arrows {
            if arrow.active {
                self.activity_by_name(arrow, to);
                continue;
            }
            let exchange = [from, to].into_iter().find_map(|all| self.exchange(body, all.node()?, arrow.span));
            self.at_exchange(exchange, |this| this.connect_all(from, to, arrow, &named));
        }
    }

    fn connect_all(&mut self, from: &All, to: &All, arrow: &Arrow, named: &BTreeSet<WireEnd>) {
        let sources: BTreeMap<&str, &Candidate> = from.sends().map(|port| (port.name.as_str(), port)).collect();
        let pairs = to.takes().filter_map(|target| Some((*sources.get(target.name.as_str())?, target)));
        let pairs: Vec<(&Candidate, &Candidate)> = pairs.collect();
        if pairs.is_empty() {
            self.nothing_matched(from, to, arrow);
        }
        for (source, target) in pairs {
            if !named.contains(&target.place) && !self.suppressed.contains(&target.place) {
                self.connect_pair((&from.end(source), source), (&to.end(target), target), arrow);
            }
        }
    }

    fn connect_pair(&mut self, from: (&End, &Candidate), to: (&End, &Candidate), arrow: &Arrow) {
        let differs = from.1.ty.compare(&to.1.ty) == Match::Different;
        if differs {
            let error = self.mismatch(from, to, arrow.span);
            let name = &to.1.name;
            self.diagnostics.push(error.note(format!("`.*` connects them because both are called `{name}`")));
        }
        self.wire(from, to, arrow, Made { differs, by_name: true });
    }

    /// Reports `.*` at one end of an arrow only.
    pub fn one_sided(&mut self, one: &End, all: &All) {
        let message = format!("`{}` is connected with `{}`, which is not followed by `.*`", all.text, one.text);
        let error = Diagnostic::error("wrong-wildcard", all.span, message).also(one.span, "no `.*` here");
        self.diagnostics.push_once(error.note("write `.*` at both ends, or name each port"));
    }

    /// Reports `=>` between ends with `.*`.
    fn activity_by_name(&mut self, arrow: &Arrow, to: &All) {
        self.suppressed.extend(to.takes().map(|port| port.place));
        let message = "`.*` cannot pass activity on: `=>` needs the names of its ports";
        let error = Diagnostic::error("wrong-wildcard", arrow.span, message);
        self.diagnostics
            .push_once(error.note("write `node.port => node.port`; a port that is named is left out of `.*`"));
    }

    /// Reports ends with `.*` that have no name in common.
    fn nothing_matched(&mut self, from: &All, to: &All, arrow: &Arrow) {
        let message = format!("no port that `{}` stands for has the name of one of `{}`", to.text, from.text);
        let side = |all: &All, ports: Vec<&Candidate>, verb: &str| {
            let words: Vec<String> = ports.iter().map(|port| format!("`{}: {}`", port.name, port.ty)).collect();
            let words = if words.is_empty() { "no tokens".to_owned() } else { words.join(", ") };
            format!("`{}` {verb} {words}", all.text)
        };
        let error = Diagnostic::error("nothing-matched", arrow.span, message)
            .note(side(from, from.sends().collect(), "sends"))
            .note(side(to, to.takes().collect(), "takes"));
        self.diagnostics.push(error);
        self.suppressed.extend(to.takes().map(|port| port.place));
    }
}

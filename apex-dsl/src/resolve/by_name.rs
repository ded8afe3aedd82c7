//! Connections by name: `a.* -> b.*;` connects each port of `a` that sends tokens with the port of `b` that takes them
//! and has the same name.

use super::{
    builder::{Body, Builder},
    ends::{All, Chosen, End, without_ports},
    standard::own_node,
    table::{Candidate, Symbol, Table},
};
use crate::{
    graph::WireEnd,
    report::Diagnostic,
    source::Span,
    syntax::tree::{AllPorts, Arrow, Ident, PortsOf},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    rc::Rc,
};

impl Builder<'_> {
    /// The ports for which an endpoint with `.*` stands. `None` stands for an error. Parameters are not among them.
    pub fn all_ports(&mut self, body: &Body<'_>, table: &Table, all: &AllPorts) -> Option<All> {
        self.look(body.item.ports.len(), all.span)?;
        let own = |sends: bool| table.own_ports().filter(|port| port.kind.sends() == sends).cloned().collect();
        let (node, name, ports) = match &all.of {
            // Seen from inside, the inputs of the graph send.
            PortsOf::In => (None, "in", own(true)),
            PortsOf::Out => (None, "out", own(false)),
            PortsOf::Node(name) => (Some(name.text.clone()), &*name.text, self.ports_of(body, table, name, all.span)?),
        };
        Some(All { node, text: format!("{name}.*"), span: all.span, ports })
    }

    fn ports_of(&mut self, body: &Body<'_>, table: &Table, name: &Ident, span: Span) -> Option<Vec<Candidate>> {
        let error = match table.get(&name.text) {
            Some((Symbol::Ports(_, ports), _)) => {
                self.look(ports.len(), span)?;
                return Some(ports.iter().filter(|port| !port.parameter).cloned().collect());
            }
            Some((Symbol::Broken, _)) => return None,
            Some((Symbol::Own(_), _)) => {
                without_ports(name, span).note("`in.*` and `out.*` stand for the ports of this graph")
            }
            None if own_node(&name.text).is_some() => {
                let message = format!("`{}` is a single port: write it without `.*`", name.text);
                Diagnostic::error("wrong-wildcard", span, message)
            }
            None => {
                self.unknown_name(body, table, name);
                return None;
            }
        };
        self.diagnostics.push(error);
        None
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
            let exchange = [from, to].into_iter().find_map(|all| self.exchange(body, all.node.as_ref()?, arrow.span));
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
                let (sender, taker) = (from.name(source), to.name(target));
                let sender = Chosen { text: &sender, span: from.span, port: source };
                self.wire(sender, Chosen { text: &taker, span: to.span, port: target }, arrow, true, None);
            }
        }
    }

    /// Suppresses errors about missing connections to the ports: they could not be made, which has been reported.
    pub fn suppress_all(&mut self, to: &All) {
        self.suppressed.extend(to.takes().map(|port| port.place));
    }

    /// Reports `.*` at one end of an arrow only.
    pub fn one_sided(&mut self, one: &End, all: &All) {
        let message = format!("`{}` is connected with `{}`, which is not followed by `.*`", all.text, one.text);
        let error = Diagnostic::error("wrong-wildcard", all.span, message).also(one.span, "no `.*` here");
        self.diagnostics.push_once(error.note("write `.*` at both ends, or name each port"));
    }

    /// Reports `=>` between ends with `.*`.
    fn activity_by_name(&mut self, arrow: &Arrow, to: &All) {
        self.suppress_all(to);
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
        self.suppress_all(to);
    }
}

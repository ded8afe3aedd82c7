//! Unknown names: finds the one that was misspelt, and the place at which to report it.

use super::{
    builder::{Body, Builder},
    suggest::{Known, everywhere, suggest, unknown},
    table::{Candidate, Owner, Symbol, Table, list},
};
use crate::{
    graph::{Standard, WireEnd},
    report::{Diagnostic, nearest_within},
    source::Span,
    syntax::tree::{Ident, PortKind, PortRef},
};

/// Names that people give to the slot that makes a node active.
const ACTIVITY: [&str; 6] = ["activate", "begin", "go", "on", "run", "start"];

impl Builder<'_> {
    /// Reports a name in a graph body that is neither a node nor a port.
    pub fn unknown_name(&mut self, body: &Body<'_>, table: &Table, word: &Ident) {
        // One message covers all uses of the name in the graph, however often the graph is instantiated.
        if !self.unknown.insert((body.id, word.text.clone())) {
            return;
        }
        let firsts = body.item.names();
        let mut uses: Vec<Span> = firsts.iter().filter(|first| first.text == word.text).map(|i| i.span).collect();
        uses.sort_unstable();
        let near = nearest_within(&word.text, table.names(), 2);
        let is_port = near.is_some_and(|near| body.item.ports.iter().any(|port| port.name.text == near));
        let known: Vec<Known<'_>> = table
            .names()
            .map(|name| Known {
                name,
                declared: table.get(name).map(|(_, span)| span),
                used: firsts.iter().any(|first| first.text == name),
            })
            .collect();
        let message = format!("there is no node or port `{}` in this graph", word.text);
        // The name of a port is also used by the graphs around.
        let code = if is_port { "unknown-port" } else { "unknown-node" };
        let all = if is_port { self.uses_of_port(body.id.file, word, body.item.extent) } else { uses.clone() };
        let error = unknown(code, message.clone(), word, &all, &known).unwrap_or_else(|| {
            let declare = format!(
                "declare it with `node {} = …;`, or write the node in place with `()` after its name",
                word.text
            );
            everywhere("unknown-node", message, word.span, &uses).note(declare)
        });
        // The declaration may be in a statement that could not be read.
        self.diagnostics.push(Diagnostic { declared_in: Some(body.item.extent), ..error });
    }

    /// Reports a port that the node or nested graph `node` does not have.
    pub fn unknown_port(&mut self, body: &Body<'_>, (node, port): (&Ident, &Ident), symbol: &Symbol) {
        let Symbol::Ports(owner, ports) = symbol else { return };
        let references = body.item.references();
        let named: Vec<&Ident> = references.iter().filter_map(|reference| port_of(reference, &node.text)).collect();
        let mut uses: Vec<Span> = named.iter().filter(|name| name.text == port.text).map(|name| name.span).collect();
        let near = nearest_within(&port.text, ports.iter().map(|p| p.name.as_str()), 2);
        let declared = ports.iter().find(|p| Some(p.name.as_str()) == near).and_then(|p| self.declaration(*owner, p));
        if let Some((declared, false)) = declared {
            uses = self.uses_of_port(body.id.file, port, declared);
        }
        let known: Vec<Known<'_>> = ports
            .iter()
            .map(|candidate| {
                let used = named.iter().any(|name| name.text == candidate.name);
                let declared = self.declaration(*owner, candidate);
                Known {
                    name: &candidate.name,
                    declared: declared.map(|(span, _)| span),
                    used: used || declared.is_some_and(|(_, used)| used),
                }
            })
            .collect();
        let message = format!("`{}` has no port `{}`", node.text, port.text);
        let error = unknown("unknown-port", message.clone(), port, &uses, &known).unwrap_or_else(|| {
            let error = Diagnostic::error("unknown-port", port.span, message);
            self.suggest_standard(error, body, (*owner, ports), port)
        });
        let shown: Vec<&Candidate> = ports.iter().filter(|p| !p.parameter).collect();
        let error = error.note(match list(&shown) {
            ports if ports.is_empty() => format!("`{}` has no ports", node.text),
            ports => format!("`{}` has {ports}", node.text),
        });
        let is_standard = Standard::ALL.iter().any(|standard| standard.name() == port.text);
        self.diagnostics.push(match (is_standard, owner) {
            (true, Owner::Scope(_)) => error.note("nodes have this port, but nested graphs do not"),
            (true, Owner::Node(_)) => error.note("a node with `each` has only the ports of its body"),
            _ => error,
        });
    }

    /// Adds the standard port that may be meant by `port` as a fix: one that resembles it, or `enable` for the activity
    /// of a node without slots.
    fn suggest_standard(
        &self,
        error: Diagnostic,
        body: &Body<'_>,
        (owner, ports): (Owner, &[Candidate]),
        port: &Ident,
    ) -> Diagnostic {
        let standards = self.standards_at(body, owner, port);
        let has_slot = ports.iter().any(|port| port.kind == PortKind::Slot);
        let is_activity = ACTIVITY.contains(&port.text.as_str()) && standards.contains(&Standard::Enable);
        if is_activity && !has_slot && matches!(owner, Owner::Node(_)) {
            let help = "a node without slots gets activity by `enable`, which every node has";
            return error.guess(help, port.span, Standard::Enable.name());
        }
        suggest(error, port, standards.into_iter().map(Standard::name))
    }

    /// The standard ports of `owner` that can be where `port` is written: slots behind an arrow, events before one.
    fn standards_at(&self, body: &Body<'_>, owner: Owner, port: &Ident) -> Vec<Standard> {
        let place = body.item.chains.iter().find_map(|chain| {
            let at = chain.ends.iter().position(|end| end.span().contains(port.span))?;
            Some((at > 0, at + 1 < chain.ends.len()))
        });
        let (takes, sends) = place.unwrap_or((true, true));
        let fits = |standard: &Standard| if standard.kind().sends() { sends } else { takes };
        Standard::ALL.into_iter().filter(|standard| self.has_standard(owner, *standard) && fits(standard)).collect()
    }

    /// The places in source file `file` that use the port name: behind the name of a node, or inside the graph at
    /// `inside`.
    fn uses_of_port(&self, file: usize, port: &Ident, inside: Span) -> Vec<Span> {
        let mut uses = vec![];
        for graph in &self.texts.files[file].1.graphs {
            let is_inside = graph.extent.start <= inside.start && inside.end <= graph.extent.end;
            for reference in graph.references() {
                let named = reference.parts.iter().skip(usize::from(!is_inside));
                uses.extend(named.filter(|name| name.text == port.text).map(|name| name.span));
            }
        }
        uses.sort_unstable();
        uses
    }

    /// Place of the declaration of a nested graph's port, and `true` if a wire uses the port.
    fn declaration(&self, owner: Owner, port: &Candidate) -> Option<(Span, bool)> {
        let (Owner::Scope(_), WireEnd::Pin(pin)) = (owner, port.place) else { return None };
        let span = self.pins[pin].span;
        let used = self.wires.iter().any(|wire| wire.from == port.place || wire.to == port.place);
        Some((span, used))
    }
}

/// The port of `node` that a reference names.
fn port_of<'a>(reference: &'a PortRef, node: &str) -> Option<&'a Ident> {
    match reference.parts.as_slice() {
        [first, port] if first.text == node => Some(port),
        _ => None,
    }
}

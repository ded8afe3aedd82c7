//! Unknown names: finds the one that was misspelt, and the place at which to report it.

use super::{
    instance::{Body, Builder},
    table::{Candidate, Owner, Symbol, Table},
};
use crate::{
    graph::{Standard, WireEnd},
    report::{Diagnostic, nearest, nearest_within},
    source::Span,
    syntax::tree::{Ident, PortRef},
};

/// Largest number of places that one message shows.
const MAX_PLACES: usize = 8;

/// A name that may have been meant.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// The name.
    pub name: &'a str,
    /// Place of its declaration in the source files.
    pub declared: Option<Span>,
    /// `true` if it is used.
    pub used: bool,
}

impl<'a> Known<'a> {
    /// A name that is not declared in the source files.
    pub fn elsewhere(name: &'a str) -> Self {
        Self { name, declared: None, used: true }
    }
}

/// An error about an unknown name, for all places where it is used.
pub fn everywhere(code: &'static str, message: String, word: Span, uses: &[Span]) -> Diagnostic {
    let (first, others) = uses.split_first().unwrap_or((&word, &[]));
    let message = match others.len() {
        0 => message,
        1 => format!("{message}, here and in another place"),
        n => format!("{message}, here and in {n} other places"),
    };
    let error = Diagnostic::error(code, *first, message);
    others.iter().take(MAX_PLACES).fold(error, |error, place| error.also(*place, "here too"))
}

/// An error about `word`, which is used at `uses` and resembles a known name; `None` if it resembles none. If that name
/// is not used, but `word` is used in several places, the declaration is considered misspelt.
pub fn unknown(
    code: &'static str,
    message: String,
    word: &Ident,
    uses: &[Span],
    known: &[Known<'_>],
) -> Option<Diagnostic> {
    // A name without uses may be meant even if it is less similar.
    let unused = known.iter().filter(|known| !known.used && known.declared.is_some()).map(|known| known.name);
    let near = nearest(&word.text, known.iter().map(|known| known.name));
    let near = near.or_else(|| nearest_within(&word.text, unused, 2))?;
    let near = known.iter().find(|known| known.name == near)?;
    let title = |name: &str| format!("did you mean `{name}`?");
    Some(match near.declared.filter(|_| !near.used) {
        Some(declared) if uses.len() > 1 => misspelt(code, declared, near.name, &word.text, uses[0]),
        Some(declared) => Diagnostic::error(code, word.span, message)
            .also(declared, format!("`{}` is not used", near.name))
            .guess(title(near.name), word.span, near.name),
        None => Diagnostic::error(code, word.span, message).guess(title(near.name), word.span, near.name),
    })
}

/// An error about a declaration: a name similar to the declared one is used instead.
fn misspelt(code: &'static str, declared: Span, name: &str, word: &str, used: Span) -> Diagnostic {
    let message = format!("`{name}` is declared here, but `{word}` is used");
    Diagnostic::error(code, declared, message).also(used, "for example here").guess(
        format!("did you mean `{word}`?"),
        declared,
        word,
    )
}

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
        let error = unknown("unknown-port", message.clone(), port, &uses, &known)
            .unwrap_or_else(|| Diagnostic::error("unknown-port", port.span, message));
        let shown: Vec<&Candidate> = ports.iter().filter(|p| !p.parameter).collect();
        let error = error.note(match super::connect::list(&shown) {
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

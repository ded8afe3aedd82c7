//! Connections as written: the choice of ports that are not named, and the comparison of their types.

use super::{
    builder::{Body, Builder},
    ends::{All, Chosen, End, without_ports},
    given,
    link::{Link, Side},
    mismatch,
    standard::own_node,
    table::{Candidate, Symbol, Table, list},
};
use crate::{
    catalog::{Match, Type},
    graph::{self, Given, NodeKind, Port, PortId, Wire, WireEnd, snake},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Arrow, Endpoint, Expr, GraphItem, Ident, PortKind, PortRef, PortsOf},
};
use std::rc::Rc;

/// Meaning of an end of a chain.
#[derive(Debug, Clone)]
enum Meaning {
    One(End),
    /// Shared, because a list makes many pairs of them.
    All(Rc<All>),
}

/// An endpoint of a connection: the ports that it may stand for, and its place.
struct EndpointCandidates {
    candidates: Vec<Candidate>,
    explicit: bool,
    /// All ports of the node, as text.
    all: String,
    name: String,
    span: Span,
}

impl Builder<'_> {
    /// Resolves all chains of a graph body.
    pub fn chains(&mut self, body: &Body<'_>, table: &Table) {
        let (mut in_place, mut by_name, first) = (0, vec![], self.wires.len());
        for chain in &body.item.chains {
            // Ends that name nothing count, too.
            if self
                .look(chain.ends.len(), chain.arrows.first().map_or(body.item.name.span, |arrow| arrow.span))
                .is_none()
            {
                return;
            }
            // A node that is written in place is made once, although it is an end of two arrows.
            let ends: Vec<Vec<Option<Meaning>>> =
                chain.ends.iter().map(|end| self.endpoint(body, table, end, &mut in_place)).collect();
            for (i, arrow) in chain.arrows.iter().enumerate() {
                if ends[i].iter().any(Option::is_none) {
                    ends[i + 1].iter().flatten().for_each(|to| self.suppress_end(to));
                }
                let open =
                    [i == 0 && is_named(&chain.ends[0]), i + 2 == chain.ends.len() && is_named(&chain.ends[i + 1])];
                for from in ends[i].iter().flatten() {
                    for to in ends[i + 1].iter().flatten() {
                        match (from, to) {
                            (Meaning::One(from), Meaning::One(to)) => {
                                let exchange =
                                    [from, to].into_iter().find_map(|end| self.exchange(body, end.node(), arrow.span));
                                self.at_exchange(exchange, |this| this.connect(body, from, to, arrow, open));
                            }
                            (Meaning::All(from), Meaning::All(to)) => {
                                if self.look(from.count() + to.count() + 1, arrow.span).is_none() {
                                    return;
                                }
                                by_name.push((Rc::clone(from), Rc::clone(to), *arrow));
                            }
                            (Meaning::One(one), Meaning::All(all)) | (Meaning::All(all), Meaning::One(one)) => {
                                self.one_sided(one, all);
                                self.suppress_end(to);
                            }
                        }
                        if self.is_exhausted() {
                            return;
                        }
                    }
                }
            }
            if self.is_exhausted() {
                return;
            }
        }
        self.connect_by_name(body, &by_name, first);
    }

    /// Place of the node that stands for `name` in a statement at `at`, if a variant or a test has exchanged it: there
    /// is the cause of a connection that does not fit.
    pub fn exchange(&self, body: &Body<'_>, name: &str, at: Span) -> Option<Span> {
        if !self.replaced.is_empty() {
            let path = graph::path(&self.scopes, body.scope, Some(name));
            if let Some(instance) = self.replaced.get(&path) {
                return Some(instance.span);
            }
        }
        let variant = self.texts.variant(body.id)?;
        variant.exchanged.get(name).copied().filter(|_| !body.item.extent.contains(at))
    }

    /// Calls `act`, whose messages are moved to the place of an exchange if there is one.
    pub fn at_exchange<T>(&mut self, exchange: Option<Span>, act: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.diagnostics.anchor(exchange);
        let result = act(self);
        self.diagnostics.anchor(before);
        result
    }

    /// Meanings of one end of a chain. `None` stands for an error.
    fn endpoint(
        &mut self,
        body: &Body<'_>,
        table: &Table,
        end: &Endpoint,
        in_place: &mut usize,
    ) -> Vec<Option<Meaning>> {
        match end {
            Endpoint::List(ends, _) => ends.iter().flat_map(|end| self.endpoint(body, table, end, in_place)).collect(),
            Endpoint::Port(reference, given) => {
                vec![self.port(body, table, reference, given.as_deref()).map(Meaning::One)]
            }
            Endpoint::All(all) => vec![self.all_ports(body, table, all).map(Rc::new).map(Meaning::All)],
            Endpoint::Instance(instance) => {
                if let [port] = instance.path.segments.as_slice()
                    && (table.get(&port.text).is_some() || own_node(&port.text).is_some())
                {
                    if let Some((reference, given)) = instance.as_given() {
                        return vec![self.port(body, table, &reference, Some(given)).map(Meaning::One)];
                    }
                    if self.constructor(&instance.path).is_err() {
                        self.diagnostics.push(given::no_value(port, instance));
                        return vec![None];
                    }
                }
                *in_place += 1;
                let word = instance.path.segments.last().map_or("node", |s| s.text.as_str());
                let mut text = format!("{}_{in_place}", snake(word));
                while table.get(&text).is_some() {
                    text.push('_');
                }
                let name = Ident { text, span: instance.path.span };
                let symbol = self.instance(body, &name, instance, "");
                let end = |symbol| End { symbol, text: instance.path.text(), span: instance.path.span, given: None };
                vec![symbol.map(end).map(Meaning::One)]
            }
        }
    }

    /// A port, with the value that is given to it.
    fn port(&mut self, body: &Body<'_>, table: &Table, reference: &PortRef, given: Option<&Expr>) -> Option<End> {
        let end = self.reference(body, table, reference);
        let Some(given) = given else { return end };
        let given = self.given(body, given)?;
        Some(End { given: Some(Box::new(given)), ..end? })
    }

    fn reference(&mut self, body: &Body<'_>, table: &Table, reference: &PortRef) -> Option<End> {
        let first = reference.parts.first()?;
        let end = |symbol| End { symbol, text: reference.text(), span: reference.span, given: None };
        let Some((symbol, _)) = table.get(&first.text) else {
            if let (Some(kind), [_]) = (own_node(&first.text), reference.parts.as_slice()) {
                let node = self.own_node(body, first, kind)?;
                return Some(end(Symbol::of_node(node, &self.nodes[node])));
            }
            self.unknown_name(body, table, first);
            return None;
        };
        match symbol {
            Symbol::Broken => return None,
            Symbol::Ports(_, ports) => self.look(ports.len(), reference.span)?,
            Symbol::Own(_) => {}
        }
        match (symbol, &reference.parts[1..]) {
            (symbol, []) => Some(end(symbol.clone())),
            (Symbol::Ports(owner, ports), [port]) => {
                let mut named: Vec<Candidate> = ports.iter().filter(|p| p.name == port.text).cloned().collect();
                if named.is_empty() {
                    named.extend(self.standard_port(*owner, port));
                }
                if named.is_empty() {
                    let exchange = self.exchange(body, &first.text, reference.span);
                    self.at_exchange(exchange, |this| this.unknown_port(body, (first, port), symbol));
                    self.suppress(symbol);
                    return None;
                }
                Some(end(Symbol::Ports(*owner, named)))
            }
            (_, rest) => {
                let span = rest[rest.len() - 1].span;
                let error = if matches!(symbol, Symbol::Own(_)) {
                    without_ports(first, span)
                } else {
                    let message = "a nested graph can only be connected through its ports";
                    Diagnostic::error("unknown-port", span, message)
                };
                self.diagnostics.push(error);
                None
            }
        }
    }

    /// Handles `start => node`: the node is initially active, and no token is sent. Returns `false` for any other
    /// connection, and for a node with a slot for the token, which is sent as by any other event then.
    fn starts_active(&mut self, body: &Body<'_>, from: &End, to: &End, arrow: &Arrow) -> bool {
        let (Symbol::Ports(_, from), Symbol::Ports(_, to_ports)) = (&from.symbol, &to.symbol) else { return false };
        let is_start = from
            .iter()
            .any(|c| matches!(c.place, WireEnd::Port(end) if matches!(self.nodes[end.node].kind, NodeKind::Start)));
        // The type of a generic slot is determined by its other connections, if there are any.
        let takes = |c: &Candidate| {
            let decided = matches!(c.ty, Type::Param(_)) && is_fed(body.item, &to.text);
            c.kind == PortKind::Slot && !decided && c.ty.compare(&Type::unit()) != Match::Different
        };
        if !is_start || !arrow.active || to.text.contains('.') || to_ports.iter().any(takes) {
            return false;
        }
        match to_ports.first().map(|c| c.place) {
            Some(WireEnd::Port(end)) if matches!(self.nodes[end.node].kind, NodeKind::Library(_)) => {
                self.nodes[end.node].starts_active = true;
                true
            }
            _ => false,
        }
    }

    /// Connects two ends of a chain. `open` is `true` for each end where a port can be named: a node that is written in
    /// place has no name, and a port that is named inside a chain would be used by the next arrow, too.
    fn connect(&mut self, body: &Body<'_>, from: &End, to: &End, arrow: &Arrow, open: [bool; 2]) {
        let ends = |symbol: &Symbol| if let Symbol::Ports(_, ports) = symbol { ports.len() } else { 1 };
        if self.look(ends(&from.symbol) + ends(&to.symbol), arrow.span).is_none() {
            return;
        }
        if let Some(given) = &from.given {
            self.refuse_given(given, &from.text);
            return self.suppress(&to.symbol);
        }
        if to.given.is_none() && self.starts_active(body, from, to, arrow) {
            return;
        }
        let sources = meant(from, true);
        let targets = meant(to, false);
        // A port that is named decides which port is meant at the other end; so do types.
        let Some((source, target)) = self.choose(sources, targets, open, to.given.is_some()) else {
            return self.suppress(&to.symbol);
        };
        if let Some(given) = to.given.as_ref().filter(|_| target.kind != PortKind::Slot) {
            self.diagnostics.push_once(given::no_slot(given, &to.text));
            return self.suppress(&to.symbol);
        }
        self.wire(from.chosen(&source), to.chosen(&target), arrow, false, to.given.clone());
    }

    /// Connects two ports and reports different types. `by_name` is `true` if `.*` stands at the ends.
    pub fn wire(&mut self, from: Chosen<'_>, to: Chosen<'_>, arrow: &Arrow, by_name: bool, given: Option<Box<Given>>) {
        let differs = given.is_none() && from.port.ty.compare(&to.port.ty) == Match::Different;
        if differs {
            let error = self.mismatch(from, to, arrow);
            let name = &to.port.name;
            match by_name {
                true => {
                    self.diagnostics.push(error.note(format!("`.*` connects them because both are called `{name}`")))
                }
                // All connections of a list of ends have the same arrow.
                false => self.diagnostics.push_once(error),
            }
        }
        let (active, span) = (arrow.active, arrow.span);
        let end = self.free_input(to.port.place);
        self.wires.push(Wire { from: from.port.place, to: end, active, differs, given, span });
        let is_outermost = self.open.len() == 1;
        let Some(links) = self.links.as_mut().filter(|_| is_outermost) else { return };
        let side = |Chosen { text, port, .. }: Chosen<'_>| {
            let is_named = text == port.name || text.contains('.');
            let name = if is_named { text.to_owned() } else { format!("{text}.{}", port.name) };
            Side { name, kind: port.kind, ty: port.ty.clone() }
        };
        links.push(Link { arrow: span, active, by_name, from: side(from), to: side(to) });
    }

    /// The port that a connection to `place` takes: if the node takes any number of inputs there, the next one.
    fn free_input(&mut self, place: WireEnd) -> WireEnd {
        let WireEnd::Port(PortId { node, port }) = place else { return place };
        let ports = &mut self.nodes[node].ports;
        if ports[port].element_of.is_none() || self.arrays.insert(place) {
            return place;
        }
        let number = ports.iter().filter(|other| other.element_of == Some(port)).count();
        let element = Port { name: format!("{}[{number}]", ports[port].name), ..ports[port].clone() };
        ports.push(element);
        WireEnd::Port(PortId { node, port: ports.len() - 1 })
    }

    fn suppress_end(&mut self, to: &Meaning) {
        match to {
            Meaning::One(end) => self.suppress(&end.symbol),
            Meaning::All(all) => self.suppress_all(all),
        }
    }

    /// Suppresses errors about a missing connection to `to`: it could not be made, which has been reported.
    fn suppress(&mut self, to: &Symbol) {
        match to {
            Symbol::Ports(_, ports) => {
                self.suppressed.extend(ports.iter().filter(|p| !p.kind.sends()).map(|p| p.place))
            }
            Symbol::Own(own) => self.suppressed.extend([own.place]),
            Symbol::Broken => {}
        }
    }

    fn choose(
        &mut self,
        from: EndpointCandidates,
        to: EndpointCandidates,
        open: [bool; 2],
        is_given: bool,
    ) -> Option<(Candidate, Candidate)> {
        let fits = |a: &Candidate, b: &Candidate| is_given || a.ty.compare(&b.ty) != Match::Different;
        let narrow = |side: &EndpointCandidates, other: &EndpointCandidates| -> Vec<Candidate> {
            match side.candidates.as_slice() {
                [one] => vec![one.clone()],
                several => several.iter().filter(|c| other.candidates.iter().any(|o| fits(c, o))).cloned().collect(),
            }
        };
        let (sources, targets) = (narrow(&from, &to), narrow(&to, &from));
        match (sources.as_slice(), targets.as_slice()) {
            ([source], [target]) => Some((source.clone(), target.clone())),
            ([_], _) => {
                self.ambiguous(&to, &targets, &from, ["takes", "take", "sends"], open[1]);
                None
            }
            _ => {
                self.ambiguous(&from, &sources, &to, ["sends", "send", "takes"], open[0]);
                None
            }
        }
    }

    fn ambiguous(
        &mut self,
        meant: &EndpointCandidates,
        fitting: &[Candidate],
        other: &EndpointCandidates,
        [one, many, opposite]: [&str; 3],
        open: bool,
    ) {
        let name = &meant.name;
        let error = match (meant.candidates.len(), fitting.len()) {
            (0, _) if meant.explicit => {
                let message = format!("`{name}` {one} no tokens: it {opposite} them");
                let error = Diagnostic::error("wrong-direction", meant.span, message);
                // Seen from inside, the ports of the graph itself have the opposite direction.
                let own =
                    "inside a graph, its `in` and `slot` ports send tokens, and its `out` and `event` ports take them";
                if name.contains('.') { error } else { error.note(own) }
            }
            (0, _) => {
                Diagnostic::error("wrong-direction", meant.span, format!("`{name}` has no port that {one} tokens"))
                    .note(match meant.all.as_str() {
                        "" => format!("`{name}` has no ports"),
                        all => format!("`{name}` has {all}"),
                    })
            }
            (_, 0) => {
                let all: Vec<&Candidate> = meant.candidates.iter().collect();
                let message = format!("no port of `{name}` has a type that fits `{}`", other.name);
                let others: Vec<&Candidate> = other.candidates.iter().collect();
                let error = Diagnostic::error("type-mismatch", meant.span, message)
                    .also(other.span, format!("has {}", list(&others)))
                    .note(format!("`{name}` has {}", list(&all)));
                let ends = [(all.first(), name), (others.first(), &other.name)];
                let declared = ends.into_iter().filter_map(|(c, name)| Some(self.declared(c?, &format!("`{name}`"))));
                declared.fold(error, Diagnostic::note)
            }
            _ => {
                let message = format!("`{name}` has several ports that could {many} this: name one");
                let error = Diagnostic::error("ambiguous-port", meant.span, message);
                let all: Vec<&Candidate> = fitting.iter().collect();
                let error = error.note(format!("`{name}` has {}", list(&all)));
                let fitting = if open { fitting } else { &[] };
                let error = match open {
                    true => error,
                    false => error.note(
                        "declare it with `node name = …;` and split the chain there, so that each part can name its port: `name.port`",
                    ),
                };
                fitting.iter().take(4).fold(error, |error, c| {
                    error.guess(format!("use `{}`", c.name), meant.span.after(), format!(".{}", c.name))
                })
            }
        };
        self.diagnostics.push(error);
    }

    /// The error for ends with different types.
    fn mismatch(&self, from: Chosen<'_>, to: Chosen<'_>, arrow: &Arrow) -> Diagnostic {
        let (a, b) = (self.describe(from.port, from.text), self.describe(to.port, to.text));
        let (sent, taken) = (&from.port.ty, &to.port.ty);
        let message = format!("{a} sends `{sent}`, but {b} takes `{taken}`");
        let error = Diagnostic::error(mismatch::code(sent, taken), arrow.span, message)
            .also(from.span, format!("sends `{sent}`"))
            .also(to.span, format!("takes `{taken}`"))
            .note(self.declared(from.port, &a))
            .note(self.declared(to.port, &b));
        mismatch::remedy(error, sent, taken, arrow.span, arrow.active, self.catalog)
    }

    fn describe(&self, candidate: &Candidate, written: &str) -> String {
        let node = written.split('.').next().unwrap_or(written);
        if node == candidate.name { format!("`{node}`") } else { format!("`{node}.{}`", candidate.name) }
    }

    fn declared(&self, candidate: &Candidate, name: &str) -> String {
        match candidate.place {
            WireEnd::Port(end) => match &self.nodes[end.node].kind {
                NodeKind::Library(library) => {
                    let signature = &self.catalog.signatures[library.signature];
                    format!(
                        "{name} is declared at {}:{} (`{}`)",
                        signature.file.display(),
                        signature.line,
                        signature.name
                    )
                }
                NodeKind::Start => format!("{name} is where activity begins; every graph has it"),
                NodeKind::Watchdog => format!("{name} is the event that reports a hanging node; every graph has it"),
                NodeKind::SetBack => format!("{name} is the event that the time has gone back; every graph has it"),
                _ => format!("{name} is a port of this graph"),
            },
            WireEnd::Pin(pin) => format!("{name} is a port of the graph `{}`", self.scopes[self.pins[pin].scope].graph),
        }
    }
}

/// Returns `true` if the ends are names, to which that of a port can be added.
fn is_named(end: &Endpoint) -> bool {
    match end {
        Endpoint::Port(..) => true,
        Endpoint::List(ends, _) => ends.iter().all(is_named),
        Endpoint::All(_) | Endpoint::Instance(_) => false,
    }
}

/// Returns `true` if a connection leads to the node `name` in this graph from anything but `start`.
fn is_fed(graph: &GraphItem, name: &str) -> bool {
    fn names(end: &Endpoint, name: &str) -> bool {
        match end {
            Endpoint::Port(reference, _) => reference.parts.first().is_some_and(|first| first.text == name),
            Endpoint::All(all) => matches!(&all.of, PortsOf::Node(node) if node.text == name),
            Endpoint::List(ends, _) => ends.iter().any(|end| names(end, name)),
            Endpoint::Instance(_) => false,
        }
    }
    let steps = graph.chains.iter().flat_map(|chain| chain.ends.windows(2));
    steps.into_iter().any(|step| names(&step[1], name) && !names(&step[0], "start"))
}

/// The ports that an endpoint may stand for, among those that send or those that take. Parameters count only if they
/// are named.
fn meant(end: &End, sends: bool) -> EndpointCandidates {
    let End { symbol, text: name, span, .. } = end;
    let explicit = name.contains('.');
    let candidates = match symbol {
        Symbol::Own(candidate) if candidate.kind.sends() == sends => vec![candidate.clone()],
        Symbol::Ports(_, ports) => {
            let side: Vec<Candidate> =
                ports.iter().filter(|p| p.kind.sends() == sends && (explicit || !p.parameter)).cloned().collect();
            // A port hides a parameter of the same name.
            if side.len() > 1 && explicit { side.into_iter().filter(|p| !p.parameter).collect() } else { side }
        }
        _ => vec![],
    };
    let all = match symbol {
        // The list is shown only if there are no candidates.
        Symbol::Ports(_, ports) if candidates.is_empty() => {
            list(&ports.iter().filter(|p| !p.parameter).collect::<Vec<_>>())
        }
        _ => String::new(),
    };
    EndpointCandidates {
        candidates,
        all,
        explicit: explicit || matches!(symbol, Symbol::Own(_)),
        name: name.clone(),
        span: *span,
    }
}

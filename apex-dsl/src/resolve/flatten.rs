//! Flattening: wires through ports of nested graphs become connections between nodes.

use super::{budget::MAX_NODES, builder::Builder};
use crate::{
    graph::{Connection, ConnectionId, Crossing, NodeId, NodeKind, Pin, Port, PortId, ScopeId, Wire, WireEnd},
    index::IdVec,
    report::Diagnostic,
    syntax::tree::{Ident, PortKind},
};
use std::collections::{BTreeMap, BTreeSet};

/// Replaces all pins by the ports that are connected through them. Also returns the nodes with an input at a pin
/// without tokens.
pub fn wires(builder: &mut Builder<'_>) -> (IdVec<ConnectionId, Connection>, BTreeSet<NodeId>) {
    let mut wires = builder.wires.clone();
    check_single(builder, &wires);
    add_relays(builder, &mut wires);
    let mut into: BTreeMap<WireEnd, Vec<usize>> = BTreeMap::new();
    for (i, wire) in wires.iter().enumerate() {
        into.entry(wire.to).or_default().push(i);
    }
    check_pins(builder, &into, &wires);
    let mut connections = IdVec::default();
    let mut seen = BTreeSet::new();
    for wire in &wires {
        let WireEnd::Port(to) = wire.to else { continue };
        // Follow the wire upstream to the ports where it begins. Each pin is visited once, because pins may form a
        // cycle.
        let mut ends = vec![(wire.from, wire.active, wire.differs, &wire.given, false, vec![])];
        let mut visited = BTreeSet::new();
        while let Some((place, active, differs, given, relayed, crossings)) = ends.pop() {
            match place {
                WireEnd::Port(from) => {
                    // Several ways from port to port are one connection, but each way to a slot delivers a token.
                    let to_slot = builder.nodes[to.node].ports[to.port].kind == PortKind::Slot;
                    if seen.insert((from, to)) || to_slot {
                        // The crossings were collected against the direction of the tokens.
                        let crossings = crossings.into_iter().rev().collect();
                        let (given, span) = (given.clone(), wire.span);
                        connections.push(Connection { from, to, active, differs, given, crossings, relayed, span });
                    }
                }
                WireEnd::Pin(pin) if visited.insert(place) => {
                    let relayed = relayed || !builder.pins[pin].kind.is_synchronous();
                    // The ports of other kinds pass each token alone, so that it does not cross the boundary together
                    // with others.
                    let side = builder.pins[pin].kind.is_synchronous().then(|| crossing(&builder.pins[pin]));
                    let crossings: Vec<Crossing> = crossings.into_iter().chain(side).collect();
                    for &up in into.get(&place).into_iter().flatten() {
                        let wire = &wires[up];
                        // One `->` on the way suffices to stop activity.
                        let (active, differs) = (active && wire.active, differs || wire.differs);
                        // A value hides what came before it.
                        let given = if given.is_some() { given } else { &wire.given };
                        ends.push((wire.from, active, differs, given, relayed, crossings.clone()));
                    }
                }
                WireEnd::Pin(_) => {}
            }
        }
        if connections.len() > 4 * MAX_NODES {
            let message = format!("this program has more than {} connections", 4 * MAX_NODES);
            builder.diagnostics.push(Diagnostic::error("too-large", wire.span, message));
            break;
        }
    }
    let fed: BTreeSet<PortId> = connections.iter().map(|c| c.to).collect();
    let hanging = wires.iter().filter_map(|w| match (w.from, w.to) {
        (WireEnd::Pin(_), WireEnd::Port(end)) if !fed.contains(&end) => Some(end.node),
        _ => None,
    });
    (connections, hanging.collect())
}

/// Adds relays at ports of nested graphs where the synchronous flow begins or ends. The inputs of a nested graph are
/// taken together and its outputs are sent together, even if an event leads to them or they lead to a slot: the relay
/// takes part in the synchronous flow there. A port that is the only one of its kind needs no relay, because no
/// difference can be observed.
fn add_relays(builder: &mut Builder<'_>, wires: &mut Vec<Wire>) {
    let barred = barred_pins(builder);
    let is_barred = |place| match place {
        WireEnd::Pin(pin) => barred.contains(&pin).then_some(pin),
        WireEnd::Port(_) => None,
    };
    let comes = |w: &Wire| (w.from, w.to);
    let goes = |w: &Wire| (w.to, w.from);
    // Tokens arrive outside the synchronous flow from the places in `comes`, and leave it to the places in `goes`.
    let (comes, goes) = (asynchronous(builder, wires, &barred, comes), asynchronous(builder, wires, &barred, goes));
    let mut behind: BTreeMap<usize, NodeId> = BTreeMap::new();
    for index in 0..wires.len() {
        let Wire { from, to, .. } = wires[index];
        // In front of the pin: each wire to the pin has a relay of its own, as each of them delivers tokens.
        if let Some(pin) = is_barred(to).filter(|_| comes.contains(&from)) {
            let Some(relay) = add_relay(builder, pin, false) else { return };
            let from = WireEnd::Port(PortId { node: relay, port: 1 });
            wires.push(Wire { from, given: None, ..wires[index].clone() });
            wires[index].to = WireEnd::Port(PortId { node: relay, port: 0 });
        }
        // Behind the pin: one relay serves all wires, as the pin sends each token only once.
        if let Some(pin) = is_barred(from).filter(|_| goes.contains(&to)) {
            let relay = match behind.get(&pin) {
                Some(relay) => *relay,
                None => {
                    let Some(relay) = add_relay(builder, pin, true) else { return };
                    let to = WireEnd::Port(PortId { node: relay, port: 0 });
                    wires.push(Wire { to, given: None, ..wires[index].clone() });
                    *behind.entry(pin).or_insert(relay)
                }
            };
            wires[index].from = WireEnd::Port(PortId { node: relay, port: 1 });
        }
    }
}

/// Synchronous pins of nested graphs with several pins of the same kind, which pass their tokens together.
fn barred_pins(builder: &Builder<'_>) -> BTreeSet<usize> {
    let mut ports: BTreeMap<(ScopeId, PortKind), usize> = BTreeMap::new();
    for pin in &builder.pins {
        *ports.entry((pin.scope, pin.kind)).or_default() += 1;
    }
    let is_barred = |pin: &Pin| pin.kind.is_synchronous() && ports[&(pin.scope, pin.kind)] > 1;
    (0..builder.pins.len()).filter(|pin| is_barred(&builder.pins[*pin])).collect()
}

/// Places outside the synchronous flow, and the pins that can be reached from them along `next` without entering the
/// flow.
fn asynchronous(
    builder: &Builder<'_>,
    wires: &[Wire],
    barred: &BTreeSet<usize>,
    next: impl Fn(&Wire) -> (WireEnd, WireEnd),
) -> BTreeSet<WireEnd> {
    let mut behind: BTreeMap<WireEnd, Vec<WireEnd>> = BTreeMap::new();
    for (from, to) in wires.iter().map(next) {
        behind.entry(from).or_default().push(to);
    }
    let mut found: BTreeSet<WireEnd> = behind.iter().flat_map(|(from, to)| to.iter().chain([from])).copied().collect();
    found.retain(|place| !is_synchronous(builder, *place));
    let mut ends: Vec<WireEnd> = found.iter().copied().collect();
    while let Some(place) = ends.pop() {
        // A pin that is the only one of its kind passes tokens on as they come.
        for next in behind.get(&place).into_iter().flatten() {
            let passes = matches!(next, WireEnd::Pin(pin) if !barred.contains(pin));
            if passes && found.insert(*next) {
                ends.push(*next);
            }
        }
    }
    found
}

/// Adds a node that passes on the tokens of a pin: in front of the pin, or `behind` it.
fn add_relay(builder: &mut Builder<'_>, pin: usize, behind: bool) -> Option<NodeId> {
    let Pin { kind, scope, span, ref name, ref ty, .. } = builder.pins[pin];
    let name = Ident { text: format!("{name}_{}", if behind { "relay" } else { "entry" }), span };
    // Tokens behind an input, or in front of an output, are inside the nested graph.
    let inside = (kind == PortKind::Input) == behind;
    let at = if inside { scope } else { builder.scopes[scope].parent };
    let port = |name, kind| Port::new(name, kind, ty.clone());
    let ports = vec![port("in", PortKind::Input), port("out", PortKind::Output)];
    builder.node(&name, at, NodeKind::Relay, ports, "")
}

/// Returns `true` if the tokens at a place belong to the synchronous flow.
fn is_synchronous(builder: &Builder<'_>, place: WireEnd) -> bool {
    match place {
        WireEnd::Port(end) => builder.nodes[end.node].ports[end.port].kind.is_synchronous(),
        WireEnd::Pin(pin) => builder.pins[pin].kind.is_synchronous(),
    }
}

fn crossing(pin: &Pin) -> Crossing {
    match pin.kind {
        PortKind::Input | PortKind::Slot => Crossing::Enter(pin.scope),
        PortKind::Output | PortKind::Event => Crossing::Leave(pin.scope),
    }
}

/// Reports inputs with several connections, and connections that are made twice.
fn check_single(builder: &mut Builder<'_>, wires: &[Wire]) {
    let mut first: BTreeMap<WireEnd, usize> = BTreeMap::new();
    let mut pairs: BTreeMap<(WireEnd, WireEnd), usize> = BTreeMap::new();
    for (i, wire) in wires.iter().enumerate() {
        if builder.diagnostics.is_full() {
            return;
        }
        // A slot may get several values, one after the other.
        if wire.given.is_some() {
            continue;
        }
        if let Some(&before) = pairs.get(&(wire.from, wire.to)) {
            let error = Diagnostic::error(
                "connected-twice",
                wire.span,
                format!("{} is already connected to {}", name(builder, wire.from), name(builder, wire.to)),
            );
            builder
                .diagnostics
                .push(error.also(wires[before].span, "first connected here").note("remove one of the two"));
            continue;
        }
        pairs.insert((wire.from, wire.to), i);
        if !is_input(builder, wire.to) {
            continue;
        }
        match first.get(&wire.to) {
            Some(&before) => {
                let message = format!("{} is connected twice: an input takes one connection", name(builder, wire.to));
                let error = Diagnostic::error("connected-twice", wire.span, message)
                    .also(wires[before].span, "first connected here")
                    .note("`[a, b] -> merge() -> c;` takes the first of them that is not ⊥ (`apex_nodes::flow::merge`); a slot takes several connections");
                builder.diagnostics.push(error);
                excuse_inputs(builder, wire.to);
            }
            None => {
                first.insert(wire.to, i);
            }
        }
    }
}

/// Suppresses errors about the other inputs of a node: one of two connections to one input may be meant for them.
fn excuse_inputs(builder: &mut Builder<'_>, place: WireEnd) {
    match place {
        WireEnd::Port(PortId { node, .. }) => {
            let ports = 0..builder.nodes[node].ports.len();
            builder.suppressed.extend(ports.map(|port| WireEnd::Port(PortId { node, port })));
        }
        WireEnd::Pin(pin) => {
            let scope = builder.pins[pin].scope;
            let pins = 0..builder.pins.len();
            builder.suppressed.extend(pins.filter(|pin| builder.pins[*pin].scope == scope).map(WireEnd::Pin));
        }
    }
}

fn is_input(builder: &Builder<'_>, place: WireEnd) -> bool {
    match place {
        WireEnd::Port(end) => builder.nodes[end.node].ports[end.port].kind == PortKind::Input,
        // An `in` is an input seen from outside, an `out` is one seen from inside.
        WireEnd::Pin(pin) => builder.pins[pin].kind.is_synchronous(),
    }
}

fn name(builder: &Builder<'_>, place: WireEnd) -> String {
    format!("`{}`", place.text(&builder.nodes, &builder.pins, &builder.scopes))
}

/// Reports pins that nothing is connected to although their tokens are needed.
fn check_pins(builder: &mut Builder<'_>, into: &BTreeMap<WireEnd, Vec<usize>>, wires: &[Wire]) {
    let mut out_of: BTreeMap<WireEnd, Vec<WireEnd>> = BTreeMap::new();
    for wire in wires {
        out_of.entry(wire.from).or_default().push(wire.to);
    }
    let mut suppressed = BTreeSet::new();
    for index in 0..builder.pins.len() {
        let place = WireEnd::Pin(index);
        if !into.contains_key(&place) {
            // The error is reported at the pin, not at the places downstream of it.
            let behind = places_behind(&out_of, place).into_iter().filter(|behind| *behind != place);
            suppressed.extend(behind);
        }
        let pin = &builder.pins[index];
        if into.contains_key(&place) || builder.suppressed.contains(&place) {
            continue;
        }
        let scope = &builder.scopes[pin.scope];
        let error = match pin.kind {
            // A slot needs a connection, too, if it leads to a required input inside.
            PortKind::Input | PortKind::Slot if needs_token(builder, &out_of, place) => {
                let message = format!("{} `{}` of `{}` is not connected", pin.kind.word(), pin.name, scope.name);
                Diagnostic::error("open-input", scope.span, message)
                    .also(pin.span, "declared here")
                    .note(format!("connect it: `… -> {}.{};`", scope.name, pin.name))
            }
            PortKind::Output if out_of.contains_key(&place) => {
                let message = format!("nothing inside `{}` is connected to its output `{}`", scope.graph, pin.name);
                Diagnostic::error("open-output", pin.span, message).note(format!("connect it: `… -> {};`", pin.name))
            }
            _ => continue,
        };
        builder.diagnostics.push(error);
    }
    builder.suppressed.extend(suppressed);
}

/// A pin, the pins that its tokens go on to, and the ports at their ends.
fn places_behind(out_of: &BTreeMap<WireEnd, Vec<WireEnd>>, pin: WireEnd) -> BTreeSet<WireEnd> {
    let (mut ends, mut found) = (vec![pin], BTreeSet::new());
    while let Some(place) = ends.pop() {
        if found.insert(place) && matches!(place, WireEnd::Pin(_)) {
            ends.extend(out_of.get(&place).into_iter().flatten());
        }
    }
    found
}

/// Returns `true` if a node behind an unconnected pin requires its tokens.
fn needs_token(builder: &Builder<'_>, out_of: &BTreeMap<WireEnd, Vec<WireEnd>>, pin: WireEnd) -> bool {
    places_behind(out_of, pin).into_iter().any(|place| match place {
        WireEnd::Port(end) => {
            let port = &builder.nodes[end.node].ports[end.port];
            port.kind == PortKind::Input && !port.optional
        }
        WireEnd::Pin(_) => false,
    })
}

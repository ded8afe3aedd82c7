//! Comparison of the frames at both ends of a connection.
//!
//! Ports whose tokens are in one frame, whichever it is, form a group: the ports of a delay, those of a node for tokens
//! of any type, which it cannot change, and all ports of a node that is marked as keeping the frame. A connection joins
//! two groups. A group has the frame that one of its ports says.

use crate::{
    catalog::{Catalog, Signature, Type},
    graph::{Graph, NodeId, NodeKind, PortId, Wire, WireEnd},
    report::{Diagnostic, Diagnostics},
    resolve::mismatch,
    syntax::tree::{Arrow, Ident},
};
use std::collections::BTreeMap;

/// Traits by which a node cannot turn the tokens of a type that it does not know.
const HARMLESS: [&str; 12] =
    ["Clone", "Copy", "Debug", "Default", "Eq", "Hash", "Ord", "PartialEq", "PartialOrd", "Send", "Sync", "'static"];

/// The node of the library that turns a scan.
const MOUNT: &str = "apex_nodes::scan::MountScan";

/// Reports connections between ports whose frames differ.
pub fn check_frames(graph: &Graph, catalog: &Catalog, diagnostics: &mut Diagnostics) {
    let says = graph.nodes.iter().flat_map(|node| &node.ports).any(|port| port.frame.is_some());
    if !says && graph.pins.iter().all(|pin| pin.frame.is_none()) {
        return;
    }
    let mut frames = Frames::new(graph, catalog);
    for wire in graph.wires.iter().filter(|wire| wire.given.is_none()) {
        if let Some((sent, taken)) = frames.join(wire) {
            diagnostics.push_once(error(graph, catalog, wire, (&sent, &taken)));
        }
    }
}

/// Ports in the same frame.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Group {
    /// A port alone.
    Place(WireEnd),
    /// The ports of a node for tokens of this type parameter, or all.
    Node(NodeId, String),
}

struct Frames<'a> {
    graph: &'a Graph,
    catalog: &'a Catalog,
    /// For groups that are joined with others, one of these.
    joined: BTreeMap<Group, Group>,
    /// Frames of groups.
    known: BTreeMap<Group, Ident>,
}

impl<'a> Frames<'a> {
    fn new(graph: &'a Graph, catalog: &'a Catalog) -> Self {
        let mut frames = Self { graph, catalog, joined: BTreeMap::new(), known: BTreeMap::new() };
        let ports = graph.nodes.iter_enumerated().flat_map(|(node, n)| {
            let ports = n.ports.iter().enumerate();
            ports.filter_map(move |(port, p)| Some((WireEnd::Port(PortId { node, port }), p.frame.as_ref()?)))
        });
        let pins = graph.pins.iter().enumerate().filter_map(|(i, pin)| Some((WireEnd::Pin(i), pin.frame.as_ref()?)));
        for (place, frame) in ports.chain(pins) {
            frames.known.insert(frames.group(place), frame.clone());
        }
        frames
    }

    /// The group of a port.
    fn group(&self, place: WireEnd) -> Group {
        let WireEnd::Port(end) = place else { return Group::Place(place) };
        let kept = match &self.graph.nodes[end.node].kind {
            NodeKind::Delay(_) | NodeKind::Relay => Some(String::new()),
            NodeKind::Library(library) => {
                let declared = self.graph.port(end).element_of.unwrap_or(end.port);
                kept(&self.catalog.signatures[library.signature], declared)
            }
            _ => None,
        };
        kept.map_or(Group::Place(place), |ty| Group::Node(end.node, ty))
    }

    fn root(&self, group: Group) -> Group {
        let mut group = group;
        while let Some(next) = self.joined.get(&group) {
            group = next.clone();
        }
        group
    }

    /// Joins the ends of a connection. Returns their frames if they differ.
    fn join(&mut self, wire: &Wire) -> Option<(Ident, Ident)> {
        let (from, to) = (self.root(self.group(wire.from)), self.root(self.group(wire.to)));
        if from == to {
            return None;
        }
        match (self.known.get(&from), self.known.get(&to)) {
            (Some(sent), Some(taken)) if sent.text != taken.text => return Some((sent.clone(), taken.clone())),
            (None, Some(taken)) => _ = self.known.insert(from.clone(), taken.clone()),
            _ => {}
        }
        self.joined.insert(to, from);
        None
    }
}

/// The part of a port's group: a type parameter, or nothing for a node whose tokens all are in one frame.
fn kept(signature: &Signature, port: usize) -> Option<String> {
    let ty = &signature.ports.get(port)?.ty;
    if signature.keeps_frame {
        return Some(String::new());
    }
    let name = signature.generics.iter().find(|name| ty.may_mention(name))?;
    is_unknown(signature, name).then(|| name.clone())
}

/// Returns `true` if a node does not know what the tokens of a type parameter are.
fn is_unknown(signature: &Signature, param: &str) -> bool {
    let mut asked = signature.bounds().filter(|(of, _)| *of == param).flat_map(|(_, traits)| traits);
    asked.all(|name| HARMLESS.contains(&name))
}

fn error(graph: &Graph, catalog: &Catalog, wire: &Wire, (sent, taken): (&Ident, &Ident)) -> Diagnostic {
    let (from, to) = (name(graph, wire.from), name(graph, wire.to));
    let message =
        format!("`{from}` sends tokens in the frame `{}`, but `{to}` takes them in `{}`", sent.text, taken.text);
    let error = Diagnostic::error("wrong-frame", wire.span, message)
        .also(sent.span, "declared here")
        .also(taken.span, "declared here")
        .note("insert a node that turns the tokens; what it sends has no frame until a port says one");
    if ty(graph, wire.from).name() != "Scan" {
        return error;
    }
    let help = format!("turn the scan, with the pose of `{}` in `{}`", sent.text, taken.text);
    let arrow = Arrow { active: wire.active, span: wire.span };
    mismatch::inserting(error, &help, (MOUNT, "x = 0m, y = 0m, heading = 0deg"), arrow, catalog)
}

fn ty(graph: &Graph, place: WireEnd) -> &Type {
    match place {
        WireEnd::Port(end) => &graph.port(end).ty,
        WireEnd::Pin(pin) => &graph.pins[pin].ty,
    }
}

/// A port as it is written in the graph around it; for a delay, which is a modifier, the port before it.
fn name(graph: &Graph, place: WireEnd) -> String {
    let place = match place {
        WireEnd::Port(end) if graph.nodes[end.node].is_delay() => WireEnd::Port(graph.origin(end)),
        place => place,
    };
    place.text(&graph.nodes, &graph.pins, &graph.scopes)
}

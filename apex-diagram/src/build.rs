//! Builds the model of a graph. Nested graphs follow the connections as written, not the flattened ones.

use crate::{
    model::{Anchor, Flow, Frame, Item, Line, Port, Shape, Side},
    states, words,
};
use apex_dsl::{
    analyse,
    catalog::Catalog,
    graph::{Each, Graph, Library, Node, NodeId, NodeKind, PortId, ScopeId, Subject, Wire, WireEnd},
    machine::Machines,
    syntax::tree::PortKind,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    time::Duration,
};

/// Diagram of a graph.
pub fn diagram(graph: &Graph, machines: &Machines, catalog: &Catalog) -> Item {
    let mut item = Item::new(Shape::Node, &graph.name);
    item.ty.clone_from(&graph.name);
    item.docs.clone_from(&graph.docs);
    let builder = Builder::new(graph, machines, catalog);
    item.ports = builder.boundaries().map(|node| builder.boundary_port(node)).collect();
    item.inside = Some(builder.frame(ScopeId::TOP));
    item
}

/// A node or a nested graph in a scope.
#[derive(Clone, Copy)]
enum Member {
    Node(NodeId),
    Scope(ScopeId),
}

struct Builder<'a> {
    graph: &'a Graph,
    machines: &'a Machines,
    catalog: &'a Catalog,
    /// Nodes that activity can reach.
    active: BTreeSet<NodeId>,
    /// All ends of connections.
    connected: BTreeSet<WireEnd>,
    /// Real periods of sources that slower ones hold back.
    throttled: BTreeMap<NodeId, Duration>,
}

impl<'a> Builder<'a> {
    fn new(graph: &'a Graph, machines: &'a Machines, catalog: &'a Catalog) -> Self {
        let connected = graph.wires.iter().flat_map(|w| [w.from, w.to]).collect();
        let throttled = analyse::throttled_periods(graph, catalog);
        Self { graph, machines, catalog, active: analyse::active_nodes(graph), connected, throttled }
    }

    /// Boundary nodes, which are the ports of the graph itself.
    fn boundaries(&self) -> impl Iterator<Item = NodeId> {
        self.graph.nodes.ids().filter(|n| matches!(self.graph.nodes[*n].kind, NodeKind::Boundary(_)))
    }

    fn boundary_port(&self, id: NodeId) -> Port {
        let node = &self.graph.nodes[id];
        let NodeKind::Boundary(kind) = node.kind else { unreachable!("only called for ports of the graph") };
        let connected = self.connected.contains(&WireEnd::Port(PortId { node: id, port: 0 }));
        Port {
            name: node.name.clone(),
            side: side(kind),
            docs: docs(&node.ports[0].ty.to_string(), &node.docs),
            connected,
        }
    }

    /// All members of a scope, in the order of the source file.
    fn frame(&self, scope: ScopeId) -> Frame {
        let mut frame = Frame::default();
        let mut places: BTreeMap<WireEnd, Anchor> = self.own_places(scope);
        let mut waiting = vec![];
        for member in self.members(scope) {
            let at = frame.items.len();
            let (item, shown) = match member {
                Member::Node(node) => self.node(node),
                Member::Scope(inner) => self.scope(inner),
            };
            places.extend(shown.into_iter().enumerate().map(|(port, place)| (place, Anchor::Of(at, port))));
            if matches!(member, Member::Node(node) if self.graph.nodes[node].starts_active) {
                waiting.push(at);
            }
            frame.items.push(item);
        }
        frame.lines = self.graph.wires.iter().filter_map(|wire| self.line(wire, &places)).collect();
        start(&mut frame, &waiting);
        frame
    }

    fn own_places(&self, scope: ScopeId) -> BTreeMap<WireEnd, Anchor> {
        let places: Vec<WireEnd> = match scope {
            ScopeId::TOP => self.boundaries().map(|node| WireEnd::Port(PortId { node, port: 0 })).collect(),
            _ => self.pins(scope).map(WireEnd::Pin).collect(),
        };
        places.into_iter().enumerate().map(|(port, place)| (place, Anchor::Own(port))).collect()
    }

    fn pins(&self, scope: ScopeId) -> impl Iterator<Item = usize> {
        (0..self.graph.pins.len()).filter(move |pin| self.graph.pins[*pin].scope == scope)
    }

    fn members(&self, scope: ScopeId) -> Vec<Member> {
        let graph = self.graph;
        let drawn = |n: &NodeId| {
            let node = &graph.nodes[*n];
            use NodeKind::{Boundary, Interrupt, Probe, Relay};
            let hidden = matches!(node.kind, Boundary(_) | Relay | Probe | Interrupt(_));
            node.scope == scope && !hidden
        };
        let nodes = graph.nodes.ids().filter(drawn).map(|n| (graph.nodes[n].span.start, Member::Node(n)));
        let inner = graph.nested().filter(|s| graph.scopes[*s].parent == scope);
        let inner = inner.map(|s| (graph.scopes[s].span.start, Member::Scope(s)));
        let mut all: Vec<(u32, Member)> = nodes.chain(inner).collect();
        all.sort_by_key(|(at, _)| *at);
        all.into_iter().map(|(_, member)| member).collect()
    }

    /// A wire whose ends both belong to the scope that `places` are of.
    fn line(&self, wire: &Wire, places: &BTreeMap<WireEnd, Anchor>) -> Option<Line> {
        let to = match wire.to {
            WireEnd::Port(PortId { node, port }) => {
                WireEnd::Port(PortId { node, port: self.graph.nodes[node].declared(port) })
            }
            WireEnd::Pin(_) => wire.to,
        };
        let (from, to) = (*places.get(&wire.from)?, *places.get(&to)?);
        if !(self.is_on_side(wire.from, from, true) && self.is_on_side(wire.to, to, false)) {
            return None;
        }
        let sends = |place: WireEnd| match place {
            WireEnd::Port(end) => self.graph.port(end).kind,
            WireEnd::Pin(pin) => self.graph.pins[pin].kind,
        };
        let flow = match (sends(wire.from).is_synchronous(), sends(wire.to).is_synchronous()) {
            (true, true) => Flow::Synchronous,
            (false, false) => Flow::Asynchronous,
            _ => Flow::Hybrid,
        };
        Some(Line { from, to, active: wire.active, flow, label: String::new() })
    }

    /// Returns `true` if a wire that leaves (or enters) a pin at this place is in the frame of the place. A wire from
    /// an event of a nested graph to its own slot is outside of the graph, one from a slot to an event inside.
    fn is_on_side(&self, end: WireEnd, place: Anchor, leaves: bool) -> bool {
        let WireEnd::Pin(pin) = end else { return true };
        let is_result = matches!(self.graph.pins[pin].kind, PortKind::Output | PortKind::Event);
        let is_inside = matches!(place, Anchor::Own(_));
        (is_result != is_inside) == leaves
    }

    /// A nested graph with its pins.
    fn scope(&self, id: ScopeId) -> (Item, Vec<WireEnd>) {
        let scope = &self.graph.scopes[id];
        let mut item = Item::new(Shape::Node, &scope.name);
        item.ty.clone_from(&scope.graph);
        item.words = [scope.graph.clone()].into_iter().chain(words::arguments(&scope.args)).collect();
        item.docs.clone_from(&scope.docs);
        let pins: Vec<usize> = self.pins(id).collect();
        let port = |pin: &usize| {
            let (place, pin) = (WireEnd::Pin(*pin), &self.graph.pins[*pin]);
            let connected = self.connected.contains(&place);
            Port { name: pin.name.clone(), side: side(pin.kind), docs: pin.docs.clone(), connected }
        };
        item.ports = pins.iter().map(port).collect();
        let frame = self.frame(id);
        item.active = frame.items.iter().any(|inner| inner.active);
        item.inside = Some(frame);
        (item, pins.into_iter().map(WireEnd::Pin).collect())
    }

    /// A node, with the places of the ports that are shown.
    fn node(&self, id: NodeId) -> (Item, Vec<WireEnd>) {
        let node = &self.graph.nodes[id];
        let mut item = match &node.kind {
            NodeKind::Library(library) => self.library(id, node, library),
            NodeKind::Each(each) => self.each(node, each),
            NodeKind::Delay(initial) => {
                let held: Vec<String> =
                    initial.iter().map(|v| v.as_ref().map_or("0".to_owned(), |v| words::value(v, None))).collect();
                let mut item = Item::new(Shape::Node, "delay");
                item.words.push(format!("[{}]", held.join(", ")));
                item
            }
            NodeKind::Start => Item::new(Shape::Start, "start"),
            NodeKind::Watchdog => Item::new(Shape::Event, "hung"),
            NodeKind::SetBack => Item::new(Shape::Event, "set_back"),
            NodeKind::Exit(_) => Item::new(Shape::End, &node.name),
            NodeKind::Reset => Item::new(Shape::Reset, &node.name),
            _ => unreachable!("these are no members"),
        };
        item.active = self.active.contains(&id);
        let ports = 0..node.ports.len();
        let places: Vec<WireEnd> = ports.map(|port| WireEnd::Port(PortId { node: id, port })).collect();
        let shown: Vec<usize> = (0..places.len())
            // Any number of inputs are one port.
            .filter(|p| node.declared(*p) == *p)
            .filter(|p| {
                let port = &node.ports[*p];
                self.connected.contains(&places[*p]) || port.standard.is_none() && port.parameter.is_none()
            })
            .collect();
        let is_alone =
            |port: &usize| shown.iter().filter(|p| node.ports[**p].kind == node.ports[*port].kind).count() == 1;
        let is_delay = node.is_delay();
        let port = |index: &usize| {
            let port = &node.ports[*index];
            // `out` is the default name of the result of a node.
            let hidden = is_delay || item.shape != Shape::Node || port.name == "out" && is_alone(index);
            let name = if hidden { String::new() } else { port.name.clone() };
            let connected = self.connected.contains(&places[*index]);
            Port {
                name,
                side: shape_side(item.shape, port.kind),
                docs: docs(&port.ty.to_string(), &port.docs),
                connected,
            }
        };
        let mut ports: Vec<Port> = shown.iter().map(port).collect();
        let mut places: Vec<WireEnd> = shown.into_iter().map(|p| places[p]).collect();
        for place in self.interrupt_of(id) {
            let port = self.graph.port(place);
            let (name, side) = (port.name.clone(), shape_side(item.shape, port.kind));
            ports.push(Port { name, side, docs: String::new(), connected: true });
            places.push(WireEnd::Port(place));
        }
        item.ports = ports;
        (item, places)
    }

    /// The ports `cancel`, `resume` and `cancelled` of a node, as far as they are connected.
    fn interrupt_of(&self, id: NodeId) -> Vec<PortId> {
        let interrupt = self.graph.nodes.position(|node| node.interrupts() == Some(Subject::Node(id)));
        let ports = interrupt
            .into_iter()
            .flat_map(|node| (0..self.graph.nodes[node].ports.len()).map(move |port| PortId { node, port }));
        ports.filter(|place| self.connected.contains(&WireEnd::Port(*place))).collect()
    }

    fn library(&self, id: NodeId, node: &Node, library: &Library) -> Item {
        let mut item = Item::new(Shape::Node, &node.name);
        let signature = &self.catalog.signatures[library.signature];
        item.words.push(words::type_name(library, self.catalog));
        item.words.extend(words::parameters(library, self.catalog));
        item.words.extend(words::modifiers(&node.modifiers));
        item.words.extend(self.throttled.get(&id).map(|real| format!("really every {}", words::duration(*real))));
        item.docs.clone_from(&node.docs);
        item.states = self.machines.get(&library.signature).map(states::machine);
        item.ty = match &item.states {
            Some(_) => signature.name.clone(),
            None => format!("{}:{}", signature.file.display(), signature.name),
        };
        item
    }

    /// The body of an `each`, opened. A body with a single node becomes that node.
    fn each(&self, node: &Node, each: &Each) -> Item {
        let body = &*each.body;
        let inner = Builder::new(body, self.machines, self.catalog);
        let mut item = match body.nodes.iter_enumerated().next() {
            Some((id, only)) if only.span == body.span && matches!(only.kind, NodeKind::Library(_)) => inner.node(id).0,
            _ => {
                let mut item = Item::new(Shape::Node, &node.name);
                item.ty.clone_from(&body.name);
                item.words.push(body.name.clone());
                item.docs.clone_from(&body.docs);
                item.inside = Some(inner.frame(ScopeId::TOP));
                item
            }
        };
        let list = each.list.map_or("", |list| node.ports[list].name.as_str());
        item.words.push(format!("each{}({list})", if each.parallel { " par" } else { "" }));
        item.each = true;
        item
    }
}

/// Adds lines of activity from a start dot to the items that are active from the start.
fn start(frame: &mut Frame, waiting: &[usize]) {
    if waiting.is_empty() {
        return;
    }
    let dot = frame.items.iter().position(|item| item.shape == Shape::Start).unwrap_or_else(|| {
        let mut item = Item::new(Shape::Start, "start");
        item.ports.push(Port::unnamed(Side::Right));
        frame.items.push(item);
        frame.items.len() - 1
    });
    for &item in waiting {
        frame.items[item].ports.push(Port::unnamed(Side::Top));
        let to = Anchor::Of(item, frame.items[item].ports.len() - 1);
        let from = Anchor::Of(dot, 0);
        frame.lines.push(Line { from, to, active: true, flow: Flow::Asynchronous, label: String::new() });
    }
}

fn docs(ty: &str, docs: &str) -> String {
    let (ty, docs) = (ty.trim(), docs.trim());
    if ty.is_empty() || docs.is_empty() { format!("{ty}{docs}") } else { format!("{ty}\n{docs}") }
}

fn side(kind: PortKind) -> Side {
    match kind {
        PortKind::Input => Side::Left,
        PortKind::Output => Side::Right,
        PortKind::Slot => Side::Top,
        PortKind::Event => Side::Bottom,
    }
}

/// Side of a port. Lines meet dots only from the left and the right.
fn shape_side(shape: Shape, kind: PortKind) -> Side {
    match shape {
        Shape::Node | Shape::State => side(kind),
        Shape::Start | Shape::Event => Side::Right,
        Shape::End | Shape::Reset => Side::Left,
    }
}

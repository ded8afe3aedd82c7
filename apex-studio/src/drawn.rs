//! The picture of a robot without its text, from what it says about itself: nodes in the graphs that their names tell.

use crate::kinds::{is_inserted, is_state};
use apex_diagram::{Anchor, Flow, Frame, Item, Line, Port, Shape, Side, joined};
use apex_rt::studio::message::{About, AboutConnection, PortRole};
use std::collections::BTreeMap;

/// Maximum number of hidden nodes one behind the other.
const MAX_RELAYS: usize = 64;

/// The picture of a robot.
pub fn drawn(about: &About) -> Item {
    let mut graphs = Graphs { all: vec![Graph::new(&about.name, None)], place: BTreeMap::new() };
    for (at, node) in about.nodes.iter().enumerate() {
        if is_state(&node.kind) {
            graphs.state(about, &node.name);
        } else if !is_inserted(&node.kind) {
            graphs.add(at, &node.name, &node.kind, &node.docs);
        }
    }
    for connection in &about.connections {
        for (to, input, role) in targets(about, connection, MAX_RELAYS) {
            graphs.connect(about, connection, (to, input), role);
        }
    }
    graphs.finish()
}

/// The ports that a connection leads to, behind nodes that are not drawn.
fn targets<'a>(about: &'a About, connection: &'a AboutConnection, depth: usize) -> Vec<(usize, &'a str, PortRole)> {
    let to = connection.to as usize;
    let Some(node) = about.nodes.get(to) else { return vec![] };
    if is_inserted(&node.kind) {
        let next = about.connections.iter().filter(|next| next.from == connection.to && depth > 0);
        return next.flat_map(|next| targets(about, next, depth - 1)).collect();
    }
    let role = node.ports.iter().find(|(name, ..)| *name == connection.input).map(|(_, role, _)| *role);
    role.map(|role| (to, connection.input.as_str(), role)).into_iter().collect()
}

/// All graphs, the whole first.
struct Graphs {
    all: Vec<Graph>,
    /// The graph of each drawn node, and its place there.
    place: BTreeMap<usize, (usize, usize)>,
}

/// A graph that is being drawn.
struct Graph {
    item: Item,
    items: Vec<Member>,
    lines: Vec<Line>,
    /// Nested graphs by name.
    nested: BTreeMap<String, usize>,
    /// Ports by the node and port outside or inside that they stand for.
    pins: BTreeMap<(usize, String, bool), usize>,
    /// The graph around it, and its place there.
    around: Option<(usize, usize)>,
}

enum Member {
    Node(Box<Item>),
    Graph(usize),
}

impl Graph {
    fn new(name: &str, around: Option<(usize, usize)>) -> Self {
        let item = Item::new(Shape::Node, name);
        let (items, lines, nested, pins) = Default::default();
        Self { item, items, lines, nested, pins, around }
    }

    fn line(&mut self, line: Line) {
        if !self.lines.contains(&line) {
            self.lines.push(line);
        }
    }
}

impl Graphs {
    fn add(&mut self, node: usize, name: &str, kind: &str, docs: &str) {
        let (path, own) = name.rsplit_once('.').unwrap_or(("", name));
        let mut graph = 0;
        for name in path.split('.').filter(|name| !name.is_empty()) {
            graph = match self.all[graph].nested.get(name) {
                Some(inner) => *inner,
                None => {
                    let (inner, place) = (self.all.len(), self.all[graph].items.len());
                    self.all.push(Graph::new(name, Some((graph, place))));
                    self.all[graph].items.push(Member::Graph(inner));
                    self.all[graph].nested.insert(name.to_owned(), inner);
                    inner
                }
            };
        }
        let mut item = Item::new(if kind == "start" { Shape::Start } else { Shape::Node }, own);
        item.words.push(kind.to_owned());
        docs.clone_into(&mut item.docs);
        self.place.insert(node, (graph, self.all[graph].items.len()));
        self.all[graph].items.push(Member::Node(Box::new(item)));
    }

    /// A state of a state machine, which comes before it. What leads from one to another is not known.
    fn state(&mut self, about: &About, name: &str) {
        let inside = |at: &usize| name.strip_prefix(&about.nodes[*at].name).and_then(|rest| rest.strip_prefix('.'));
        let machine = self.place.iter().find_map(|(at, place)| Some((*place, inside(at)?)));
        let Some(((graph, at), state)) = machine else { return };
        if let Member::Node(item) = &mut self.all[graph].items[at] {
            let states = item.states.get_or_insert_default();
            states.items.push(Item { active: true, ..Item::new(Shape::State, state) });
        }
    }

    fn connect(&mut self, about: &About, connection: &AboutConnection, to: (usize, &str), takes: PortRole) {
        let from = connection.from as usize;
        let (Some(&(mut graph, at)), Some(&(mut inner, place))) = (self.place.get(&from), self.place.get(&to.0)) else {
            return;
        };
        let ports = &about.nodes[from].ports;
        let Some(sends) = ports.iter().find(|(name, ..)| *name == connection.output).map(|(_, role, _)| *role) else {
            return;
        };
        let flow = match (sends, takes) {
            (PortRole::Output, PortRole::Input) => Flow::Synchronous,
            (PortRole::Event, PortRole::Slot) => Flow::Asynchronous,
            _ => Flow::Hybrid,
        };
        let active = connection.activity;
        let line = |from, to| Line { from, to, active, flow, label: String::new() };
        let mut begin = Anchor::Of(at, self.port((graph, at), &connection.output, sends, active));
        let mut end = Anchor::Of(place, self.port((inner, place), to.1, takes, active));
        while !self.is_around(graph, inner) {
            let pin = self.pin(graph, (from, &connection.output, true), sends, about);
            self.all[graph].line(line(begin, Anchor::Own(pin)));
            let Some((around, place)) = self.all[graph].around else { return };
            (graph, begin) = (around, Anchor::Of(place, pin));
        }
        while inner != graph {
            let pin = self.pin(inner, (to.0, to.1, false), takes, about);
            self.all[inner].line(line(Anchor::Own(pin), end));
            let Some((around, place)) = self.all[inner].around else { return };
            (inner, end) = (around, Anchor::Of(place, pin));
        }
        self.all[graph].line(line(begin, end));
    }

    /// `true` if a graph is another one, or around it.
    fn is_around(&self, graph: usize, mut inner: usize) -> bool {
        while inner != graph {
            let Some((around, _)) = self.all[inner].around else { return false };
            inner = around;
        }
        true
    }

    /// Port of a node, which has only those that are connected.
    fn port(&mut self, (graph, at): (usize, usize), name: &str, role: PortRole, active: bool) -> usize {
        let Member::Node(item) = &mut self.all[graph].items[at] else { return 0 };
        item.active |= active;
        if let Some(known) = item.ports.iter().position(|port| port.name == name) {
            return known;
        }
        // Lines meet dots only from the left and the right.
        let side = if item.shape == Shape::Start { Side::Right } else { side(role) };
        item.ports.push(Port { name: name.to_owned(), side, docs: String::new(), connected: true });
        item.ports.len() - 1
    }

    /// Port of a graph that stands for one of a node in it or elsewhere.
    fn pin(&mut self, graph: usize, (node, port, sends): (usize, &str, bool), role: PortRole, about: &About) -> usize {
        let key = (node, port.to_owned(), sends);
        let graph = &mut self.all[graph];
        if let Some(known) = graph.pins.get(&key) {
            return *known;
        }
        let node = about.nodes[node].name.rsplit('.').next().unwrap_or_default();
        let name = if port == "out" { node.to_owned() } else { joined(node, port) };
        // Two nodes in different graphs may have the same name.
        let is_taken = graph.item.ports.iter().any(|port| port.name == name);
        let name = if is_taken { format!("{name} {}", graph.item.ports.len()) } else { name };
        graph.item.ports.push(Port { name, side: side(role), docs: String::new(), connected: true });
        graph.pins.insert(key, graph.item.ports.len() - 1);
        graph.item.ports.len() - 1
    }

    /// The whole with all that is nested.
    fn finish(mut self) -> Item {
        // Nested graphs come behind those around them.
        let mut done: BTreeMap<usize, Item> = BTreeMap::new();
        while let Some(Graph { mut item, items, lines, .. }) = self.all.pop() {
            let at = self.all.len();
            let items = items.into_iter().filter_map(|member| match member {
                Member::Node(item) => Some(*item),
                Member::Graph(inner) => done.remove(&inner),
            });
            let frame = Frame { items: items.collect(), lines };
            item.active = at > 0 && frame.items.iter().any(|inner| inner.active);
            item.inside = Some(frame);
            done.insert(at, item);
        }
        done.remove(&0).unwrap_or_else(|| Item::new(Shape::Node, ""))
    }
}

fn side(role: PortRole) -> Side {
    match role {
        PortRole::Input => Side::Left,
        PortRole::Output => Side::Right,
        PortRole::Slot => Side::Top,
        PortRole::Event => Side::Bottom,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        picture::{Picture, View},
        samples::{node, robot},
    };
    use apex_rt::studio::message::AboutNode;

    #[test]
    fn states_are_in_their_machines() {
        let mut about = robot(&[]);
        about.nodes = vec![node("a.m", "Mission"), node("a.m.fetch.drive", "state"), node("a.m.wait", "state")];
        let picture = Picture::new(drawn(&about));
        assert_eq!(picture.states(&about), [0, 1, 2]);
        let (svg, _) = picture.drawn(View::Activity, &picture.first_open(View::Activity), &about);
        for name in ["a.m.fetch.drive", "a.m.wait"] {
            assert!(svg.contains(&format!("data-item=\"{name}\"")), "{name}: {svg}");
        }
    }

    #[test]
    fn nodes_are_in_the_graphs_of_their_names_and_lines_lead_to_their_connections() {
        let node = |name: &str, kind: &str| AboutNode {
            ports: vec![("in".into(), PortRole::Input, String::new()), ("out".into(), PortRole::Output, String::new())],
            ..node(name, kind)
        };
        let connection =
            |from, to| AboutConnection { from, output: "out".into(), to, input: "in".into(), activity: false };
        let mut about = robot(&[]);
        about.nodes =
            vec![node("a.b.x", "X"), node("a.y", "Y"), node("relay", "relay"), node("c.z", "Z"), node("z", "Z")];
        about.connections =
            vec![connection(0, 1), connection(1, 2), connection(2, 3), connection(0, 4), connection(0, 77)];
        let picture = Picture::new(drawn(&about));
        assert_eq!(picture.graphs(View::Wiring), ["a.b", "a", "c"]);
        let (svg, lines) = picture.drawn(View::Wiring, &picture.first_open(View::Wiring), &about);
        assert_eq!(lines["a.b:x a.y:in"], [0]);
        assert_eq!(lines["a.b.x:out a.b:x"], [0, 3]);
        assert_eq!(lines["a:x z:in"], [3]);
        // Over the relay.
        for line in ["a.y:out a:y", "a:y c:z.in", "c:z.in c.z:in"] {
            assert_eq!(lines[line], [1, 2], "{line}");
        }
        for name in ["a.b.x", "a.y", "c.z", "z"] {
            assert!(svg.contains(&format!("data-item=\"{name}\"")), "{name}: {svg}");
        }
        assert!(!svg.contains("data-item=\"relay\""));
    }
}

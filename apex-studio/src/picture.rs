//! The picture of a robot, and which of its connections each line stands for.

use crate::kinds::is_inserted;
use apex_diagram::{Anchor, Frame, Item, joined, svg};
use apex_rt::studio::message::About;
use std::collections::{BTreeMap, BTreeSet};

/// Number of boxes up to which nested graphs are open at the beginning.
const MAX_OPEN: usize = 25;

/// The picture of a robot.
pub struct Picture {
    whole: Item,
}

/// A port in a flat graph: the full name of its node, and its own name; empty for any.
type End = (String, String);

impl Picture {
    /// The picture of a graph with all that is nested.
    pub fn new(whole: Item) -> Self {
        Self { whole }
    }

    /// Full names of all nested graphs.
    pub fn graphs(&self) -> Vec<String> {
        let mut graphs = vec![];
        collect(&self.whole, "", &mut graphs);
        graphs
    }

    /// Full names of all uses of a graph; the empty one for the whole.
    pub fn instances(&self, graph: &str) -> Vec<String> {
        let mut instances = vec![];
        if self.whole.name == graph {
            instances.push(String::new());
        }
        uses(&self.whole, "", graph, &mut instances);
        instances
    }

    /// The nested graphs that are open at the beginning: level by level, as long as the picture is readable.
    pub fn first_open(&self) -> BTreeSet<String> {
        let mut graphs = self.graphs();
        graphs.sort_by_key(|path| path.matches('.').count());
        let mut open = BTreeSet::new();
        for path in graphs {
            let parent_is_open = path.rsplit_once('.').is_none_or(|(parent, _)| open.contains(parent));
            if !parent_is_open {
                continue;
            }
            open.insert(path.clone());
            if self.opened(&open).count() > MAX_OPEN {
                open.remove(&path);
            }
        }
        open
    }

    /// The picture as SVG, with these nested graphs open.
    pub fn svg(&self, open: &BTreeSet<String>) -> String {
        svg(&self.opened(open))
    }

    fn opened(&self, open: &BTreeSet<String>) -> Item {
        self.whole.clone().opened(&|path| open.contains(path))
    }

    /// The connections of the robot that each line stands for, by the names at the ends of the line.
    pub fn lines(&self, about: &About) -> BTreeMap<String, Vec<usize>> {
        let mut lines = BTreeMap::new();
        let top = Within { item: &self.whole, path: String::new(), around: None };
        top.lines(about, &mut lines);
        lines
    }
}

fn collect(item: &Item, path: &str, graphs: &mut Vec<String>) {
    for inner in item.inside.iter().flat_map(|frame| &frame.items).filter(|inner| inner.inside.is_some()) {
        let path = joined(path, &inner.name);
        collect(inner, &path, graphs);
        graphs.push(path);
    }
}

fn uses(item: &Item, path: &str, graph: &str, found: &mut Vec<String>) {
    for inner in item.inside.iter().flat_map(|frame| &frame.items).filter(|inner| inner.inside.is_some()) {
        let path = joined(path, &inner.name);
        uses(inner, &path, graph, found);
        if inner.words.first().is_some_and(|name| name == graph) {
            found.push(path);
        }
    }
}

/// The connections between these ports, also over nodes of the compiler that are not in the picture.
fn between(about: &About, from: &[End], to: &[End]) -> Vec<usize> {
    let is = |ends: &[End], node: u32, port: &str| {
        let node = about.nodes.get(node as usize).map_or("", |node| &node.name);
        ends.iter().any(|end| end.0 == node && (end.1.is_empty() || end.1 == port))
    };
    let kind = |node: u32| about.nodes.get(node as usize).map_or("", |node| &node.kind);
    let connections = || about.connections.iter().enumerate();
    let (mut found, mut passed) = (BTreeSet::new(), BTreeSet::new());
    for (first, c) in connections().filter(|(_, c)| is(from, c.from, &c.output)) {
        // The ways from here, each as its connections.
        let mut ways = vec![(c, vec![first])];
        while let Some((last, way)) = ways.pop() {
            if is(to, last.to, &last.input) {
                found.extend(way);
            } else if is_inserted(kind(last.to)) && passed.insert((first, last.to)) {
                let next = connections().filter(|(_, next)| next.from == last.to);
                ways.extend(next.map(|(at, next)| (next, [&way[..], &[at]].concat())));
            }
        }
    }
    found.into_iter().collect()
}

/// An open item, with the one around it and its place there.
struct Within<'a> {
    item: &'a Item,
    path: String,
    around: Option<(&'a Within<'a>, usize)>,
}

/// A direction along lines.
#[derive(Clone, Copy, PartialEq)]
enum Towards {
    Source,
    Target,
}

impl Within<'_> {
    fn lines(&self, about: &About, lines: &mut BTreeMap<String, Vec<usize>>) {
        let Some(frame) = &self.item.inside else { return };
        for line in &frame.lines {
            let (mut from, mut to) = (vec![], vec![]);
            self.ends(frame, line.from, Towards::Source, &mut from);
            self.ends(frame, line.to, Towards::Target, &mut to);
            let name = format!("{} {}", self.name(frame, line.from), self.name(frame, line.to));
            lines.insert(name, between(about, &from, &to));
        }
        for (at, item) in frame.items.iter().enumerate() {
            Within { item, path: joined(&self.path, &item.name), around: Some((self, at)) }.lines(about, lines);
        }
    }

    /// Name of an end of a line, as in the SVG.
    fn name(&self, frame: &Frame, end: Anchor) -> String {
        match end {
            Anchor::Own(port) => format!("{}:{}", self.path, self.item.ports[port].name),
            Anchor::Of(inner, port) => {
                let inner = &frame.items[inner];
                format!("{}:{}", joined(&self.path, &inner.name), inner.ports[port].name)
            }
        }
    }

    /// Collects the ports of nodes that an end of a line leads to, through the ports of nested graphs.
    fn ends(&self, frame: &Frame, end: Anchor, towards: Towards, ends: &mut Vec<End>) {
        match end {
            Anchor::Own(port) => self.outwards(port, towards, ends),
            Anchor::Of(at, port) => {
                let item = &frame.items[at];
                let path = joined(&self.path, &item.name);
                match &item.inside {
                    None => ends.push((path, item.ports[port].name.clone())),
                    Some(inside) => {
                        let inner = Within { item, path, around: Some((self, at)) };
                        inner.follow(inside, Anchor::Own(port), towards, ends);
                    }
                }
            }
        }
    }

    fn outwards(&self, port: usize, towards: Towards, ends: &mut Vec<End>) {
        match self.around {
            // A port of the robot is a node of its own.
            None => ends.push((self.item.ports[port].name.clone(), String::new())),
            Some((around, at)) => {
                if let Some(frame) = &around.item.inside {
                    around.follow(frame, Anchor::Of(at, port), towards, ends);
                }
            }
        }
    }

    /// Follows the lines at a port of this item's frame.
    fn follow(&self, frame: &Frame, at: Anchor, towards: Towards, ends: &mut Vec<End>) {
        for line in &frame.lines {
            let (near, far) = match towards {
                Towards::Source => (line.to, line.from),
                Towards::Target => (line.from, line.to),
            };
            if near == at {
                self.ends(frame, far, towards, ends);
            }
        }
    }
}

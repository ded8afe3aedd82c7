//! The pictures of a robot, and which of its connections each line stands for.

use crate::kinds::{is_inserted, is_silent};
use apex_diagram::{Anchor, Frame, Item, joined, layout::place, states, svg};
use apex_rt::studio::message::{About, AboutConnection, AboutNode};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// Number of boxes up to which nested graphs are open at the beginning.
const MAX_OPEN: usize = 25;
/// Width in units up to which they are, in the view of the activity: its words can be read without zooming.
const MAX_WIDTH: i64 = 1200;

/// A view of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// The nodes that can be active, and the tokens that pass activity on.
    Activity,
    /// All nodes and connections.
    Wiring,
}

/// The pictures of a robot.
pub struct Picture {
    whole: Item,
    /// Its activity, if it has one.
    activity: Option<Item>,
}

/// A port in a flat graph: the full name of its node, and its own name; empty for any.
type End = (String, String);

impl Picture {
    /// The pictures of a graph with all that is nested.
    pub fn new(whole: Item) -> Self {
        let activity = states(&whole);
        Self { whole, activity }
    }

    /// The view at the beginning.
    pub fn first_view(&self) -> View {
        if self.activity.is_some() { View::Activity } else { View::Wiring }
    }

    /// Full names of all nested graphs of a view.
    pub fn graphs(&self, view: View) -> Vec<String> {
        let mut graphs = vec![];
        collect(&self.whole, "", &mut graphs);
        if view == View::Activity {
            let seen = self.paths();
            graphs.retain(|graph| seen.contains(graph));
        }
        graphs
    }

    /// Full names of everything in the view of the activity.
    fn paths(&self) -> BTreeSet<String> {
        let mut paths = BTreeSet::new();
        self.activity.iter().for_each(|item| insert(item, "", &mut paths));
        paths
    }

    /// Numbers of the nodes in the view of the activity.
    pub fn states(&self, about: &About) -> Vec<usize> {
        let paths = self.paths();
        let is_state = |(_, node): &(usize, &AboutNode)| !is_silent(&node.kind) && paths.contains(&node.name);
        about.nodes.iter().enumerate().filter(is_state).map(|(at, _)| at).collect()
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
    pub fn first_open(&self, view: View) -> BTreeSet<String> {
        let mut graphs = self.graphs(view);
        graphs.sort_by_key(|path| path.matches('.').count());
        let mut open = BTreeSet::new();
        for path in graphs {
            let parent_is_open = path.rsplit_once('.').is_none_or(|(parent, _)| open.contains(parent));
            if !parent_is_open {
                continue;
            }
            open.insert(path.clone());
            let item = self.opened(view, &open);
            let is_wide = || view == View::Activity && place(&item).size.0 > MAX_WIDTH;
            if item.count() > MAX_OPEN || is_wide() {
                open.remove(&path);
            }
        }
        open
    }

    /// A view with these nested graphs open.
    fn opened(&self, view: View, open: &BTreeSet<String>) -> Item {
        let whole = self.whole.clone().opened(&|path| open.contains(path));
        let activity = if view == View::Activity { states(&whole) } else { None };
        activity.unwrap_or(whole)
    }

    /// A view with these nested graphs open as SVG, and the connections of the robot that each line stands for, by the
    /// names at the ends of the line.
    pub fn drawn(&self, view: View, open: &BTreeSet<String>, about: &About) -> (String, BTreeMap<String, Vec<usize>>) {
        let (item, mut lines) = (self.opened(view, open), BTreeMap::new());
        // Lines of the wiring lead into closed graphs.
        let whole = if view == View::Wiring { &self.whole } else { &item };
        let top = Within { item: whole, path: String::new(), around: None };
        top.lines(&Ways { about, view }, &mut lines);
        (svg(&item), lines)
    }
}

fn collect(item: &Item, path: &str, graphs: &mut Vec<String>) {
    for inner in item.inside.iter().flat_map(|frame| &frame.items).filter(|inner| inner.inside.is_some()) {
        let path = joined(path, &inner.name);
        collect(inner, &path, graphs);
        graphs.push(path);
    }
}

/// Adds the full names of everything in an item.
fn insert(item: &Item, path: &str, paths: &mut BTreeSet<String>) {
    for inner in item.inside.iter().flat_map(|frame| &frame.items) {
        let path = joined(path, &inner.name);
        insert(inner, &path, paths);
        paths.insert(path);
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

/// The connections that lines of a view stand for.
struct Ways<'a> {
    about: &'a About,
    view: View,
}

impl Ways<'_> {
    fn kind(&self, node: u32) -> &str {
        self.about.nodes.get(node as usize).map_or("", |node| &node.kind)
    }

    /// `true` if a port is one of these ends. In the view of the activity an end may be a closed graph.
    fn is_at(&self, ends: &[End], node: u32, port: &str) -> bool {
        let node = self.about.nodes.get(node as usize).map_or("", |node| &node.name);
        let is_inside = |graph: &str| {
            self.view == View::Activity && node.strip_prefix(graph).is_some_and(|rest| rest.starts_with('.'))
        };
        ends.iter().any(|end| (end.0 == node || is_inside(&end.0)) && (end.1.is_empty() || end.1 == port))
    }

    /// The connections between these ports, also over nodes of the compiler that are not in the picture.
    fn between(&self, from: &[End], to: &[End]) -> Vec<usize> {
        let connections = || self.about.connections.iter().enumerate();
        let is_seen = |c: &AboutConnection| self.view == View::Wiring || c.activity;
        let (mut found, mut passed) = (BTreeSet::new(), BTreeSet::new());
        for (first, c) in connections().filter(|(_, c)| is_seen(c) && self.is_at(from, c.from, &c.output)) {
            // The ways from here, each as its connections.
            let mut ways = vec![(c, vec![first])];
            while let Some((last, way)) = ways.pop() {
                if self.is_at(to, last.to, &last.input) {
                    found.extend(way);
                } else if is_inserted(self.kind(last.to)) && passed.insert((first, last.to)) {
                    let next = connections().filter(|(_, next)| next.from == last.to);
                    ways.extend(next.map(|(at, next)| (next, [&way[..], &[at]].concat())));
                }
            }
        }
        found.into_iter().collect()
    }
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
    fn lines(&self, ways: &Ways<'_>, lines: &mut BTreeMap<String, Vec<usize>>) {
        let Some(frame) = &self.item.inside else { return };
        for line in &frame.lines {
            let (mut from, mut to) = (vec![], vec![]);
            self.ends(frame, line.from, Towards::Source, &mut from);
            self.ends(frame, line.to, Towards::Target, &mut to);
            let name = format!("{} {}", self.name(frame, line.from), self.name(frame, line.to));
            lines.insert(name, ways.between(&from, &to));
        }
        for (at, item) in frame.items.iter().enumerate() {
            Within { item, path: joined(&self.path, &item.name), around: Some((self, at)) }.lines(ways, lines);
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

//! Assigns items to layers. A line that skips layers or goes backwards has a bend in each layer between its ends.

use super::{
    cycles,
    labels::{Bend, Labels, Way, labels},
    leaf::{self, Sides},
    placed::{Placed, SMALL, wide},
};
use crate::model::{Anchor, Flow, Frame, Item, Line, Side};
use std::collections::{BTreeMap, BTreeSet};

/// Distance between the rows of slots and events, in pixels.
pub const ROW: i64 = 11;
/// Distance between the nearest row and its box, in pixels.
pub const CLEAR: i64 = 14;

/// An item, port, bend or label in a layer.
#[derive(Debug, Clone)]
pub struct Cell {
    pub role: Role,
    pub layer: usize,
    /// Number of the connected part of the graph.
    pub part: usize,
    pub size: (i64, i64),
    /// Ends of lines on the left, from top to bottom. The first `slots` of them are in the rows above the box.
    pub left: Vec<usize>,
    pub slots: usize,
    /// Ends of lines on the right, from top to bottom. The first `outputs` of them are beside the box, the others in
    /// the rows below.
    pub right: Vec<usize>,
    pub outputs: usize,
    /// Vertical positions of the ends on the left, relative to the top of the cell.
    pub left_at: Vec<i64>,
    pub right_at: Vec<i64>,
    /// `true` if ends on the same side may be reordered.
    pub free: bool,
}

/// Role of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Item(usize),
    /// Port of the frame.
    Pin(usize),
    Bend,
    /// Label, by its number; a line passes below it.
    Label(usize),
}

/// An end of a line, or of a piece of it.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    pub cell: usize,
    /// Port of the item or frame.
    pub port: usize,
}

/// A piece of a line between two neighbouring layers. Both ends are in the same layer where a line turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Link {
    /// Left layer.
    pub gap: usize,
    /// Number of the net: lines with a common start.
    pub net: usize,
    pub from: usize,
    pub to: usize,
}

/// Cells of a frame.
#[derive(Debug, Clone)]
pub struct Cells {
    pub cells: Vec<Cell>,
    pub terms: Vec<Term>,
    /// Cells of each layer, from top to bottom.
    pub layers: Vec<Vec<usize>>,
    pub links: Vec<Link>,
    /// Pieces of each line.
    pub paths: Vec<Vec<Link>>,
    /// Items, with their ports in the order of the model.
    pub placed: Vec<Placed>,
    /// Labels of lines.
    pub labels: Vec<String>,
    /// End of a line at each port.
    ends: BTreeMap<Anchor, usize>,
    bends: BTreeMap<Bend, usize>,
}

impl Cells {
    /// Returns the cells of a frame. Each item with a frame of its own has been `placed`.
    pub fn new(around: &Item, frame: &Frame, placed: Vec<Option<Placed>>) -> Self {
        let (layer_of, last) = cycles::layers(frame);
        let mut cells = Self {
            cells: vec![],
            terms: vec![],
            layers: vec![vec![]; last + 1],
            links: vec![],
            paths: vec![],
            placed: vec![],
            labels: vec![],
            ends: BTreeMap::new(),
            bends: BTreeMap::new(),
        };
        let lined: BTreeSet<Anchor> = frame.lines.iter().flat_map(|l| [l.from, l.to]).collect();
        for ((i, item), placed) in frame.items.iter().enumerate().zip(placed) {
            cells.item((i, item), placed, layer_of[i], &lined);
        }
        for port in 0..around.ports.len() {
            cells.pin(port, &around.ports[port].name, around.ports[port].side, last);
        }
        cells.find_parts(frame);
        cells.lines(around, frame);
        cells
    }

    fn add(&mut self, role: Role, layer: usize, size: (i64, i64)) -> usize {
        let (left, right, left_at, right_at) = (vec![], vec![], vec![], vec![]);
        let cell =
            Cell { role, layer, part: 0, size, left, slots: 0, right, outputs: 0, left_at, right_at, free: false };
        self.cells.push(cell);
        self.layers[layer].push(self.cells.len() - 1);
        self.cells.len() - 1
    }

    fn term(&mut self, cell: usize, port: usize) -> usize {
        self.terms.push(Term { cell, port });
        self.terms.len() - 1
    }

    fn item(&mut self, (index, item): (usize, &Item), placed: Option<Placed>, layer: usize, lined: &BTreeSet<Anchor>) {
        let lined = |port: &usize| lined.contains(&Anchor::Of(index, *port));
        let mut sides = Sides::of(item).first(&lined);
        let placed = placed.unwrap_or_else(|| leaf::place(item, &sides));
        if item.inside.is_some() {
            sides.slots.sort_by_key(|p| -placed.ports[*p].0);
            sides.events.sort_by_key(|p| -placed.ports[*p].0);
            sides.left.sort_by_key(|p| placed.ports[*p].1);
            sides.right.sort_by_key(|p| placed.ports[*p].1);
        }
        let kept = |ports: Vec<usize>| -> Vec<usize> { ports.into_iter().filter(lined).collect() };
        let (slots, left, right, events) = (kept(sides.slots), kept(sides.left), kept(sides.right), kept(sides.events));
        let rows = |count: usize| if count == 0 { 0 } else { (count as i64 - 1) * ROW + CLEAR };
        let top = rows(slots.len());
        let bottom = top + placed.size.1;
        let at = self.add(Role::Item(index), layer, (placed.size.0, bottom + rows(events.len())));
        let y = |ports: &[usize]| -> Vec<i64> { ports.iter().map(|p| top + placed.ports[*p].1).collect() };
        let above = (0..slots.len()).map(|i| i as i64 * ROW);
        let below = (0..events.len()).map(|i| bottom + CLEAR + i as i64 * ROW);
        let (left_at, right_at) = (above.chain(y(&left)).collect(), y(&right).into_iter().chain(below).collect());
        let mut ends = |ports: &[usize]| -> Vec<usize> {
            ports
                .iter()
                .map(|port| {
                    let term = self.term(at, *port);
                    self.ends.insert(Anchor::Of(index, *port), term);
                    term
                })
                .collect()
        };
        let (above, beside) = (ends(&slots), ends(&left));
        let (outputs, below) = (ends(&right), ends(&events));
        let cell = &mut self.cells[at];
        (cell.slots, cell.outputs) = (above.len(), outputs.len());
        cell.left = above.into_iter().chain(beside).collect();
        cell.right = outputs.into_iter().chain(below).collect();
        (cell.left_at, cell.right_at) = (left_at, right_at);
        cell.free = item.inside.is_none();
        self.placed.push(placed);
    }

    fn pin(&mut self, port: usize, name: &str, side: Side, last: usize) {
        let sends = matches!(side, Side::Left | Side::Top);
        let cell = self.add(Role::Pin(port), if sends { 0 } else { last }, (wide(name, SMALL) + 8, 16));
        let term = self.term(cell, port);
        self.ends.insert(Anchor::Own(port), term);
        self.give(cell, (!sends).then_some(term), sends.then_some(term), 13);
    }

    fn give(&mut self, cell: usize, left: Option<usize>, right: Option<usize>, y: i64) {
        let cell = &mut self.cells[cell];
        cell.left.extend(left);
        cell.right.extend(right);
        cell.outputs = cell.right.len();
        cell.left_at = vec![y; cell.left.len()];
        cell.right_at = vec![y; cell.right.len()];
    }

    /// Numbers the connected parts in the order of the model.
    fn find_parts(&mut self, frame: &Frame) {
        let mut part: Vec<usize> = (0..self.cells.len()).collect();
        fn top(part: &[usize], mut cell: usize) -> usize {
            while part[cell] != cell {
                cell = part[cell];
            }
            cell
        }
        for line in &frame.lines {
            let [a, b] = [line.from, line.to].map(|end| top(&part, self.terms[self.ends[&end]].cell));
            part[a.max(b)] = a.min(b);
        }
        for cell in 0..self.cells.len() {
            self.cells[cell].part = top(&part, cell);
        }
    }

    fn lines(&mut self, around: &Item, frame: &Frame) {
        let mut nets: BTreeMap<(Anchor, bool, Flow, Option<usize>), usize> = BTreeMap::new();
        let mut ways = vec![];
        for (index, line) in frame.lines.iter().enumerate() {
            let alone = (!line.label.is_empty()).then_some(index);
            let count = nets.len();
            let net = *nets.entry((line.from, line.active, line.flow, alone)).or_insert(count);
            ways.push(self.way(net, line));
        }
        let labels = labels(around, frame, &ways);
        for way in &ways {
            let path = self.path(way, &labels);
            self.paths.push(path);
        }
        let links: BTreeSet<Link> = self.paths.iter().flatten().copied().collect();
        self.links = links.into_iter().collect();
    }

    fn way(&self, net: usize, line: &Line) -> Way {
        let (from, to) = (self.ends[&line.from], self.ends[&line.to]);
        let layer = |term: usize| self.cells[self.terms[term].cell].layer;
        let (begin, end) = (layer(from), layer(to));
        let back = end <= begin;
        let passed: Vec<usize> = if back { (end..=begin).rev().collect() } else { (begin + 1..end).collect() };
        let labelled = if back { end.max(begin.saturating_sub(1)) } else { begin + 1 };
        Way { net, from, to, back, passed, labelled, end }
    }

    fn path(&mut self, way: &Way, labels: &Labels) -> Vec<Link> {
        let (net, back) = (way.net, way.back);
        let part = self.cells[self.terms[way.from].cell].part;
        let mut path = vec![];
        let mut at = way.from;
        for &layer in &way.passed {
            let bend = self.bend((net, back, layer), part, labels.get(&(net, back, layer)));
            let (left, right) = (self.cells[bend].left[0], self.cells[bend].right[0]);
            let (enter, leave, gap) = if back { (right, left, layer) } else { (left, right, layer - 1) };
            path.push(Link { gap, net, from: at, to: enter });
            at = leave;
        }
        path.push(Link { gap: way.end - 1, net, from: at, to: way.to });
        path
    }

    /// Bend of a net in a layer, which all lines of the net share.
    fn bend(&mut self, bend: Bend, part: usize, label: Option<&String>) -> usize {
        if let Some(&known) = self.bends.get(&bend) {
            return known;
        }
        let (role, size, y) = match label {
            Some(label) => {
                self.labels.push(label.clone());
                (Role::Label(self.labels.len() - 1), (wide(label, SMALL) + 10, 16), 13)
            }
            None => (Role::Bend, (0, 0), 0),
        };
        let cell = self.add(role, bend.2, size);
        let (left, right) = (self.term(cell, 0), self.term(cell, 0));
        self.give(cell, Some(left), Some(right), y);
        self.cells[cell].part = part;
        self.bends.insert(bend, cell);
        cell
    }

    /// Vertical position of an end, relative to the top of its cell.
    pub fn offset(&self, term: usize) -> i64 {
        let cell = &self.cells[self.terms[term].cell];
        match cell.left.iter().position(|t| *t == term) {
            Some(rank) => cell.left_at[rank],
            None => cell.right_at[cell.right.iter().position(|t| *t == term).unwrap_or(0)],
        }
    }

    /// Layer of an end.
    pub fn layer(&self, term: usize) -> usize {
        self.cells[self.terms[term].cell].layer
    }
}

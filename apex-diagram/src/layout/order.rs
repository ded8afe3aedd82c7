//! Orders the cells of each layer, and the ports on each side of a box, so that few lines cross: barycentres first,
//! then exchanges of neighbours.

use super::cells::{Cells, Role};
use crate::model::Side;

/// Number of barycentre sweeps.
const SWEEPS: usize = 24;
/// Maximum number of passes that exchange neighbours.
const EXCHANGES: usize = 8;

/// Orders the cells. `side` returns the side of a port of the frame.
pub fn order(cells: &mut Cells, side: &dyn Fn(usize) -> Side) {
    let sorter = Sorter::new(cells, side);
    for layer in 0..cells.layers.len() {
        sorter.settle(cells, layer);
    }
    let mut best = cells.clone();
    let mut least = sorter.crossings(cells);
    for sweep in 0..SWEEPS {
        let forward = sweep % 2 == 0;
        let count = cells.layers.len();
        for step in 0..count {
            let layer = if forward { step } else { count - 1 - step };
            sorter.sort(cells, layer, forward);
            sorter.sort_ports(cells, layer, forward);
        }
        let crossings = sorter.crossings(cells);
        if crossings < least {
            (least, best) = (crossings, cells.clone());
        }
    }
    *cells = best;
    for _ in 0..EXCHANGES {
        if !sorter.exchange(cells) {
            break;
        }
    }
}

struct Sorter {
    /// Ends that are linked to each end.
    linked: Vec<Vec<usize>>,
    /// Links between neighbouring layers.
    gaps: Vec<Vec<(usize, usize)>>,
    /// Class of each cell; cells of one class stay together. Slots are before inputs, outputs before events, then the
    /// order is by part.
    class: Vec<(usize, usize)>,
}

impl Sorter {
    fn new(cells: &Cells, side: &dyn Fn(usize) -> Side) -> Self {
        let mut linked = vec![vec![]; cells.terms.len()];
        let mut gaps = vec![vec![]; cells.layers.len()];
        for link in &cells.links {
            linked[link.from].push(link.to);
            linked[link.to].push(link.from);
            gaps[link.gap].push((link.from, link.to));
        }
        let class = cells.cells.iter().map(|cell| match cell.role {
            Role::Pin(port) => match side(port) {
                Side::Top => (0, 0),
                Side::Bottom => (2, 0),
                Side::Left | Side::Right => (1, cell.part),
            },
            _ => (1, cell.part),
        });
        Self { linked, gaps, class: class.collect() }
    }

    fn settle(&self, cells: &mut Cells, layer: usize) {
        let class = &self.class;
        cells.layers[layer].sort_by_key(|cell| class[*cell]);
    }

    /// Numbers the ends on one side of a layer from top to bottom.
    fn positions(&self, cells: &Cells, layer: usize, right: bool, into: &mut [usize]) {
        let mut next = 0;
        for &cell in &cells.layers[layer] {
            let cell = &cells.cells[cell];
            for &term in if right { &cell.right } else { &cell.left } {
                into[term] = next;
                next += 1;
            }
        }
    }

    /// Sorts a layer by the barycentres of its lines on one side.
    fn sort(&self, cells: &mut Cells, layer: usize, from_left: bool) {
        let other = if from_left { layer.checked_sub(1) } else { Some(layer + 1).filter(|l| *l < cells.layers.len()) };
        let Some(other) = other else { return };
        let mut position = vec![0; cells.terms.len()];
        self.positions(cells, other, from_left, &mut position);
        let centre = |cell: usize| -> Option<f64> {
            let cell = &cells.cells[cell];
            let terms = if from_left { &cell.left } else { &cell.right };
            let linked = terms.iter().flat_map(|t| &self.linked[*t]).filter(|t| cells.layer(**t) == other);
            mean(linked.map(|t| position[*t] as f64))
        };
        let centres: Vec<Option<f64>> = cells.layers[layer].iter().map(|cell| centre(*cell)).collect();
        // A cell without lines to that side keeps its position in the layer, or moves beside the cell that it is linked
        // to.
        let own = &cells.layers[layer];
        let partner = |cell: usize| -> Option<f64> {
            let terms = cells.cells[cell].left.iter().chain(&cells.cells[cell].right);
            let same = terms.flat_map(|t| &self.linked[*t]).map(|t| cells.terms[*t].cell);
            let centres = same.filter_map(|c| own.iter().position(|o| *o == c).and_then(|at| centres[at]));
            mean(centres).map(|c| c + 0.4)
        };
        let mut last = -1.0;
        let mut keyed: Vec<((usize, usize), f64, usize)> = vec![];
        for (at, &cell) in own.iter().enumerate() {
            let centre = centres[at].or_else(|| partner(cell)).unwrap_or(last);
            last = centre;
            keyed.push((self.class[cell], centre, cell));
        }
        keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        cells.layers[layer] = keyed.into_iter().map(|(_, _, cell)| cell).collect();
    }

    /// Sorts the ports on one side of the boxes of a layer.
    fn sort_ports(&self, cells: &mut Cells, layer: usize, left: bool) {
        let mut position = vec![0; cells.terms.len()];
        if let Some(other) = if left { layer.checked_sub(1) } else { Some(layer + 1) }
            && other < cells.layers.len()
        {
            self.positions(cells, other, left, &mut position);
        }
        for at in 0..cells.layers[layer].len() {
            let index = cells.layers[layer][at];
            let cell = &cells.cells[index];
            if !cell.free {
                continue;
            }
            let (terms, split) = if left { (&cell.left, cell.slots) } else { (&cell.right, cell.outputs) };
            let towards = |term: usize| -> f64 {
                let centres = self.linked[term].iter().map(|t| match cells.layer(*t) {
                    other if other != layer => position[*t] as f64,
                    // A line that turns leads around the box.
                    _ => {
                        let turn = cells.layers[layer].iter().position(|c| *c == cells.terms[*t].cell);
                        if turn.is_some_and(|turn| turn < at) { -1e6 } else { 1e6 }
                    }
                });
                mean(centres).unwrap_or(0.0)
            };
            let mut keyed: Vec<(bool, f64, usize)> =
                terms.iter().enumerate().map(|(rank, t)| (rank >= split, towards(*t), *t)).collect();
            keyed.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            let sorted = keyed.into_iter().map(|(_, _, term)| term).collect();
            let cell = &mut cells.cells[index];
            *(if left { &mut cell.left } else { &mut cell.right }) = sorted;
        }
    }

    fn crossings(&self, cells: &Cells) -> usize {
        (0..cells.layers.len()).map(|gap| self.crossings_of(cells, gap)).sum()
    }

    /// Number of crossings between a layer and the next one.
    fn crossings_of(&self, cells: &Cells, gap: usize) -> usize {
        let mut position = vec![0; cells.terms.len()];
        self.positions(cells, gap, true, &mut position);
        if gap + 1 < cells.layers.len() {
            self.positions(cells, gap + 1, false, &mut position);
        }
        let mut across = vec![];
        let mut turns = vec![];
        for &(a, b) in &self.gaps[gap] {
            let (la, lb) = (cells.layer(a), cells.layer(b));
            let (pa, pb) = (position[a], position[b]);
            match (la == gap, lb == gap) {
                (true, false) => across.push((pa, pb)),
                (false, true) => across.push((pb, pa)),
                (at_left, _) => turns.push((at_left, pa.min(pb), pa.max(pb))),
            }
        }
        let mut count = 0;
        across.sort_unstable();
        let mut seen: Vec<usize> = vec![];
        for &(_, right) in &across {
            let below = seen.partition_point(|r| *r <= right);
            count += seen.len() - below;
            seen.insert(below, right);
        }
        for (at_left, low, high) in turns {
            let inside = |p: usize| low < p && p < high;
            count += across.iter().filter(|(l, r)| inside(if at_left { *l } else { *r })).count();
        }
        count
    }

    /// Exchanges neighbours if that saves crossings. Returns `true` if it did.
    fn exchange(&self, cells: &mut Cells) -> bool {
        let mut better = false;
        for layer in 0..cells.layers.len() {
            let around = |cells: &Cells| {
                self.crossings_of(cells, layer) + layer.checked_sub(1).map_or(0, |gap| self.crossings_of(cells, gap))
            };
            let mut now = around(cells);
            for at in 1..cells.layers[layer].len() {
                let (a, b) = (cells.layers[layer][at - 1], cells.layers[layer][at]);
                if now == 0 || self.class[a] != self.class[b] {
                    continue;
                }
                cells.layers[layer].swap(at - 1, at);
                let then = around(cells);
                if then < now {
                    (now, better) = (then, true);
                } else {
                    cells.layers[layer].swap(at - 1, at);
                }
            }
            self.sort_ports_if_better(cells, layer, &around);
        }
        better
    }

    fn sort_ports_if_better(&self, cells: &mut Cells, layer: usize, around: &dyn Fn(&Cells) -> usize) {
        let before = around(cells);
        let old: Vec<_> = cells.layers[layer].iter().map(|c| (*c, cells.cells[*c].clone())).collect();
        self.sort_ports(cells, layer, true);
        self.sort_ports(cells, layer, false);
        if around(cells) > before {
            old.into_iter().for_each(|(index, cell)| cells.cells[index] = cell);
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

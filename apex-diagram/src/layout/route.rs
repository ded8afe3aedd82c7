//! Routes lines between layers: horizontal pieces at the height of their ends, and one vertical piece for each net, on
//! a track of its own.

use super::{cells::Cells, placed::Point};
use std::collections::BTreeMap;

/// Distance between tracks.
const TRACK: i64 = 9;
/// Distances before the first track and after the last one, where the arrow heads are.
const BEFORE: i64 = 12;
const BEHIND: i64 = 18;
/// Horizontal pieces at a smaller distance look like one.
const TOUCHING: i64 = 4;

/// The space between two neighbouring layers.
pub struct Gap {
    /// Minimum width.
    pub width: i64,
    /// Horizontal position of the vertical piece of each net, relative to the left side of the gap.
    pub tracks: BTreeMap<usize, i64>,
    /// Pairs of ends whose horizontal pieces overlap; they need different heights.
    pub hidden: Vec<(usize, usize)>,
}

/// Vertical piece of a net.
#[derive(Default)]
struct Piece {
    net: usize,
    lefts: Vec<i64>,
    rights: Vec<i64>,
    left_ends: Vec<usize>,
    right_ends: Vec<usize>,
}

impl Piece {
    fn low(&self) -> i64 {
        self.lefts.iter().chain(&self.rights).copied().min().unwrap_or(0)
    }

    fn high(&self) -> i64 {
        self.lefts.iter().chain(&self.rights).copied().max().unwrap_or(0)
    }

    fn spans(&self, y: i64) -> bool {
        self.low() <= y && y <= self.high()
    }

    fn meets(&self, other: &Self) -> bool {
        self.low() - TOUCHING <= other.high() && other.low() - TOUCHING <= self.high()
    }

    /// Cost of a position left of `other`: crossings, and, with a much higher weight, overlaps.
    fn cost_before(&self, other: &Self) -> usize {
        let crossed = other.lefts.iter().filter(|y| self.spans(**y)).count();
        let crossing = self.rights.iter().filter(|y| other.spans(**y)).count();
        crossed + crossing + 1000 * self.hidden(other).len()
    }

    /// Ends at equal heights on the right of this piece and on the left of `other`, which overlap if this piece is left
    /// of `other`.
    fn hidden(&self, other: &Self) -> Vec<(usize, usize)> {
        let mut found = vec![];
        for (right, a) in self.rights.iter().zip(&self.right_ends) {
            let touching =
                other.lefts.iter().zip(&other.left_ends).filter(|(left, _)| (right - **left).abs() < TOUCHING);
            found.extend(touching.map(|(_, b)| (*a, *b)));
        }
        found
    }
}

/// Gaps after all layers but the last. `y` returns the vertical position of an end.
pub fn gaps(cells: &Cells, y: &dyn Fn(usize) -> i64) -> Vec<Gap> {
    let mut pieces: Vec<BTreeMap<usize, Piece>> = cells.layers.iter().map(|_| BTreeMap::new()).collect();
    for link in &cells.links {
        let piece = pieces[link.gap].entry(link.net).or_default();
        piece.net = link.net;
        for end in [link.from, link.to] {
            let (heights, ends) = if cells.layer(end) == link.gap {
                (&mut piece.lefts, &mut piece.left_ends)
            } else {
                (&mut piece.rights, &mut piece.right_ends)
            };
            heights.push(y(end));
            ends.push(end);
        }
    }
    pieces.into_iter().map(|pieces| gap(pieces.into_values().collect())).collect()
}

fn gap(pieces: Vec<Piece>) -> Gap {
    let is_empty = pieces.is_empty();
    let turns = |p: &Piece| p.low() != p.high();
    let pieces = in_order(pieces.into_iter().filter(turns).collect());
    let mut level: Vec<usize> = vec![];
    for (i, piece) in pieces.iter().enumerate() {
        let before = (0..i).filter(|j| pieces[*j].meets(piece));
        level.push(before.map(|j| level[j] + 1).max().unwrap_or(0));
    }
    let hidden = (0..pieces.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let hidden = hidden.flat_map(|(a, b)| pieces[a].hidden(&pieces[b])).collect();
    let count = level.iter().max().map_or(0, |most| most + 1) as i64;
    let tracks = pieces.iter().zip(&level).map(|(p, l)| (p.net, BEFORE + *l as i64 * TRACK)).collect();
    let width = match count {
        0 if is_empty => 16,
        0 => 26,
        _ => BEFORE + (count - 1) * TRACK + BEHIND,
    };
    Gap { width, tracks, hidden }
}

/// Order of the pieces from left to right with low cost.
fn in_order(pieces: Vec<Piece>) -> Vec<Piece> {
    let cost: Vec<Vec<usize>> = pieces.iter().map(|a| pieces.iter().map(|b| a.cost_before(b)).collect()).collect();
    let gain = |a: usize, b: usize| cost[a][b] as i64 - cost[b][a] as i64;
    // Inserts each piece at the position with the lowest cost among the pieces before it.
    let mut order: Vec<usize> = vec![];
    for new in 0..pieces.len() {
        // Cost of the first position, and its change from position to position.
        let (mut change, mut best, mut place) = (0, 0, 0);
        for (at, &old) in order.iter().enumerate() {
            change += gain(old, new);
            if change < best {
                (best, place) = (change, at + 1);
            }
        }
        order.insert(place, new);
    }
    for _ in 0..pieces.len() {
        let mut better = false;
        for at in 1..order.len() {
            if gain(order[at - 1], order[at]) > 0 {
                order.swap(at - 1, at);
                better = true;
            }
        }
        if !better {
            break;
        }
    }
    let mut pieces: Vec<Option<Piece>> = pieces.into_iter().map(Some).collect();
    order.into_iter().filter_map(|i| pieces[i].take()).collect()
}

/// Removes repeated and collinear points from a line.
pub fn simplified(points: Vec<Point>) -> Vec<Point> {
    let mut result: Vec<Point> = vec![];
    for point in points {
        if result.last() == Some(&point) {
            continue;
        }
        if let [.., a, b] = result[..]
            && (a.0 == b.0 && b.0 == point.0 || a.1 == b.1 && b.1 == point.1)
        {
            result.pop();
        }
        result.push(point);
    }
    result
}

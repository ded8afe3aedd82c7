//! Vertical positions of cells, with lines as straight as possible.

use super::{
    cells::{Cell, Cells, ROW, Role},
    simplex::{Arc, solve},
};
use std::collections::BTreeSet;

/// Top of each cell. The ends in each pair of `apart` get different heights.
pub fn heights(cells: &Cells, apart: &[(usize, usize)]) -> Vec<i64> {
    let mut arcs = vec![];
    for layer in &cells.layers {
        for pair in layer.windows(2) {
            let (upper, lower) = (&cells.cells[pair[0]], &cells.cells[pair[1]]);
            let min = upper.size.1 + distance(upper, lower);
            arcs.push(Arc { from: pair[0], to: pair[1], min, weight: 1 });
        }
    }
    for &(a, b) in apart {
        let [a, b] = [a, b].map(|term| (cells.terms[term].cell, cells.offset(term)));
        let (upper, lower) = if leads(&arcs, b.0, a.0) { (b, a) } else { (a, b) };
        arcs.push(Arc { from: upper.0, to: lower.0, min: upper.1 - lower.1 + ROW, weight: 0 });
    }
    let mut count = cells.cells.len();
    for link in &cells.links {
        let [a, b] = [link.from, link.to].map(|term| (cells.terms[term].cell, cells.offset(term)));
        if a.0 == b.0 {
            continue;
        }
        // An auxiliary variable above both ends and as close to both as possible: its distances measure the bend of the
        // line.
        let weight = weight(&cells.cells[a.0], &cells.cells[b.0]);
        for (cell, offset) in [a, b] {
            arcs.push(Arc { from: count, to: cell, min: -offset, weight });
        }
        count += 1;
    }
    let solved = solve(count, &arcs);
    let least = (0..cells.cells.len()).map(|cell| solved[cell]).min().unwrap_or(0);
    (0..cells.cells.len()).map(|cell| solved[cell] - least).collect()
}

/// `true` if arcs lead from one cell to another.
fn leads(arcs: &[Arc], from: usize, to: usize) -> bool {
    let mut found = BTreeSet::from([from]);
    let mut open = vec![from];
    while let Some(cell) = open.pop() {
        open.extend(arcs.iter().filter(|arc| arc.from == cell).map(|arc| arc.to).filter(|next| found.insert(*next)));
    }
    found.contains(&to)
}

/// Minimum distance between two neighbours.
fn distance(upper: &Cell, lower: &Cell) -> i64 {
    match (upper.role, lower.role) {
        (Role::Bend, Role::Bend) => ROW,
        (Role::Bend, Role::Item(_)) if lower.slots > 0 => ROW,
        (Role::Item(_), Role::Bend) if upper.outputs < upper.right.len() => ROW,
        (Role::Item(_), Role::Item(_)) => 22,
        (Role::Pin(_) | Role::Label(_), Role::Pin(_) | Role::Label(_)) => 2,
        _ => 14,
    }
}

fn weight(a: &Cell, b: &Cell) -> i64 {
    let bends = [a, b].iter().filter(|c| matches!(c.role, Role::Bend | Role::Label(_))).count();
    match bends {
        _ if a.layer == b.layer => 2,
        0 => 4,
        1 => 8,
        _ => 24,
    }
}

//! Backward lines, and the layer of each item.

use super::simplex::{Arc, solve};
use crate::model::{Anchor, Frame, Line, Shape};

/// Layer of each item, counted from 1, and the number of the last layer. The first layer (0) and the last one contain
/// the ports of the frame.
pub fn layers(frame: &Frame) -> (Vec<usize>, usize) {
    let back = leading_back(frame);
    let (first, last) = (frame.items.len(), frame.items.len() + 1);
    let mut arcs = vec![Arc { from: first, to: last, min: 1, weight: 1 }];
    for (line, is_back) in frame.lines.iter().zip(back) {
        let (from, to) = (line.from.item().unwrap_or(first), line.to.item().unwrap_or(last));
        let (from, to) = if is_back { (to, from) } else { (from, to) };
        // A label needs a layer of its own.
        let min = if line.label.is_empty() { 1 } else { 2 };
        let weight = if from == first || to == last { 1 } else { 2 };
        if from != to {
            arcs.push(Arc { from, to, min, weight });
        }
    }
    for item in 0..frame.items.len() {
        arcs.push(Arc { from: first, to: item, min: 1, weight: 0 });
        arcs.push(Arc { from: item, to: last, min: 1, weight: 0 });
    }
    let solved = solve(frame.items.len() + 2, &arcs);
    let layer = |i: usize| (solved[i] - solved[first]) as usize;
    ((0..frame.items.len()).map(layer).collect(), layer(last))
}

/// For each line, `true` if it closes a cycle in a walk from the entries of the graph.
fn leading_back(frame: &Frame) -> Vec<bool> {
    let count = frame.items.len();
    let mut leaving: Vec<Vec<usize>> = vec![vec![]; count];
    let mut has_source = vec![false; count];
    let mut is_entry = vec![false; count];
    for (i, line) in frame.lines.iter().enumerate() {
        match (line.from, line.to.item()) {
            (Anchor::Of(item, _), Some(to)) => {
                leaving[item].push(i);
                has_source[to] |= item != to;
            }
            (Anchor::Own(_), Some(to)) => is_entry[to] = true,
            _ => {}
        }
    }
    let rank = |item: &usize| match () {
        () if frame.items[*item].shape == Shape::Start => 0,
        () if !has_source[*item] => 1,
        () if is_entry[*item] => 2,
        () => 3,
    };
    let mut roots: Vec<usize> = (0..count).collect();
    roots.sort_by_key(rank);
    let mut back = vec![false; frame.lines.len()];
    let mut state = vec![Visit::New; count];
    for root in roots {
        walk(root, &frame.lines, &leaving, &mut state, &mut back);
    }
    back
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    New,
    Open,
    Done,
}

/// Walks depth first, without recursion, and marks backward lines.
fn walk(root: usize, lines: &[Line], leaving: &[Vec<usize>], state: &mut [Visit], back: &mut [bool]) {
    if state[root] != Visit::New {
        return;
    }
    state[root] = Visit::Open;
    let mut stack = vec![(root, 0)];
    while let Some((item, next)) = stack.pop() {
        let Some(&line) = leaving[item].get(next) else {
            state[item] = Visit::Done;
            continue;
        };
        stack.push((item, next + 1));
        let Some(to) = lines[line].to.item() else { continue };
        match state[to] {
            Visit::New => {
                state[to] = Visit::Open;
                stack.push((to, 0));
            }
            Visit::Open => back[line] = true,
            Visit::Done => {}
        }
    }
}

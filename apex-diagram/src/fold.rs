//! Reduction of large diagrams to a readable size: closes nested graphs and draws chains as one box.

use crate::{
    layout::place,
    model::{Anchor, Frame, Item, Line, Shape, Side},
    states,
};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of boxes of a diagram that is readable without zooming.
pub const READABLE: usize = 24;
/// Maximum width of a diagram that is readable without zooming, in pixels.
const WIDEST: i64 = 2000;
/// Minimum number of nodes of a chain that becomes one box.
const CHAIN: usize = 3;

/// Changes by which a diagram was reduced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Folding {
    /// Depth to which nested graphs are still open, or `None` if all are open.
    pub depth: Option<usize>,
    /// Number of boxes that represent a chain of nodes.
    pub chains: usize,
}

/// Reduces a diagram until it is readable, with at most [`READABLE`] boxes, if that is possible. Closes the innermost
/// graphs first, then draws chains of synchronous nodes as one box.
pub fn folded(item: Item) -> (Item, Folding) {
    let mut folding = Folding::default();
    if is_readable(&item) {
        return (item, folding);
    }
    folding.depth = readable_depth(&item, |closed| is_readable(&closed));
    let mut item = match folding.depth {
        Some(depth) => item.closed(depth + 1),
        None => item,
    };
    if !is_readable(&item) {
        folding.chains = fold_chains(&mut item);
    }
    (item, folding)
}

/// Activity of a diagram (see [`states`]), with nested graphs closed until it is readable. Returns `None` if the
/// diagram has no activity.
pub fn folded_states(item: &Item) -> Option<(Item, Folding)> {
    let whole = states(item)?;
    if is_readable(&whole) {
        return Some((whole, Folding::default()));
    }
    let depth = readable_depth(item, |closed| states(&closed).is_some_and(|seen| is_readable(&seen)));
    let seen = depth.and_then(|depth| states(&item.clone().closed(depth + 1)));
    Some((seen.unwrap_or(whole), Folding { depth, chains: 0 }))
}

fn is_readable(item: &Item) -> bool {
    item.count() <= READABLE && place(item).size.0 <= WIDEST
}

/// Largest depth at which the closed diagram is readable, or else 0. Returns `None` without nested graphs.
fn readable_depth(item: &Item, is_readable: impl Fn(Item) -> bool) -> Option<usize> {
    let mut depths = (1..depth(item)).rev().map(|levels| levels - 1);
    depths.clone().find(|depth| is_readable(item.clone().closed(depth + 1))).or(depths.next_back())
}

/// Number of nesting levels of graphs, including the outermost graph.
fn depth(item: &Item) -> usize {
    item.inside.as_ref().map_or(0, |frame| 1 + frame.items.iter().map(depth).max().unwrap_or(0))
}

/// Replaces each long chain by one box, at all depths. Returns their number.
fn fold_chains(item: &mut Item) -> usize {
    let Some(frame) = &mut item.inside else { return 0 };
    let chains: Vec<Vec<usize>> = chains(frame).into_iter().filter(|chain| chain.len() >= CHAIN).collect();
    if !chains.is_empty() {
        *frame = with_boxes(frame, &chains);
    }
    chains.len() + frame.items.iter_mut().map(fold_chains).sum::<usize>()
}

/// Chains of nodes. Each node in a chain has a single line to the next one, which has no other incoming line.
fn chains(frame: &Frame) -> Vec<Vec<usize>> {
    let mut next: BTreeMap<usize, usize> = BTreeMap::new();
    for line in frame.lines.iter().filter(|line| !line.active) {
        if let (Some(from), Some(to)) = (line.from.item(), line.to.item())
            && frame.lines.iter().filter(|l| l.from.item() == Some(from)).count() == 1
            && frame.lines.iter().filter(|l| l.to.item() == Some(to)).count() == 1
            && is_alike(&frame.items[from], &frame.items[to])
            && from != to
        {
            next.insert(from, to);
        }
    }
    let followers: BTreeSet<usize> = next.values().copied().collect();
    let firsts = next.keys().filter(|first| !followers.contains(first));
    firsts.map(|first| std::iter::successors(Some(*first), |at| next.get(at).copied()).collect()).collect()
}

fn is_alike(a: &Item, b: &Item) -> bool {
    let is_plain =
        |item: &Item| item.shape == Shape::Node && item.inside.is_none() && item.states.is_none() && !item.each;
    is_plain(a) && is_plain(b) && a.active == b.active && a.new == b.new
}

/// Replaces each chain by a box in the position of its first node.
fn with_boxes(frame: &Frame, chains: &[Vec<usize>]) -> Frame {
    let mut result = Frame::default();
    // Port in the new frame for each old one.
    let mut places: BTreeMap<Anchor, Anchor> = BTreeMap::new();
    let inner: BTreeSet<usize> = chains.iter().flat_map(|chain| chain[1..].iter().copied()).collect();
    for (index, item) in frame.items.iter().enumerate().filter(|(index, _)| !inner.contains(index)) {
        let at = result.items.len();
        let chain = chains.iter().find(|chain| chain[0] == index);
        let (item, ports) = chain.map_or_else(
            || (item.clone(), (0..item.ports.len()).map(|port| (index, port)).collect()),
            |chain| one_box(frame, chain),
        );
        let ports = ports.into_iter().enumerate();
        places.extend(ports.map(|(new, (item, port))| (Anchor::Of(item, port), Anchor::Of(at, new))));
        result.items.push(item);
    }
    let place = |end: Anchor| end.item().map_or(Some(end), |_| places.get(&end).copied());
    result.lines = frame
        .lines
        .iter()
        .filter_map(|line| Some(Line { from: place(line.from)?, to: place(line.to)?, ..line.clone() }))
        .collect();
    result
}

/// Box for a chain, and the item and port from which each of its ports comes.
fn one_box(frame: &Frame, chain: &[usize]) -> (Item, Vec<(usize, usize)>) {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    let items = || chain.iter().map(|index| &frame.items[*index]);
    let mut item = Item::new(Shape::Node, &format!("{} … {}", frame.items[first].name, frame.items[last].name));
    (item.active, item.new) = (frame.items[first].active, frame.items[first].new);
    item.words =
        items().map(|item| format!("{}: {}", item.name, item.words.first().map_or("", String::as_str))).collect();
    item.docs = format!("a chain of {} nodes", chain.len());
    let begins = |side: Side| matches!(side, Side::Left | Side::Top);
    let mut ports = vec![];
    for (index, wanted) in [(first, true), (last, false)] {
        let of = frame.items[index].ports.iter().enumerate().filter(|(_, port)| begins(port.side) == wanted);
        for (number, port) in of {
            item.ports.push(port.clone());
            ports.push((index, number));
        }
    }
    (item, ports)
}

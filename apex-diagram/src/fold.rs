//! Large pictures made small enough to be read: nested graphs are closed, and chains become one box.

use crate::{
    layout::place,
    model::{Anchor, Frame, Item, Line, Shape, Side},
    states,
};
use std::collections::{BTreeMap, BTreeSet};

/// Most boxes of a picture that can be read without zooming.
pub const READABLE: usize = 24;
/// Widest picture that can be read without zooming, in pixels.
const WIDEST: i64 = 2000;
/// Fewest nodes of a chain that becomes one box.
const CHAIN: usize = 3;

/// What was done to a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Folding {
    /// How deep nested graphs are still open; nothing if all of them are.
    pub depth: Option<usize>,
    /// How many boxes stand for a chain of nodes.
    pub chains: usize,
}

/// The picture with as much closed as it takes to be read, if that is possible, with [`READABLE`] boxes at most: first
/// the innermost graphs, then chains of synchronous nodes.
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

/// The activity of a picture (see [`states`]), with nested graphs closed until it can be read; nothing if there is no
/// activity in it.
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

/// The largest depth at which the closed picture can be read, or else 0; nothing if there are no nested graphs.
fn readable_depth(item: &Item, is_readable: impl Fn(Item) -> bool) -> Option<usize> {
    let mut depths = (1..depth(item)).rev().map(|levels| levels - 1);
    depths.clone().find(|depth| is_readable(item.clone().closed(depth + 1))).or(depths.next_back())
}

/// How many graphs are nested in each other, the outermost one included.
fn depth(item: &Item) -> usize {
    item.inside.as_ref().map_or(0, |frame| 1 + frame.items.iter().map(depth).max().unwrap_or(0))
}

/// Makes one box of each long chain, at all depths; gives their number.
fn fold_chains(item: &mut Item) -> usize {
    let Some(frame) = &mut item.inside else { return 0 };
    let chains: Vec<Vec<usize>> = chains(frame).into_iter().filter(|chain| chain.len() >= CHAIN).collect();
    if !chains.is_empty() {
        *frame = with_boxes(frame, &chains);
    }
    chains.len() + frame.items.iter_mut().map(fold_chains).sum::<usize>()
}

/// Chains of nodes: from each to the next leads the only line of the one, which is the only one to the other.
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
    is_plain(a) && is_plain(b) && a.active == b.active
}

/// The frame with a box for each chain, where its first node was.
fn with_boxes(frame: &Frame, chains: &[Vec<usize>]) -> Frame {
    let mut result = Frame::default();
    // From each port to that of the new frame.
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

/// A box for a chain, with the item and port that each of its ports was.
fn one_box(frame: &Frame, chain: &[usize]) -> (Item, Vec<(usize, usize)>) {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    let items = || chain.iter().map(|index| &frame.items[*index]);
    let mut item = Item::new(Shape::Node, &format!("{} … {}", frame.items[first].name, frame.items[last].name));
    item.active = frame.items[first].active;
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

//! Marks for what a graph has and others lack.

use crate::model::{Frame, Item};
use std::collections::BTreeSet;

/// Numbers of nodes, without nested graphs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct News {
    /// Nodes whose types the others lack.
    pub new: usize,
    /// All nodes.
    pub all: usize,
}

/// Marks the nodes whose types none of the `others` has, at any depth, and the nested graphs that none of them has
/// with the same name, nodes and connections. The outermost graph is not marked. A new graph also says how many of its
/// nodes are new.
pub fn mark_new(item: &mut Item, others: &[Item]) -> News {
    let mut known = BTreeSet::new();
    others.iter().for_each(|other| collect(other, &mut known));
    item.inside.as_mut().map_or_else(News::default, |frame| mark(frame, &known))
}

fn mark(frame: &mut Frame, known: &BTreeSet<String>) -> News {
    let mut news = News::default();
    for item in frame.items.iter_mut().filter(|item| !item.ty.is_empty()) {
        item.new = !known.contains(&identity(item));
        let of = match &mut item.inside {
            Some(inside) => mark(inside, known),
            None => News { new: usize::from(item.new), all: 1 },
        };
        if item.new && item.inside.is_some() {
            item.words.push(format!("{} of {} new", of.new, of.all));
        }
        news = News { new: news.new + of.new, all: news.all + of.all };
    }
    news
}

/// Adds what an item has, and itself.
fn collect(item: &Item, known: &mut BTreeSet<String>) {
    known.insert(identity(item));
    item.items().for_each(|inner| collect(inner, known));
}

/// Type of a node, with everything that is in a nested graph or a state machine, but for parameters.
fn identity(item: &Item) -> String {
    let Some(frame) = item.inside.as_ref().or(item.states.as_ref()) else { return item.ty.clone() };
    let items: Vec<String> = frame.items.iter().map(|inner| format!("{}: {}", inner.name, identity(inner))).collect();
    format!("{} {{ {}; {:?} }}", item.ty, items.join(", "), frame.lines)
}

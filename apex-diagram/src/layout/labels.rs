//! What stands at lines. A long way says at its beginning where it leads, and at its end where it comes from.

use crate::{
    model::{Anchor, Frame, Item},
    text::shortened,
};
use std::collections::BTreeMap;

/// A line that passes so many layers between those of its ends is long.
const LONG: usize = 3;
/// Longest label, in characters.
const LONGEST: usize = 26;

/// A bend: its net, whether that goes back, its layer.
pub type Bend = (usize, bool, usize);

/// What stands at bends.
pub type Labels = BTreeMap<Bend, String>;

/// The way of a line over layers.
pub struct Way {
    /// The lines that begin together.
    pub net: usize,
    /// Its ends.
    pub from: usize,
    pub to: usize,
    /// It goes from right to left.
    pub back: bool,
    /// The layers in which it bends.
    pub passed: Vec<usize>,
    /// The layer for its own label.
    pub labelled: usize,
    /// The layer of its end.
    pub end: usize,
}

/// The labels of all lines of a frame, whose ways are given in the same order.
pub fn labels(around: &Item, frame: &Frame, ways: &[Way]) -> Labels {
    let mut labels = Labels::new();
    let mut targets: BTreeMap<Bend, Vec<String>> = BTreeMap::new();
    for (line, way) in frame.lines.iter().zip(ways) {
        let bend = |layer: usize| (way.net, way.back, layer);
        let own = !line.label.is_empty();
        if own && way.passed.contains(&way.labelled) {
            labels.insert(bend(way.labelled), line.label.clone());
        }
        let (Some(&first), Some(&last)) = (way.passed.first(), way.passed.last()) else { continue };
        // A way back bends in the layers of its ends, too.
        if way.passed.len() < LONG + if way.back { 2 } else { 0 } {
            continue;
        }
        let (from, to) = (name(around, frame, line.from), name(around, frame, line.to));
        if own {
            labels.insert(bend(way.labelled), format!("{} → {to}", line.label));
        } else {
            targets.entry(bend(first)).or_default().push(to);
        }
        labels.entry(bend(last)).or_insert_with(|| shortened(&format!("{from} →"), LONGEST));
    }
    for (bend, names) in targets {
        let all = format!("→ {}", names.join(", "));
        let label = match names.split_first() {
            Some((first, more)) if !more.is_empty() && all.chars().count() > LONGEST => {
                format!("→ {}, {} more", shortened(first, LONGEST), more.len())
            }
            _ => shortened(&all, LONGEST),
        };
        labels.insert(bend, label);
    }
    labels
}

/// An end as the text has it: `node.port`.
fn name(around: &Item, frame: &Frame, end: Anchor) -> String {
    match end {
        Anchor::Own(port) => around.ports[port].name.clone(),
        Anchor::Of(item, port) => {
            let item = &frame.items[item];
            match item.ports[port].name.as_str() {
                "" => item.name.clone(),
                port => format!("{}.{port}", item.name),
            }
        }
    }
}

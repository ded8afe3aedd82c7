//! Labels of lines. A long line is labelled with its target at the start, and with its source at the end.

use crate::{
    model::{Anchor, Frame, Item},
    text::shortened,
};
use std::collections::BTreeMap;

/// Minimum number of layers that a long line passes between its ends.
const LONG: usize = 3;
/// Maximum length of a label in characters.
const LONGEST: usize = 26;

/// A bend: its net, `true` for a backward line, and its layer.
pub type Bend = (usize, bool, usize);

/// Labels of bends.
pub type Labels = BTreeMap<Bend, String>;

/// Path of a line through layers.
pub struct Way {
    /// Number of the net: lines with a common start.
    pub net: usize,
    /// Ends of the line.
    pub from: usize,
    pub to: usize,
    /// `true` for a backward line, from right to left.
    pub back: bool,
    /// Layers in which the line bends.
    pub passed: Vec<usize>,
    /// Layer of the line's own label.
    pub labelled: usize,
    /// Layer of its end.
    pub end: usize,
}

/// Labels of all lines of a frame. `ways` has the same order as the lines.
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
        // A backward line also bends in the layers of its ends.
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

/// End of a line in the notation of the language: `node.port`.
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

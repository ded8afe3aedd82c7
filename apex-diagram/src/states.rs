//! The activity sub-graph alone, as a state diagram: who can be active, and where activity goes with which token.

use crate::model::{Anchor, Flow, Frame, Item, Line, Port, Shape, Side};
use apex_dsl::machine::{Arm, Machine, Sending, Slot};
use std::collections::{BTreeMap, BTreeSet};

/// What activity sees of a picture; nothing if there is no activity in it.
pub fn states(diagram: &Item) -> Option<Item> {
    let seen = seen(diagram, BTreeSet::new())?;
    Some(Item { shape: Shape::Node, ..seen.item })
}

/// An item as activity sees it.
struct Seen {
    item: Item,
    /// From the numbers of its ports to those that they have now. Nothing if each line gets a port of its own.
    ports: Option<BTreeMap<usize, usize>>,
}

/// An item whose ports `used` activity comes through; nothing if activity does not come to it.
fn seen(item: &Item, used: BTreeSet<usize>) -> Option<Seen> {
    let shape = if item.shape == Shape::Node { Shape::State } else { item.shape };
    let words = item.words.iter().take(1).cloned().collect();
    let bare = Item { shape, words, each: false, ports: vec![], inside: None, states: None, ..item.clone() };
    let Some(frame) = item.inside.as_ref().filter(|_| !item.each) else {
        let is_seen = !used.is_empty() || item.states.is_some();
        return is_seen.then(|| Seen { item: Item { inside: item.states.clone(), ..bare }, ports: None });
    };
    let mut inside = active(frame);
    let mut own = used;
    own.extend(inside.lines.iter().flat_map(|l| [l.from, l.to]).filter_map(own_port));
    if inside.items.is_empty() && own.is_empty() {
        return None;
    }
    let number: BTreeMap<usize, usize> = own.iter().enumerate().map(|(new, old)| (*old, new)).collect();
    for line in &mut inside.lines {
        for end in [&mut line.from, &mut line.to] {
            *end = own_port(*end).map_or(*end, |port| Anchor::Own(number[&port]));
        }
    }
    let ports = own.iter().map(|port| turned(&item.ports[*port])).collect();
    Some(Seen { item: Item { ports, inside: Some(inside), ..bare }, ports: Some(number) })
}

fn own_port(end: Anchor) -> Option<usize> {
    if let Anchor::Own(port) = end { Some(port) } else { None }
}

/// In a state diagram everything goes from left to right.
fn turned(port: &Port) -> Port {
    let side = if matches!(port.side, Side::Left | Side::Top) { Side::Left } else { Side::Right };
    Port { side, ..port.clone() }
}

/// The active lines of a frame and the items at their ends.
fn active(frame: &Frame) -> Frame {
    let lines: Vec<&Line> = frame.lines.iter().filter(|l| l.active).collect();
    let mut used = vec![BTreeSet::new(); frame.items.len()];
    for end in lines.iter().flat_map(|l| [l.from, l.to]) {
        if let Anchor::Of(item, port) = end {
            used[item].insert(port);
        }
    }
    let mut view = View { frame, result: Frame::default(), items: BTreeMap::new(), lines: BTreeMap::new() };
    for (at, (item, used)) in frame.items.iter().zip(used).enumerate() {
        if let Some(seen) = seen(item, used) {
            view.items.insert(at, (view.result.items.len(), seen.ports));
            view.result.items.push(seen.item);
        }
    }
    lines.into_iter().for_each(|line| view.add(line));
    view.result
}

/// A frame as activity sees it, while it is being made.
struct View<'a> {
    frame: &'a Frame,
    result: Frame,
    /// From the number of an item in the whole picture: its number here, and those of its ports.
    items: BTreeMap<usize, (usize, Option<BTreeMap<usize, usize>>)>,
    /// The lines by what they connect: those between the same states are drawn as one.
    lines: BTreeMap<(Anchor, Anchor), usize>,
}

impl View<'_> {
    fn add(&mut self, line: &Line) {
        let label = match line.from {
            Anchor::Of(item, port) if self.frame.items[item].inside.is_none() => {
                self.frame.items[item].ports[port].name.clone()
            }
            _ => String::new(),
        };
        let ends = (self.place(line.from), self.place(line.to));
        if let Some(&same) = self.lines.get(&ends) {
            let all = &mut self.result.lines[same].label;
            if !label.is_empty() && all.split(", ").all(|known| known != label) {
                *all = if all.is_empty() { label } else { format!("{all}, {label}") };
            }
            return;
        }
        self.lines.insert(ends, self.result.lines.len());
        let (from, to) = (self.end(line.from, Side::Right), self.end(line.to, Side::Left));
        // All lines are alike here: there is nothing to tell apart.
        self.result.lines.push(Line { from, to, active: false, flow: Flow::Synchronous, label });
    }

    /// What tells ends of lines apart: a state is the same at all of its ports.
    fn place(&self, end: Anchor) -> Anchor {
        match end {
            Anchor::Of(item, _) if self.items[&item].1.is_none() => Anchor::Of(item, 0),
            _ => end,
        }
    }

    /// An end here; a state gets a port for it.
    fn end(&mut self, end: Anchor, side: Side) -> Anchor {
        let Anchor::Of(item, port) = end else { return end };
        let (item, ports) = &self.items[&item];
        match ports {
            Some(ports) => Anchor::Of(*item, ports[&port]),
            None => {
                let made = &mut self.result.items[*item];
                // All lines at a dot end at the same point.
                if made.shape == Shape::State || made.ports.is_empty() {
                    made.ports.push(Port::unnamed(side));
                }
                Anchor::Of(*item, made.ports.len() - 1)
            }
        }
    }
}

/// The picture of a state machine by itself.
pub fn chart(of: &Machine) -> Item {
    let mut item = Item::new(Shape::Node, &of.name);
    item.words.push("fsm".to_owned());
    item.docs.clone_from(&of.docs);
    item.inside = Some(machine(of));
    item
}

/// The inside of a state machine as a state diagram.
pub fn machine(machine: &Machine) -> Frame {
    let mut frame = Frame::default();
    for state in &machine.states {
        frame.items.push(Item { active: true, ..Item::new(Shape::State, state) });
    }
    frame.items.push(Item::new(Shape::Start, "start"));
    transition(&mut frame, machine.states.len(), 0, sends(machine, &machine.begin).trim().to_owned());
    for slot in &machine.slots {
        for arm in &slot.arms {
            let what = label(machine, slot, arm);
            match arm.target {
                Some(target) => transition(&mut frame, arm.state, target, what),
                None => frame.items[arm.state].words.push(what),
            }
        }
    }
    frame
}

fn transition(frame: &mut Frame, from: usize, to: usize, label: String) {
    let mut end = |item: usize, side| {
        let ports = &mut frame.items[item].ports;
        ports.push(Port::unnamed(side));
        Anchor::Of(item, ports.len() - 1)
    };
    let (from, to) = (end(from, Side::Right), end(to, Side::Left));
    frame.lines.push(Line { from, to, active: false, flow: Flow::Synchronous, label });
}

/// `slot [guard] / events`
fn label(machine: &Machine, slot: &Slot, arm: &Arm) -> String {
    let mut text = slot.name.clone();
    if let Some(guard) = &arm.guard {
        text += &format!(" [{}]", guard.text(&slot.name));
    }
    text + &sends(machine, &arm.sends)
}

/// ` / events`, or nothing.
fn sends(machine: &Machine, sent: &[Sending]) -> String {
    let events: Vec<&str> = sent.iter().map(|s| machine.events[s.event].0.as_str()).collect();
    if events.is_empty() { String::new() } else { format!(" / {}", events.join(", ")) }
}

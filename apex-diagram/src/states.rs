//! Reduces a diagram to activity, as a state diagram: the nodes that can be active, and the tokens that pass activity
//! on.

use crate::model::{Anchor, Flow, Frame, Item, Line, Port, Shape, Side};
use apex_dsl::machine::{Arm, Machine, Sending, Slot};
use std::collections::{BTreeMap, BTreeSet};

/// State diagram of the activity in a diagram, or `None` if there is no activity.
pub fn states(diagram: &Item) -> Option<Item> {
    let seen = seen(diagram, BTreeSet::new())?;
    Some(Item { shape: Shape::Node, ..seen.item })
}

/// An item in the state diagram.
struct Seen {
    item: Item,
    /// New index of each port that is kept, or `None` if each line gets a port of its own.
    ports: Option<BTreeMap<usize, usize>>,
}

/// State of an item, of which activity uses the ports `used`, or `None` if activity does not reach it.
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

/// Moves a port to the left or the right: state diagrams have no ports at the top or the bottom.
fn turned(port: &Port) -> Port {
    let side = if matches!(port.side, Side::Left | Side::Top) { Side::Left } else { Side::Right };
    Port { side, ..port.clone() }
}

/// Active lines of a frame, and the items at their ends.
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

/// Construction of the state diagram of a frame.
struct View<'a> {
    frame: &'a Frame,
    result: Frame,
    /// For the index of an item in the whole diagram: its new index, and those of its ports.
    items: BTreeMap<usize, (usize, Option<BTreeMap<usize, usize>>)>,
    /// Lines by their ends: lines between the same states are drawn as one.
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
        // All lines look alike, because all of them carry activity.
        self.result.lines.push(Line { from, to, active: false, flow: Flow::Synchronous, label });
    }

    /// Identity of an end: all ports of a state are one end.
    fn place(&self, end: Anchor) -> Anchor {
        match end {
            Anchor::Of(item, _) if self.items[&item].1.is_none() => Anchor::Of(item, 0),
            _ => end,
        }
    }

    /// End in the state diagram; a state gets a new port for it.
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

/// Diagram of a state machine.
pub fn chart(of: &Machine) -> Item {
    let mut item = Item::new(Shape::Node, &of.name);
    item.words.push("fsm".to_owned());
    item.docs.clone_from(&of.docs);
    item.inside = Some(machine(of));
    item
}

/// Contents of a state machine as a state diagram.
pub fn machine(machine: &Machine) -> Frame {
    let mut frame = Frame::default();
    for state in &machine.states {
        frame.items.push(Item { active: true, ..Item::new(Shape::State, state) });
    }
    frame.items.push(Item::new(Shape::Start, "start"));
    transition(&mut frame, machine.states.len(), 0, sends(machine, machine.begin()).trim().to_owned());
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

/// Label of a transition: `slot [guard] / events`.
fn label(machine: &Machine, slot: &Slot, arm: &Arm) -> String {
    let mut text = slot.name.clone();
    if let Some(condition) = machine.condition(slot, arm) {
        text += &format!(" [{condition}]");
    }
    text + &sends(machine, &arm.sends)
}

/// Events of a transition: ` / events`, or an empty string.
fn sends(machine: &Machine, sent: &[Sending]) -> String {
    let events: Vec<&str> = sent.iter().map(|s| machine.events[s.event].0.as_str()).collect();
    if events.is_empty() { String::new() } else { format!(" / {}", events.join(", ")) }
}

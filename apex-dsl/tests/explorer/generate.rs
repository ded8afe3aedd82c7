//! Random graphs of activity.

use crate::{
    case::{Case, End, Item, Part, Wire},
    dice::Dice,
};

/// Node type: its name and its inputs, slots, outputs and events.
struct Kind {
    name: &'static str,
    inputs: &'static [&'static str],
    slots: &'static [&'static str],
    outputs: &'static [&'static str],
    events: &'static [&'static str],
}

const fn kind(
    name: &'static str,
    inputs: &'static [&'static str],
    slots: &'static [&'static str],
    outputs: &'static [&'static str],
    events: &'static [&'static str],
) -> Kind {
    Kind { name, inputs, slots, outputs, events }
}

/// The nodes of `world.rs`. Those that come first are used more often.
const KINDS: [Kind; 9] = [
    kind("Turn", &[], &["s", "t"], &[], &["l", "r"]),
    kind("Rest", &[], &["s"], &[], &[]),
    kind("Mixed", &["x"], &["s"], &["out"], &["l"]),
    kind("pass", &["x"], &[], &["out"], &[]),
    kind("fork", &["x"], &[], &["y", "z"], &[]),
    kind("join", &["a", "b"], &[], &["out"], &[]),
    kind("emit", &["x"], &[], &[], &["l", "r"]),
    kind("source", &[], &[], &["out"], &["l"]),
    kind("Stop", &["x"], &["s"], &["out"], &["l"]),
];

/// Ports that nodes have without a declaration, and that may send activity.
const STANDARD: [&str; 4] = ["activated", "deactivated", "processed", "failed"];

/// A random source file.
pub fn generate(dice: &mut Dice) -> Case {
    let mut parts: Vec<Part> = vec![];
    for number in 0..dice.below(3) {
        let part = Maker::new(dice, format!("G{number}"), &parts).make(false);
        parts.extend(Some(part).filter(|part| !part.nodes.is_empty()));
    }
    let program = Maker::new(dice, "P".to_owned(), &parts).make(true);
    parts.push(program);
    Case { parts }
}

/// Maker of a graph that may contain those made before.
struct Maker<'a> {
    dice: &'a mut Dice,
    before: &'a [Part],
    part: Part,
}

impl<'a> Maker<'a> {
    fn new(dice: &'a mut Dice, name: String, before: &'a [Part]) -> Self {
        Self { dice, before, part: Part { name, ..Part::default() } }
    }

    fn make(mut self, is_program: bool) -> Part {
        self.ports(is_program);
        let (least, more) = if is_program { (2, 5) } else { (1, 3) };
        for number in 0..least + self.dice.below(more) {
            self.node(number);
        }
        let starts = match self.dice.below(10) {
            _ if !is_program => usize::from(self.dice.one_in(10)),
            0..=6 => 1,
            7 | 8 => 2,
            _ => 3,
        };
        for _ in 0..starts {
            self.start();
        }
        self.borders();
        if self.dice.one_in(2) {
            self.interrupt();
        }
        for _ in 0..2 * self.part.nodes.len() + self.dice.below(4) {
            let from = self.sender();
            let to = self.taker();
            self.wire(from, to);
        }
        self.required();
        let wires = &self.part.wires;
        self.part.ports.retain(|(_, name)| {
            let end = End::new("", name);
            wires.iter().any(|wire| wire.from == end || wire.to == end)
        });
        for _ in 0..if is_program { 2 + self.dice.below(4) } else { self.dice.below(2) } {
            self.claim();
        }
        self.part
    }

    fn ports(&mut self, is_program: bool) {
        let mut ports = vec![("slot", "s"), ("event", "l")];
        let more = [("slot", "t"), ("event", "r"), ("in", "x"), ("in", "w"), ("out", "y"), ("out", "z")];
        ports.extend(more.into_iter().filter(|_| self.dice.below(5) < 2));
        if is_program {
            ports.retain(|_| self.dice.one_in(3));
        }
        self.part.ports = ports;
    }

    fn node(&mut self, number: usize) {
        let nested = self.dice.below(self.before.len() + 1).checked_sub(1).filter(|_| self.dice.below(3) > 0);
        let (ty, is_graph) = match nested {
            Some(graph) => (self.before[graph].name.clone(), true),
            None if self.dice.one_in(12) => ("Stop".to_owned(), false),
            None => {
                let most = 1 + self.dice.below(KINDS.len());
                (KINDS[self.dice.below(most)].name.to_owned(), false)
            }
        };
        let name = format!("{}{number}", if is_graph { "g" } else { "n" });
        let times_out = !is_graph && (ty == "Rest" && !self.dice.one_in(4) || self.dice.one_in(5));
        let delay = match ty.as_str() {
            "pass" | "Mixed" if self.dice.one_in(3) => 1 + self.dice.below(2),
            _ => 0,
        };
        self.part.nodes.push(Item { name, ty, times_out, delay });
    }

    /// Names of the ports of a node that are of a kind, given by the keyword of a graph.
    fn ports_of(&self, item: &Item, keyword: &str) -> Vec<&'static str> {
        if let Some(part) = self.before.iter().find(|part| part.name == item.ty) {
            return part.ports.iter().filter(|(kind, _)| *kind == keyword).map(|(_, name)| *name).collect();
        }
        let Some(kind) = KINDS.iter().find(|kind| kind.name == item.ty) else { return vec![] };
        match keyword {
            "in" => kind.inputs.to_vec(),
            "slot" => kind.slots.to_vec(),
            "out" => kind.outputs.to_vec(),
            _ => kind.events.to_vec(),
        }
    }

    fn own(&mut self, keywords: [&str; 2]) -> Option<End> {
        let ports: Vec<&str> =
            self.part.ports.iter().filter(|(kind, _)| keywords.contains(kind)).map(|(_, name)| *name).collect();
        self.dice.of(&ports).map(|name| End::new("", name))
    }

    fn item(&mut self) -> Item {
        let number = self.dice.below(self.part.nodes.len());
        self.part.nodes[number].clone()
    }

    /// A random port that sends tokens.
    fn sender(&mut self) -> Option<End> {
        if self.dice.one_in(8) {
            return self.own(["slot", "in"]);
        }
        let item = self.item();
        let is_graph = self.before.iter().any(|part| part.name == item.ty);
        if item.times_out && !self.dice.one_in(3) {
            return Some(End::new(&item.name, "timeout"));
        }
        if self.dice.one_in(5) {
            return Some(End::new(&item.name, "cancelled"));
        }
        if self.dice.one_in(12) {
            let port = if is_graph { "failed" } else { STANDARD[self.dice.below(STANDARD.len())] };
            return Some(End::new(&item.name, port));
        }
        let mut ports = self.ports_of(&item, "event");
        ports.extend(self.ports_of(&item, "out"));
        self.dice.of(&ports).map(|port| End::new(&item.name, port))
    }

    /// A random port that takes tokens.
    fn taker(&mut self) -> Option<End> {
        if self.dice.one_in(8) {
            return self.own(["event", "out"]);
        }
        if self.dice.one_in(14) {
            return Some(End::new("", if self.dice.one_in(2) { "reset" } else { "exit" }));
        }
        let item = self.item();
        if self.dice.one_in(3) {
            return Some(End::new(&item.name, if self.dice.one_in(2) { "cancel" } else { "resume" }));
        }
        if self.dice.one_in(12) {
            return Some(End::new(&item.name, if self.dice.one_in(2) { "enable" } else { "disable" }));
        }
        let slots = self.ports_of(&item, "slot");
        let inputs = self.ports_of(&item, "in");
        let ports = if self.dice.one_in(2) { slots } else { [slots, inputs].concat() };
        self.dice.of(&ports).map(|port| End::new(&item.name, port))
    }

    fn wire(&mut self, from: Option<End>, to: Option<End>) {
        let (Some(from), Some(to)) = (from, to) else { return };
        let active = self.dice.below(4) > 0;
        // A graph whose events lead back to its slots is often refused, as a node may wait for its own event then.
        let is_loop = from.node == to.node && from.port != "cancelled" && self.dice.below(4) > 0;
        let is_named = |end: &End| self.part.nodes.iter().position(|item| item.name == end.node);
        let is_input = |end: &End| {
            let item = is_named(end).map(|number| &self.part.nodes[number]);
            let inside = item.is_some_and(|item| self.ports_of(item, "in").contains(&end.port.as_str()));
            inside || end.node.is_empty() && ["y", "z"].contains(&end.port.as_str())
        };
        let interrupts = ["cancel", "resume"].contains(&to.port.as_str()) || from.port == "cancelled";
        // Synchronous connections lead forward, so that there are no cycles; an event never leads to its own node.
        let is_backward = is_input(&to) && is_named(&from).is_some_and(|n| is_named(&to).is_some_and(|to| n >= to));
        let is_own = from.node == to.node && !interrupts && !self.before.iter().any(|p| is_graph(p, &self.part, &from));
        let is_taken = |wire: &Wire| wire.to == to && (is_input(&to) || wire.from == from);
        if is_backward || is_own || is_loop || self.part.wires.iter().any(is_taken) {
            return;
        }
        self.part.wires.push(Wire { from, active, to });
    }

    fn start(&mut self) {
        let item = self.item();
        let slots = self.ports_of(&item, "slot");
        let port = match self.dice.of(&slots) {
            _ if self.dice.one_in(12) => ["cancel", "resume", "enable"][self.dice.below(3)],
            Some(slot) => slot,
            None => "",
        };
        let (to, active) = (End::new(&item.name, port), port.is_empty() || !self.dice.one_in(12));
        if !self.part.wires.iter().any(|other| other.to == to) {
            self.part.wires.push(Wire { from: End::new("", "start"), active, to });
        }
    }

    /// Connects a node so that it can be cancelled, and another one that can give it its activity back.
    fn interrupt(&mut self) {
        let (item, other) = (self.item(), self.item());
        let from = self.sender();
        self.wire(from, Some(End::new(&item.name, "cancel")));
        let slots = self.ports_of(&other, "slot");
        let to = self.dice.of(&slots).map(|slot| End::new(&other.name, slot));
        self.wire(Some(End::new(&item.name, "cancelled")), to);
        let events = self.ports_of(&other, "event");
        let back = if other.times_out { Some(&"timeout") } else { self.dice.of(&events) };
        self.wire(back.map(|port| End::new(&other.name, port)), Some(End::new(&item.name, "resume")));
    }

    /// Connects each port of the graph to a node.
    fn borders(&mut self) {
        for (keyword, name) in self.part.ports.clone() {
            let end = Some(End::new("", name));
            for _ in 0..4 {
                let before = self.part.wires.len();
                match keyword {
                    "slot" | "in" => {
                        let to = self.taker();
                        self.wire(end.clone(), to);
                    }
                    _ => {
                        let from = self.sender();
                        self.wire(from, end.clone());
                    }
                }
                if self.part.wires.len() > before {
                    break;
                }
            }
        }
    }

    /// Connects the inputs that need a connection, or removes their node. Slots of graphs may lead to such inputs.
    fn required(&mut self) {
        for item in self.part.nodes.clone() {
            let mut ports = self.ports_of(&item, "in");
            if self.before.iter().any(|part| part.name == item.ty) {
                ports.extend(self.ports_of(&item, "slot"));
            }
            let ends: Vec<End> = ports.iter().map(|port| End::new(&item.name, port)).collect();
            let are_fed = ends.iter().all(|end| self.feed(end));
            if !are_fed && self.part.nodes.len() > 1 {
                self.part.remove_node(&item.name);
            }
        }
    }

    /// Connects an end that takes tokens, unless it is. Returns `false` if no connection was found.
    fn feed(&mut self, end: &End) -> bool {
        for _ in 0..12 {
            if self.part.wires.iter().any(|wire| wire.to == *end) {
                return true;
            }
            let from = self.sender();
            self.wire(from, Some(end.clone()));
        }
        false
    }

    fn claim(&mut self) {
        let kind = ["exclusive", "reaches", "exclusive", "reaches", "conserved"][self.dice.below(5)];
        let count = match kind {
            "conserved" => 0,
            "exclusive" if self.dice.one_in(5) => 3,
            _ => 2,
        };
        let mut of: Vec<String> = vec![];
        for _ in 0..8 {
            let item = self.item();
            if of.len() < count && !of.contains(&item.name) {
                of.push(item.name);
            }
        }
        if of.len() == count && !self.part.claims.contains(&(kind, of.clone())) {
            self.part.claims.push((kind, of));
        }
    }
}

/// `true` if an end is a port of an instance of `graph`.
fn is_graph(graph: &Part, part: &Part, end: &End) -> bool {
    part.nodes.iter().any(|item| item.name == end.node && item.ty == graph.name)
}

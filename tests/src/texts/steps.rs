//! Random steps in the construction of a graph.

use super::{
    interface::{Interface, Node, Port, port},
    kinds::Kind,
    maker::Maker,
    sheet::{Sheet, Wire},
    types::PLAIN,
    values::PARAMS,
};

impl Maker {
    /// Adds a random part.
    pub fn step(&mut self, sheet: &mut Sheet) {
        let nested = self.dice.one_in(4) || (self.has(Kind::NodeNames) && self.dice.one_in(2));
        let machine = self.has(Kind::Machines) && self.dice.one_in(2);
        match self.dice.below(14) {
            _ if machine && !self.machines.is_empty() => {
                let node = self.dice.of(&self.machines.clone()).clone();
                self.instance(sheet, &node, true);
            }
            _ if nested && !self.graphs.is_empty() => {
                let Interface { node, .. } = self.dice.of(&self.graphs.clone()).clone();
                self.instance(sheet, &node, true);
            }
            0 => self.library(sheet),
            1 => {
                let ty = self.ty();
                let node = self.source(ty);
                self.instance(sheet, &node, true);
            }
            2 => self.each(sheet),
            4 => self.activity(sheet),
            5 if self.has(Kind::Bounds) => self.bounded(sheet),
            6 if !self.machines.is_empty() => {
                let node = self.dice.of(&self.machines.clone()).clone();
                self.instance(sheet, &node, true);
            }
            7 => self.inherited(sheet),
            _ => {
                let ty = self.ty();
                let node = self.node(ty);
                let in_place = node.inputs.len() + node.slots.len() == 1 && self.dice.one_in(5);
                self.instance(sheet, &node, !in_place);
            }
        }
    }

    /// Adds a node and connects its inputs. Its outputs and events become available.
    pub fn instance(&mut self, sheet: &mut Sheet, node: &Node, named: bool) {
        let wires: Vec<Wire> = node.inputs.iter().map(|p| self.wire(sheet, p.ty)).collect();
        let args = self.arguments(sheet, node);
        let generic = self.type_arguments(node);
        let modifiers = self.modifiers(node);
        let call = format!("{}{generic}({args}){modifiers}", node.name);
        if !named {
            let of = node.inputs.iter().chain(&node.slots).next().map(|p| p.ty);
            let Some(ty) = of else { return };
            let wire = wires.into_iter().next().unwrap_or_else(|| self.wire(sheet, ty));
            let output = node.outputs.first().filter(|_| node.outputs.len() + node.events.len() == 1).cloned();
            match output {
                Some(out) => {
                    let name = self.port_name(&mut sheet.used);
                    let written = self.written(out.ty);
                    sheet.port_lines.push(format!("out {name}: {written};"));
                    sheet.ports.push(("out", port(&name, out.ty)));
                    sheet.links.push(format!("{} -> {call} -> {name};", wire.from));
                }
                None => sheet.links.push(format!("{} -> {call};", wire.from)),
            }
            return;
        }
        let name = self.node_name(&mut sheet.used);
        let own = node.has_state() && !node.name.contains("::") && !node.name.starts_with("Holder");
        // Some nodes are made in Rust and handed in.
        match own && self.dice.one_in(10) {
            true => sheet.nodes.push(format!("node {name}: {};", node.name)),
            false => sheet.nodes.push(format!("node {name} = {call};")),
        }
        for (port, wire) in node.inputs.iter().zip(&wires) {
            self.link(sheet, &wire.from.clone(), &format!("{name}.{}", port.name));
        }
        for slot in &node.slots {
            if !self.dice.one_in(12) {
                let value = if self.dice.one_in(6) { self.token(slot.ty) } else { None };
                match (value, sheet.wires.is_empty()) {
                    // Tokens of any type.
                    (Some(value), false) => {
                        let from = self.dice.of(&sheet.wires).from.clone();
                        self.link(sheet, &from, &format!("{name}.{}({value})", slot.name));
                    }
                    _ => {
                        let wire = self.wire(sheet, slot.ty);
                        self.link(sheet, &wire.from, &format!("{name}.{}", slot.name));
                    }
                }
            }
        }
        let sends = |ports: &[Port], event: bool| -> Vec<Wire> {
            ports.iter().map(|p| Wire { from: format!("{name}.{}", p.name), ty: p.ty, event }).collect()
        };
        sheet.wires.extend(sends(&node.outputs, false));
        sheet.wires.extend(sends(&node.events, true));
        if !self.graphs.iter().any(|g| g.node.name == node.name) {
            sheet.named.push((name, node.clone()));
        }
    }

    fn link(&mut self, sheet: &mut Sheet, from: &str, to: &str) {
        let arrow = if self.dice.one_in(12) { "=>" } else { "->" };
        let link = match self.dice.below(8) {
            0 => format!("{from} {arrow} [{to}];"),
            _ => format!("{from} {arrow} {to};"),
        };
        sheet.links.push(link);
    }

    fn arguments(&mut self, sheet: &Sheet, node: &Node) -> String {
        let mut args = vec![];
        for (name, param) in &node.params {
            let known = sheet.params.iter().find(|(_, p)| p.ty == param.ty);
            let value = match known {
                Some((known, _)) if self.dice.one_in(2) => Some(known.clone()),
                _ => self.value(param),
            };
            args.extend(value.filter(|_| !self.dice.one_in(12)).map(|value| format!("{name} = {value}")));
        }
        args.join(", ")
    }

    fn type_arguments(&mut self, node: &Node) -> String {
        if self.strikes(Kind::WrongTypes, 6) {
            return format!("<{}>", self.dice.of(super::types::WRONG));
        }
        match &node.generic {
            Some(ty) if self.dice.one_in(2) => format!("<{ty}>"),
            _ => String::new(),
        }
    }

    fn modifiers(&mut self, node: &Node) -> String {
        let mut text = String::new();
        let is_source = node.inputs.is_empty() && !node.outputs.is_empty();
        if is_source && self.dice.one_in(2) {
            text.push_str(self.word(&[" every 20ms", " after 1s", " after 1s every 3ms"]));
        }
        if !self.groups.is_empty() && self.dice.one_in(2) {
            let groups = self.groups.clone();
            text.push_str(&format!(" on {}", self.dice.of(&groups)));
        }
        if !node.outputs.is_empty() && self.dice.one_in(12) {
            let value = self.token(node.outputs[0].ty);
            text.push_str(
                &value.filter(|_| !self.dice.one_in(3)).map_or(" delay".to_owned(), |v| format!(" delay {v}")),
            );
        }
        let seldom = if self.has(Kind::Modifiers) { 3 } else { 16 };
        if self.graphs.iter().any(|g| g.node.name == node.name) && !self.has(Kind::Modifiers) {
            return text;
        }
        if node.has_state() && self.dice.one_in(12) {
            text.push_str(" restart");
        } else if self.dice.one_in(seldom) {
            let some = [
                " pipelined",
                " deadline 10ms",
                " pipelined",
                " deadline 1s",
                " pipelined",
                " deadline 5ms",
                " restart",
                " essential",
                " timeout 5s",
                " delay",
                " each",
                " each par",
                " delay [0, 0]",
                " delay 300",
                " delay \"s\"",
                " delay [1, [2]]",
                " every 0s",
                " every -1s",
                " timeout 0s",
                " after 1e30s",
                " on main",
                " restart essential",
                " timeout 1",
                " each(x)",
                " each(nope)",
                " deadline 0s",
                " delay crate::HOME",
                " every 1ns",
                " delay -1",
                " delay 1.5",
                " delay true",
                " every 1s every 2s",
                " restart restart",
                " delay []",
            ];
            let few = if self.has(Kind::Modifiers) { some.len() } else { 6 };
            text.push_str(some[self.dice.below(few)]);
        }
        text
    }

    /// Adds a node of the library.
    fn library(&mut self, sheet: &mut Sheet) {
        let ty = self.ty();
        let number = &PLAIN[1];
        let path = |name: &str| format!("apex_nodes::{name}");
        let plain = |name: &str, inputs: &[&str], slots: &[&str], outputs: &[&str], events: &[&str], ty| Node {
            name: path(name),
            generic: None,
            inputs: inputs.iter().map(|n| port(n, ty)).collect(),
            slots: slots.iter().map(|n| port(n, ty)).collect(),
            outputs: outputs.iter().map(|n| port(n, ty)).collect(),
            events: events.iter().map(|n| port(n, ty)).collect(),
            params: vec![],
        };
        let mut node = match self.dice.below(10) {
            0 => plain("flow::Relay", &[], &["put"], &[], &["signal"], ty),
            1 => plain("flow::emit", &["value"], &[], &[], &["signal"], ty),
            2 => plain("flow::Latch", &[], &["set"], &["out"], &[], ty),
            3 => plain("flow::Hold", &["value"], &[], &["out"], &[], ty),
            4 => plain("flow::ActivityGate", &["value"], &[], &["out"], &[], ty),
            5 => plain("math::add", &["a", "b"], &[], &["out"], &[], if self.has(Kind::Bounds) { ty } else { number }),
            6 => plain("math::clamp", &["x"], &[], &["out"], &[], number),
            7 => plain("flow::merge", &["values", "values", "values"], &[], &["out"], &[], ty),
            8 => plain("math::median", &["values", "values"], &[], &["out"], &[], number),
            _ => plain("flow::Latest", &[], &["set"], &["out"], &[], ty),
        };
        if node.name.ends_with("clamp") {
            let float = PARAMS.iter().find(|p| p.ty == "f64").unwrap_or(&PARAMS[0]);
            node.params = vec![("lower".to_owned(), float), ("upper".to_owned(), float)];
        }
        self.instance(sheet, &node, true);
    }

    /// Adds a node whose bounds may not be met, or whose constants cannot be inferred.
    fn bounded(&mut self, sheet: &mut Sheet) {
        let ty = self.ty();
        let shape = *self.dice.of(&["Ordered", "Summed", "Fixed", "Sized", "Ring", "Fresh", "Holder", "Generic"]);
        let node = self.node_of(shape, ty);
        self.instance(sheet, &node, true);
    }

    /// Adds a node with `each`.
    fn each(&mut self, sheet: &mut Sheet) {
        let list = PLAIN.iter().find(|t| t.name == "Vec<f64>").unwrap_or(&PLAIN[0]);
        let wire = self.wire(sheet, list);
        let name = self.node_name(&mut sheet.used);
        let shape =
            self.word(&["pass", "maybe", "Generic", "tuned", "written", "fallible", "Split", "pass", "Keeper", "ctx"]);
        let node = self.node_of(shape, &PLAIN[1]);
        let args = self.arguments(sheet, &node);
        let listed = |ports: &[Port]| ports.iter().map(|p| port(&p.name, list)).collect();
        let outside = Node { inputs: listed(&node.inputs), outputs: listed(&node.outputs), ..node.clone() };
        let par = if self.dice.one_in(4) { " par" } else { "" };
        let input = node.inputs.first().map(|p| p.name.clone()).unwrap_or_default();
        sheet.nodes.push(format!("node {name} = {}({args}) each{par};", node.name));
        self.link(sheet, &wire.from, &format!("{name}.{input}"));
        if let Some(out) = node.outputs.first() {
            sheet.wires.push(Wire { from: format!("{name}.{}", out.name), ty: list, event: false });
        }
        sheet.named.push((name, outside));
    }

    /// Adds a region with two rates.
    pub fn rates(&mut self, sheet: &mut Sheet) {
        let ty = self.ty();
        let (from, to) = (self.port_name(&mut sheet.used), self.port_name(&mut sheet.used));
        let (first, second) = (self.node_name(&mut sheet.used), self.node_name(&mut sheet.used));
        let one = self.node_of("double", ty);
        let between = self.dice.one_in(2).then(|| {
            let shape = self.word(&["pass", "maybe", "Keeper", "fallible", "written", "Generic", "Fresh"]);
            (self.node_name(&mut sheet.used), self.node_of(shape, ty))
        });
        let other = self.node_of("pair", ty);
        let all = [(first, one)].into_iter().chain(between).chain([(second, other)]);
        let mut before = from.clone();
        for (name, node) in all {
            let restart = if node.has_state() && self.dice.one_in(3) { " restart" } else { "" };
            let delay = if self.dice.one_in(8) { self.word(&[" delay", " delay [0, 0]", " delay [0, 0]"]) } else { "" };
            sheet.nodes.push(format!("node {name} = {}(){restart}{delay};", node.name));
            sheet.links.push(format!("{before} -> {name}.{};", node.inputs[0].name));
            before = format!("{name}.{}", node.outputs[0].name);
            sheet.named.push((name, node));
        }
        for (kind, name) in [("in", &from), ("out", &to)] {
            let written = self.written(ty);
            sheet.port_lines.push(format!("{kind} {name}: {written};"));
            sheet.ports.push((kind, port(name, ty)));
        }
        sheet.links.push(format!("{before} -> {to};"));
    }

    /// Adds a node that can be active, and a path to another one.
    fn activity(&mut self, sheet: &mut Sheet) {
        let name = self.node_name(&mut sheet.used);
        let timeout = if self.dice.one_in(2) { " timeout 2s" } else { "" };
        let ty = self.ty();
        if timeout.is_empty() {
            let wire = self.wire(sheet, ty);
            sheet.nodes.push(format!("node {name} = apex_nodes::flow::Relay();"));
            sheet.links.push(format!("{} -> {name}.put;", wire.from));
            sheet.wires.push(Wire { from: format!("{name}.signal"), ty, event: true });
        } else {
            sheet.nodes.push(format!("node {name} = apex_nodes::flow::Wait<()>(){timeout};"));
        }
        let (enter, leave) = if timeout.is_empty() { ("enable", "signal") } else { ("activate", "timeout") };
        match sheet.active.last().cloned() {
            Some(before) if before.ends_with("timeout") => sheet.links.push(format!("{before} => {name}.{enter};")),
            Some(before) => sheet.links.push(format!("{before} => apex_nodes::flow::Signal() => {name}.{enter};")),
            None => sheet.links.push(format!("start => {name}.{enter};")),
        }
        if !timeout.is_empty() && self.dice.one_in(3) {
            sheet.links.push(format!("{name}.{leave} => {name}.{enter};"));
        }
        let other = sheet.active.last().and_then(|o| o.split('.').next()).map(str::to_owned);
        if let Some(other) = other.filter(|_| self.dice.one_in(3)) {
            sheet.links.push(format!("claim exclusive({other}, {name});"));
        }
        sheet.active.push(format!("{name}.{leave}"));
    }

    /// Uses ports that every node has.
    fn inherited(&mut self, sheet: &mut Sheet) {
        let Some((name, _)) = sheet.named.last().cloned() else { return };
        let active = sheet.active.last().and_then(|port| port.split('.').next()).map(str::to_owned);
        let name = active.filter(|_| self.dice.one_in(2)).unwrap_or(name);
        let wire = sheet.wires.first().map(|wire| wire.from.clone());
        let line = match self.dice.below(8) {
            0 => format!("{name}.failed -> abort;"),
            1 => format!("{name}.processed -> exit;"),
            2 => format!("{name}.activated -> apex_nodes::flow::Signal() -> reset;"),
            3 => format!("start => {name}.enable;"),
            4 => match wire {
                Some(wire) if self.dice.one_in(2) => format!("{wire} -> {name}.cancel;\n{wire} => {name}.resume;"),
                Some(wire) => format!("{wire} -> {name}.cancel;"),
                None => return,
            },
            5 => format!("{name}.cancelled => apex_nodes::flow::Signal() -> exit;"),
            6 => format!("{name}.cancelled -> {name}.resume;"),
            _ => match sheet.wires.first().cloned() {
                Some(wire) => format!("{} -> apex_nodes::flow::Signal() -> {name}.disable;", wire.from),
                None => return,
            },
        };
        sheet.links.push(line);
    }
}

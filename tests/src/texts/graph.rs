//! Graphs: ports, nodes and connections, added step by step to the available tokens.

use super::{
    case::Item,
    interface::{Interface, Node, port},
    kinds::Kind,
    maker::Maker,
    names,
    sheet::Sheet,
    values::Param,
};

impl Maker {
    /// Generates a graph, after the graphs nested in it.
    pub fn graph(&mut self) -> Interface {
        let mut sheet = Sheet::default();
        let mut used: Vec<String> = self.graphs.iter().map(|g| g.node.name.clone()).collect();
        used.extend(self.machines.iter().map(|m| m.name.clone()));
        let list = if self.strikes(Kind::GraphNames, 1) { names::GRAPHS } else { names::PLAIN_GRAPHS };
        let name = self.free(list, &mut used);
        if self.dice.one_in(3) || self.has(Kind::Values) || self.has(Kind::Constants) {
            self.params(&mut sheet);
        }
        if self.dice.one_in(10) {
            self.rates(&mut sheet);
            return self.close(sheet, name);
        }
        if self.dice.one_in(6) {
            let ty = self.ty();
            let node = self.source(ty);
            self.instance(&mut sheet, &node, true);
        }
        let inputs = self.dice.below(3);
        for _ in 0..inputs {
            let ty = self.ty();
            self.input(&mut sheet, ty);
        }
        for _ in 0..2 + self.dice.below(5) {
            self.step(&mut sheet);
        }
        self.outputs(&mut sheet);
        self.close(sheet, name)
    }

    /// Adds parameters of the graph, with or without defaults.
    fn params(&mut self, sheet: &mut Sheet) {
        let hard = self.strikes(Kind::Twice, 2);
        for _ in 0..1 + self.dice.below(2) {
            let param = self.param_type();
            let name = if hard { "level".to_owned() } else { self.port_name(&mut sheet.used) };
            self.rust(param.item);
            sheet.params.push((name, param));
        }
    }

    /// Adds outputs for most of the unused tokens.
    fn outputs(&mut self, sheet: &mut Sheet) {
        let wires = sheet.wires.clone();
        let last = wires.len().saturating_sub(3);
        for wire in &wires[last..] {
            let used_up = sheet.ports.iter().any(|(_, p)| p.name == wire.from) && self.dice.one_in(2);
            if used_up || self.dice.one_in(5) {
                continue;
            }
            let name = self.port_name(&mut sheet.used);
            let kind = if wire.event && !self.dice.one_in(8) { "event" } else { "out" };
            let written = self.written(wire.ty);
            sheet.port_lines.push(format!("{kind} {name}: {written};"));
            sheet.ports.push((kind, port(&name, wire.ty)));
            let arrow = if wire.event && self.dice.one_in(5) { "=>" } else { "->" };
            sheet.links.push(format!("{} {arrow} {name};", wire.from));
        }
    }

    fn close(&mut self, mut sheet: Sheet, name: String) -> Interface {
        let is_robot = sheet.ports.is_empty();
        let word = if is_robot { "robot" } else { "graph" };
        if is_robot && !self.groups.is_empty() {
            self.thread(&mut sheet);
        }
        let params: Vec<String> = sheet.params.iter().map(|(name, param)| self.param(name, param)).collect();
        let params = if params.is_empty() { String::new() } else { format!("({})", params.join(", ")) };
        let mut body = sheet.port_lines;
        body.extend(sheet.nodes);
        body.extend(sheet.links);
        if self.strikes(Kind::Twice, 6)
            && let Some(line) = body.last().cloned()
        {
            body.push(line);
        }
        self.items.push(Item { head: format!("{word} {name}{params}"), body: Some(body) });
        let of = |kind: &str| sheet.ports.iter().filter(|(k, _)| *k == kind).map(|(_, p)| p.clone()).collect();
        let node = Node {
            name,
            generic: None,
            inputs: of("in"),
            outputs: of("out"),
            slots: of("slot"),
            events: of("event"),
            params: sheet.params,
        };
        Interface { node, named: sheet.named, active: sheet.active }
    }

    /// Adds settings of a thread.
    fn thread(&mut self, sheet: &mut Sheet) {
        let group = self.groups[self.dice.below(self.groups.len())];
        let settings = ["hang = 200ms", "cores = [0]", "priority = 3; policy = fifo", "rights = warn", "cores = []"];
        let setting = self.word(&settings);
        sheet.nodes.push(format!("thread {group} {{ {setting} }}"));
    }

    /// Declaration of a parameter in a graph.
    fn param(&mut self, name: &str, param: &'static Param) -> String {
        let ty = match param.ty.trim_start_matches("&'static ") {
            "core::time::Duration" => "Duration",
            other => other,
        };
        let ty = if self.strikes(Kind::WrongTypes, 3) { self.dice.of(super::types::WRONG) } else { ty };
        let before = self.mistakes;
        let default = self.value(param).filter(|_| !self.dice.one_in(8));
        // A Rust constant cannot be the default of a graph, except as a mistake.
        let default = default.filter(|value| !value.contains("crate::") || self.mistakes > before);
        let default = default.map(|value| format!(" = {value}")).unwrap_or_default();
        let range = if param.ty.starts_with('f') && self.dice.one_in(3) { " in -10..=10" } else { "" };
        format!("{name}: {ty}{default}{range}")
    }
}

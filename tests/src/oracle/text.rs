//! Writes a random graph as a source file.

use super::{
    case::{Cancel, Case, Instance, Link, TIMEOUT, Target, around},
    script::GIVEN,
};
use std::{collections::BTreeMap, fmt::Write as _};

impl Case {
    /// Source file of this graph, with the name `name`.
    pub fn text(&self, name: &str) -> String {
        let mut bodies = Bodies { case: self, lines: vec![vec![]; self.groups.len()], pins: BTreeMap::new() };
        for node in &self.nodes {
            bodies.lines[node.group].push(format!("node n{} = {};", node.id, self.instance(node)));
            if node.starts {
                bodies.lines[node.group].push(format!("start => n{};", node.id));
            }
        }
        for group in (1..self.groups.len()).filter(|g| self.is_used(*g)) {
            bodies.lines[self.groups[group]].push(format!("node g{group} = {name}Group{group}();"));
        }
        for link in &self.links {
            bodies.link(link);
        }
        for cancel in &self.cancels {
            bodies.cancel(cancel);
        }
        for ((by, port), active) in &self.resets {
            bodies.line(0, format!("n{by}.{port} {} reset;", arrow(*active)));
        }
        let mut names: Vec<&str> = self.nodes.iter().map(|n| n.ty.name).collect();
        names.sort_unstable();
        names.dedup();
        let imports: Vec<String> = names.iter().map(|name| self.import(name)).collect();
        let mut text = format!("use apex_tests::nodes::{{{}}};\n", imports.join(", "));
        for group in (0..self.groups.len()).rev().filter(|g| *g == 0 || self.is_used(*g)) {
            let graph = if group == 0 { name.to_owned() } else { format!("{name}Group{group}") };
            let _ = writeln!(text, "{} {graph} {{", self.item(group));
            for line in bodies.pins.get(&group).into_iter().flat_map(BTreeMap::values) {
                let _ = writeln!(text, "    {line}");
            }
            let lines = &bodies.lines[group];
            let lines = if self.seed.is_multiple_of(2) { by_name(lines) } else { lines.clone() };
            for line in lines {
                let _ = writeln!(text, "    {line}");
            }
            text.push_str("}\n");
        }
        text
    }

    /// Every `n`-th graph is written in another form with the same meaning.
    fn in_form(&self, n: u64) -> bool {
        (self.seed / 2).is_multiple_of(n)
    }

    /// Import of a node, under another name in some graphs.
    fn import(&self, name: &str) -> String {
        if self.in_form(7) { format!("{name} as {}", self.called(name)) } else { name.to_owned() }
    }

    fn called(&self, name: &str) -> String {
        if self.in_form(7) { format!("Own{name}") } else { name.to_owned() }
    }

    /// Keywords of the graph, or of a nested one.
    fn item(&self, group: usize) -> &'static str {
        match group {
            0 if self.in_form(3) => "robot",
            0 => "graph",
            _ if self.in_form(5) => "pub graph",
            _ => "graph",
        }
    }

    fn instance(&self, node: &Instance) -> String {
        if node.ty.name == "pass" {
            return format!("{}() each{}", self.called("pass"), self.on(node));
        }
        let mut text = format!(
            "{}(id = {}, script = [{}, {}, {}])",
            self.called(node.ty.name),
            node.id,
            self.seed % 1_000_000,
            node.mode,
            self.limit
        );
        if let Some((every, after)) = node.every {
            let _ = write!(text, " every {every}ms");
            if after > 0 {
                let _ = write!(text, " after {after}ms");
            }
            if self.skips {
                text.push_str(" skip");
            }
        }
        if let Some(timeout) = node.timeout {
            let _ = write!(text, " timeout {timeout}ms");
        }
        if node.delay > 0 {
            let _ = write!(text, " delay {:?}", vec![7; node.delay]);
        }
        if self.in_form(4) {
            text.push_str(" deadline 1h");
        }
        if self.in_form(9) {
            text.push_str(" restart");
        }
        text + &self.on(node)
    }

    fn on(&self, node: &Instance) -> String {
        if node.thread > 0 { format!(" on t{}", node.thread) } else { String::new() }
    }

    /// `true` if a nested graph contains any node.
    fn is_used(&self, group: usize) -> bool {
        self.nodes.iter().any(|n| self.around(n.group).contains(&group))
    }

    /// A nested graph and all around it, innermost first, without the graph itself.
    fn around(&self, group: usize) -> Vec<usize> {
        around(&self.groups, group)
    }
}

fn arrow(active: bool) -> &'static str {
    if active { "=>" } else { "->" }
}

/// The lines of a body, of which those that pass tokens on under the same name become `in.* -> g.*` and `g.* -> out.*`.
/// The ports of nested graphs are called after the sender, so that those with the same name belong together.
fn by_name(lines: &[String]) -> Vec<String> {
    let mut written: Vec<String> = vec![];
    for line in lines {
        let line = passed_on(line).unwrap_or_else(|| line.clone());
        if !written.contains(&line) {
            written.push(line);
        }
    }
    written
}

/// The connection by name that makes the connection of a line, if there is one.
fn passed_on(line: &str) -> Option<String> {
    let (from, to) = line.strip_suffix(';')?.split_once(" -> ")?;
    match (from.split_once('.'), to.split_once('.')) {
        (None, Some((graph, port))) if from == port => Some(format!("in.* -> {graph}.*;")),
        (Some((graph, port)), None) if to == port => Some(format!("{graph}.* -> out.*;")),
        _ => None,
    }
}

struct Bodies<'a> {
    case: &'a Case,
    lines: Vec<Vec<String>>,
    /// Ports of each nested graph.
    pins: BTreeMap<usize, BTreeMap<String, String>>,
}

impl Bodies<'_> {
    fn cancel(&mut self, cancel: &Cancel) {
        let (body, name) = match cancel.of {
            Target::Node(id) => (self.case.node(id).map_or(0, |node| node.group), format!("n{id}")),
            Target::Group(group) => (self.case.groups[group], format!("g{group}")),
        };
        let ((by, port), active) = cancel.by;
        self.line(body, format!("n{by}.{port} {} {name}.cancel;", arrow(active)));
        if let Some(((by, port), active)) = cancel.back {
            self.line(body, format!("n{by}.{port} {} {name}.resume;", arrow(active)));
        }
        if let Some((told, active)) = cancel.tells {
            self.line(body, format!("{name}.cancelled {} n{told}.s;", arrow(active)));
        }
    }

    fn link(&mut self, link: &Link) {
        let (Some(from), Some(to)) = (self.case.node(link.from.0), self.case.node(link.to.0)) else { return };
        let (leaves, enters) = (self.case.around(from.group), self.case.around(to.group));
        let arrow = arrow(link.active);
        let port = format!(
            "{}_{}{}{}",
            link.from.0,
            link.from.1,
            if link.relayed { "_r" } else { "" },
            if link.active { "_a" } else { "" }
        );
        let ty = match from.ty.name {
            _ if link.from.1 == TIMEOUT => "()",
            "ScList" | "pass" => "Vec<i64>",
            _ => "i64",
        };
        let (words_in, words_out) = if link.relayed { ("slot", "event") } else { ("in", "out") };
        let mut at = format!("n{}.{}", link.from.0, link.from.1);
        let mut body = from.group;
        for group in leaves.iter().take_while(|g| !enters.contains(g)) {
            let pin = format!("o_{port}");
            self.pin(*group, &pin, format!("{words_out} {pin}: {ty};"));
            self.line(body, format!("{at} {arrow} {pin};"));
            at = format!("g{group}.{pin}");
            body = self.case.groups[*group];
        }
        let inner: Vec<usize> = enters.iter().copied().take_while(|g| !leaves.contains(g)).collect();
        for group in inner.into_iter().rev() {
            let pin = format!("i_{port}");
            self.pin(group, &pin, format!("{words_in} {pin}: {ty};"));
            self.line(body, format!("{at} {arrow} g{group}.{pin};"));
            at = pin;
            body = group;
        }
        let given = if link.given { format!("({GIVEN})") } else { String::new() };
        self.line(body, format!("{at} {arrow} n{}.{}{given};", link.to.0, link.to.1.trim_end_matches('?')));
    }

    fn pin(&mut self, group: usize, name: &str, line: String) {
        self.pins.entry(group).or_default().insert(name.to_owned(), line);
    }

    fn line(&mut self, body: usize, line: String) {
        if !self.lines[body].contains(&line) {
            self.lines[body].push(line);
        }
    }
}

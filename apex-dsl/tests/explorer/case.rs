//! Graphs as text in parts that can be removed.

use std::fmt::{self, Display, Write as _};

/// Source file: graphs, the program last.
#[derive(Debug, Clone)]
pub struct Case {
    /// The graphs.
    pub parts: Vec<Part>,
}

/// A graph.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// Name of the graph.
    pub name: String,
    /// Its ports as keyword and name.
    pub ports: Vec<(&'static str, &'static str)>,
    /// Its nodes and nested graphs.
    pub nodes: Vec<Item>,
    /// Its connections.
    pub wires: Vec<Wire>,
    /// Its claims: the kind, and the names of the subjects.
    pub claims: Vec<(&'static str, Vec<String>)>,
}

/// A node or nested graph.
#[derive(Debug, Clone)]
pub struct Item {
    /// Name of the instance.
    pub name: String,
    /// Name of the node type or graph.
    pub ty: String,
    /// `true` with the modifier `timeout`.
    pub times_out: bool,
    /// Number of initial tokens of the modifier `delay`; 0 without it.
    pub delay: usize,
}

/// End of a connection: a node, or empty for the graph itself, and a port, or empty for a predefined name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct End {
    /// Name of the node.
    pub node: String,
    /// Name of the port.
    pub port: String,
}

impl End {
    /// The port of a node, or of the graph itself if the name of the node is empty.
    pub fn new(node: &str, port: &str) -> Self {
        Self { node: node.to_owned(), port: port.to_owned() }
    }
}

impl Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.node.as_str(), self.port.as_str()) {
            ("", name) | (name, "") => f.write_str(name),
            (node, port) => write!(f, "{node}.{port}"),
        }
    }
}

/// A connection.
#[derive(Debug, Clone)]
pub struct Wire {
    /// Origin of the tokens.
    pub from: End,
    /// `true` for `=>`.
    pub active: bool,
    /// Destination of the tokens.
    pub to: End,
}

impl Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = String::new();
        for part in &self.parts {
            writeln!(text, "graph {} {{", part.name)?;
            part.ports.iter().try_for_each(|(keyword, name)| writeln!(text, "    {keyword} {name};"))?;
            for Item { name, ty, times_out, delay } in &part.nodes {
                let timeout = if *times_out { " timeout 1s" } else { "" };
                let delay = match delay {
                    0 => String::new(),
                    1 => " delay".to_owned(),
                    count => format!(" delay [{}]", vec!["crate::NIL"; *count].join(", ")),
                };
                writeln!(text, "    node {name} = {ty}(){timeout}{delay};")?;
            }
            for Wire { from, active, to } in &part.wires {
                writeln!(text, "    {from} {} {to};", if *active { "=>" } else { "->" })?;
            }
            for (kind, of) in &part.claims {
                let names = if of.is_empty() { String::new() } else { format!("({})", of.join(", ")) };
                writeln!(text, "    claim {kind}{names};")?;
            }
            writeln!(text, "}}\n")?;
        }
        f.write_str(text.trim_end())
    }
}

impl Case {
    /// Number of things that could be removed.
    pub fn size(&self) -> usize {
        let of = |part: &Part| {
            let modifiers = part.nodes.iter().map(|n| usize::from(n.times_out) + n.delay).sum::<usize>();
            1 + part.ports.len() + part.nodes.len() + part.wires.len() + part.claims.len() + modifiers
        };
        self.parts.iter().map(of).sum()
    }

    /// The same case with one thing less, in all ways.
    pub fn smaller(&self) -> Vec<Self> {
        let mut found = vec![];
        for (number, part) in self.parts.iter().enumerate() {
            let used = self.parts.iter().flat_map(|p| &p.nodes).any(|item| item.ty == part.name);
            if number + 1 < self.parts.len() && !used {
                let mut less = self.clone();
                less.parts.remove(number);
                found.push(less);
            }
            let mut with = |change: &dyn Fn(&mut Part)| {
                let mut less = self.clone();
                change(&mut less.parts[number]);
                found.push(less);
            };
            for n in 0..part.nodes.len() {
                with(&|less| less.remove_node(&part.nodes[n].name));
            }
            for w in 0..part.wires.len() {
                with(&|part| _ = part.wires.remove(w));
            }
            for c in 0..part.claims.len() {
                with(&|part| _ = part.claims.remove(c));
            }
            for p in 0..part.ports.len() {
                with(&|part| _ = part.ports.remove(p));
            }
            for n in 0..part.nodes.len() {
                with(&|part| part.nodes[n].times_out = false);
                with(&|part| part.nodes[n].delay = part.nodes[n].delay.saturating_sub(1));
            }
        }
        found.retain(|less| less.size() < self.size());
        found
    }
}

impl Part {
    /// Removes a node with its connections and the claims about it.
    pub fn remove_node(&mut self, name: &str) {
        self.nodes.retain(|item| item.name != name);
        self.wires.retain(|wire| wire.from.node != name && wire.to.node != name);
        self.claims.retain(|(_, of)| !of.iter().any(|of| of == name));
    }
}

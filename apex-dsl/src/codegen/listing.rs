//! The program between analysis and Rust as text: state, conditions, clusters, slots, timers, and what follows from
//! tokens.

use super::{Generator, activity::ProgramView, each_part};
use crate::{
    analyse::{Block, Run, Step},
    catalog::Catalog,
    checked::CheckedProgram,
    graph::NodeId,
    program::{Carries, Flag, Port, Silence, Slot, Timeout},
    source::Sources,
    syntax::tree::PortKind,
};
use std::fmt::Write as _;

/// Lines with their indentation.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn add(&mut self, depth: usize, line: &str) {
        let _ = writeln!(self.0, "{:1$}{line}", "", 2 * depth);
    }
}

/// The program that Rust is written from, as text.
pub fn listing(program: &CheckedProgram, catalog: &Catalog, sources: &Sources) -> String {
    let mut lines = Lines::default();
    lines.add(0, &format!("program {}", program.graph.name));
    each_part(program, catalog, sources, &mut |generator, view, part| {
        if let Some(part) = part {
            lines.add(0, &format!("thread {}", part.group));
        }
        generator.list_state(&mut lines, view);
        generator.list_clusters(&mut lines, view);
        generator.list_slots(&mut lines, view);
        generator.list_timers(&mut lines, view);
    });
    lines.0
}

/// Numbers in a list: `2, 5`.
fn numbers(numbers: impl IntoIterator<Item = usize>) -> String {
    numbers.into_iter().map(|number| number.to_string()).collect::<Vec<_>>().join(", ")
}

impl Generator<'_> {
    fn list_state(&self, lines: &mut Lines, view: ProgramView<'_>) {
        let state = self.state(view);
        if !state.is_empty() {
            lines.add(1, "state");
        }
        let places = state.iter().flat_map(|kept| kept.places().map(move |(place, of)| (kept.kind, place, of)));
        for (kind, place, of) in places {
            let kind = format!("{kind:?}").to_lowercase();
            lines.add(2, &format!("{place}: {kind} {of}"));
        }
        let guard = |guard: usize| view.analysis.guards[guard].text(view.graph);
        let conditions = view.wiring.bits.texts(view.graph, &view.labels.clusters, &guard);
        if !conditions.is_empty() {
            lines.add(1, "conditions");
        }
        for (bit, text) in conditions.iter().enumerate() {
            lines.add(2, &format!("{bit} {text}"));
        }
    }

    fn list_clusters(&self, lines: &mut Lines, view: ProgramView<'_>) {
        for (index, cluster) in view.analysis.clusters.iter_enumerated().filter(|(_, c)| c.fires) {
            let guards = cluster.own_guards.iter().map(|guard| view.analysis.guards[*guard].text(view.graph));
            let when: Vec<String> = guards.chain((!cluster.upstream.is_empty()).then(|| "tokens".to_owned())).collect();
            lines.add(1, &format!("cluster {}: {}", view.labels.clusters[index], when.join(", ")));
            self.list_block(lines, view, &cluster.block, 2);
        }
    }

    fn list_block(&self, lines: &mut Lines, view: ProgramView<'_>, block: &Block, depth: usize) {
        for step in &block.steps {
            match step {
                Step::Fire(node) => {
                    lines.add(depth, &format!("fire {}", view.graph.path(*node)));
                    self.list_ports(lines, view, *node, depth + 1, |_| true);
                }
                Step::Repeat(Run { node, from, to }) => {
                    let times = if to - from == 1 { String::new() } else { format!(", {} times", to - from) };
                    lines.add(depth, &format!("fire {}{times}", view.graph.path(*node)));
                    self.list_ports(lines, view, *node, depth + 1, |_| true);
                }
                Step::Block(inner) => {
                    let tokens: Vec<String> = inner.opens.iter().map(|end| self.name(*end).to_string()).collect();
                    lines.add(depth, &format!("if {}", tokens.join(" and ")));
                    self.list_block(lines, view, inner, depth + 1);
                }
            }
        }
    }

    /// Lists the effects of tokens at the ports of a node of which `sends` is `true`. A slot sends on events only.
    fn list_ports(
        &self,
        lines: &mut Lines,
        view: ProgramView<'_>,
        node: NodeId,
        depth: usize,
        sends: impl Fn(PortKind) -> bool,
    ) {
        for port in view.wiring.of(node).iter().filter(|port| sends(view.graph.port(port.end).kind)) {
            lines.add(depth, &format!("if {}", self.name(port.end)));
            for effect in effects(view, port) {
                lines.add(depth + 1, &effect);
            }
        }
    }

    fn list_slots(&self, lines: &mut Lines, view: ProgramView<'_>) {
        for (number, slot) in view.wiring.slots.iter().enumerate() {
            let (Slot { connection, node, frees, carries, settles, needs }, name) = (slot, &view.labels.slots[number]);
            lines.add(1, &format!("slot {number} {name}: {}", view.graph.connection_text(*connection)));
            if !needs.is_empty() {
                lines.add(2, &format!("needs {}", numbers(needs.iter().copied())));
            }
            if let Some(bit) = frees {
                lines.add(2, &format!("raise {bit}"));
            }
            let node_name = view.graph.path(*node);
            match carries {
                Carries::Nothing => {}
                Carries::Always => lines.add(2, &format!("activate {node_name}")),
                Carries::Sometimes => lines.add(2, &format!("activate {node_name} if carries {number}")),
                Carries::Away => lines.add(2, &format!("deactivate {node_name}")),
            }
            let call = view.graph.end_name(view.graph.connections[*connection].to);
            lines.add(2, &format!("call {call}"));
            self.list_ports(lines, view, *node, 2, |kind| kind == PortKind::Event);
            if let Some(row) = settles {
                lines.add(2, &format!("settle row {row}"));
            }
        }
    }

    fn list_timers(&self, lines: &mut Lines, view: ProgramView<'_>) {
        for (number, (node, bit)) in view.wiring.timers.iter().enumerate() {
            lines.add(1, &format!("timer {number} of {}: raises {bit}", view.graph.path(*node)));
        }
        for (number, Timeout { node, after, needs }) in view.wiring.timeouts.iter().enumerate() {
            let needs = if needs.is_empty() { String::new() } else { format!(", needs {}", numbers(needs.clone())) };
            lines.add(1, &format!("timeout {number}: {} active for {after:?}{needs}", view.graph.path(*node)));
            self.list_ports(lines, view, *node, 2, |kind| kind == PortKind::Event);
        }
        for (number, Silence { guard, nodes, .. }) in view.wiring.silences.iter().enumerate() {
            let nodes: Vec<String> = nodes.iter().map(|node| view.graph.path(*node)).collect();
            let guard = view.analysis.guards[*guard].text(view.graph);
            lines.add(1, &format!("silence {number} of {guard}: ⊥ after the time of {}", nodes.join(", ")));
        }
    }
}

/// Effects of a token at a port.
fn effects(view: ProgramView<'_>, port: &Port) -> Vec<String> {
    let flag = |flag: &Flag| match *flag {
        Flag::Active(node) => format!("active {}", view.graph.path(node)),
        Flag::Gains(node) => format!("gains {}", view.graph.path(node)),
        Flag::Loses(node) => format!("loses {}", view.graph.path(node)),
        Flag::Enabled(node) => format!("enabled {}", view.graph.path(node)),
        Flag::Carries(slot) => format!("carries {slot}"),
    };
    let mut effects: Vec<String> = port.takes_away.iter().map(|set| format!("set {}", flag(set))).collect();
    if let Some(along) = &port.passes {
        effects.push(format!("deactivate {}", view.graph.path(port.end.node)));
        effects.extend(along.iter().map(|set| format!("set {} if it was active", flag(set))));
    }
    for send in &port.sends {
        effects.extend(send.queued.map(|slot| format!("queue slot {slot}")));
        effects.extend(send.raises.map(|bit| format!("raise {bit}")));
        effects.extend(send.occupies.map(|bit| format!("clear {bit}")));
    }
    effects
}

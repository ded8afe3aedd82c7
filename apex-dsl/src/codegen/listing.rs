//! The program between analysis and Rust as text: state, conditions, what clusters, slots and timeouts do, and the
//! reaction.

use super::{generator::Generator, programs::each_part, view::ProgramView};
use crate::{
    catalog::Catalog,
    checked::CheckedProgram,
    program::{Carries, Lines, Slot, Timeout, numbers},
    source::Sources,
};

/// The program that Rust is written from, as text.
pub fn listing(program: &CheckedProgram, catalog: &Catalog, sources: &Sources) -> String {
    let mut text = format!("program {}\n", program.graph.name);
    each_part(program, catalog, sources, &mut |generator, view, part| {
        let mut lines = Lines::new(view.program);
        if let Some(part) = part {
            lines.add(&format!("thread {}", part.group));
        }
        lines.inside(|lines| {
            generator.list_state(lines, view);
            generator.list_clusters(lines, view);
            list_slots(lines, view);
            list_timers(lines, view);
            list_others(lines, view);
            lines.reaction(&view.program.reaction, &|cluster| view.labels.clusters[cluster].clone());
        });
        text.push_str(&lines.finish());
    });
    text
}

impl Generator<'_> {
    fn list_state(&self, lines: &mut Lines<'_>, view: ProgramView<'_>) {
        let state = self.state(view);
        if !state.is_empty() {
            lines.add("state");
        }
        let places = state.iter().flat_map(|kept| kept.places().map(move |(place, of)| (kept.kind, place, of)));
        lines.inside(|lines| {
            for (kind, place, of) in places {
                let kind = format!("{kind:?}").to_lowercase();
                lines.add(&format!("{place}: {kind} {of}"));
            }
        });
        let guard = |guard: usize| view.analysis.guards[guard].text(view.graph);
        let conditions = view.wiring.bits.texts(view.graph, &view.labels.clusters, &guard);
        if !conditions.is_empty() {
            lines.add("conditions");
        }
        lines.inside(|lines| {
            conditions.iter().enumerate().for_each(|(bit, text)| lines.add(&format!("{bit} {text}")));
        });
    }

    fn list_clusters(&self, lines: &mut Lines<'_>, view: ProgramView<'_>) {
        for (index, cluster) in view.analysis.clusters.iter_enumerated().filter(|(_, c)| c.fires) {
            let guards = cluster.own_guards.iter().map(|guard| view.analysis.guards[*guard].text(view.graph));
            let when: Vec<String> = guards.chain((!cluster.upstream.is_empty()).then(|| "tokens".to_owned())).collect();
            lines.add(&format!("cluster {}: {}", view.labels.clusters[index], when.join(", ")));
            lines.inside(|lines| lines.ops(&view.program.clusters[index]));
        }
    }
}

fn list_slots(lines: &mut Lines<'_>, view: ProgramView<'_>) {
    for (number, slot) in view.wiring.slots.iter().enumerate() {
        let (Slot { connection, node, frees, needs, .. }, name) = (slot, &view.labels.slots[number]);
        lines.add(&format!("slot {number} {name}: {}", view.graph.connection_text(*connection)));
        lines.inside(|lines| {
            if !needs.is_empty() {
                lines.add(&format!("needs {}", numbers(needs)));
            }
            if let Some(bit) = frees {
                lines.add(&format!("raise {bit}"));
            }
            let node = view.graph.path(*node);
            match slot.carries_to(view.graph) {
                Carries::Nothing => {}
                Carries::Always => lines.add(&format!("activate {node}")),
                Carries::Sometimes => lines.add(&format!("activate {node} if carries {number}")),
                Carries::Away => lines.add(&format!("deactivate {node}")),
            }
            let served = &view.program.slots[number];
            if !served.turned.is_empty() {
                lines.inside(|lines| lines.ops(&served.turned));
            }
            [&served.clear, &served.call, &served.after].into_iter().for_each(|ops| lines.ops(ops));
        });
    }
}

fn list_timers(lines: &mut Lines<'_>, view: ProgramView<'_>) {
    for (number, (node, bit)) in view.wiring.timers.iter().enumerate() {
        lines.add(&format!("timer {number} of {}: raises {bit}", view.graph.path(*node)));
    }
    for (number, Timeout { node, wait, after, needs }) in view.wiring.timeouts.iter().enumerate() {
        let needs = if needs.is_empty() { String::new() } else { format!(", needs {}", numbers(needs)) };
        let stays = if wait.is_some() { "in a state" } else { "active" };
        lines.add(&format!("timeout {number}: {} {stays} for {after:?}{needs}", view.graph.path(*node)));
        lines.inside(|lines| lines.ops(&view.program.timeouts[number]));
    }
    for (number, silence) in view.wiring.silences.iter().enumerate() {
        let nodes: Vec<String> = view.wiring.missed_by(silence).map(|node| view.graph.path(node)).collect();
        let guard = view.analysis.guards[silence.guard].text(view.graph);
        lines.add(&format!("silence {number} of {guard}: ⊥ after the time of {}", nodes.join(", ")));
    }
}

/// Operations before the first reaction, at `cancel` and `resume`, and at `reset`.
fn list_others(lines: &mut Lines<'_>, view: ProgramView<'_>) {
    let program = view.program;
    if program.lower.has_start() {
        lines.add("start");
        lines.inside(|lines| lines.ops(&program.first));
    }
    for (slot, ops) in &program.interrupts {
        lines.add(&view.graph.end_name(*slot));
        lines.inside(|lines| lines.ops(ops));
    }
    if program.lower.has_reset() {
        lines.add("reset");
        lines.inside(|lines| lines.ops(&program.reset));
    }
}

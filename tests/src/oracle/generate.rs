//! Generates random graphs.

use super::{
    ALWAYS,
    case::{Cancel, Case, Instance, Link, NODE_TYPES, NodeType, TIMEOUT, Target, node_type},
};
use crate::Dice;

/// Types that are neither sources nor sinks.
const MIDDLE: [&str; 7] = ["ScPass", "ScSplit", "ScJoin", "ScMaybe", "ScEvent", "ScFull", "ScFull"];
const SINKS: [&str; 3] = ["ScSink", "ScSinkS", "ScKeen"];
const SOURCES: [&str; 4] = ["ScSource", "ScSource", "ScSourceE", "ScTicker"];
const HANDLERS: [&str; 3] = ["ScHandler", "ScHandler", "ScStop"];

/// Features of a graph besides data flow.
struct Flavour {
    events: bool,
    hybrid: bool,
    activity: bool,
    nested: bool,
    relayed: bool,
    paced: bool,
    delays: bool,
}

/// The graph for `seed`. `asynchronous` allows events, slots and activity.
pub fn generate(seed: u64, asynchronous: bool) -> Case {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let size = match dice.below(4) {
        0 => 2 + dice.below(6),
        1 | 2 => 4 + dice.below(16),
        _ => 2 + dice.below(58),
    };
    let flavour = Flavour {
        events: asynchronous && !dice.one_in(6),
        hybrid: asynchronous && dice.one_in(2),
        activity: asynchronous && dice.one_in(2),
        nested: dice.one_in(2),
        relayed: asynchronous && dice.one_in(3),
        paced: dice.one_in(4),
        delays: dice.one_in(3),
    };
    let limit = if dice.one_in(3) { 3 } else { 1 + dice.below(25) };
    let mut case = Case {
        seed,
        limit,
        nodes: vec![],
        links: vec![],
        groups: vec![0],
        cancels: vec![],
        resets: vec![],
        skips: (seed / 2).is_multiple_of(6),
    };
    nodes(&mut dice, &mut case, size, &flavour);
    if flavour.nested {
        nest(&mut dice, &mut case);
    }
    connect_inputs(&mut dice, &mut case, &flavour);
    if flavour.events || flavour.hybrid {
        connect_slots(&mut dice, &mut case, &flavour);
    }
    if flavour.activity {
        activate(&mut dice, &mut case);
        if dice.one_in(2) {
            cancel(&mut dice, &mut case, &flavour);
        }
    }
    if (seed / 3).is_multiple_of(4) {
        give(&mut case);
    }
    case.clean();
    case
}

/// Gives some slots a value in place of tokens.
fn give(case: &mut Case) {
    let mut dice = Dice(case.seed.wrapping_mul(0x2545_f491_4f6c_dd1d) | 1);
    let Case { nodes, links, .. } = case;
    for link in links {
        let takes = |node: &Instance| node.ty.name != "ScKick" && node.ty.slots.contains(&link.to.1);
        link.given = nodes.iter().any(|node| node.id == link.to.0 && takes(node)) && dice.one_in(3);
    }
}

/// Distributes a graph to two to four threads. Neighbouring nodes of a nested graph mostly run on the same thread.
pub fn on_threads(mut case: Case) -> Case {
    let mut dice = Dice(case.seed.wrapping_mul(0xd134_2543_de82_ef95) | 1);
    let count = 2 + dice.below(3);
    let mut thread = 0;
    let mut group = 0;
    for node in &mut case.nodes {
        if node.group != group || dice.one_in(if group == 0 { 2 } else { 12 }) {
            thread = dice.below(count);
        }
        group = node.group;
        node.thread = thread;
    }
    // One thread takes all activity away at once.
    case.cancels.clear();
    case.resets.clear();
    // For some lists, the body of an `each` is on another thread, but not for most.
    for at in 1..case.nodes.len() {
        if matches!(case.nodes[at].ty.name, "pass" | "ScListSink") && !dice.one_in(3) {
            case.nodes[at].thread = case.nodes[at - 1].thread;
        }
    }
    case
}

/// Gives all sources a period, so that nothing depends on the number of reactions. Loops of delays that nothing feeds
/// do; the graph has no delays.
pub fn paced(mut case: Case) -> Case {
    let mut dice = Dice(case.seed.wrapping_mul(0xe703_7ed1_a0b4_28db) | 1);
    case.skips = false;
    for node in &mut case.nodes {
        node.delay = 0;
        let is_source = node.ty.name.starts_with("ScSource") || node.ty.name == "ScTicker";
        node.every = node.every.or_else(|| is_source.then(|| (1 + dice.below(3), dice.below(2))));
    }
    case
}

/// Lets some tokens of a graph reset it.
pub fn with_resets(mut case: Case) -> Case {
    let mut dice = Dice(case.seed.wrapping_mul(0xc2b2_ae3d_27d4_eb4f) | 1);
    for _ in 0..1 + dice.below(2) {
        let by = beside(&mut dice, &case, 0);
        case.resets.extend(by.map(|by| (by, dice.one_in(2))));
    }
    case
}

/// Gives some nodes of a graph a `timeout`, which is told to a slot or an input, or cancels something.
pub fn with_timeouts(mut case: Case) -> Case {
    let mut dice = Dice(case.seed.wrapping_mul(0xa076_1d64_78bd_642f) | 1);
    for _ in 0..1 + dice.below(4) {
        let id = dice.of(&case.nodes).id;
        time_out(&mut dice, &mut case, id);
    }
    let Case { nodes, cancels, .. } = &mut case;
    for cancel in cancels {
        // All that cancels is in the body of the same nested graph.
        let group = nodes.iter().find(|node| node.id == cancel.by.0.0).map(|node| node.group);
        let timed = nodes.iter().find(|node| node.timeout.is_some() && Some(node.group) == group);
        if let Some(timed) = timed.filter(|_| dice.one_in(2)) {
            cancel.by.0 = (timed.id, TIMEOUT);
        }
    }
    case
}

/// Gives a node a `timeout`, and a node that is told of it.
fn time_out(dice: &mut Dice, case: &mut Case, id: usize) {
    let Some(node) = case.nodes.iter_mut().find(|node| node.id == id) else { return };
    if node.timeout.is_some() || matches!(node.ty.name, "pass" | "ScList") {
        return;
    }
    node.timeout = Some(1 + dice.below(5));
    let (mut told, group) = (node.clone(), node.group);
    let port;
    (told.ty, port) = if dice.one_in(3) { (node_type("ScTock"), "x") } else { (node_type("ScKick"), "s") };
    told.id = 1 + case.nodes.iter().map(|node| node.id).max().unwrap_or_default();
    told.group = if dice.one_in(2) { group } else { 0 };
    (told.delay, told.every, told.timeout, told.starts) = (0, None, None, false);
    case.links.push(Link {
        from: (id, TIMEOUT),
        to: (told.id, port),
        active: !dice.one_in(3),
        relayed: dice.one_in(4),
        given: false,
    });
    let to = dice.of(&case.nodes);
    if let Some(slot) = to.ty.slots.first().filter(|_| to.ty.name != "ScKick") {
        let (active, relayed) = (dice.one_in(2), dice.one_in(4));
        case.links.push(Link { from: (told.id, "e"), to: (to.id, slot), active, relayed, given: false });
    }
    case.nodes.push(told);
}

fn nodes(dice: &mut Dice, case: &mut Case, size: usize, flavour: &Flavour) {
    let sources = 1 + dice.below(1 + size / 6);
    while case.nodes.len() < size {
        let at = case.nodes.len();
        let kinds: &[&str] = match () {
            () if at < sources => &SOURCES,
            () if flavour.events && dice.one_in(5) => &HANDLERS,
            () if at + 1 + size / 5 >= size => &SINKS,
            () => &MIDDLE,
        };
        let mut name = *dice.of(kinds);
        if !flavour.events && !flavour.hybrid {
            name = match name {
                "ScTicker" | "ScSourceE" => "ScSource",
                "ScEvent" => "ScPass",
                "ScFull" => "ScJoin",
                "ScSinkS" => "ScSink",
                other => other,
            };
        }
        if at >= sources && dice.one_in(12) {
            for name in ["ScList", "pass", "ScListSink"] {
                push(dice, case, node_type(name), flavour);
            }
            continue;
        }
        push(dice, case, node_type(name), flavour);
    }
}

fn push(dice: &mut Dice, case: &mut Case, ty: &'static NodeType, flavour: &Flavour) {
    let is_source = ty.inputs.is_empty() && !(ty.outputs.is_empty() && ty.name != "ScTicker");
    let is_list = matches!(ty.name, "ScList" | "pass" | "ScListSink");
    let delayed = flavour.delays && !ty.outputs.is_empty() && !is_list && dice.one_in(4);
    case.nodes.push(Instance {
        id: case.nodes.len(),
        ty,
        mode: if dice.one_in(2) { ALWAYS } else { 0 },
        group: 0,
        delay: if delayed { 1 + dice.below(2) } else { 0 },
        every: (is_source && flavour.paced && dice.one_in(2)).then(|| (1 + dice.below(4), dice.below(3))),
        timeout: None,
        starts: false,
        thread: 0,
    });
}

/// Moves neighbouring nodes into nested graphs, with at most two levels.
fn nest(dice: &mut Dice, case: &mut Case) {
    let count = case.nodes.len();
    for _ in 0..1 + dice.below(3) {
        let start = dice.below(count);
        let end = (start + 1 + dice.below(12)).min(count);
        if case.nodes[start..end].iter().any(|n| n.group != 0) {
            continue;
        }
        case.groups.push(0);
        let group = case.groups.len() - 1;
        case.nodes[start..end].iter_mut().for_each(|n| n.group = group);
        if end - start > 3 && dice.one_in(2) {
            case.groups.push(group);
            let inner = case.groups.len() - 1;
            case.nodes[start + 1..end - 1].iter_mut().for_each(|n| n.group = inner);
        }
    }
}

fn link(dice: &mut Dice, case: &mut Case, from: (usize, &'static str), to: (usize, &'static str), flavour: &Flavour) {
    let is_synchronous =
        NODE_TYPES.iter().any(|t| t.outputs.contains(&from.1)) && !to.1.starts_with('s') && !to.1.starts_with('t');
    let relayed = flavour.relayed && dice.one_in(if is_synchronous { 8 } else { 2 });
    // Activity cannot pass delays yet.
    let active = flavour.activity && dice.one_in(3) && case.node(from.0).is_none_or(|n| n.delay == 0);
    case.links.push(Link { from, to, active, relayed, given: false });
}

/// Connects each input to an earlier output, to a later one with a delay, or to an event.
fn connect_inputs(dice: &mut Dice, case: &mut Case, flavour: &Flavour) {
    for n in 0..case.nodes.len() {
        let ty = case.nodes[n].ty;
        for input in ty.inputs {
            if input.ends_with('?') && dice.one_in(5) {
                continue;
            }
            if matches!(ty.name, "pass" | "ScListSink") {
                link(dice, case, (n - 1, "out"), (n, input), flavour);
                continue;
            }
            let event = flavour.hybrid && dice.one_in(5);
            let Some(from) = sender(dice, case, n, event) else { continue };
            if event && dice.one_in(2) {
                case.nodes[from.0].mode = ALWAYS;
            }
            link(dice, case, from, (n, input), flavour);
        }
    }
}

/// Random port that may be connected to an input of node `n`.
fn sender(dice: &mut Dice, case: &Case, n: usize, event: bool) -> Option<(usize, &'static str)> {
    let is_list = |i: usize| matches!(case.nodes[i].ty.name, "ScList" | "pass");
    for _ in 0..60 {
        let everywhere = dice.one_in(4);
        let from =
            if everywhere { dice.below(case.nodes.len()) } else { n.saturating_sub(1 + dice.below(n.clamp(1, 6))) };
        let ty = case.nodes[from].ty;
        let ports = if event { ty.events } else { ty.outputs };
        let later = from >= n && !event && case.nodes[from].delay == 0;
        if !ports.is_empty() && !later && !is_list(from) && (event || from != n || case.nodes[from].delay > 0) {
            return Some((from, *dice.of(ports)));
        }
    }
    None
}

/// Connects events and outputs to slots, several to some, in any direction.
fn connect_slots(dice: &mut Dice, case: &mut Case, flavour: &Flavour) {
    for n in 0..case.nodes.len() {
        for slot in case.nodes[n].ty.slots {
            for _ in 0..1 + dice.below(3) {
                let from = dice.below(case.nodes.len());
                let ty = case.nodes[from].ty;
                let ports = if dice.one_in(4) { ty.outputs } else { ty.events };
                if ports.is_empty() || matches!(ty.name, "ScList" | "pass") {
                    continue;
                }
                let port = *dice.of(ports);
                // The compiler rejects a node that waits for its own event.
                if from == n || case.links.iter().any(|l| l.from == (from, port) && l.to == (n, slot)) {
                    continue;
                }
                link(dice, case, (from, port), (n, slot), flavour);
            }
        }
    }
}

/// Cancels some nodes and nested graphs, and resumes some of them.
fn cancel(dice: &mut Dice, case: &mut Case, flavour: &Flavour) {
    for _ in 0..1 + dice.below(3) {
        let (of, group) = if case.groups.len() > 1 && dice.one_in(2) {
            let group = 1 + dice.below(case.groups.len() - 1);
            (Target::Group(group), case.groups[group])
        } else {
            let node = dice.below(case.nodes.len());
            if case.nodes[node].ty.name == "pass" {
                continue;
            }
            (Target::Node(case.nodes[node].id), case.nodes[node].group)
        };
        let is_told = dice.one_in(2);
        let told = is_told.then(|| {
            push(dice, case, node_type("ScKick"), flavour);
            let told = case.nodes.len() - 1;
            case.nodes[told].group = group;
            connect_kick(dice, case, told, flavour);
            (told, !dice.one_in(3))
        });
        let Some(by) = beside(dice, case, group) else { continue };
        let back = if dice.one_in(2) { beside(dice, case, group) } else { None };
        let by = (by, dice.one_in(2));
        let back = back.map(|back| (back, dice.one_in(2)));
        case.cancels.push(Cancel { of, by, back, tells: told });
    }
}

/// Connects the event of a node that is told of a `cancel` with some slot.
fn connect_kick(dice: &mut Dice, case: &mut Case, from: usize, flavour: &Flavour) {
    let to = dice.below(case.nodes.len());
    let slots: Vec<&'static str> = case.nodes[to].ty.slots.to_vec();
    if to != from && case.nodes[to].ty.name != "ScKick" && !slots.is_empty() {
        let slot = *dice.of(&slots);
        link(dice, case, (from, "e"), (to, slot), flavour);
    }
}

/// Random port of a node that sends, in the body of a nested graph.
fn beside(dice: &mut Dice, case: &Case, group: usize) -> Option<(usize, &'static str)> {
    for _ in 0..40 {
        let node = dice.of(&case.nodes);
        let ports = if dice.one_in(3) { node.ty.outputs } else { node.ty.events };
        if node.group == group && !ports.is_empty() && !matches!(node.ty.name, "ScList" | "pass") {
            return Some((node.id, *dice.of(ports)));
        }
    }
    None
}

/// Activates some nodes at the start.
fn activate(dice: &mut Dice, case: &mut Case) {
    for _ in 0..1 + dice.below(3) {
        let n = dice.below(case.nodes.len());
        if !matches!(case.nodes[n].ty.name, "pass" | "ScKick" | "ScTock") {
            case.nodes[n].starts = true;
        }
    }
    // The body of an `each` has no activity of its own.
    let lists: Vec<usize> = case.nodes.iter().filter(|n| n.ty.name == "pass").map(|n| n.id).collect();
    case.links
        .iter_mut()
        .filter(|l| lists.contains(&l.to.0) || lists.contains(&l.from.0))
        .for_each(|l| l.active = false);
}

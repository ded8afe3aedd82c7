//! Random synchronous graphs: as source files for the compiler, and run by an interpreter of the rules R1 to R3.
//!
//! Every graph is written twice, flat and with some neighbouring nodes in a nested graph; both must behave identically.

mod interpret;
mod kinds;
mod run;
mod text;

pub use run::Trace;
pub use text::text;

use crate::Dice;
use kinds::{COUNT, Kind, ONE_BASED, OPERATIONS, SINKS, Token};
use std::ops::Range;

/// Seed of the committed source files.
pub const SEED: u64 = 0x5eed_a9e1;

/// An output of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct End {
    node: usize,
    output: usize,
}

/// A node of a random graph.
#[derive(Debug)]
struct Instance {
    kind: &'static Kind,
    parameter: i64,
    /// Source of each input; an optional one may be unconnected.
    inputs: Vec<Option<End>>,
    /// Initial tokens, if the outputs are delayed; `None` is the default, 0.
    delay: Option<Vec<Token>>,
}

/// A random graph.
#[derive(Debug)]
pub struct Case {
    nodes: Vec<Instance>,
    /// Nodes that are also written as a nested graph.
    group: Range<usize>,
}

/// The first `count` graphs for `seed`.
pub fn cases(seed: u64, count: usize) -> Vec<Case> {
    let mut dice = Dice(seed);
    (0..count).map(|_| case(&mut dice)).collect()
}

fn case(dice: &mut Dice) -> Case {
    let mut nodes: Vec<Instance> = vec![];
    let size = 5 + dice.below(36);
    let sources = 1 + dice.below(1 + size / 8);
    let sinks = 1 + size / 5;
    for _ in 0..sources {
        let kind = if dice.one_in(3) { &ONE_BASED } else { &COUNT };
        nodes.push(instance(dice, kind, vec![]));
    }
    while nodes.len() + sinks < size {
        let kind = dice.of(OPERATIONS);
        let optional = kind.inputs.len() - kind.optional..kind.inputs.len();
        let inputs = (0..kind.inputs.len()).map(|input| {
            // One of any number of inputs exists only with its connection.
            let is_single = kind.inputs.iter().filter(|name| **name == kind.inputs[input]).count() == 1;
            let open = optional.contains(&input) && is_single && dice.one_in(6);
            (!open).then(|| end(dice, &nodes))
        });
        let inputs = inputs.collect();
        let mut node = instance(dice, kind, inputs);
        if dice.one_in(if ends_loops(kind) { 2 } else { 8 }) {
            let tokens = 1 + dice.below(2);
            let held = (0..tokens).map(|_| Some(dice.below(9) as i64)).collect();
            node.delay = Some(if dice.one_in(3) { vec![None] } else { held });
        }
        nodes.push(node);
    }
    close_loops(dice, &mut nodes);
    let inner = nodes.len();
    for id in 0..sinks {
        let kind = dice.of(SINKS);
        let inputs = vec![Some(end(dice, &nodes[..inner]))];
        nodes.push(Instance { kind, parameter: id as i64, inputs, delay: None });
    }
    let start = dice.below(nodes.len() - 1);
    let group = start..start + 2 + dice.below((nodes.len() - start - 1).min(10));
    Case { nodes, group }
}

fn instance(dice: &mut Dice, kind: &'static Kind, inputs: Vec<Option<End>>) -> Instance {
    let parameter = kind.parameter.clone().map_or(0, |(_, r)| r.start + dice.below((r.end - r.start) as usize) as i64);
    Instance { kind, parameter, inputs, delay: None }
}

/// A random existing output, preferably a late one.
fn end(dice: &mut Dice, nodes: &[Instance]) -> End {
    let near = if dice.one_in(2) { nodes.len() } else { nodes.len().min(5) };
    let node = nodes.len() - 1 - dice.below(near);
    End { node, output: dice.below(nodes[node].kind.outputs.len()) }
}

/// Values in cycles must not grow without bound: a loop goes through a node whose values are small.
fn ends_loops(kind: &Kind) -> bool {
    kind.name == "Accumulate"
}

/// Connects some inputs to a later node with delayed outputs.
fn close_loops(dice: &mut Dice, nodes: &mut [Instance]) {
    for node in 0..nodes.len() {
        for input in 0..nodes[node].inputs.len() {
            let later: Vec<usize> =
                (node..nodes.len()).filter(|n| nodes[*n].delay.is_some() && ends_loops(nodes[*n].kind)).collect();
            if !later.is_empty() && dice.one_in(5) {
                let from = *dice.of(&later);
                let output = dice.below(nodes[from].kind.outputs.len());
                nodes[node].inputs[input] = Some(End { node: from, output });
            }
        }
    }
}

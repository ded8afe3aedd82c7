use super::{
    Case, End,
    kinds::{State, Token},
};
use std::collections::VecDeque;

/// Behaviour of a graph.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// For each iteration, the nodes that fired, in the order of their names.
    pub fired: Vec<Vec<String>>,
    /// Tokens that each sink wrote.
    pub tapes: Vec<Vec<Token>>,
}

impl Case {
    /// Runs `iterations` iterations: R1 (all inputs hold a token), R2 (one token to every output), R3 (⊥).
    pub fn run(&self, iterations: usize) -> Trace {
        let mut states = vec![State::default(); self.nodes.len()];
        let held = |n: &super::Instance| {
            let initial: VecDeque<Token> = n.delay.iter().flatten().map(|t| Some(t.unwrap_or(0))).collect();
            vec![initial; n.kind.outputs.len()]
        };
        let mut delays: Vec<Vec<VecDeque<Token>>> = self.nodes.iter().map(held).collect();
        let fired = (0..iterations).map(|_| self.iteration(&mut states, &mut delays)).collect();
        let sinks = self.nodes.iter().zip(states).filter(|(n, _)| n.kind.outputs.is_empty());
        Trace { fired, tapes: sinks.map(|(_, state)| state.tape).collect() }
    }

    fn iteration(&self, states: &mut [State], delays: &mut [Vec<VecDeque<Token>>]) -> Vec<String> {
        // The tokens of a delayed node exist before any node fires.
        let waiting = delays.iter_mut().map(|queues| queues.iter_mut().filter_map(VecDeque::pop_front).collect());
        let mut sent: Vec<Vec<Token>> = waiting.collect();
        let mut fired = vec![];
        for (id, node) in self.nodes.iter().enumerate() {
            let inputs: Vec<Token> =
                node.inputs.iter().map(|i| i.and_then(|End { node, output }| sent[node][output])).collect();
            let mandatory = &inputs[..inputs.len() - node.kind.optional];
            let runs = node.kind.told || mandatory.iter().all(Option::is_some);
            let outputs = if runs {
                fired.push(self.name(id));
                (node.kind.fire)(&mut states[id], node.parameter, &inputs)
            } else {
                vec![None; node.kind.outputs.len()]
            };
            if node.delay.is_some() {
                delays[id].iter_mut().zip(outputs).for_each(|(queue, token)| queue.push_back(token));
            } else {
                sent[id] = outputs;
            }
        }
        fired.sort();
        fired
    }

    /// Number of sinks.
    pub fn sinks(&self) -> usize {
        self.nodes.iter().filter(|n| n.kind.outputs.is_empty()).count()
    }

    pub(super) fn name(&self, node: usize) -> String {
        format!("n{node}")
    }
}

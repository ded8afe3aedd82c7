//! Execution of a cluster: blocks, firings, and how tokens get from one to the next.

use crate::{
    Value,
    local::{Local, put},
    run::{Place, Run},
};
use apex_dsl::{
    analyse::{ClusterId, Run as Firings},
    graph::{NodeId, NodeKind, PortId},
    program::{Op, Storage},
};
use apex_rt::{Ctx, Observer};

impl<'r, O: Observer> Run<'r, '_, O> {
    /// Fires a cluster of the program.
    pub fn fire_cluster(&mut self, cluster: ClusterId, ctx: &Ctx) {
        let code = self.code;
        let mut local = Local::new(code.program.lower, &code.program.plans[cluster]);
        self.ops(&code.program.clusters[cluster], ctx, &mut Place { local: Some(&mut local), taken: None });
    }

    /// Executes an operation that belongs to a cluster.
    pub fn in_cluster(&mut self, op: &Op, ctx: &Ctx, place: &mut Place<'_, 'r>) {
        let Some(local) = place.local.as_deref_mut() else { return };
        match op {
            Op::Take(port) => {
                let token = self.waiting(port.node);
                local.write(self.state, *port, token);
            }
            Op::TakeDelayed(node) => {
                let token = self.delayed(*node, local);
                local.write(self.state, PortId { node: *node, port: 1 }, token);
            }
            Op::Declare(port) => self.declare(*port, local),
            Op::Block { tokens, body, .. } => {
                let is_open = tokens.iter().all(|port| local.read(self.state, *port).is_some());
                self.ops(if is_open { body } else { &[] }, ctx, place);
            }
            Op::Iteration { runs, firings } => {
                for Firings { node, from, to } in runs {
                    for firing in *from..*to {
                        if let Some(local) = place.local.as_deref_mut() {
                            local.firing = firing as usize;
                        }
                        self.ops(&firings[node], ctx, place);
                    }
                }
                if let Some(local) = place.local.as_deref_mut() {
                    local.firing = 0;
                }
            }
            Op::IfArrived { inputs, body } => {
                let is_open = inputs.iter().all(|input| local.arriving(self.state, *input).is_some());
                self.ops(if is_open { body } else { &[] }, ctx, place);
            }
            Op::Fire { node, fire } => self.fire(*node, fire, ctx, local),
            Op::Store(port) => {
                let token = local.read(self.state, *port);
                put(&mut self.state.tokens, *port, token);
            }
            Op::HoldIteration(node) => {
                for firing in 0..self.code.program.lower.analysis.repetitions[*node] {
                    local.firing = firing as usize;
                    let token = local.arriving(self.state, PortId { node: *node, port: 0 });
                    self.state.held.entry(*node).and_modify(|held| held.put(token));
                }
                local.firing = 0;
            }
            // All others belong to no cluster.
            _ => {}
        }
    }

    /// The token that waits in a delay or at an input of the program.
    fn waiting(&mut self, node: NodeId) -> Option<Value> {
        match self.code.graph().nodes[node].kind {
            NodeKind::Delay(_) => self.state.held.get_mut(&node).and_then(|held| held.take_at(0)),
            _ => self.state.inputs.remove(&node).map(|(_, token)| token),
        }
    }

    /// Token of a firing of a delay: first those that it holds, then the first ones of this iteration.
    fn delayed(&mut self, node: NodeId, local: &Local<'_>) -> Option<Value> {
        let NodeKind::Delay(initial) = &self.code.graph().nodes[node].kind else { return None };
        match local.firing.checked_sub(initial.len()) {
            None => self.state.held.get_mut(&node).and_then(|held| held.take_at(local.firing)),
            Some(newer) => {
                let from = self.code.program.lower.incoming(PortId { node, port: 0 })?;
                local.arrays.get(&from)?.get(newer)?.clone()
            }
        }
    }

    fn declare(&mut self, port: PortId, local: &mut Local<'_>) {
        match local.plan.storage(port) {
            Storage::Buffer => drop(self.state.tokens.remove(&port)),
            Storage::Array => {
                let lower = self.code.program.lower;
                let size = lower.analysis.repetitions[port.node] as usize * lower.graph.port(port).rate;
                local.arrays.insert(port, vec![None; size]);
            }
            _ => drop(local.tokens.remove(&port)),
        }
    }
}

//! `each`: its body runs once for each element of a list.

use crate::{
    Value,
    cluster::Local,
    ops::{Place, Run},
};
use apex_dsl::{
    graph::{NodeId, NodeKind, PortId},
    syntax::tree::PortKind,
};
use apex_rt::{Ctx, Observer};
use std::collections::BTreeMap;

impl<'r, O: Observer> Run<'r, '_, O> {
    /// Fires an `each`: the results are collected in order, ⊥ is dropped.
    pub fn fire_each(&mut self, node: NodeId, ctx: &Ctx, local: &mut Local<'r>) {
        let code = self.code;
        let graph = code.graph();
        let NodeKind::Each(each) = &graph.nodes[node].kind else { return };
        let (Some(list), Some(body)) = (each.list, code.bodies.get(&node)) else { return };
        let Some(tokens) = local.arriving(self.state, PortId { node, port: list }) else { return };
        let number = self.number(node);
        self.observer.fired(number);
        let Some(mut inner) = self.state.bodies.remove(&node) else { return };
        // Ports of the body have the names of those of the node.
        let boundary = |port: usize, kind: PortKind| {
            let name = &graph.nodes[node].ports[port].name;
            body.graph().nodes.position(|n| n.name == *name && matches!(n.kind, NodeKind::Boundary(k) if k == kind))
        };
        let of_kind = |kind: PortKind| {
            let ports = graph.nodes[node].ports.iter().enumerate();
            ports.filter(move |(_, port)| port.kind == kind).map(|(port, _)| port)
        };
        let mut results: BTreeMap<usize, Vec<Value>> = of_kind(PortKind::Output).map(|port| (port, vec![])).collect();
        for item in self.library.items(&tokens) {
            let mut given: BTreeMap<PortId, Value> = BTreeMap::new();
            for port in of_kind(PortKind::Input) {
                let token =
                    if port == list { Some(item.clone()) } else { local.arriving(self.state, PortId { node, port }) };
                if let (Some(inside), Some(token)) = (boundary(port, PortKind::Input), token) {
                    given.insert(PortId { node: inside, port: 0 }, token);
                }
            }
            let mut run = Run {
                code: body,
                state: &mut inner,
                cells: &mut *self.cells,
                library: self.library,
                observer: &mut *self.observer,
            };
            for cluster in body.clusters.ids() {
                let mut local = Local::new(body.program.lower, &body.plans[cluster]);
                given.iter().for_each(|(port, token)| local.write(run.state, *port, Some(token.clone())));
                run.ops(&body.clusters[cluster], ctx, &mut Place { local: Some(&mut local), taken: None });
                for (port, collected) in &mut results {
                    let Some(output) = boundary(*port, PortKind::Output) else { continue };
                    if body.program.lower.analysis.clusters[cluster].nodes.contains(&output) {
                        collected.extend(local.arriving(run.state, PortId { node: output, port: 0 }));
                    }
                }
            }
        }
        for (port, items) in results {
            let end = PortId { node, port };
            let list = self.library.list(items, &graph.port(end).ty);
            local.write(self.state, end, Some(list));
        }
        self.state.bodies.insert(node, inner);
        self.observer.finished(number);
    }
}

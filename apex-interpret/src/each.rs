//! `each`: its body runs once for each element of a list.

use crate::{
    Value,
    local::Local,
    run::{Place, Run},
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
        for item in self.library.items((number, list), &tokens) {
            let mut given: BTreeMap<PortId, Value> = BTreeMap::new();
            for port in of_kind(PortKind::Input) {
                let token =
                    if port == list { Some(item.clone()) } else { local.arriving(self.state, PortId { node, port }) };
                if let (Some(inside), Some(token)) = (boundary(port, PortKind::Input), token) {
                    given.insert(PortId { node: inside, port: 0 }, token);
                }
            }
            let outputs: Vec<(usize, NodeId)> =
                results.keys().filter_map(|port| Some((*port, boundary(*port, PortKind::Output)?))).collect();
            let (state, cells, library) = (&mut inner, &mut *self.cells, self.library);
            // What happens on other threads cannot be watched.
            let sent = match each.parallel {
                true => Run { code: body, state, cells, library, observer: &mut () }.element(&given, &outputs, ctx),
                false => Run { code: body, state, cells, library, observer: &mut *self.observer }
                    .element(&given, &outputs, ctx),
            };
            for (port, token) in sent {
                results.entry(port).or_default().push(token);
            }
        }
        for (port, items) in results {
            let end = PortId { node, port };
            let list = self.library.list((number, port), items);
            local.write(self.state, end, list);
        }
        self.state.bodies.insert(node, inner);
        self.observer.finished(number);
    }

    /// Runs the body for one element. Returns the tokens at `outputs`, by the ports of the node.
    fn element(
        &mut self,
        given: &BTreeMap<PortId, Value>,
        outputs: &[(usize, NodeId)],
        ctx: &Ctx,
    ) -> Vec<(usize, Value)> {
        let code = self.code;
        let mut sent = vec![];
        for cluster in code.program.clusters.ids() {
            let mut local = Local::new(code.program.lower, &code.program.plans[cluster]);
            given.iter().for_each(|(port, token)| local.write(self.state, *port, Some(token.clone())));
            self.ops(&code.program.clusters[cluster], ctx, &mut Place { local: Some(&mut local), taken: None });
            let nodes = &code.program.lower.analysis.clusters[cluster].nodes;
            for (port, node) in outputs.iter().filter(|(_, node)| nodes.contains(node)) {
                let token = local.arriving(self.state, PortId { node: *node, port: 0 });
                sent.extend(token.map(|token| (*port, token)));
            }
        }
        sent
    }
}

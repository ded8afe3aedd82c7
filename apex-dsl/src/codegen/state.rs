//! State of a program besides its nodes and ports: its fields.

use super::{
    field::{Kind, StateField, fields},
    generator::Generator,
    structs::Struct,
    tokens::constant,
    view::ProgramView,
};
use crate::{
    analyse::Analysis,
    graph::{Connection, Graph, NodeId, NodeKind, PortId},
    program::{Storage, is_buffer, storage},
    syntax::tree::PortKind,
};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;

impl Generator<'_> {
    /// The structs of the state and of its core.
    pub fn state_structs(&self, view: ProgramView<'_>) -> [Struct; 2] {
        let kept = self.state(view);
        let (core, state): (Vec<&StateField>, Vec<&StateField>) = kept.iter().partition(|kept| kept.is_core());
        let state = Struct::new(&self.item(view.graph, "State"), "Tokens.", &fields(state));
        let docs = "Activity, timers, and which tokens are on their way.";
        let mut core = Struct::new(&self.item(view.graph, "Core"), docs, &fields(core));
        if !core.item.is_empty() && view.wiring.has_rows() {
            core.item.extend(self.wired(view));
        }
        [state, core]
    }

    /// The types of the state and of its core.
    pub fn state_types(&self, view: ProgramView<'_>) -> [TokenStream; 2] {
        self.state_structs(view).map(|state| state.ty)
    }

    /// The state of a program.
    pub fn state(&self, view: ProgramView<'_>) -> Vec<StateField> {
        let mut kept = self.token_state(view.graph, view.analysis);
        kept.extend(self.timer_state(view));
        kept.extend(self.activity_state(view));
        kept.extend(self.claim_state(view));
        kept.extend(self.stamps(view));
        kept.extend(self.dispatcher_state(view));
        kept
    }

    /// Tokens that are kept in the state of the program, or of a parallel body.
    pub fn token_state(&self, graph: &Graph, analysis: &Analysis) -> Vec<StateField> {
        let mut kept = vec![];
        let mut leaving: BTreeMap<PortId, Vec<&Connection>> = BTreeMap::new();
        graph.connections.iter().for_each(|c| leaving.entry(c.from).or_default().push(c));
        for (node, n) in graph.nodes.iter_enumerated() {
            let ports = (0..n.ports.len()).filter(|port| n.ports[*port].kind.sends());
            kept.extend(ports.filter_map(|port| {
                let end = PortId { node, port };
                self.kept_token(graph, analysis, end, leaving.get(&end).map_or(&[], Vec::as_slice))
            }));
            kept.extend(self.kept_delay(graph, node));
            if let (NodeKind::Each(each), Some(body)) = (&n.kind, analysis.bodies.get(&node))
                && !each.parallel
            {
                kept.extend(self.inside(graph, node).token_state(&each.body, body));
            }
        }
        kept
    }

    /// Field of a token on these connections; `None` if the token does not outlive the firing of its cluster.
    fn kept_token(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        end: PortId,
        leaving: &[&Connection],
    ) -> Option<StateField> {
        let is_sent = leaving.iter().any(|c| !graph.is_synchronous(c));
        if graph.port(end).kind == PortKind::Event && !is_sent {
            return None;
        }
        let (of, name) = (self.token_name(graph, end), self.name(end));
        if is_buffer(graph, self.catalog, end) {
            let ty = self.buffer_type(graph, end);
            return Some(StateField::new(
                Kind::Token,
                of,
                name,
                quote!(::apex_rt::Out<#ty>),
                quote!(::apex_rt::Out::new()),
            ));
        }
        let crosses = || leaving.iter().any(|c| analysis.cluster_of[c.to.node] != analysis.cluster_of[end.node]);
        if !is_sent && !crosses() {
            return None;
        }
        debug_assert!(!matches!(storage(graph, self.catalog, end), Storage::Argument | Storage::MaybeArgument));
        let ty = self.token_type(graph, end);
        Some(StateField::new(Kind::Token, of, name, quote!(::core::option::Option<#ty>), quote!(None)))
    }

    /// The tokens that a delay holds back.
    fn kept_delay(&self, graph: &Graph, node: NodeId) -> Option<StateField> {
        let NodeKind::Delay(initial) = &graph.nodes[node].kind else { return None };
        let end = PortId { node, port: 1 };
        let (ty, count) = (self.token_type(graph, end), initial.len());
        let port_ty = &graph.port(graph.incoming(PortId { node, port: 0 }).map_or(end, |c| graph.origin(c.from))).ty;
        let values = initial.iter().map(|value| match value {
            Some(value) => constant(value, port_ty),
            None => self.first_token(graph, node),
        });
        let make = quote!(::apex_rt::Delay::new([#(Some(#values)),*]));
        let of = self.node_path(graph, node).join(".");
        Some(StateField::new(Kind::Token, of, self.held(node), quote!(::apex_rt::Delay<#ty, #count>), make))
    }

    /// A token as a person would name it, also inside of an `each`.
    fn token_name(&self, graph: &Graph, end: PortId) -> String {
        let node = self.node_path(graph, end.node).join(".");
        match graph.nodes[end.node].kind {
            NodeKind::Boundary(_) => node,
            _ => format!("{node}.{}", graph.port(end).name),
        }
    }

    /// Type that a node writes in place: one token, or an array of the tokens of a firing.
    fn buffer_type(&self, graph: &Graph, end: PortId) -> TokenStream {
        let (ty, rate) = (self.token_type(graph, end), graph.port(end).rate);
        if rate > 1 { quote!([#ty; #rate]) } else { ty }
    }
}

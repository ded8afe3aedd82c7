//! Runs a net without a program: a random legal run, recorded as by a program.

use super::{
    judge::{Checked, Record, script_of},
    script::{self, GIVEN},
};
use crate::Dice;
use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    graph::{Graph, NodeId, NodeKind, PortId},
};
use apex_petri::{Call, State, Token, TransitionId, TransitionKind};
use std::{collections::BTreeMap, time::Duration};

/// A random run of `reactions` reactions, one per millisecond. Silent transitions occur at random times.
pub fn walk(catalog: &Catalog, checked: &Checked, dice: &mut Dice, reactions: u64) -> Vec<Record> {
    let Checked { program: CheckedProgram { graph, .. }, net, .. } = checked;
    let scripts = script_of(graph, catalog);
    let sends = |call: Call, port: usize| match scripts.get(&call.node) {
        Some((id, parameters)) => {
            script::sends(*id, *parameters, &graph.nodes[call.node].ports[port].name, call.nth as i64)
        }
        None => true,
    };
    let mut state = State::new(graph, catalog, net, &sends);
    state.take_changes();
    let mut fired: BTreeMap<NodeId, u32> = BTreeMap::new();
    let mut records = vec![];
    for reaction in 0..reactions {
        let now = Duration::from_millis(reaction);
        state.set_time(now);
        records.push(Record::Begin(now.as_nanos() as u64));
        let mut plain: Vec<NodeId> = vec![];
        loop {
            let sources = state.sources().clone();
            let is_due = |node: NodeId| {
                let modifiers = &graph.nodes[node].modifiers;
                let count = fired.get(&node).copied().unwrap_or_default();
                !sources.contains(&node)
                    || now.checked_sub(modifiers.after.unwrap_or_default()).is_some_and(|passed| {
                        modifiers.every.map_or(!plain.contains(&node), |every| every * count <= passed)
                    })
            };
            let ready: Vec<TransitionId> = net
                .transitions
                .ids()
                .filter(|t| state.is_enabled(*t))
                .filter(|t| match net.transitions[*t].kind {
                    TransitionKind::Take(node) | TransitionKind::Release(node) => is_due(node),
                    _ => true,
                })
                .collect();
            // A timeout comes only if nothing else is left to do, the first one.
            let is_time_out = |t: &TransitionId| matches!(net.transitions[*t].kind, TransitionKind::TimeOut(_));
            let (due, others): (Vec<_>, Vec<_>) = ready.into_iter().partition(is_time_out);
            let transition = match (others.is_empty(), due.first()) {
                (false, _) => *dice.of(&others),
                (true, Some(first)) => *first,
                (true, None) => break,
            };
            let kind = net.transitions[transition].kind;
            if let TransitionKind::Take(node) | TransitionKind::Release(node) = kind {
                *fired.entry(node).or_default() += 1;
                plain.push(node);
            }
            occur(graph, &mut state, transition, kind, net, &mut records);
        }
        records.push(Record::End);
    }
    records
}

/// Fires a transition. A call is one unit: the tokens that it takes and sends, and the events that it triggers.
fn occur(
    graph: &Graph,
    state: &mut State<'_>,
    transition: TransitionId,
    kind: TransitionKind,
    net: &apex_petri::Net,
    records: &mut Vec<Record>,
) {
    let (node, record, after) = match kind {
        TransitionKind::Take(node) => {
            (node, state.preview(node).reported.then_some(Record::Fired(node)), TransitionKind::Send(node))
        }
        TransitionKind::Handle(connection) => {
            let node = graph.connections[connection].to.node;
            (node, Some(Record::Handled(connection)), TransitionKind::Handled(node))
        }
        _ => {
            state.occur(transition);
            return changes(state, records);
        }
    };
    let is_reported = record.is_some();
    records.extend(record);
    state.occur(transition);
    let tokens = state.tokens_of(node);
    changes(state, records);
    if is_reported && matches!(graph.nodes[node].kind, NodeKind::Library(_)) {
        records.push(Record::Took(tokens.iter().map(|t| value(graph, *t)).collect()));
    }
    let ports = 0..graph.nodes[node].ports.len();
    let decisions = ports.flat_map(|port| {
        [TransitionKind::Trigger(PortId { node, port }), TransitionKind::Suppress(PortId { node, port })]
    });
    for next in [after].into_iter().chain(decisions) {
        if let Some(transition) = net.find(next).filter(|t| state.is_enabled(*t)) {
            state.occur(transition);
            changes(state, records);
        }
    }
}

fn changes(state: &mut State<'_>, records: &mut Vec<Record>) {
    records.extend(state.take_changes().into_iter().map(|(node, active)| Record::Activity(node, active)));
}

/// Value that a scripted node sends; 7 is the initial token of delays.
fn value(graph: &Graph, token: Token) -> Option<i64> {
    let made = |end: PortId, call: usize| {
        if end.node.index() >= graph.nodes.len() {
            return GIVEN;
        }
        let NodeKind::Library(library) = &graph.nodes[end.node].kind else { return 7 };
        let id = library.params.first();
        let id = match id {
            Some(apex_dsl::graph::Value::Number(number)) => number.value as i64,
            _ => 0,
        };
        script::value(id, &graph.port(end).name, call as i64)
    };
    token.value.then(|| token.origin.map_or(7, |o| made(o.end, o.call)))
}

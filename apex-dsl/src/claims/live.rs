//! The claim that tokens never wait for one another, and a warning where nothing is claimed.

use super::verdict::{Verdict, how_checked};
use crate::{
    analyse::{Analysis, Stuck, find_stuck, is_live},
    catalog::Catalog,
    graph::{Claim, ClaimKind, ConnectionId, Graph},
    report::{Diagnostic, Diagnostics},
};

/// Decides `claim live`, if it is claimed, and warns where it is not claimed and does not hold.
pub fn live(graph: &Graph, analysis: &Analysis, catalog: &Catalog, diagnostics: &mut Diagnostics) -> Option<Verdict> {
    let claim = graph.claims.iter().find(|claim| claim.kind == ClaimKind::Live);
    let stuck = find_stuck(graph, analysis, catalog);
    if let Some(stuck) = &stuck {
        diagnostics.push_once(explain(graph, stuck, |message, first| match claim {
            Some(claim) => Diagnostic::error("claim-fails", claim.span, message),
            None => {
                let to = &graph.nodes[graph.connections[first].to.node];
                let warning = Diagnostic::warning("stuck", graph.connections[first].span, message);
                warning.inside(graph.scope_path(to.scope))
            }
        }));
    }
    let claim = claim?;
    if stuck.is_some() {
        return Some(Verdict::Fails);
    }
    if is_live(graph, analysis) {
        return Some(Verdict::Holds);
    }
    diagnostics.push_once(unknown(graph, claim));
    Some(Verdict::undecided(graph))
}

/// A message about tokens that wait for one another, with the run to them. `begin` gets its text, and the connection of
/// a token that waits.
fn explain(graph: &Graph, stuck: &Stuck, begin: impl FnOnce(String, ConnectionId) -> Diagnostic) -> Diagnostic {
    let text = |connection: ConnectionId| format!("`{}`", graph.connection_text(connection));
    let waits = |(token, before): &(ConnectionId, ConnectionId)| {
        let node = graph.path(graph.connections[*token].to.node);
        format!(
            "the token of {} waits: `{node}` is called only after that of {} was taken",
            text(*token),
            text(*before)
        )
    };
    let names: Vec<String> =
        stuck.waits.iter().map(|(token, _)| graph.end_name(graph.connections[*token].to)).collect();
    let message = format!("tokens may wait for one another forever at `{}`", names.join("` and `"));
    let mut diagnostic = begin(message, stuck.waits[0].0);
    if !stuck.run.is_empty() {
        let run: Vec<String> = stuck.run.iter().map(|token| text(*token)).collect();
        diagnostic = diagnostic.note(format!("first the tokens of {} are taken", run.join(", then ")));
    }
    let diagnostic = stuck.waits.iter().map(waits).fold(diagnostic, Diagnostic::note);
    diagnostic.note("let one token reach only one node of a cycle, or send it on through a `delay`")
}

fn unknown(graph: &Graph, claim: &Claim) -> Diagnostic {
    let message = "`live` is undecided: tokens may wait for one another, or events of several threads lead in a circle";
    let warning = Diagnostic::warning("claim-undecided", claim.span, message).note(how_checked(graph));
    warning.note("let events lead in no circle from slot to slot, or send a token on through a `delay`")
}

//! Claims about activity, decided before a program runs by a search through all states of its activity, and the claim
//! that its tokens never wait for one another.

mod live;
mod model;
mod properties;
mod search;
mod slices;
mod trace;
mod verdict;

use crate::{
    analyse::Analysis,
    catalog::Catalog,
    graph::{Claim, ClaimKind, Graph, Subject},
    report::{Diagnostic, Diagnostics},
};

pub use model::{Arrival, Delay, Emission, Model, Move, Place, PlaceId, State};
pub use properties::{Checks, FROM, NEARER, scopes_of};
pub use search::{MAX_STATES, Outcome, search};
pub use slices::{Slice, slices};
pub use verdict::Verdict;

use verdict::how_checked;

/// Verdicts on the claims of a graph.
#[derive(Debug, Clone, Default)]
pub struct Decided {
    /// Number of visited states.
    pub states: usize,
    /// Verdict on each claim, in the order of [`Graph::claims`].
    pub verdicts: Vec<Verdict>,
    /// The claim `live`.
    live: Option<usize>,
}

impl Decided {
    /// The claims about activity that the program has to check at run time.
    pub fn undecided(&self) -> Vec<usize> {
        (0..self.verdicts.len()).filter(|c| self.live != Some(*c) && self.is_undecided(*c)).collect()
    }

    /// The claim `live`, if the program has to check it at run time.
    pub fn undecided_live(&self) -> Option<usize> {
        self.live.filter(|claim| self.is_undecided(*claim))
    }

    fn is_undecided(&self, claim: usize) -> bool {
        self.verdicts[claim] == Verdict::Undecided
    }
}

/// Decides the claims of `graph` with at most `bound` visited states. Reports claims that fail or remain undecided,
/// once for each place in the source file, however often its graph is used. Warns of tokens that wait for one another.
pub fn decide(
    graph: &Graph,
    analysis: &Analysis,
    catalog: &Catalog,
    bound: usize,
    diagnostics: &mut Diagnostics,
) -> Decided {
    let live = live::live(graph, analysis, catalog, diagnostics);
    if graph.claims.is_empty() {
        return Decided::default();
    }
    let model = Model::new(graph, catalog);
    let checks = Checks::new(graph, &model);
    let is_live = |claim: &Claim| claim.kind == ClaimKind::Live;
    let mut decided = Decided { live: graph.claims.iter().position(is_live), ..Decided::default() };
    let mut found: Vec<(Option<Vec<Move>>, bool)> = vec![(None, true); graph.claims.len()];
    for slice in slices(&model, &checks) {
        let mut outcome = search(&model, &checks, &slice, bound.saturating_sub(decided.states));
        decided.states += outcome.states;
        for claim in slice.claims {
            let (run, complete) = &mut found[claim];
            *run = run.take().or(outcome.runs[claim].take());
            *complete &= outcome.complete;
        }
    }
    for (number, (claim, (run, complete))) in graph.claims.iter().zip(&found).enumerate() {
        if let (ClaimKind::Live, Some(verdict)) = (claim.kind, live) {
            decided.verdicts.push(verdict);
            continue;
        }
        decided.verdicts.push(match run {
            Some(run) => {
                diagnostics.push_once(failure(graph, &model, claim, run));
                Verdict::Fails
            }
            None if *complete || checks.is_certain(&model, number, claim.of.len() as u32) => Verdict::Holds,
            None => {
                diagnostics.push_once(open(graph, claim, decided.states));
                Verdict::undecided(graph)
            }
        });
    }
    decided
}

fn failure(graph: &Graph, model: &Model, claim: &Claim, run: &[Move]) -> Diagnostic {
    let names: Vec<String> = claim.of.iter().map(|s| format!("`{}`", graph.subject_name(*s))).collect();
    let (message, advice) = match claim.kind {
        ClaimKind::Exclusive => (
            format!("{} can be active at the same time", active_at_end(graph, model, claim, run).join(" and ")),
            "make activity leave one of them on every path on which it reaches the other",
        ),
        ClaimKind::Reaches => (
            format!("{} can be active when no activity can reach {}", names[0], names[1]),
            "connect the node at which the run ends by `=>`, so that activity can continue from there",
        ),
        ClaimKind::Live | ClaimKind::Conserved => {
            let (left, given) = (end(model, run).into_iter().filter(|p| model.is_active(*p)).count(), model.given);
            let what = if left < given { "lost" } else { "multiplied" };
            (
                format!("activity can be {what}: `start` creates {given}, and the run below ends with {left}"),
                "activity is multiplied where one port has several `=>`, and lost where it reaches a node that is already active, leaves the program or is taken away",
            )
        }
    };
    let mut error = Diagnostic::error("claim-fails", claim.span, message);
    for (subject, name) in claim.of.iter().zip(&names) {
        let span = match subject {
            Subject::Node(node) => graph.nodes[*node].span,
            Subject::Scope(scope) => graph.scopes[*scope].span,
        };
        error = error.also(span, format!("{name} is declared here"));
    }
    let error = trace::run(graph, model, run).into_iter().fold(error, Diagnostic::note);
    error.note(advice)
}

/// The state at the end of a run.
fn end(model: &Model, run: &[Move]) -> State {
    let mut state = model.initial.clone();
    for by in run.iter().filter(|by| **by != Move::Start) {
        let mut next = vec![];
        model.moves(&state, &mut |found, to| {
            if found == *by {
                next = to;
            }
        });
        state = next;
    }
    state
}

/// The subjects of a claim that are active at the end of a run.
fn active_at_end(graph: &Graph, model: &Model, claim: &Claim, run: &[Move]) -> Vec<String> {
    let state = end(model, run);
    let is_in = |subject: &&Subject| {
        state.iter().map(|p| model.places[*p as usize]).any(|place| match **subject {
            Subject::Node(node) => place == Place::Node(node),
            Subject::Scope(scope) => scopes_of(graph, place).contains(&scope),
        })
    };
    claim.of.iter().filter(is_in).map(|s| format!("`{}`", graph.subject_name(*s))).collect()
}

fn open(graph: &Graph, claim: &Claim, states: usize) -> Diagnostic {
    let message = format!(
        "`{}` is undecided: activity has more than the {states} states that were searched",
        graph.claim_text(claim)
    );
    let warning = Diagnostic::warning("claim-undecided", claim.span, message).note(how_checked(graph));
    warning.note("to reduce the number of states, let fewer nodes be active at the same time, or make the claim in a smaller graph")
}

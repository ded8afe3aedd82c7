//! Verdicts on claims from the states of a graph.

use crate::{
    explore::Explored,
    net::{Net, State, Step},
};
use apex_dsl::graph::{Claim, ClaimKind, Subject};

/// State that violates a claim, as a number in [`Explored::states`]; `None` if the claim holds.
///
/// - `exclusive`: "no two of the nodes are ever active at the same time".
/// - `conserved`: "the amount of activity in the program is always the amount that `start` created".
/// - `reaches`: "whenever `a` is active, there is a path on which activity can reach `b`". So from each state in which
///   `a` is active a state can be reached in which `b` is active. "A `reset` without activity is not a path."
pub fn violation(net: &Net<'_>, explored: &Explored, claim: &Claim) -> Option<usize> {
    let state = |number: usize| explored.states[number];
    let is_active = |state: State, subject: Subject| state & net.activity_of(subject) != 0;
    match claim.kind {
        ClaimKind::Exclusive => {
            explored.first(|n| claim.of.iter().filter(|subject| is_active(state(n), **subject)).count() > 1)
        }
        ClaimKind::Conserved => explored.first(|n| net.amount(state(n)) != net.amount(net.start())),
        ClaimKind::Reaches => {
            let [a, b] = claim.of[..] else { return None };
            let can = explored.can_reach(|state| is_active(state, b), |step| !matches!(step, Step::Reset(_)));
            explored.first(|n| is_active(state(n), a) && !can[n])
        }
        // It is not about activity: no graph here claims it.
        ClaimKind::Live => None,
    }
}

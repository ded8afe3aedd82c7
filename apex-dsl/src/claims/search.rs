//! Breadth-first search over the states of a [`Model`].

use super::{
    model::{Model, Move, State},
    properties::Checks,
};
use std::{collections::BTreeSet, sync::Arc};

/// Largest number of states that are visited.
pub const MAX_STATES: usize = 100_000;
/// Largest number of places that are visited, in all states and moves together.
const MAX_WORK: usize = 40_000_000;

/// Result of a search.
#[derive(Debug)]
pub struct Outcome {
    /// Number of visited states.
    pub states: usize,
    /// `true` if these are all states.
    pub complete: bool,
    /// For each claim a shortest run to a state where it does not hold, if there is one.
    pub runs: Vec<Option<Vec<Move>>>,
}

struct Visited {
    state: Arc<State>,
    before: usize,
    by: Move,
}

/// Searches at most `bound` states for violations of the claims.
pub fn search(model: &Model, checks: &Checks, bound: usize) -> Outcome {
    let initial = Arc::new(model.initial.clone());
    let mut known = BTreeSet::from([initial.clone()]);
    let mut visited = vec![Visited { state: initial, before: 0, by: Move::Start }];
    let mut runs: Vec<Option<Vec<Move>>> = vec![None; checks.count()];
    let (mut at, mut work, mut complete) = (0, 0, true);
    while at < visited.len() {
        let state = visited[at].state.clone();
        for claim in checks.broken(model, &state) {
            if runs[claim].is_none() {
                runs[claim] = Some(run(&visited, at));
            }
        }
        // Nothing is left to be found if each claim is known to fail.
        if work > MAX_WORK || runs.iter().all(Option::is_some) {
            complete = false;
            at += 1;
            break;
        }
        work += checks.cost(&state);
        model.moves(&state, &mut |by, next| {
            work += 1 + next.len();
            if known.contains(&next) {
                return;
            }
            if visited.len() >= bound {
                complete = false;
                return;
            }
            let next = Arc::new(next);
            known.insert(next.clone());
            visited.push(Visited { state: next, before: at, by });
        });
        at += 1;
    }
    Outcome { states: at, complete, runs }
}

/// The moves that led to a state.
fn run(visited: &[Visited], mut at: usize) -> Vec<Move> {
    let mut moves = vec![visited[at].by];
    while at != 0 {
        at = visited[at].before;
        moves.push(visited[at].by);
    }
    moves.reverse();
    moves
}

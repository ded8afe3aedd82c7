//! Breadth-first search over the states of a [`Model`].

use super::{
    model::{Model, Move, State},
    properties::Checks,
    slices::Slice,
};
use std::{collections::BTreeMap, sync::Arc};

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

/// Searches at most `bound` states of a slice for violations of its claims.
pub fn search(model: &Model, checks: &Checks, slice: &Slice, bound: usize) -> Outcome {
    let initial: State = model.initial.iter().copied().filter(|place| slice.places[*place as usize]).collect();
    let (given, initial) = (initial.len(), Arc::new(initial));
    let mut known = BTreeMap::from([(initial.clone(), 0)]);
    let mut visited = vec![Visited { state: initial, before: 0, by: Move::Start }];
    let mut runs: Vec<Option<Vec<Move>>> = vec![None; checks.count()];
    let (mut at, mut work, mut complete) = (0, 0, true);
    // Each state with one before it, if a claim asks for ways.
    let about_ways: Vec<usize> = checks.about_ways().filter(|claim| slice.claims.contains(claim)).collect();
    let (mut ways, keeps_ways) = (vec![], !about_ways.is_empty());
    while at < visited.len() {
        let state = visited[at].state.clone();
        for claim in checks.broken(model, &state, given) {
            if runs[claim].is_none() && slice.claims.contains(&claim) {
                runs[claim] = Some(run(&visited, at));
            }
        }
        // Nothing is left to be found if each claim is known to fail.
        if work > MAX_WORK || slice.claims.iter().all(|claim| runs[*claim].is_some()) {
            complete = false;
            at += 1;
            break;
        }
        work += checks.cost(&state);
        model.moves(&state, &mut |by, next| {
            work += 1 + next.len();
            let number = match known.get(&next) {
                Some(number) => *number,
                None if visited.len() >= bound => {
                    complete = false;
                    return;
                }
                None => {
                    let next = Arc::new(next);
                    known.insert(next.clone(), visited.len());
                    visited.push(Visited { state: next, before: at, by });
                    visited.len() - 1
                }
            };
            if keeps_ways {
                ways.push((number, at));
            }
        });
        at += 1;
    }
    if complete {
        ways.sort_unstable();
        for claim in about_ways.into_iter().filter(|claim| runs[*claim].is_none()).collect::<Vec<_>>() {
            let lost = first_lost(checks, claim, &visited, &ways);
            runs[claim] = lost.map(|lost| run(&visited, lost));
        }
    }
    Outcome { states: at, complete, runs }
}

/// The first state in which the first subject of a `reaches` is active, and from which no way leads to a state in which
/// the second one is. `ways` has each state with one before it, in ascending order.
fn first_lost(checks: &Checks, claim: usize, visited: &[Visited], ways: &[(usize, usize)]) -> Option<usize> {
    let arrives = |at: &usize| checks.arrives(claim, &visited[*at].state);
    let mut stack: Vec<usize> = (0..visited.len()).filter(arrives).collect();
    let mut reaching = vec![false; visited.len()];
    stack.iter().for_each(|at| reaching[*at] = true);
    while let Some(at) = stack.pop() {
        let first = ways.partition_point(|(to, _)| *to < at);
        for (_, from) in ways[first..].iter().take_while(|(to, _)| *to == at) {
            if !std::mem::replace(&mut reaching[*from], true) {
                stack.push(*from);
            }
        }
    }
    (0..visited.len()).find(|at| !reaching[*at] && checks.begins(claim, &visited[*at].state))
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

use crate::Space;
use serde::{Deserialize, Serialize};

/// Best candidate so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Values of the parameters, in their units.
    pub values: Vec<f64>,
    /// Fitness; less is better.
    pub fitness: f64,
}

/// Condition under which the exact fitness of a candidate matters to a search. A candidate that certainly fails it may
/// be told as infinite: the search continues in the same way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Selection<'a> {
    /// The exact fitness matters if it is at most this value, by number of the candidate.
    AtMost(&'a [f64]),
    /// The exact fitness matters if it is among so many best ones of the generation.
    Best(usize),
    /// The order of all candidates matters.
    All,
}

/// Optimizer that proposes candidates and is told their fitness, in turns.
pub trait Search {
    /// Search space.
    fn space(&self) -> &Space;

    /// Candidates of the current generation: the values of the parameters, in their units.
    fn ask(&self) -> &[Vec<f64>];

    /// Candidates whose exact fitness matters in the current generation.
    fn selection(&self) -> Selection<'_>;

    /// Takes the fitness of each candidate by number, and proposes the next generation. A candidate has failed if its
    /// fitness is missing, NaN or infinite.
    fn tell(&mut self, fitness: &[f64]);

    /// Best candidate so far, or `None` while all have failed.
    fn best(&self) -> Option<&Best>;
}

/// Fitness by number of the candidate, infinite for failures.
pub(super) fn complete(fitness: &[f64], count: usize) -> Vec<f64> {
    let given = fitness.iter().map(|f| if f.is_finite() { *f } else { f64::INFINITY });
    given.chain(core::iter::repeat(f64::INFINITY)).take(count).collect()
}

/// Keeps the better one of the best candidate so far and the candidates of a generation.
pub(super) fn keep_best(best: &mut Option<Best>, candidates: &[Vec<f64>], fitness: &[f64]) {
    for (values, &fitness) in candidates.iter().zip(fitness) {
        if fitness.is_finite() && best.as_ref().is_none_or(|b| fitness < b.fitness) {
            *best = Some(Best { values: values.clone(), fitness });
        }
    }
}

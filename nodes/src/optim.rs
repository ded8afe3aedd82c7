//! Optimization of parameters by evolution within the flow (feature `optim`; thesis 3.6.4, 9.3.1).

use apex_optim::{Axis, BadAxis, CmaSearch, DeSearch, Scale, Search, Space};
use apex_rt::{Event, node};
use core::fmt;

/// Maximum number of parameters of a [`Candidate`].
pub const MAX_DIMENSIONS: usize = 32;

/// Values of the parameters of a candidate, in the order of the ranges of the search.
pub type Candidate = heapless::Vec<f64, MAX_DIMENSIONS>;

/// Error of ranges that cannot be searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BadRanges {
    /// Range that is wrong, by number.
    Range(usize, BadAxis),
    /// Number of ranges, if it is 0 or above [`MAX_DIMENSIONS`].
    Count(usize),
}

impl fmt::Display for BadRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Range(number, error) => write!(f, "range {number} (counted from 0): {error}"),
            Self::Count(count) => write!(f, "{count} ranges: 1 to {MAX_DIMENSIONS} parameters can be searched"),
        }
    }
}

impl core::error::Error for BadRanges {}

/// Space of these ranges. Axes without an entry in the other lists are linear and real.
fn space(ranges: &[[f64; 2]], logarithmic: &[bool], integer: &[bool]) -> Result<Space, BadRanges> {
    if ranges.is_empty() || ranges.len() > MAX_DIMENSIONS {
        return Err(BadRanges::Count(ranges.len()));
    }
    let entry = |list: &[bool], i: usize| list.get(i).copied().unwrap_or_default();
    let axis = |(i, range): (usize, &[f64; 2])| {
        let scale = if entry(logarithmic, i) { Scale::Logarithmic } else { Scale::Linear };
        Axis::new(range[0], range[1], scale, entry(integer, i)).map_err(|error| BadRanges::Range(i, error))
    };
    Ok(Space::new(ranges.iter().enumerate().map(axis).collect::<Result<_, _>>()?))
}

/// Search that evaluates one candidate after the other.
#[derive(Debug)]
struct Dialogue<S> {
    search: Option<S>,
    /// Fitness of the first candidates of the generation.
    fitness: Vec<f64>,
    /// Number of evaluated candidates.
    evaluations: u64,
}

impl<S> Default for Dialogue<S> {
    fn default() -> Self {
        Self { search: None, fitness: Vec::new(), evaluations: 0 }
    }
}

impl<S: Search> Dialogue<S> {
    fn begin(&mut self, search: S, evaluate: Event<Candidate>) {
        *self = Self { search: Some(search), fitness: Vec::new(), evaluations: 0 };
        self.propose(evaluate);
    }

    fn propose(&mut self, evaluate: Event<Candidate>) {
        let values = self.search.as_ref().and_then(|search| search.ask().get(self.fitness.len()));
        if let Some(candidate) = values.and_then(|values| Candidate::from_slice(values).ok()) {
            evaluate.emit(candidate);
        }
    }

    fn tell(&mut self, fitness: f64, longest: u64, evaluate: Event<Candidate>, done: Event<Candidate>) {
        let Some(search) = self.search.as_mut().filter(|_| self.evaluations < longest) else { return };
        self.fitness.push(fitness);
        self.evaluations += 1;
        let is_last = self.evaluations == longest;
        if self.fitness.len() == search.ask().len() || is_last {
            search.tell(&self.fitness);
            self.fitness.clear();
        }
        if !is_last {
            self.propose(evaluate);
        } else if let Some(best) = search.best().and_then(|best| Candidate::from_slice(&best.values).ok()) {
            done.emit(best);
        }
    }
}

/// Optimizer by differential evolution (thesis 3.6.4, 9.3.1; see [`DeSearch`]). It minimizes the fitness.
///
/// `begin` starts a search. `evaluate` sends the values of the next candidate, in the order of `ranges`; [`nth`] takes
/// one of them out. The slot `fitness` receives the fitness of this candidate (NaN or infinite: it has failed), and
/// sends the next one. After `evaluations` candidates, `done` sends the best one instead, unless all have failed.
///
/// Fails if a range cannot be searched; then the search does not begin.
#[node]
#[derive(Debug)]
pub struct DifferentialEvolution {
    /// Ranges of the parameters: rows of `[low, high]`, in the units of the parameters.
    #[param]
    ranges: &'static [[f64; 2]],
    /// `true` for each parameter with a logarithmic scale. Missing entries are `false`.
    #[param(default = &[])]
    logarithmic: &'static [bool],
    /// `true` for each parameter that is an integer. Missing entries are `false`.
    #[param(default = &[])]
    integer: &'static [bool],
    /// Number of candidates.
    #[param(default = 1000, range = 1..=1_000_000_000)]
    evaluations: u64,
    /// Seed of the random numbers.
    #[param(default = 1)]
    seed: u64,
    dialogue: Dialogue<DeSearch>,
}

#[node]
impl DifferentialEvolution {
    /// Starts a search with the first candidate.
    #[slot]
    fn begin(&mut self, evaluate: Event<Candidate>) -> Result<(), BadRanges> {
        let space = space(self.ranges, self.logarithmic, self.integer)?;
        self.dialogue.begin(DeSearch::new(space, self.seed), evaluate);
        Ok(())
    }

    /// Takes the fitness of the current candidate.
    #[slot]
    fn fitness(&mut self, value: &f64, evaluate: Event<Candidate>, done: Event<Candidate>) {
        self.dialogue.tell(*value, self.evaluations, evaluate, done);
    }
}

/// Optimizer by CMA-ES with restarts (see [`CmaSearch`]): for parameters that depend on each other. It minimizes the
/// fitness.
///
/// `begin` starts a search. `evaluate` sends the values of the next candidate, in the order of `ranges`; [`nth`] takes
/// one of them out. The slot `fitness` receives the fitness of this candidate (NaN or infinite: it has failed), and
/// sends the next one. After `evaluations` candidates, `done` sends the best one instead, unless all have failed.
///
/// Fails if a range cannot be searched; then the search does not begin.
#[node]
#[derive(Debug)]
pub struct CmaEs {
    /// Ranges of the parameters: rows of `[low, high]`, in the units of the parameters.
    #[param]
    ranges: &'static [[f64; 2]],
    /// `true` for each parameter with a logarithmic scale. Missing entries are `false`.
    #[param(default = &[])]
    logarithmic: &'static [bool],
    /// `true` for each parameter that is an integer. Missing entries are `false`.
    #[param(default = &[])]
    integer: &'static [bool],
    /// Number of candidates.
    #[param(default = 1000, range = 1..=1_000_000_000)]
    evaluations: u64,
    /// Seed of the random numbers.
    #[param(default = 1)]
    seed: u64,
    dialogue: Dialogue<CmaSearch>,
}

#[node]
impl CmaEs {
    /// Starts a search with the first candidate.
    #[slot]
    fn begin(&mut self, evaluate: Event<Candidate>) -> Result<(), BadRanges> {
        let space = space(self.ranges, self.logarithmic, self.integer)?;
        self.dialogue.begin(CmaSearch::new(space, self.seed), evaluate);
        Ok(())
    }

    /// Takes the fitness of the current candidate.
    #[slot]
    fn fitness(&mut self, value: &f64, evaluate: Event<Candidate>, done: Event<Candidate>) {
        self.dialogue.tell(*value, self.evaluations, evaluate, done);
    }
}

/// Value of one parameter of a candidate, in its unit; ⊥ if the candidate has fewer parameters.
#[node]
pub fn nth(candidate: &Candidate, #[param(default = 0)] index: usize) -> Option<f64> {
    candidate.get(index).copied()
}

use crate::{Journal, JournalError, Run, Summary, race::Race};
use apex_nodes::optim::{Axis, Best, CmaSearch, DeSearch, Search, Selection, Space};
use rayon::prelude::*;
use std::sync::Mutex;

/// Costs of the runs of a candidate, by number of the seed.
pub(crate) type Runs = Vec<Option<f64>>;

/// Robot or algorithm whose parameters are optimized.
pub trait Objective: Sync {
    /// Runs once with these values of the parameters, in their units, and returns the cost: 0 or more, less is better.
    /// The same values and the same seed must give the same cost. A run has failed if its cost is negative, NaN or
    /// infinite; a candidate with a failed run has failed.
    fn cost(&self, values: &[f64], seed: u64) -> f64;
}

/// Parameter to be optimized.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name in the report.
    pub name: String,
    /// Unit in the report.
    pub unit: String,
    /// Range and scale.
    pub axis: Axis,
    /// Value with which the search starts and the result is compared.
    pub default: f64,
}

/// Method of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Differential evolution.
    DifferentialEvolution,
    /// CMA-ES with restarts.
    CmaEs,
}

/// Search for the parameters with the best fitness over some seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Parameters to be optimized.
    pub parameters: Vec<Parameter>,
    /// Method of all searches.
    pub method: Method,
    /// Fitness of a candidate from the costs of its runs.
    pub summary: Summary,
    /// Seeds on which every candidate runs: common random numbers.
    pub seeds: Vec<u64>,
    /// Seeds on which only the result is scored.
    pub held_out: Vec<u64>,
    /// Number of independent searches. They can be spread over machines.
    pub searches: u64,
    /// Number of candidates of each search.
    pub candidates: u64,
    /// Seed of the searches.
    pub seed: u64,
    /// Stops candidates that cannot win any more. The result is the same.
    pub racing: bool,
}

/// State of a running study.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Number of the search.
    pub search: u64,
    /// Number of evaluated candidates of this search.
    pub candidates: u64,
    /// Best candidate of this search.
    pub best: Option<Best>,
}

/// Result of one search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Number of the search.
    pub search: u64,
    /// Best candidate, or `None` if all have failed.
    pub best: Option<Best>,
    /// Number of evaluated candidates and best fitness after each improvement.
    pub improvements: Vec<(u64, f64)>,
    /// Number of runs.
    pub runs: u64,
    /// Number of runs that were not necessary.
    pub saved: u64,
}

impl Study {
    /// Description in one line: equal for equal studies.
    pub fn description(&self) -> String {
        format!("{self:?}")
    }

    /// Default values of the parameters.
    pub fn defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default).collect()
    }

    /// Runs the searches of part `part` of `parts` (counted from 0) on the threads of the current pool of rayon. Runs
    /// that are in the journal are not repeated. The result does not depend on the number of threads, and the results
    /// of all parts together are those of part 0 of 1.
    pub fn run(
        &self,
        objective: &dyn Objective,
        journal: &mut Journal,
        (part, parts): (u64, u64),
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Vec<Found>, JournalError> {
        let searches = (0..self.searches).filter(|search| search % parts.max(1) == part);
        searches.map(|search| self.search(search, objective, journal, progress)).collect()
    }

    fn search(
        &self,
        number: u64,
        objective: &dyn Objective,
        journal: &mut Journal,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Found, JournalError> {
        let mut search = self.start(number);
        let mut found = Found { search: number, best: None, improvements: Vec::new(), runs: 0, saved: 0 };
        let mut weights = vec![0.0; self.seeds.len()];
        let mut first = 0;
        while first < self.candidates {
            let mut generation = search.ask().to_vec();
            generation.truncate((self.candidates - first) as usize);
            let order = hardest_first(&weights);
            let selection = if self.racing { search.selection() } else { Selection::All };
            let race = Race { summary: self.summary, selection, order: &order };
            let costs = race.run(generation.len(), |work| {
                let runs: Vec<(Run, &[f64])> = work
                    .iter()
                    .map(|&(c, seed)| {
                        let run = Run { search: number, candidate: first + c as u64, seed: self.seeds[seed] };
                        (run, generation[c].as_slice())
                    })
                    .collect();
                evaluate(objective, journal, &runs)
            })?;
            let fitness: Vec<f64> = costs.iter().map(|runs| self.fitness(runs)).collect();
            search.tell(&fitness);
            first += generation.len() as u64;
            found.count(&costs);
            found.improve(first, search.best());
            add_weights(&mut weights, &costs);
            progress(&Progress { search: number, candidates: first, best: found.best.clone() });
        }
        Ok(found)
    }

    fn start(&self, number: u64) -> Box<dyn Search> {
        let space = Space::new(self.parameters.iter().map(|p| p.axis).collect());
        // An odd multiple: different seeds for different searches.
        let seed = self.seed.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        match self.method {
            Method::DifferentialEvolution => Box::new(DeSearch::starting_at(space, seed, &self.defaults())),
            Method::CmaEs => Box::new(CmaSearch::from_better_half(space, seed, &self.defaults())),
        }
    }

    /// Fitness of a candidate with all runs; infinite if runs were saved.
    fn fitness(&self, runs: &Runs) -> f64 {
        if runs.iter().all(Option::is_some) { self.summary.fitness(runs) } else { f64::INFINITY }
    }

    /// Fitness on these seeds.
    pub(crate) fn score(&self, objective: &dyn Objective, values: &[f64], seeds: &[u64]) -> f64 {
        let cost = |seed: &u64| Some(cost(objective, values, *seed));
        self.summary.fitness(&seeds.par_iter().map(cost).collect::<Vec<_>>())
    }
}

impl Found {
    fn count(&mut self, costs: &[Runs]) {
        for runs in costs {
            let done = runs.iter().flatten().count() as u64;
            self.runs += done;
            self.saved += runs.len() as u64 - done;
        }
    }

    fn improve(&mut self, candidates: u64, best: Option<&Best>) {
        if let Some(best) = best.filter(|best| self.best.as_ref() != Some(best)) {
            self.improvements.push((candidates, best.fitness));
            self.best = Some(best.clone());
        }
    }
}

fn cost(objective: &dyn Objective, values: &[f64], seed: u64) -> f64 {
    let cost = objective.cost(values, seed);
    if cost >= 0.0 { cost } else { f64::INFINITY }
}

/// Costs of these runs, in their order, from the journal or by running.
fn evaluate(
    objective: &dyn Objective,
    journal: &mut Journal,
    runs: &[(Run, &[f64])],
) -> Result<Vec<f64>, JournalError> {
    let known: Vec<Option<f64>> = runs.iter().map(|(run, _)| journal.cost(run)).collect();
    let journal = Mutex::new((journal, Ok(())));
    let costs = runs.par_iter().zip(known).with_max_len(1).map(|((run, values), known)| {
        known.unwrap_or_else(|| {
            let cost = cost(objective, values, run.seed);
            let mut guard = journal.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            let (journal, written) = &mut *guard;
            if written.is_ok() {
                *written = journal.add(*run, cost);
            }
            cost
        })
    });
    let costs = costs.collect();
    let (_, written) = journal.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    written.map(|()| costs)
}

/// Numbers of the seeds, those with the greatest costs so far first: with these, bad candidates are recognized early.
fn hardest_first(weights: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*b].total_cmp(&weights[*a]));
    order
}

/// Adds the costs of the candidates with all runs, each relative to the sum of the candidate's costs.
fn add_weights(weights: &mut [f64], costs: &[Runs]) {
    for runs in costs {
        let sum: Option<f64> = runs.iter().copied().sum();
        if let Some(sum) = sum.filter(|sum| *sum > 0.0 && sum.is_finite()) {
            weights.iter_mut().zip(runs.iter().flatten()).for_each(|(weight, cost)| *weight += cost / sum);
        }
    }
}

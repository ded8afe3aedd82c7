//! One search of a study, generation by generation.

use crate::{
    Found, Method, Point, Run, Study,
    goal::{Fitness, Runs, add_to_front, costs},
    race::Race,
};
use apex_optim::{Best, CmaSearch, DeSearch, Search, Selection, Space};

/// A search with its current generation. The costs of its runs come from outside: from an objective or a journal.
pub(crate) struct Course {
    number: u64,
    fitness: Fitness,
    search: Box<dyn Search + Send>,
    /// Number of the first candidate of the current generation.
    first: u64,
    /// Current generation: the values of the parameters. Empty at the end.
    generation: Vec<Vec<f64>>,
    /// Shares of the candidates that were better on the other seeds, by number of the seed.
    weights: Vec<f64>,
    found: Found,
}

impl Course {
    /// Begins search `number`.
    pub fn new(study: &Study, number: u64, fitness: Fitness) -> Self {
        let space = Space::new(study.parameters.iter().map(|p| p.axis).collect());
        // An odd multiple: different seeds for different searches.
        let seed = study.seed.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let search: Box<dyn Search + Send> = match study.method {
            Method::DifferentialEvolution => Box::new(DeSearch::starting_at(space, seed, &study.defaults())),
            Method::CmaEs => Box::new(CmaSearch::from_better_half(space, seed, &study.defaults())),
        };
        let found = Found { search: number, best: None, improvements: vec![], runs: 0, saved: 0, front: vec![] };
        let weights = vec![0.0; study.seeds.len()];
        let mut course = Self { number, fitness, search, first: 0, generation: vec![], weights, found };
        course.begin_generation(study);
        course
    }

    fn begin_generation(&mut self, study: &Study) {
        self.generation = self.search.ask().to_vec();
        self.generation.truncate((study.candidates - self.first) as usize);
    }

    /// Returns `true` if all candidates are evaluated.
    pub fn is_over(&self) -> bool {
        self.generation.is_empty()
    }

    /// Number of candidates of the generations that have ended.
    pub fn ended(&self) -> u64 {
        self.first
    }

    /// Values of the candidates of the current generation.
    pub fn generation(&self) -> &[Vec<f64>] {
        &self.generation
    }

    /// Fitness of costs by goal.
    pub fn fitness(&self, costs: &[f64]) -> f64 {
        self.fitness.of(costs)
    }

    /// Result so far.
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// Result at the end.
    pub fn into_found(self) -> Found {
        self.found
    }

    /// Runs the candidates of the current generation. `run` returns the costs of runs with these values.
    pub fn race<E>(
        &self,
        study: &Study,
        mut run: impl FnMut(&[(Run, &[f64])]) -> Result<Vec<Vec<f64>>, E>,
    ) -> Result<Vec<Runs>, E> {
        let order = hardest_first(&self.weights);
        let selection = if study.racing { self.search.selection() } else { Selection::All };
        let race = Race { goals: &study.goals, fitness: &self.fitness, selection, order: &order };
        race.run(self.generation.len(), |work| {
            let named = |&(candidate, seed): &(usize, usize)| {
                let number = self.first + candidate as u64;
                let name = Run { search: self.number, candidate: number, seed: study.seeds[seed] };
                (name, self.generation[candidate].as_slice())
            };
            run(&work.iter().map(named).collect::<Vec<_>>())
        })
    }

    /// Ends the current generation with the costs of its runs, by candidate, and begins the next one.
    pub fn end_generation(&mut self, study: &Study, runs: Vec<Runs>) {
        let told: Vec<f64> = runs.iter().map(|runs| self.told(study, runs)).collect();
        self.search.tell(&told);
        self.first += self.generation.len() as u64;
        self.found.count(&runs);
        self.found.improve(self.first, self.search.best());
        add_weights(&mut self.weights, &runs, |run| self.fitness.of(run));
        if study.goals.len() > 1 {
            let complete = |(_, runs): &(Vec<f64>, Runs)| runs.iter().all(Option::is_some);
            for (values, runs) in std::mem::take(&mut self.generation).into_iter().zip(runs).filter(complete) {
                add_to_front(&mut self.found.front, Point { values, costs: costs(&study.goals, &runs) });
            }
        }
        self.begin_generation(study);
    }

    /// Fitness of a candidate with all runs; infinite if runs were saved.
    fn told(&self, study: &Study, runs: &Runs) -> f64 {
        let is_complete = runs.iter().all(Option::is_some);
        if is_complete { self.fitness.of(&costs(&study.goals, runs)) } else { f64::INFINITY }
    }
}

impl Found {
    fn count(&mut self, all: &[Runs]) {
        for runs in all {
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

/// Numbers of the seeds, those with the greatest costs so far first: with these, bad candidates are recognized early.
fn hardest_first(weights: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*b].total_cmp(&weights[*a]));
    order
}

/// Adds to each seed the share of the others on which a candidate with all runs has been better. `fitness` takes the
/// costs of a run.
fn add_weights(weights: &mut [f64], runs: &[Runs], fitness: impl Fn(&[f64]) -> f64) {
    for runs in runs {
        let all: Option<Vec<f64>> = runs.iter().map(|run| run.as_deref().map(&fitness)).collect();
        let Some(all) = all.filter(|all| all.iter().all(|f| f.is_finite())) else { continue };
        for rank in hardest_first(&all).into_iter().rev().enumerate() {
            weights[rank.1] += rank.0 as f64 / all.len() as f64;
        }
    }
}

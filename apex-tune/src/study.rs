use crate::{
    Goal, Journal, JournalError, Point, Run,
    course::Course,
    goal::{Fitness, costs},
};
use apex_optim::{Axis, Best};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::{fmt, sync::Mutex};

/// Robot or algorithm whose parameters are optimized.
pub trait Objective: Sync {
    /// Runs once with these values of the parameters, in their units, and returns the value of each goal. The same
    /// values and the same seed must give the same result. NaN or an infinite cost means that the run has failed; a
    /// candidate with a failed run has failed. An error ends the study.
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String>;
}

/// Objective of a study whose runs are all in journals.
#[derive(Debug, Clone, Copy)]
pub struct Known;

impl Objective for Known {
    fn run(&self, _: &[f64], _: u64) -> Result<Vec<f64>, String> {
        Err("the journals are not complete: a part is missing, or was not finished (`--shard K/N --resume`)".to_owned())
    }
}

/// Error that ends a study.
#[derive(Debug)]
pub enum StudyError {
    /// Error of the journal.
    Journal(JournalError),
    /// Error of the objective.
    Run(String),
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Journal(error) => error.fmt(f),
            Self::Run(error) => f.write_str(error),
        }
    }
}

impl std::error::Error for StudyError {}

/// Parameter to be optimized.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Name in the report.
    pub name: String,
    /// SI unit of its values.
    pub unit: String,
    /// Unit in the report, if it is another one.
    #[serde(default)]
    pub shown_in: Option<Shown>,
    /// Range and scale.
    pub axis: Axis,
    /// Value with which the search starts and the result is compared.
    pub default: f64,
    /// Parameters of the program that have its value, such as `plan.segment.gap`.
    pub targets: Vec<String>,
    /// `true` if the values are of single precision.
    pub single: bool,
}

/// Unit in which people read the values of a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Shown {
    /// Name of the unit: `deg`.
    pub unit: String,
    /// Value of one of it, in the SI unit.
    pub size: f64,
}

impl Parameter {
    /// Name of the unit in the report, and the value of one of it in the SI unit.
    pub fn shown(&self) -> (&str, f64) {
        self.shown_in.as_ref().map_or((&self.unit, 1.0), |shown| (&shown.unit, shown.size))
    }
}

/// Method of the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Method {
    /// Differential evolution.
    DifferentialEvolution,
    /// CMA-ES with restarts.
    CmaEs,
}

/// Search for the parameters with the best fitness over some seeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Name.
    pub name: String,
    /// Number that another objective changes, such as a hash of its source text.
    pub objective: u64,
    /// Parameters to be optimized.
    pub parameters: Vec<Parameter>,
    /// Method of all searches.
    pub method: Method,
    /// Goals of a run; at least one.
    pub goals: Vec<Goal>,
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
    /// Best candidate of this search. Its fitness is the cost of the only goal.
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
    /// Candidates with all runs of which none is better than another one in all goals.
    pub front: Vec<Point>,
}

/// Does `work` on so many threads; 0 stands for one on each core.
///
/// # Errors
/// The threads cannot be started.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| format!("cannot start the threads: {e}"))?.install(work))
}

/// Search number of the runs that score results.
pub(crate) const SCORES: u64 = u64::MAX;

impl Study {
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
    ) -> Result<Vec<Found>, StudyError> {
        let fitness = self.fitness(objective, journal)?;
        let searches = (0..self.searches).filter(|search| search % parts.max(1) == part);
        searches.map(|search| self.search(search, &fitness(search), objective, journal, progress)).collect()
    }

    /// Fitness of each search. With several goals it depends on the costs of the defaults.
    pub(crate) fn fitness(
        &self,
        objective: &dyn Objective,
        journal: &mut Journal,
    ) -> Result<impl Fn(u64) -> Fitness + use<>, StudyError> {
        let defaults = match self.goals.len() {
            0 | 1 => Vec::new(),
            _ => self.score(objective, journal, 0, &self.defaults(), &self.seeds)?,
        };
        Ok(move |search| Fitness::of_search(search, &defaults))
    }

    fn search(
        &self,
        number: u64,
        fitness: &Fitness,
        objective: &dyn Objective,
        journal: &mut Journal,
        progress: &mut dyn FnMut(&Progress),
    ) -> Result<Found, StudyError> {
        let mut course = Course::new(self, number, fitness.clone());
        while !course.is_over() {
            let runs = course.race(self, |runs| self.evaluate(objective, journal, runs))?;
            course.end_generation(self, runs);
            progress(&Progress { search: number, candidates: course.ended(), best: course.found().best.clone() });
        }
        Ok(course.into_found())
    }

    /// Costs on these seeds, by goal. `number` is that of the scored values: the runs are in the journal, too.
    pub(crate) fn score(
        &self,
        objective: &dyn Objective,
        journal: &mut Journal,
        number: u64,
        values: &[f64],
        seeds: &[u64],
    ) -> Result<Vec<f64>, StudyError> {
        let run = |seed: &u64| (Run { search: SCORES, candidate: number, seed: *seed }, values);
        let runs = self.evaluate(objective, journal, &seeds.iter().map(run).collect::<Vec<_>>())?;
        Ok(costs(&self.goals, &runs.into_iter().map(Some).collect()))
    }

    /// Costs of these runs, in their order, from the journal or by running.
    fn evaluate(
        &self,
        objective: &dyn Objective,
        journal: &mut Journal,
        runs: &[(Run, &[f64])],
    ) -> Result<Vec<Vec<f64>>, StudyError> {
        let known: Vec<Option<Vec<f64>>> = runs.iter().map(|(run, _)| journal.values(run).map(Vec::from)).collect();
        let journal = Mutex::new(journal);
        let values = runs.par_iter().zip(known).with_max_len(1).map(|((run, values), known)| match known {
            Some(known) => Ok(known),
            None => {
                let mut values = objective.run(values, run.seed).map_err(StudyError::Run)?;
                let (found, goals) = (values.len(), self.goals.len());
                if found < goals {
                    return Err(StudyError::Run(format!("a run has {found} values, and the study {goals} goals")));
                }
                values.truncate(goals);
                let mut journal = journal.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                journal.add(*run, values.clone()).map_err(StudyError::Journal)?;
                Ok(values)
            }
        });
        let values: Vec<Vec<f64>> = values.collect::<Result<_, _>>()?;
        Ok(values.iter().map(|values| self.costs_of_run(values)).collect())
    }

    /// Costs of a run, by goal. All are infinite if it has failed.
    pub(crate) fn costs_of_run(&self, values: &[f64]) -> Vec<f64> {
        let value = |number: usize| values.get(number).copied().unwrap_or(f64::NAN);
        let costs: Vec<f64> = self.goals.iter().enumerate().map(|(number, goal)| goal.cost(value(number))).collect();
        if costs.contains(&f64::INFINITY) { vec![f64::INFINITY; costs.len()] } else { costs }
    }
}

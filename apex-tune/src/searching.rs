//! A study that is run: its searches, their candidates, and its journal.

use crate::{
    course::Course,
    goal::{Fitness, costs},
    journal::{Journal, JournalError, Run, SCORES},
    study::{Found, Study},
};
use apex_optim::Best;
use rayon::prelude::*;
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

/// Does `work` on so many threads; 0 stands for one on each core.
///
/// # Errors
/// The threads cannot be started.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| format!("cannot start the threads: {e}"))?.install(work))
}

impl Study {
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
}

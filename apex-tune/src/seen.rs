//! A study as its journal tells it: what is not in the journal follows from the searches, which repeat what they did.

use crate::{
    Found, Journal, Known, Report, Run, Study,
    course::Course,
    goal::{Fitness, Runs, costs},
    journal::SCORES,
    sample::Sample,
};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of parameters, goals, seeds with those held out, and searches of a study that is shown.
const LIMITS: [(&str, usize); 4] = [("parameters", 100), ("goals", 16), ("seeds", 10_000), ("searches", 1000)];

/// State of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// It may get more runs.
    Running,
    /// It has run with all seeds.
    Complete,
    /// It could not win any more, so that it was not run with the remaining seeds.
    Stopped,
    /// A run has failed.
    Failed,
}

/// Candidate of a search.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Costs by goal; lower bounds if runs are missing.
    pub costs: Vec<f64>,
    /// Fitness of the costs.
    pub fitness: f64,
    /// Number of its runs.
    pub runs: usize,
    /// State.
    pub fate: Fate,
}

/// One search as far as its runs are known.
pub struct Trail {
    course: Course,
    candidates: Vec<Candidate>,
    best: Option<usize>,
}

/// A study as far as its runs are known.
pub struct Seen {
    study: Study,
    journal: Journal,
    trails: BTreeMap<u64, Trail>,
    /// Searches with runs that have not been looked at yet, among them [`SCORES`].
    fresh: BTreeSet<u64>,
    /// Number of runs of the searches, and of those that have failed.
    counts: (u64, u64),
    /// Costs of runs, by goal.
    samples: Vec<Sample>,
    /// Result of a complete study; `None` in it if all candidates have failed.
    result: Option<Option<Report>>,
}

impl Seen {
    /// A study without runs.
    ///
    /// # Errors
    /// The study is too large.
    pub fn new(study: Study) -> Result<Self, String> {
        let seeds = study.seeds.len() + study.held_out.len();
        let searches = usize::try_from(study.searches).unwrap_or(usize::MAX);
        let counts = [study.parameters.len(), study.goals.len(), seeds, searches];
        if let Some((count, (name, limit))) = counts.into_iter().zip(LIMITS).find(|(count, (_, limit))| count > limit) {
            return Err(format!("it has {count} {name}, and at most {limit} are shown"));
        }
        let samples = vec![Sample::default(); study.goals.len()];
        let (journal, trails, fresh) = (Journal::in_memory(), BTreeMap::new(), BTreeSet::new());
        Ok(Self { study, journal, trails, fresh, counts: (0, 0), samples, result: None })
    }

    /// Adds a run of the journal.
    pub(crate) fn add(&mut self, run: Run, values: Vec<f64>) {
        let costs = self.study.costs_of_run(&values);
        if self.journal.insert(run, values) && run.search < self.study.searches {
            self.counts.0 += 1;
            self.counts.1 += u64::from(costs.contains(&f64::INFINITY));
            self.samples.iter_mut().zip(costs).for_each(|(sample, cost)| sample.add(cost));
        }
        if run.search < self.study.searches || run.search == SCORES {
            self.fresh.insert(run.search);
        }
    }

    /// Lets the searches go on as far as their runs are known.
    pub(crate) fn advance(&mut self) {
        if self.fresh.is_empty() {
            return;
        }
        // With several goals, the fitness depends on the costs of the defaults.
        let Ok(fitness) = self.study.fitness(&Known, &mut self.journal) else { return };
        for number in std::mem::take(&mut self.fresh).into_iter().filter(|number| *number != SCORES) {
            let begin = || Trail::new(&self.study, number, fitness(number));
            self.trails.entry(number).or_insert_with(begin).advance(&self.study, &self.journal);
        }
        let is_over = self.trails.values().all(|trail| trail.course.is_over());
        if self.trails.len() as u64 == self.study.searches && is_over && self.result.is_none() {
            let found = self.trails.values().map(|trail| trail.found().clone()).collect();
            self.result = Report::new(&self.study, found, &Known, &mut self.journal).ok();
        }
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Searches with runs, by number.
    pub fn trails(&self) -> impl Iterator<Item = (u64, &Trail)> {
        self.trails.iter().map(|(number, trail)| (*number, trail))
    }

    /// Search with this number, if it has runs.
    pub fn trail(&self, number: u64) -> Option<&Trail> {
        self.trails.get(&number)
    }

    /// Number of runs of the searches.
    pub fn runs(&self) -> u64 {
        self.counts.0
    }

    /// Number of runs of the searches that have failed.
    pub fn failed_runs(&self) -> u64 {
        self.counts.1
    }

    /// Costs by goal of a candidate on each seed of the study. A run that is missing was not necessary, or is still to
    /// come.
    pub fn costs(&self, search: u64, candidate: u64) -> impl Iterator<Item = Option<Vec<f64>>> {
        let of = move |seed: &u64| self.journal.values(&Run { search, candidate, seed: *seed });
        self.study.seeds.iter().map(of).map(move |values| values.map(|values| self.study.costs_of_run(values)))
    }

    /// Usual range of the costs of a goal: those that 5 % and 95 % of the runs do not exceed.
    pub fn range(&self, goal: usize) -> Option<(f64, f64)> {
        self.samples.get(goal)?.range()
    }

    /// Search and number of the best candidate: as in the report, with several goals that of the first search.
    pub fn best(&self) -> Option<(u64, usize)> {
        let several = self.study.goals.len() > 1;
        let all = self.trails.iter().filter(|(number, _)| !several || **number == 0);
        let best = all.filter_map(|(number, trail)| Some((*number, trail.best?, trail.candidates.get(trail.best?)?)));
        best.min_by(|a, b| a.2.fitness.total_cmp(&b.2.fitness)).map(|(search, candidate, _)| (search, candidate))
    }

    /// Costs of the defaults on the seeds of the study, by goal, once all their runs have ended.
    pub fn defaults(&self) -> Option<Vec<f64>> {
        let value = |seed: &u64| self.journal.values(&Run { search: SCORES, candidate: 0, seed: *seed });
        let runs: Option<Runs> =
            self.study.seeds.iter().map(|seed| value(seed).map(|v| Some(self.study.costs_of_run(v)))).collect();
        let scored = runs.map(|runs| costs(&self.study.goals, &runs));
        // The first candidate of differential evolution has the values of the defaults.
        scored.or_else(|| {
            let mut first = self.trails.values().filter_map(|trail| trail.candidates.first());
            let is_default = |candidate: &&Candidate| candidate.values == self.study.defaults();
            first.find(|c| c.fate == Fate::Complete && is_default(c)).map(|candidate| candidate.costs.clone())
        })
    }

    /// Returns `true` if the study is complete.
    pub fn is_finished(&self) -> bool {
        self.result.is_some()
    }

    /// Result of a complete study, unless all candidates have failed.
    pub fn report(&self) -> Option<&Report> {
        self.result.as_ref()?.as_ref()
    }
}

impl Trail {
    fn new(study: &Study, number: u64, fitness: Fitness) -> Self {
        Self { course: Course::new(study, number, fitness), candidates: vec![], best: None }
    }

    fn advance(&mut self, study: &Study, journal: &Journal) {
        self.candidates.truncate(self.ended());
        let costs_of = |run: &Run| journal.values(run).map(|values| study.costs_of_run(values));
        let known = |runs: &[(Run, &[f64])]| runs.iter().map(|(run, _)| costs_of(run).ok_or(())).collect();
        while !self.course.is_over() {
            let Ok(all) = self.course.race(study, known) else { break };
            for (values, runs) in self.course.generation().iter().zip(&all) {
                let candidate = self.candidate(study, values, runs, true);
                let is_better = |best: usize| candidate.fitness < self.candidates[best].fitness;
                if candidate.fate == Fate::Complete && self.best.is_none_or(is_better) {
                    self.best = Some(self.candidates.len());
                }
                self.candidates.push(candidate);
            }
            self.course.end_generation(study, all);
        }
        for (number, values) in self.course.generation().iter().enumerate() {
            let candidate = self.ended() as u64 + number as u64;
            let run = |seed: &u64| costs_of(&Run { search: self.course.found().search, candidate, seed: *seed });
            let runs = study.seeds.iter().map(run).collect();
            let candidate = self.candidate(study, values, &runs, false);
            self.candidates.push(candidate);
        }
    }

    fn candidate(&self, study: &Study, values: &[f64], runs: &Runs, has_ended: bool) -> Candidate {
        let costs = costs(&study.goals, runs);
        let count = runs.iter().flatten().count();
        let fate = match (costs.contains(&f64::INFINITY), count == runs.len()) {
            (true, _) => Fate::Failed,
            (false, true) => Fate::Complete,
            (false, false) if has_ended => Fate::Stopped,
            (false, false) => Fate::Running,
        };
        Candidate { values: values.to_vec(), fitness: self.course.fitness(&costs), costs, runs: count, fate }
    }

    /// Candidates by number, up to those of the current generation.
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// Number of candidates that get no more runs, because their generation has ended.
    pub fn ended(&self) -> usize {
        self.course.ended() as usize
    }

    /// Number of the best candidate of the generations that have ended.
    pub fn best(&self) -> Option<usize> {
        self.best
    }

    /// Result so far.
    pub fn found(&self) -> &Found {
        self.course.found()
    }
}

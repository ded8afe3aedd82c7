//! A page of a study: what it asks for, and what it is told. All messages are JSON.

use super::{Followed, Reading};
use apex_tune::{Candidate, Fate, Report, Scale, Seen, Study, Trail};
use serde::{Deserialize, Serialize};
use std::{
    ops::Range,
    sync::Arc,
    time::{Duration, Instant},
};

/// Maximum number of lanes in an answer.
const MAX_LANES: usize = 200;
/// Maximum number of columns of a lane.
const MAX_COLUMNS: usize = 4096;
/// Maximum number of points of a line in the diagram.
const MAX_POINTS: usize = 500;
/// Interval at which the state is sent if nothing changes.
const INTERVAL: Duration = Duration::from_secs(1);

/// A message to the page.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Told {
    /// Names of all studies, which of them is shown, and names of the robots beside them.
    Studies { names: Vec<String>, shown: usize, robots: Vec<String> },
    /// A study. Everything about an earlier one is obsolete.
    Study(AboutStudy),
    /// Error of the journal, or none.
    Errors(Option<String>),
    /// Course of the study.
    State(State),
    /// Lanes of candidates.
    Lanes { search: u64, first: usize, count: usize, goal: usize, lanes: Vec<Lane> },
    /// A candidate, and its values as a file for `--params`.
    Candidate { search: u64, lane: Lane, params: String },
    /// Result of the study.
    Result(Outcome),
}

/// A message of the page.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Asked {
    /// Shows another study, by its number.
    Study(usize),
    /// Asks for lanes of a search from number `first` on, by number or the best ones first, with at most so many
    /// columns for the seeds.
    Lanes { search: u64, first: usize, count: usize, columns: usize, goal: usize, best: bool },
    /// Asks for a candidate.
    Candidate { search: u64, number: usize },
}

/// Everything about a study that does not change.
#[derive(Serialize)]
pub struct AboutStudy {
    name: String,
    journal: String,
    parameters: Vec<Parameter>,
    goals: Vec<Goal>,
    seeds: Vec<u64>,
    searches: u64,
    candidates: u64,
}

#[derive(Serialize)]
struct Parameter {
    name: String,
    unit: String,
    low: f64,
    high: f64,
    /// `true` for a logarithmic scale.
    wide: bool,
    default: f64,
}

#[derive(Serialize)]
struct Goal {
    name: String,
    unit: String,
    maximise: bool,
    /// The value of a candidate from those of its runs, in words.
    summary: String,
}

/// Course of a study.
#[derive(Serialize)]
pub struct State {
    finished: bool,
    /// Time in s since the journal has grown, and until the end.
    age: Option<f64>,
    left: Option<f64>,
    /// Number of lines that have been read: with more of them, lanes are obsolete.
    lines: usize,
    /// Number of runs, of those that were not necessary, and of those that have failed.
    runs: u64,
    saved: u64,
    failed: u64,
    searches: Vec<SearchState>,
    /// Search and number of the best candidate.
    best: Option<(u64, usize)>,
    /// Values of the defaults by goal, if they are known.
    defaults: Option<Vec<f64>>,
    /// Usual range of the values of runs by goal, from good to bad.
    ranges: Vec<Option<(f64, f64)>>,
}

#[derive(Serialize)]
struct SearchState {
    number: u64,
    /// Number of candidates that get no more runs, and of all that are known.
    ended: usize,
    known: usize,
    best: Option<usize>,
    /// Number of candidates and best value after each improvement. With several goals the value is the change from the
    /// defaults in the goal that has improved least.
    improvements: Vec<(u64, f64)>,
}

/// Candidate with its runs.
#[derive(Serialize)]
pub struct Lane {
    number: usize,
    fate: &'static str,
    values: Vec<f64>,
    /// Values by goal; bounds if runs are missing.
    goals: Vec<f64>,
    runs: usize,
    cells: Vec<Cell>,
}

/// Run of a lane, or several ones that share a column: the worst of them.
#[derive(Serialize, Debug, Clone, Copy, PartialEq)]
#[serde(untagged)]
enum Cell {
    /// Value of the goal.
    Value(f32),
    /// `false` for a run that has failed.
    Failed(bool),
    /// A run that was not necessary, or is still to come.
    Missing(()),
}

/// Result of a study.
#[derive(Serialize)]
pub struct Outcome {
    /// Values by goal of the defaults and of the result, on the seeds of the study and on those held out.
    goals: Vec<[f64; 4]>,
    /// Fitness lost with the default of each parameter.
    lost: Vec<f64>,
    cost: String,
    warning: Option<String>,
    /// `false` if the result is not better than the defaults.
    better: bool,
}

/// A page that shows a study.
pub struct Page {
    study: Arc<Followed>,
    /// Number of the journal, lines, error and end as the page knows them.
    told: Option<(u64, usize, Option<String>, bool)>,
    at: Instant,
}

impl Page {
    pub fn new(study: Arc<Followed>) -> Self {
        study.begin();
        Self { study, told: None, at: Instant::now() }
    }

    /// Changes since the last time, and the state at least once per second.
    pub fn news(&mut self) -> Vec<Told> {
        let reading = self.study.reading();
        if !reading.has_begun() {
            return vec![];
        }
        let (lines, journal) = reading.follower.state();
        let is_finished = reading.follower.seen().is_some_and(Seen::is_finished);
        let now = (journal, lines, reading.error.clone(), is_finished);
        let (before, is_due) = (self.told.as_ref(), self.at.elapsed() >= INTERVAL);
        if before == Some(&now) && !is_due {
            return vec![];
        }
        let is_other = before.is_none_or(|before| before.0 != journal || before.1 == 0 && lines > 0);
        let ends = is_finished && (is_other || before.is_some_and(|before| !before.3));
        let mut told = vec![];
        if before.is_none_or(|before| before.2 != reading.error) {
            told.push(Told::Errors(reading.error.clone()));
        }
        if let Some(seen) = reading.follower.seen() {
            told.extend(is_other.then(|| Told::Study(about(seen.study(), self.study.journal.display().to_string()))));
            told.push(Told::State(state(&reading, seen, lines)));
            told.extend(seen.report().filter(|_| ends).map(|report| Told::Result(outcome(seen.study(), report))));
        }
        drop(reading);
        (self.told, self.at) = (Some(now), Instant::now());
        told
    }

    /// Answer to a question.
    pub fn answer(&self, asked: &Asked) -> Option<Told> {
        let reading = self.study.reading();
        let seen = reading.follower.seen()?;
        match *asked {
            Asked::Study(_) => None,
            Asked::Lanes { search, first, count, columns, goal, best } => {
                let trail = seen.trail(search)?;
                let order = order(trail, best);
                let shown = order.iter().skip(first).take(count.min(MAX_LANES));
                let lanes = shown.filter_map(|number| lane(seen, search, *number, columns, goal)).collect();
                Some(Told::Lanes { search, first, count: order.len(), goal, lanes })
            }
            Asked::Candidate { search, number } => {
                let lane = lane(seen, search, number, 0, 0)?;
                let params = seen.study().params(&lane.values);
                Some(Told::Candidate { search, lane, params })
            }
        }
    }
}

fn about(study: &Study, journal: String) -> AboutStudy {
    let parameters = study.parameters.iter().map(|parameter| Parameter {
        name: parameter.name.clone(),
        unit: parameter.unit.clone(),
        low: parameter.axis.low(),
        high: parameter.axis.high(),
        wide: parameter.axis.scale() == Scale::Logarithmic,
        default: parameter.default,
    });
    let goals = study.goals.iter().map(|goal| Goal {
        name: goal.name.clone(),
        unit: goal.unit.clone(),
        maximise: goal.maximise,
        summary: goal.summary.to_string(),
    });
    AboutStudy {
        name: study.name.clone(),
        journal,
        parameters: parameters.collect(),
        goals: goals.collect(),
        seeds: study.seeds.clone(),
        searches: study.searches,
        candidates: study.candidates,
    }
}

fn state(reading: &Reading, seen: &Seen, lines: usize) -> State {
    let study = seen.study();
    let value = |goal: usize, cost: f64| study.goals[goal].value(cost);
    let range = |goal: usize| seen.range(goal).map(|(good, bad)| (value(goal, good), value(goal, bad)));
    State {
        finished: seen.is_finished(),
        age: reading.changed.and_then(|time| time.elapsed().ok()).map(|age| age.as_secs_f64()),
        left: reading.left(seen).filter(|_| !seen.is_finished()),
        lines,
        runs: seen.runs(),
        saved: seen.trails().map(|(_, trail)| trail.found().saved).sum(),
        failed: seen.failed_runs(),
        searches: seen.trails().map(|(number, trail)| search_state(study, number, trail)).collect(),
        best: seen.best(),
        defaults: seen.defaults().map(|costs| values(study, &costs)),
        ranges: (0..study.goals.len()).map(range).collect(),
    }
}

fn search_state(study: &Study, number: u64, trail: &Trail) -> SearchState {
    let all = &trail.found().improvements;
    let step = all.len().div_ceil(MAX_POINTS).max(1);
    let kept = all.iter().enumerate().filter(|(at, _)| at % step == 0 || at + 1 == all.len());
    let value = |fitness: f64| if let [goal] = study.goals.as_slice() { goal.value(fitness) } else { fitness };
    SearchState {
        number,
        ended: trail.ended(),
        known: trail.candidates().len(),
        best: trail.best(),
        improvements: kept.map(|(_, (count, fitness))| (*count, value(*fitness))).collect(),
    }
}

/// Values of costs by goal.
fn values(study: &Study, costs: &[f64]) -> Vec<f64> {
    study.goals.iter().zip(costs).map(|(goal, cost)| goal.value(*cost)).collect()
}

fn outcome(study: &Study, report: &Report) -> Outcome {
    let (defaults, tuned) = (&report.defaults, &report.tuned);
    let scores = [&defaults.training, &tuned.training, &defaults.held_out, &tuned.held_out];
    let goals = (0..study.goals.len()).map(|goal| scores.map(|costs| study.goals[goal].value(costs[goal])));
    Outcome {
        goals: goals.collect(),
        lost: report.importance.clone(),
        cost: report.cost(),
        warning: report.warning(),
        better: report.is_better(),
    }
}

/// Numbers of the candidates in their order: by number, or the best ones first.
fn order(trail: &Trail, best: bool) -> Vec<usize> {
    let candidates = trail.candidates();
    let mut order: Vec<usize> = (0..candidates.len()).collect();
    if best {
        let rank = |candidate: &Candidate| match candidate.fate {
            Fate::Complete => 0,
            Fate::Running => 1,
            Fate::Stopped => 2,
            Fate::Failed => 3,
        };
        let compare = |a: &Candidate, b: &Candidate| rank(a).cmp(&rank(b)).then(a.fitness.total_cmp(&b.fitness));
        order.sort_by(|a, b| compare(&candidates[*a], &candidates[*b]));
    }
    order
}

fn lane(seen: &Seen, search: u64, number: usize, columns: usize, goal: usize) -> Option<Lane> {
    let candidate = seen.trail(search)?.candidates().get(number)?;
    let goals = &seen.study().goals;
    let cost = |costs: Vec<f64>| costs.get(goal).copied();
    let costs: Vec<Option<f64>> = seen.costs(search, number as u64).map(|costs| costs.and_then(cost)).collect();
    let value = |cost: f64| goals.get(goal).map_or(cost, |goal| goal.value(cost));
    Some(Lane {
        number,
        fate: match candidate.fate {
            Fate::Running => "running",
            Fate::Complete => "complete",
            Fate::Stopped => "stopped",
            Fate::Failed => "failed",
        },
        values: candidate.values.clone(),
        goals: values(seen.study(), &candidate.costs),
        runs: candidate.runs,
        cells: cells(&costs, columns.min(MAX_COLUMNS)).map(|range| cell(&costs[range], value)).collect(),
    })
}

/// Numbers of the runs in each column.
fn cells(costs: &[Option<f64>], columns: usize) -> impl Iterator<Item = Range<usize>> {
    let (count, columns) = (costs.len(), columns.min(costs.len()));
    (0..columns).map(move |column| column * count / columns..(column + 1) * count / columns)
}

/// The worst of some runs.
fn cell(costs: &[Option<f64>], value: impl Fn(f64) -> f64) -> Cell {
    match costs.iter().flatten().copied().reduce(f64::max) {
        None => Cell::Missing(()),
        Some(f64::INFINITY) => Cell::Failed(false),
        Some(worst) => Cell::Value((value(worst) as f32).clamp(f32::MIN, f32::MAX)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_show_the_worst_of_their_runs() {
        let costs = [Some(1.0), Some(2.0), None, None, Some(f64::INFINITY), Some(1.0), Some(1e300)];
        let shown = |columns| cells(&costs, columns).map(|range| cell(&costs[range], |cost| -cost)).collect::<Vec<_>>();
        let (value, failed, missing) = (Cell::Value, Cell::Failed(false), Cell::Missing(()));
        assert_eq!(shown(9), [value(-1.0), value(-2.0), missing, missing, failed, value(-1.0), value(f32::MIN)]);
        assert_eq!(shown(2), [value(-2.0), failed]);
        assert_eq!(shown(0), []);
        let text = serde_json::to_string(&shown(9)[1..5]).unwrap();
        assert_eq!(text, "[-2.0,null,null,false]");
    }
}

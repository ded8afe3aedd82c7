use crate::summary::Summary;
use serde::{Deserialize, Serialize};

/// Value that a run shall make small or great.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Name in the report.
    pub name: String,
    /// Unit in the report.
    pub unit: String,
    /// `true` if greater is better.
    pub maximise: bool,
    /// Value of a candidate from the values of its runs; the costs of a goal to be maximised are the negative values.
    pub summary: Summary,
    /// Least cost that a run can have; negative infinity if there is none. A run with less has failed.
    #[serde(with = "crate::bound")]
    pub least: f64,
}

impl Goal {
    /// Cost of a value: less is better. Infinite if the run has failed.
    pub(crate) fn cost(&self, value: f64) -> f64 {
        let cost = if self.maximise { -value } else { value };
        if cost.is_nan() || cost < self.least { f64::INFINITY } else { cost }
    }

    /// Value of a cost.
    pub fn value(&self, cost: f64) -> f64 {
        if self.maximise { -cost } else { cost }
    }
}

/// Costs of the runs of a candidate by number of the seed, each with the cost of each goal. Missing runs were saved.
pub(crate) type Runs = Vec<Option<Vec<f64>>>;

/// Costs of a candidate, by goal. They are lower bounds if runs are missing.
pub(crate) fn costs(goals: &[Goal], runs: &Runs) -> Vec<f64> {
    let of = |(number, goal): (usize, &Goal)| {
        goal.summary.of(runs.iter().map(|run| run.as_ref().map(|costs| costs[number])), goal.least)
    };
    goals.iter().enumerate().map(of).collect()
}

/// Fitness of candidates by the costs of their goals: the only cost itself, or else the greatest of the weighted
/// changes from the defaults, relative to these (Tchebycheff). It never becomes smaller if a cost becomes greater.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fitness {
    /// Cost of the defaults and weight, by goal; empty for one goal.
    terms: Vec<(f64, f64)>,
}

/// Weight of a goal that does not matter: small, so that among equal candidates the better one wins.
const LEAST_WEIGHT: f64 = 0.01;

impl Fitness {
    /// Fitness of search `number`, where the defaults have these costs. The first search has equal weights, the next
    /// ones have one goal each, and all others have weights that fill the possible ones evenly.
    pub fn of_search(number: u64, defaults: &[f64]) -> Self {
        let count = defaults.len();
        if count < 2 {
            return Self { terms: Vec::new() };
        }
        let weight = |goal: usize| match number {
            0 => 1.0,
            only if only <= count as u64 => {
                if goal as u64 + 1 == only {
                    1.0
                } else {
                    LEAST_WEIGHT
                }
            }
            // Multiples of irrational numbers (a Kronecker sequence).
            other => (((other - count as u64) as f64) * f64::sqrt(2.0 + 3.0 * goal as f64)).fract().max(LEAST_WEIGHT),
        };
        let reference = |cost: f64| if cost.is_finite() { cost } else { 0.0 };
        Self { terms: defaults.iter().enumerate().map(|(goal, cost)| (reference(*cost), weight(goal))).collect() }
    }

    pub fn of(&self, costs: &[f64]) -> f64 {
        let Some(only) = costs.first().filter(|_| self.terms.is_empty()) else {
            let change = |(cost, (reference, weight)): (&f64, &(f64, f64))| {
                let scale = if *reference == 0.0 { 1.0 } else { reference.abs() };
                weight * ((cost - reference) / scale)
            };
            return costs.iter().zip(&self.terms).map(change).fold(f64::NEG_INFINITY, f64::max);
        };
        *only
    }
}

/// Candidate with its values and costs.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Values of the parameters.
    pub values: Vec<f64>,
    /// Costs, by goal.
    pub costs: Vec<f64>,
}

/// Adds a point to a front, unless another one is at least as good in all goals; removes those that are no better.
pub(crate) fn add_to_front(front: &mut Vec<Point>, point: Point) {
    let covers = |a: &Point, b: &Point| a.costs.iter().zip(&b.costs).all(|(a, b)| a <= b);
    if point.costs.iter().all(|cost| cost.is_finite()) && !front.iter().any(|other| covers(other, &point)) {
        front.retain(|other| !covers(&point, other));
        front.push(point);
    }
}

//! Studies: parameters, goals, and how they are searched.

use crate::goal::{Goal, Point};
use apex_optim::{Axis, Best};
use serde::{Deserialize, Serialize};

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

impl Study {
    /// Default values of the parameters.
    pub fn defaults(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.default).collect()
    }

    /// Costs of a run, by goal. All are infinite if it has failed.
    pub(crate) fn costs_of_run(&self, values: &[f64]) -> Vec<f64> {
        let value = |number: usize| values.get(number).copied().unwrap_or(f64::NAN);
        let costs: Vec<f64> = self.goals.iter().enumerate().map(|(number, goal)| goal.cost(value(number))).collect();
        if costs.contains(&f64::INFINITY) { vec![f64::INFINITY; costs.len()] } else { costs }
    }
}

use crate::experiments::run::Outcome;
use apex_sim::experiment::{Failure, spread};
use std::{fmt, time::Duration};

/// Score of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Seed of the hall.
    pub seed: u64,
    /// Number of cubes delivered to the right station.
    pub points: usize,
    /// Number of cubes delivered to a wrong station.
    pub wrong: usize,
    /// Number of collisions that the robot caused.
    pub caused: usize,
    /// Number of collisions that others caused.
    pub suffered: usize,
    /// Distance that the robot drove, in m.
    pub distance: f32,
    /// Failures in the robot.
    pub failures: Vec<Failure>,
    /// Computing time of the run.
    pub took: Duration,
}

/// Summary of many runs.
#[derive(Debug)]
pub struct Summary<'a>(pub &'a [Score]);

impl Score {
    /// Names of the columns.
    pub const HEAD: &'static str = "  seed  points   wrong  caused  suffered  distance      took  failures";

    /// Creates the score of a run with this computing time.
    pub fn of(outcome: &Outcome, took: Duration) -> Self {
        let report = &outcome.run_report.report;
        Self {
            seed: outcome.run_report.seed,
            points: report.points(),
            wrong: report.penalties(),
            caused: report.caused(),
            suffered: report.suffered(),
            distance: report.distance,
            failures: outcome.failures.clone(),
            took,
        }
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, points, wrong, caused, suffered, distance, failures, took } = self;
        write!(f, "{seed:>6}{points:>8}{wrong:>8}{caused:>8}{suffered:>10}{distance:>8.0} m")?;
        write!(f, "{:>8.1} s{:>10}", took.as_secs_f32(), failures.len())?;
        failures.iter().try_for_each(|failure| write!(f, "\n        {failure}"))
    }
}

impl Summary<'_> {
    /// Minimum, median and maximum of the points.
    pub fn points(&self) -> [usize; 3] {
        spread(self.0.iter().map(|score| score.points))
    }

    /// Mean of the points.
    pub fn mean(&self) -> f32 {
        self.sum(|score| score.points) as f32 / self.0.len().max(1) as f32
    }

    /// Sum of a value over all runs.
    pub fn sum(&self, value: impl Fn(&Score) -> usize) -> usize {
        self.0.iter().map(value).sum()
    }
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [least, median, most] = self.points();
        writeln!(f, "{:<20}{median} (median), {least} to {most}, {:.1} on average", "points", self.mean())?;
        writeln!(f, "{:<20}{}", "wrong deliveries", self.sum(|score| score.wrong))?;
        writeln!(f, "{:<20}{}", "collisions caused", self.sum(|score| score.caused))?;
        writeln!(f, "{:<20}{}", "collisions suffered", self.sum(|score| score.suffered))?;
        write!(f, "{:<20}{}", "failures", self.sum(|score| score.failures.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_counts_all_runs() {
        let score = |points, wrong| Score {
            seed: 1,
            points,
            wrong,
            caused: 1,
            suffered: 0,
            distance: 1.0,
            failures: vec![],
            took: Duration::ZERO,
        };
        let scores = [score(9, 0), score(3, 1), score(14, 0), score(10, 1)];
        assert_eq!(Summary(&scores).points(), [3, 9, 14]);
        let text = Summary(&scores).to_string();
        assert!(text.contains("9 (median), 3 to 14, 9.0 on average"), "{text}");
        assert!(text.contains("wrong deliveries    2\ncollisions caused   4\n"), "{text}");
        assert_eq!(Summary(&[]).points(), [0; 3]);
    }
}

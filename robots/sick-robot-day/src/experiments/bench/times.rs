use crate::{
    experiments::{
        measure::percentile,
        run::{Parts, StepView, Watch},
    },
    world::contest::START,
};
use apex_rt::{Info, Time};
use std::{
    fmt,
    time::{Duration, Instant},
};

/// Length of the intervals at the beginning and the end of a run that are compared.
const MINUTE: Duration = Duration::from_secs(60);

/// Minimum share of the time of a listed part.
const LEAST_SHARE: f64 = 0.0005;

/// Computing time of a run, by part of the robot.
#[derive(Debug)]
pub struct Times {
    info: &'static Info,
    parts: Parts,
    /// Statistics by part.
    rows: Vec<Row>,
    end: Time,
    /// Calls in progress: the innermost one is last.
    running: Vec<Running>,
    /// Time by part in this reaction, or `None` if no node of the part was called.
    spent: Vec<Option<Duration>>,
}

#[derive(Debug)]
struct Running {
    node: usize,
    since: Instant,
    /// Time of the calls made by this one.
    inner: Duration,
}

/// Statistics of a part.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    name: String,
    /// Time in each reaction in which the part was called, in ms.
    calls: Vec<f32>,
    first: Mean,
    last: Mean,
}

/// Mean time, in ms.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Times {
    /// Creates the statistics of a robot in a run that ends at `end`.
    pub fn new(info: &'static Info, end: Time) -> Self {
        let parts = Parts::new(info);
        let rows: Vec<Row> = parts.names().iter().map(|name| Row::new(name)).collect();
        let spent = vec![None; rows.len()];
        Self { info, parts, rows, end, running: vec![], spent }
    }

    /// Adds the measurements of another run of the same robot.
    pub fn add(&mut self, other: &Self) {
        for (row, other) in self.rows.iter_mut().zip(&other.rows) {
            row.calls.extend(&other.calls);
            row.first.add(other.first);
            row.last.add(other.last);
        }
    }

    fn begin(&mut self, node: usize) {
        self.running.push(Running { node, since: Instant::now(), inner: Duration::ZERO });
    }
}

impl Watch for Times {
    fn fired(&mut self, node: usize) {
        self.begin(node);
    }

    fn handled(&mut self, connection: usize) {
        self.begin(self.info.connections[connection].to);
    }

    fn finished(&mut self, _node: usize) {
        let Some(Running { node, since, inner }) = self.running.pop() else { return };
        let took = since.elapsed();
        *self.spent[self.parts.of(node)].get_or_insert_default() += took.saturating_sub(inner);
        if let Some(outer) = self.running.last_mut() {
            outer.inner += took;
        }
    }

    fn reacted(&mut self, moment: &StepView<'_>) {
        for (row, spent) in self.rows.iter_mut().zip(&mut self.spent) {
            let Some(took) = spent.take() else { continue };
            let in_first = moment.now < START + MINUTE;
            let in_last = moment.now + MINUTE >= self.end;
            row.count(took, in_first, in_last);
        }
    }
}

impl Row {
    fn new(name: &str) -> Self {
        Self { name: name.to_owned(), calls: vec![], first: Mean::default(), last: Mean::default() }
    }

    fn count(&mut self, took: Duration, in_first: bool, in_last: bool) {
        let ms = 1e3 * took.as_secs_f64();
        self.calls.push(ms as f32);
        for (mean, counts) in [(&mut self.first, in_first), (&mut self.last, in_last)] {
            if counts {
                mean.add(Mean { sum: ms, count: 1 });
            }
        }
    }

    fn sum(&self) -> f64 {
        self.calls.iter().map(|ms| f64::from(*ms)).sum()
    }
}

impl Mean {
    fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }
}

impl fmt::Display for Mean {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.count {
            0 => f.pad("–"),
            count => f.pad(&format!("{:.3}", self.sum / f64::from(count))),
        }
    }
}

impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let total: f64 = self.rows.iter().map(Row::sum).sum();
        let mut rows: Vec<(&Row, f64)> = self.rows.iter().map(|row| (row, row.sum() / total)).collect();
        rows.retain(|(_, share)| *share >= LEAST_SHARE);
        rows.sort_by(|a, b| b.1.total_cmp(&a.1));
        write!(f, "{:<38}{:>9}{:>9}{:>9}{:>9}", "ms in a reaction", "calls", "mean", "median", "99 %")?;
        write!(f, "{:>8}{:>14}{:>13}", "share", "first minute", "last minute")?;
        for (row, share) in rows {
            let mean = Mean { sum: row.sum(), count: row.calls.len() as u32 };
            write!(f, "\n{:<38}{:>9}{mean:>9}", row.name, row.calls.len())?;
            for part in [0.5, 0.99] {
                write!(f, "{:>9.3}", percentile(&row.calls, part).unwrap_or_default())?;
            }
            write!(f, "{:>6.1} %{:>14}{:>13}", 100.0 * share, row.first, row.last)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minutes_at_the_beginning_and_at_the_end_have_means_of_their_own() {
        let mut row = Row::new("see / find_sign");
        for (ms, in_first, in_last) in [(1, true, false), (3, true, false), (8, false, false), (5, false, true)] {
            row.count(Duration::from_millis(ms), in_first, in_last);
        }
        assert_eq!(
            [row.first, row.last, Mean::default()].map(|mean| format!("{mean:>6}")),
            [" 2.000", " 5.000", "     –"]
        );
        assert_eq!(percentile(&row.calls, 0.5), Some(5.0));
    }
}

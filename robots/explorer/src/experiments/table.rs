use super::Run;
use std::{fmt, time::Duration};

/// Names of the columns of [`Row`].
pub const HEAD: &str = "  seed  explored  objects  wrong  greatest error    driven  contacts  charged  least charge  home again  from station      time      took";

/// Line of the table of runs.
#[derive(Debug)]
pub struct Row<'a>(pub &'a Run);

impl fmt::Display for Row<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Run { options, report, explored, finds, lasted, took, failures, .. } = self.0;
        write!(f, "{:>6}{:>8.1} %{:>4} of {}", options.seed, 100.0 * explored, finds.found, finds.objects)?;
        write!(f, "{:>7}", finds.wrong())?;
        match finds.greatest_error() {
            Some(error) => write!(f, "{error:>14.2} m")?,
            None => write!(f, "{:>16}", "-")?,
        }
        write!(f, "{:>8.0} m", report.driven)?;
        write!(f, "{:>10}{:>9}{:>12.0} %", report.contacts.len(), report.charges.len(), 100.0 * report.least_charge)?;
        match report.finished {
            Some((at, distance)) => write!(f, "{:>10.0} s{distance:>12.2} m", at.as_secs_f64())?,
            None => write!(f, "{:>12}{:>14}", "no", "-")?,
        }
        write!(f, "{:>8.0} s{:>8.1} s", lasted.as_secs_f32(), took.as_secs_f32())?;
        failures.iter().try_for_each(|failure| write!(f, "\n        {failure}"))
    }
}

/// Sums over runs.
pub fn summary(runs: &[Run]) -> String {
    let sum = |value: fn(&Run) -> usize| runs.iter().map(value).sum::<usize>();
    let greatest = runs.iter().filter_map(|run| run.finds.greatest_error()).fold(0.0, f32::max);
    let least = runs.iter().map(|run| run.explored).fold(1.0, f32::min);
    let [real, took] = [|run: &Run| run.lasted, |run: &Run| run.took].map(|of| runs.iter().map(of).sum::<Duration>());
    format!(
        "home again                        {} of {}\n\
         least share explored              {:.1} %\n\
         objects found                     {} of {}\n\
         wrong objects                     {}\n\
         greatest error of a place         {greatest:.2} m\n\
         contacts                          {}\n\
         charged                           {}\n\
         batteries that got empty          {}\n\
         failures of nodes                 {}\n\
         simulated time / computing time   {:.1}\n",
        runs.iter().filter(|run| run.report.finished.is_some()).count(),
        runs.len(),
        100.0 * least,
        sum(|run| run.finds.found),
        sum(|run| run.finds.objects),
        sum(|run| run.finds.wrong()),
        sum(|run| run.report.contacts.len()),
        sum(|run| run.report.charges.len()),
        runs.iter().filter(|run| run.report.least_charge <= 0.0).count(),
        sum(|run| run.failures.len()),
        real.as_secs_f32() / took.as_secs_f32().max(1e-3),
    )
}

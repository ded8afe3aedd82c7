use super::Run;
use crate::world::Ending;
use std::fmt;

/// Names of the columns of [`Row`].
pub const HEAD: &str = "  seed       ran    driven  lost  longest  contacts  people  tips  falls  distance kept (median, 95 %, max)    slow  \
     fastest     time      took  ending";

/// Line of the table of runs.
#[derive(Debug)]
pub struct Row<'a>(pub &'a Run);

impl fmt::Display for Row<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Run { options, report, lasted, took, failures, .. } = self.0;
        let people = report.contacts.iter().filter(|contact| contact.is_person).count();
        let is = |ending| usize::from(report.ending == Some(ending));
        write!(f, "{:>6}{:>8.0} m{:>8.0} m", options.seed, report.ran, report.driven)?;
        write!(f, "{:>6}{:>7.1} s", report.times_lost(), report.longest_loss())?;
        write!(f, "{:>10}{people:>8}{:>6}{:>7}", report.contacts.len(), is(Ending::Tipped), is(Ending::Fell))?;
        let [median, most, max] = [0.5, 0.95, 1.0].map(|quantile| report.distance(quantile));
        write!(f, "{median:>22.1} m{most:>7.1} m{max:>7.1} m{:>6.1} %", 100.0 * self.0.share_slow())?;
        write!(f, "{:>6.2} m/s{:>7.0} s{:>8.1} s", report.fastest, lasted.as_secs_f32(), took.as_secs_f32())?;
        write!(f, "  {}", report.ending.map_or("none", Ending::name))?;
        failures.iter().try_for_each(|failure| write!(f, "\n        {failure}"))
    }
}

/// Sums over runs, beside the goals.
pub fn summary(runs: &[Run]) -> String {
    let sum = |value: fn(&Run) -> usize| runs.iter().map(value).sum::<usize>();
    let ended = |ending| runs.iter().filter(|run| run.report.ending == Some(ending)).count();
    let longest = runs.iter().map(|run| run.report.longest_loss()).fold(0.0, f32::max);
    let within = runs.iter().filter(|run| run.report.longest_loss() <= 5.0).count();
    let [real, took] =
        [|run: &Run| run.lasted, |run: &Run| run.took].map(|of| runs.iter().map(of).sum::<std::time::Duration>());
    format!(
        "runs that ended with the runner   {} of {}\n\
         never lost for longer than 5 s    {within} of {} (longest {longest:.1} s)\n\
         contacts                          {} ({} with people)\n\
         tips, falls                       {}, {}\n\
         failures of nodes                 {}\n\
         simulated time / computing time   {:.1}\n",
        ended(Ending::Arrived),
        runs.len(),
        runs.len(),
        sum(|run| run.report.contacts.len()),
        sum(|run| run.report.contacts.iter().filter(|contact| contact.is_person).count()),
        ended(Ending::Tipped),
        ended(Ending::Fell),
        sum(|run| run.failures.len()),
        real.as_secs_f32() / took.as_secs_f32().max(1e-3),
    )
}

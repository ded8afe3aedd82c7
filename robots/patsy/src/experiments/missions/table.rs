use super::{Losses, Run};
use crate::world::clinic::{Conditions, Fault, FaultKind, words};
use apex_rt::Time;
use apex_sim::{Random, experiment::spread};
use std::{cmp::Reverse, fmt, time::Duration};

/// Distance that a vehicle drives after the end of a fault that it has survived, in m.
const GOES_ON: f32 = 5.0;

/// One line of the table of runs.
#[derive(Debug)]
pub struct Row<'a>(pub &'a Run);

/// Fault of a kind at a random time of the seed, in the first two thirds of a run of this duration.
pub fn fault_at(kind: FaultKind, seed: u64, duration: Duration) -> Fault {
    let number = FaultKind::ALL.iter().position(|other| *other == kind).unwrap_or_default() as u64;
    let mut random = Random::new(seed.wrapping_mul(31).wrapping_add(number));
    let from = Time::ZERO + duration.mul_f32(random.uniform(0.1, 0.65));
    Fault { kind, from, until: from + kind.duration() }
}

impl Row<'_> {
    /// Names of the columns.
    pub const HEAD: &'static str = "  seed  delivered  misplaced  given back  contacts  falls  run over  bumps  empty lifts  wedges  distance\
         \u{20}  persons  hazards    field  planning    blind      took  failures";
}

impl fmt::Display for Row<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Run { options, report, failures, took, losses, .. } = self.0;
        let (delivered, misplaced) = (report.delivered(), report.deliveries.len() - report.delivered());
        write!(f, "{:>6}{delivered:>11}{misplaced:>11}{:>12}", options.seed, report.refused)?;
        write!(f, "{:>10}{:>7}{:>10}", report.contacts.len(), report.falls.len(), report.run_over.len())?;
        write!(f, "{:>7}{:>13}{:>8}", report.bumps.len(), report.empty_lifts.len(), report.wedges.len())?;
        write!(f, "{:>8.0} m", report.distance)?;
        let Losses { persons, hazards, field, planning, blind } = losses;
        write!(f, "{persons:>7.0} s{hazards:>7.0} s{field:>7.0} s{planning:>8.0} s{blind:>7.0} s")?;
        write!(f, "{:>8.1} s{:>10}", took.as_secs_f32(), failures.len())?;
        for fault in &options.faults {
            write!(f, "  {}, {} delivered afterwards", words(fault), delivered_after(self.0, fault.until))?;
        }
        failures.iter().try_for_each(|failure| write!(f, "\n        {failure}"))
    }
}

/// Table of runs, with a line for each.
pub fn table(runs: &[Run]) -> String {
    runs.iter().fold(format!("{}\n", Row::HEAD), |text, run| text + &format!("{}\n", Row(run)))
}

/// Summary of runs.
pub fn summary(runs: &[Run]) -> String {
    let [least, median, most] = delivered(runs);
    let sum = |value: fn(&Run) -> usize| runs.iter().map(value).sum::<usize>();
    let lost =
        |value: fn(&Losses) -> f32| runs.iter().map(|run| value(&run.losses)).sum::<f32>() / runs.len().max(1) as f32;
    format!(
        "containers delivered     {median} (median), {least} to {most}, {:.1} on average\n\
         contacts with people     {}\n\
         falls                    {}\n\
         small things run over    {}\n\
         bumps against the rest   {}\n\
         empty lifts              {}\n\
         wedges                   {}\n\
         orders given back        {}\n\
         failures                 {}\n\
         seconds lost in a run to persons {:.0}, hazards {:.0}, the field of the scans {:.0}, planning {:.0}, an unknown \
         pose {:.0}\n",
        mean(runs),
        sum(|run| run.report.contacts.len()),
        sum(|run| run.report.falls.len()),
        sum(|run| run.report.run_over.len()),
        sum(|run| run.report.bumps.len()),
        sum(|run| run.report.empty_lifts.len()),
        sum(|run| run.report.wedges.len()),
        sum(|run| run.report.refused),
        sum(|run| run.failures.len()),
        lost(|losses| losses.persons),
        lost(|losses| losses.hazards),
        lost(|losses| losses.field),
        lost(|losses| losses.planning),
        lost(|losses| losses.blind),
    )
}

/// Table of the nodes that were active for the longest time, with their shares of the time of all runs.
pub fn activity_table(runs: &[Run]) -> String {
    let mut times: Vec<(&str, Duration)> = vec![];
    for (name, time) in runs.iter().flat_map(|run| &run.activity) {
        match times.iter_mut().find(|(other, _)| other == name) {
            Some((_, sum)) => *sum += *time,
            None => times.push((name, *time)),
        }
    }
    times.sort_by_key(|(_, time)| Reverse(*time));
    let whole: Duration = times.iter().map(|(_, time)| *time).sum();
    let share = |time: Duration| 100.0 * time.as_secs_f32() / whole.as_secs_f32().max(1e-3);
    let rows =
        times.iter().map(|(name, time)| format!("{name:<40}{:>8.0} s{:>6.1} %\n", time.as_secs_f32(), share(*time)));
    rows.collect()
}

/// Table of runs with faults: a line for each kind, after one for the runs without. The last column is the share of the
/// runs in which a container is delivered after the fault.
pub fn faults_table(without: &[Run], with: &[Run]) -> String {
    let mut text = format!(
        "{:<18}{:>9}{:>7}{:>6}{:>7}{:>10}{:>7}{:>10}{:>10}{:>10}\n",
        "fault", "median", "least", "most", "mean", "contacts", "falls", "run over", "survived", "delivers"
    );
    let mut line = |name: &str, runs: &[&Run]| {
        let own: Vec<Run> = runs.iter().map(|run| (*run).clone()).collect();
        let [least, median, most] = delivered(&own);
        let sum = |value: fn(&Run) -> usize| own.iter().map(value).sum::<usize>();
        let of_all = |holds: fn(&Run) -> bool| {
            let count = own.iter().filter(|run| holds(run)).count();
            format!("{count}/{}", own.len())
        };
        text += &format!(
            "{name:<18}{median:>9}{least:>7}{most:>6}{:>7.1}{:>10}{:>7}{:>10}{:>10}{:>10}\n",
            mean(&own),
            sum(|run| run.report.contacts.len()),
            sum(|run| run.report.falls.len()),
            sum(|run| run.report.run_over.len()),
            of_all(survives),
            of_all(|run| delivered_after(run, end_of_faults(run)) > 0)
        );
    };
    line("none", &without.iter().collect::<Vec<_>>());
    for kind in FaultKind::MEASURED {
        let of: Vec<&Run> = with.iter().filter(|run| run.options.faults.iter().any(|f| f.kind == kind)).collect();
        line(kind.name(), &of);
    }
    text
}

/// Conditions whose runs tell the prices of the values of a world, with their names: each of its values alone that is
/// not kind, and all of them.
pub fn prices(world: &Conditions) -> Vec<(&'static str, Conditions)> {
    let alone = Conditions::VALUES.iter().map(|value| (value.name, Conditions::KIND.with(value, *world)));
    alone.filter(|(_, conditions)| *conditions != Conditions::KIND).chain([("all", *world)]).collect()
}

/// Table of runs in the kind world and under each of the `prices`: a line for each.
pub fn prices_table(prices: &[(&str, Conditions)], runs: &[Run]) -> String {
    let mut text = format!(
        "{:<20}{:>9}{:>8}{:>7}{:>6}{:>7}{:>11}{:>12}{:>10}{:>7}{:>10}{:>7}{:>8}\n",
        "value",
        "delivered",
        "median",
        "least",
        "most",
        "mean",
        "misplaced",
        "given back",
        "contacts",
        "falls",
        "run over",
        "bumps",
        "wedges"
    );
    for (name, conditions) in [("none", Conditions::KIND)].iter().chain(prices) {
        let own: Vec<Run> = runs.iter().filter(|run| run.options.conditions == *conditions).cloned().collect();
        let [least, median, most] = delivered(&own);
        let sum = |value: fn(&Run) -> usize| own.iter().map(value).sum::<usize>();
        text += &format!(
            "{name:<20}{:>9}{median:>8}{least:>7}{most:>6}{:>7.1}{:>11}{:>12}{:>10}{:>7}{:>10}{:>7}{:>8}\n",
            sum(|run| run.report.delivered()),
            mean(&own),
            sum(|run| run.report.deliveries.len() - run.report.delivered()),
            sum(|run| run.report.refused),
            sum(|run| run.report.contacts.len()),
            sum(|run| run.report.falls.len()),
            sum(|run| run.report.run_over.len()),
            sum(|run| run.report.bumps.len()),
            sum(|run| run.report.wedges.len()),
        );
    }
    text
}

/// Returns `true` if nothing failed, the vehicle did not fall, and it drove on after the last fault.
fn survives(run: &Run) -> bool {
    let after = end_of_faults(run);
    let poses: Vec<_> = run.report.trajectory.iter().filter(|(at, _)| *at >= after).map(|(_, pose)| pose).collect();
    let driven: f32 = poses.windows(2).map(|pair| (pair[1].position() - pair[0].position()).norm()).sum();
    run.failures.is_empty() && run.report.falls.is_empty() && driven >= GOES_ON
}

/// Time from which on nothing is broken.
fn end_of_faults(run: &Run) -> Time {
    run.options.faults.iter().map(|fault| fault.until).max().unwrap_or(Time::ZERO)
}

/// Number of containers that were brought to their destination after a time.
fn delivered_after(run: &Run, after: Time) -> usize {
    run.report.deliveries.iter().filter(|delivery| delivery.at > after && delivery.is_right()).count()
}

/// Minimum, median and maximum of the delivered containers.
fn delivered(runs: &[Run]) -> [usize; 3] {
    spread(runs.iter().map(|run| run.report.delivered()))
}

fn mean(runs: &[Run]) -> f64 {
    runs.iter().map(|run| run.report.delivered()).sum::<usize>() as f64 / runs.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_that_is_not_kind_has_a_price() {
        let all: Vec<_> = prices(&Conditions::HARDER).into_iter().map(|(name, _)| name).collect();
        let values = Conditions::VALUES.map(|value| value.name);
        assert_eq!(all, values.into_iter().chain(["all"]).collect::<Vec<_>>());
        let slip = Conditions { slip: 0.3, ..Conditions::KIND };
        assert_eq!(prices(&slip), [("slip", slip), ("all", slip)]);
    }

    #[test]
    fn faults_are_at_times_of_the_seed_within_the_run() {
        let duration = Duration::from_secs(600);
        for kind in FaultKind::MEASURED {
            let faults: Vec<Fault> = (1..20).map(|seed| fault_at(kind, seed, duration)).collect();
            assert!(faults.iter().all(|fault| fault.from >= Time::from_secs(60) && fault.until < Time::from_secs(460)));
            assert!(faults.windows(2).any(|pair| pair[0].from != pair[1].from));
            assert_eq!(faults[0], fault_at(kind, 1, duration));
        }
    }
}

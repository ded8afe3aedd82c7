use super::{Score, Summary};
use crate::world::contest::{Fault, FaultKind, START};
use apex_rt::Time;
use apex_sim::Random;
use std::{fmt, time::Duration};

/// Cost of a kind of fault, compared with the same halls without a fault.
#[derive(Debug)]
pub struct Toll<'a> {
    /// Kind of the fault, or `None` in the reference runs.
    pub kind: Option<FaultKind>,
    /// Runs with the fault.
    pub scores: &'a [Score],
    /// Runs without faults.
    pub without: &'a [Score],
}

/// A fault of a kind at a random time of the seed, in a run that ends at `end`. The scanner freezes for 3 s; all other
/// faults last 10 s.
pub fn fault_at(kind: FaultKind, seed: u64, end: Time) -> Fault {
    let length = Duration::from_secs(if kind == FaultKind::LaserFrozen { 3 } else { 10 });
    let number = FaultKind::ALL.iter().position(|other| *other == kind).unwrap_or_default() as u64;
    let mut random = Random::new(seed.wrapping_mul(31).wrapping_add(number));
    // The fault begins after the start, early enough to show its effects in the rest of the run if possible.
    let room = end.since(START).as_secs_f32();
    // In tenths of a second, as on the command line.
    let tenths = (10.0 * random.uniform(0.1, 0.8) * room) as u64;
    let from = START + Duration::from_millis(100 * tenths);
    Fault { kind, from, until: from + length }
}

impl Toll<'_> {
    /// Names of the columns.
    pub const HEAD: &'static str = "fault               median  least   most   mean  change  wrong  caused  failures";
}

impl fmt::Display for Toll<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let summary = Summary(self.scores);
        let mean = summary.mean();
        let [least, median, most] = summary.points();
        write!(f, "{:<20}{median:>6}{least:>7}{most:>7}{mean:>7.1}", self.kind.map_or("none", FaultKind::name))?;
        write!(f, "{:>+8.1}", mean - Summary(self.without).mean())?;
        let [wrong, caused] = [summary.sum(|score| score.wrong), summary.sum(|score| score.caused)];
        write!(f, "{wrong:>7}{caused:>8}{:>10}", summary.sum(|score| score.failures.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_at_times_of_the_seed_within_the_run() {
        let end = Time::from_secs(120);
        for kind in FaultKind::ALL {
            let faults: Vec<Fault> = (1..20).map(|seed| fault_at(kind, seed, end)).collect();
            assert!(faults.iter().all(|fault| fault.from > START && fault.until < end + Duration::from_secs(1)));
            assert!(faults.windows(2).any(|pair| pair[0].from != pair[1].from));
            assert_eq!(faults[0], fault_at(kind, 1, end));
        }
    }
}

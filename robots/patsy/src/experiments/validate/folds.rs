use super::knobs::{Choice, KNOBS};
use crate::{
    Finder,
    experiments::report::{RECORDED_SCANNER, read_labels},
};
use apex_nodes::{io::ScanLogReader, scan::Scan};
use apex_sim::in_order;
use std::{collections::BTreeMap, fmt::Write as _, num::NonZero, path::Path, sync::Mutex};

/// Weight of a false detection beside that of a missed pallet.
const COST: f64 = 4.0;

/// Recorded scans with and without a pallet, in the order of time.
pub struct Data {
    scans: Vec<(Scan, Option<[f64; 4]>, u64)>,
    with: usize,
}

/// Outcome of the detection in one scan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Found,
    Nothing,
    Wrong,
}

/// Counts of the scans of a fold: with a pallet, found, wrong; without a pallet, wrong.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    with: usize,
    found: usize,
    wrong: usize,
    without: usize,
    invented: usize,
}

impl Data {
    /// Reads the scans of both files, and the boxes of the pallets.
    ///
    /// # Errors
    /// If a file cannot be read.
    pub fn read(with: &Path, labels: &Path, without: &Path) -> Result<Self, String> {
        let labels = read_labels(labels).map_err(|e| e.to_string())?;
        let mut scans = Vec::new();
        let mut number = 0;
        for (path, is_labelled) in [(with, true), (without, false)] {
            let mut reader = ScanLogReader::open(path, RECORDED_SCANNER).map_err(|e| e.to_string())?;
            let mut scan = Scan::default();
            while let Some(entry) = reader.read(&mut scan).map_err(|e| e.to_string())? {
                let label = is_labelled.then(|| labels.get(&entry.id).copied()).flatten();
                if is_labelled && label.is_none() {
                    return Err(format!("scan {} of {} has no label", entry.id, path.display()));
                }
                scans.push((scan.clone(), label, entry.id));
            }
            if is_labelled {
                number = scans.len();
            }
        }
        if number == 0 || number == scans.len() {
            return Err("`--with` and `--without` need scans, and one of them has none".to_owned());
        }
        Ok(Self { scans, with: number })
    }

    /// Fold of each scan: both files are cut into `folds` blocks of consecutive scans.
    fn fold(&self, scan: usize, folds: usize) -> usize {
        let (index, length) =
            if scan < self.with { (scan, self.with) } else { (scan - self.with, self.scans.len() - self.with) };
        index * folds / length
    }

    fn outcomes(&self, choice: Choice) -> Vec<Outcome> {
        let mut finder = Finder::new(&choice.search());
        let mut outcome = |(scan, label, _): &(Scan, Option<[f64; 4]>, u64)| {
            // A scan in too many parts shows nothing.
            let Some(found) = finder.find(scan).ok().flatten() else { return Outcome::Nothing };
            let (x, y) = (f64::from(found.pose.x), f64::from(found.pose.y));
            let is_inside = label.is_some_and(|b| (b[0]..=b[2]).contains(&x) && (b[1]..=b[3]).contains(&y));
            if is_inside { Outcome::Found } else { Outcome::Wrong }
        };
        self.scans.iter().map(&mut outcome).collect()
    }

    fn count(&self, outcomes: &[Outcome], is_counted: impl Fn(usize) -> bool) -> Counts {
        let mut counts = Counts::default();
        for (scan, outcome) in outcomes.iter().enumerate().filter(|(scan, _)| is_counted(*scan)) {
            let is_wrong = usize::from(*outcome == Outcome::Wrong);
            if scan < self.with {
                counts.with += 1;
                counts.found += usize::from(*outcome == Outcome::Found);
                counts.wrong += is_wrong;
            } else {
                counts.without += 1;
                counts.invented += is_wrong;
            }
        }
        counts
    }
}

impl Counts {
    fn plus(self, other: Self) -> Self {
        Self {
            with: self.with + other.with,
            found: self.found + other.found,
            wrong: self.wrong + other.wrong,
            without: self.without + other.without,
            invented: self.invented + other.invented,
        }
    }

    fn score(&self) -> f64 {
        self.found as f64 - COST * (self.wrong + self.invented) as f64
    }
}

/// Known outcomes of choices, so that each choice is tried once for all folds.
type Memory = Mutex<BTreeMap<Choice, Vec<Outcome>>>;

/// Chooses the limits on all blocks of time but one and counts the detections in that one, for each of `folds` blocks;
/// then chooses them on all blocks. Returns the table.
pub fn validate(data: &Data, folds: usize, jobs: Option<NonZero<usize>>) -> Result<String, String> {
    let memory = Memory::default();
    let work: Vec<Option<usize>> = (0..folds).map(Some).chain([None]).collect();
    let chosen =
        in_order(&work, jobs, |fold| choose(data, &memory, folds, *fold), |_| {}).map_err(|e| e.to_string())?;
    let mut text = format!(
        "{:<6}{:>10}{:>8}{:>8}{:>12}{:>8}  chosen on the other blocks\n",
        "block", "pallets", "found", "wrong", "no pallet", "wrong"
    );
    let (mut sum, mut missed) = (Counts::default(), String::new());
    for (fold, (choice, outcomes)) in chosen.iter().take(folds).enumerate() {
        let counts = data.count(outcomes, |scan| data.fold(scan, folds) == fold);
        sum = sum.plus(counts);
        line(&mut text, &(fold + 1).to_string(), &counts, &choice.to_string());
        for (scan, outcome) in outcomes.iter().enumerate().filter(|(scan, _)| data.fold(*scan, folds) == fold) {
            let id = data.scans[scan].2;
            match outcome {
                Outcome::Nothing if scan < data.with => missed += &format!(" {id}"),
                Outcome::Wrong => missed += &format!(" {id}!"),
                _ => {}
            }
        }
    }
    line(&mut text, "all", &sum, "each block with the limits chosen on the others");
    if let Some((choice, outcomes)) = chosen.last() {
        line(&mut text, "open", &data.count(outcomes, |_| true), &format!("chosen on all blocks: {choice}"));
    }
    let _ = writeln!(text, "missed (! wrong):{missed}");
    Ok(text)
}

fn line(text: &mut String, name: &str, c: &Counts, note: &str) {
    let percent = 100.0 * c.found as f64 / c.with.max(1) as f64;
    let found = format!("{percent:.1} %");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{name:<6}{:>10}{found:>8}{:>8}{:>12}{:>8}  {note}", c.with, c.wrong, c.without, c.invented);
}

/// Best choice on all blocks but `fold`: one knob after the other, until no change is better.
fn choose(data: &Data, memory: &Memory, folds: usize, fold: Option<usize>) -> (Choice, Vec<Outcome>) {
    let outcomes = |choice: Choice| {
        let known = memory.lock().ok().and_then(|memory| memory.get(&choice).cloned());
        known.unwrap_or_else(|| {
            let outcomes = data.outcomes(choice);
            if let Ok(mut memory) = memory.lock() {
                memory.insert(choice, outcomes.clone());
            }
            outcomes
        })
    };
    let score = |choice| data.count(&outcomes(choice), |scan| Some(data.fold(scan, folds)) != fold).score();
    let mut best = Choice::middle();
    let mut best_score = score(best);
    loop {
        let before = best_score;
        for knob in 0..KNOBS.len() {
            for other in best.others(knob) {
                let other_score = score(other);
                if other_score > best_score {
                    (best, best_score) = (other, other_score);
                }
            }
        }
        if best_score <= before {
            return (best, outcomes(best));
        }
    }
}

//! Random source files with their Rust code. What the compiler accepts, rustc accepts, too, and its tests end. If the
//! compiler rejects a source file, its first error is in it.
//!
//! `APEX_TEXTS` is the number of cases (100), `APEX_TEXTS_SEED` the first seed. With `APEX_TEXTS_RAW`, failing cases
//! are shown without reduction. `APEX_TEXTS_OUT` is a folder for all failing cases.

mod cargo;
mod check;
mod forms;
mod interpreted;
mod judge;

use apex_tests::texts::{Case, Kind, Shape, generate};
use check::{Checked, Checker};
use judge::{Failure, judge, judge_run};
use rayon::prelude::*;
use std::{collections::BTreeMap, env, fs, path::PathBuf};

/// Number of cases that are compiled together.
const BATCH: usize = 40;
/// Maximum number of failures that are reduced and shown.
const SHOWN: usize = 5;
/// Maximum number of reduction steps; each compiles many cases.
const ROUNDS: usize = 12;

fn number(name: &str) -> Option<u64> {
    env::var(name).ok().and_then(|text| text.parse().ok())
}

/// Results of many cases.
#[derive(Default)]
struct Found {
    accepted: usize,
    left_to_rustc: usize,
    run: usize,
    refused: BTreeMap<String, usize>,
    by_kind: BTreeMap<Kind, (usize, usize)>,
    failures: Vec<(Case, Failure)>,
}

impl Found {
    /// Checks cases, and compiles those that are accepted.
    fn look_at(&mut self, checker: &Checker, seeds: impl Iterator<Item = u64>) {
        let cases: Vec<Case> = seeds.map(generate).collect();
        let mut accepted = vec![];
        for (slot, (case, checked)) in cases.iter().zip(checker.check_all(&cases)).enumerate() {
            for kind in &case.kinds {
                let counts = self.by_kind.entry(*kind).or_default();
                counts.0 += 1;
                counts.1 += usize::from(matches!(checked, Checked::Accepted(_)));
            }
            match checked {
                Checked::Accepted(names) => accepted.push((slot, case, names)),
                Checked::Refused(code) => *self.refused.entry(code).or_default() += 1,
                Checked::Failed(failure) => self.failures.push((case.clone(), failure)),
            }
        }
        self.accepted += accepted.len();
        let judged = judge(&accepted.iter().map(|(slot, case, names)| (*slot, *case, &**names)).collect::<Vec<_>>());
        let mut runs = vec![];
        for ((slot, case, _), failure) in accepted.iter().zip(judged) {
            match failure {
                Some(Failure::Named(_)) => self.left_to_rustc += 1,
                Some(failure) => self.failures.push(((*case).clone(), failure)),
                None if can_run(case) => runs.push((*slot, *case)),
                None => {}
            }
        }
        self.run += runs.len();
        let judged: Vec<Option<Failure>> = runs.par_iter().map(|(slot, case)| judge_run(*slot, case)).collect();
        let failures = runs.iter().zip(judged).filter_map(|((_, case), failure)| Some(((*case).clone(), failure?)));
        self.failures.extend(failures);
    }

    /// Failures by class.
    fn classes(&self) -> BTreeMap<String, Vec<&(Case, Failure)>> {
        let mut classes: BTreeMap<String, Vec<&(Case, Failure)>> = BTreeMap::new();
        for failure in &self.failures {
            classes.entry(failure.1.class()).or_default().push(failure);
        }
        classes
    }
}

/// Returns `true` if a case has tests, and nodes that end.
fn can_run(case: &Case) -> bool {
    let has_tests = case.texts.iter().flat_map(|text| &text.items).any(|item| item.head.starts_with("test "));
    has_tests && case.shape == Shape::Library && case.library.iter().all(|item| !item.contains("loop {}"))
}

/// Reduces a case while it fails in the same way.
fn smallest(checker: &Checker, case: &Case, failure: &Failure) -> (Case, Failure) {
    let (mut case, mut failure) = (case.clone(), failure.clone());
    for _ in 0..ROUNDS {
        let mut smaller = case.smaller();
        smaller.sort_by_key(Case::size);
        let mut found = None;
        for batch in smaller.chunks(BATCH) {
            let mut same = vec![];
            let mut accepted = vec![];
            for (slot, (case, checked)) in batch.iter().zip(checker.check_all(batch)).enumerate() {
                match checked {
                    Checked::Accepted(names) => accepted.push((slot, case, names)),
                    Checked::Failed(other) => same.push((case, other)),
                    Checked::Refused(_) => {}
                }
            }
            let judged =
                judge(&accepted.iter().map(|(slot, case, names)| (*slot, *case, &**names)).collect::<Vec<_>>());
            same.extend(accepted.iter().zip(judged).filter_map(|((_, case, _), f)| Some((*case, f?))));
            same.retain(|(_, f)| f.class() == failure.class());
            found = same.into_iter().min_by_key(|(case, _)| case.size());
            if found.is_some() {
                break;
            }
        }
        match found {
            Some((smaller, why)) => (case, failure) = (smaller.clone(), why),
            None => break,
        }
    }
    (case, failure)
}

fn keep(case: &Case, failure: &Failure) {
    let Some(folder) = env::var_os("APEX_TEXTS_OUT").map(PathBuf::from) else { return };
    let path = folder.join(format!("{}.txt", case.seed));
    let text = format!("{}\n\n{}\n\n{}", failure.class(), failure, case.shown());
    fs::create_dir_all(&folder)
        .and_then(|()| fs::write(&path, text))
        .expect("the folder of the failures can be written");
}

/// Seeds of cases that were accepted but did not compile in the past, which are always tested.
const KNOWN: [u64; 14] =
    [100311, 100338, 101415, 103895, 104126, 104223, 106993, 107031, 109446, 110275, 110982, 119244, 201560, 204655];

#[test]
fn what_is_accepted_compiles() {
    let count = number("APEX_TEXTS").unwrap_or(100);
    let first = number("APEX_TEXTS_SEED").unwrap_or(1);
    println!("{count} texts, APEX_TEXTS_SEED={first}");
    let checker = Checker::new(BATCH);
    let mut found = Found::default();
    found.look_at(&checker, KNOWN.iter().copied().filter(|_| count > 1));
    found.failures.iter().for_each(|(case, failure)| keep(case, failure));
    let mut seed = first;
    while seed < first + count {
        let end = (seed + BATCH as u64).min(first + count);
        let before = found.failures.len();
        found.look_at(&checker, seed..end);
        found.failures[before..].iter().for_each(|(case, failure)| keep(case, failure));
        seed = end;
        if (seed - first) % 1000 < BATCH as u64 {
            println!("{}: {} accepted, {} wrong", seed - first, found.accepted, found.failures.len());
        }
    }
    println!(
        "{} accepted, {} of them left to rustc, the tests of {} run, {} wrong",
        found.accepted,
        found.left_to_rustc,
        found.run,
        found.failures.len()
    );
    println!("refused: {:?}", found.refused);
    println!("texts and accepted ones by feature: {:?}", found.by_kind);
    let classes = found.classes();
    for (class, failures) in &classes {
        let seeds: Vec<u64> = failures.iter().map(|(case, _)| case.seed).take(12).collect();
        println!("{:4} {class} {seeds:?}", failures.len());
    }
    let shown = number("APEX_TEXTS_SHOWN").map_or(SHOWN, |n| n as usize);
    for failures in classes.values().take(shown) {
        let Some((case, failure)) = failures.iter().min_by_key(|(case, _)| case.size()) else { continue };
        let raw = env::var_os("APEX_TEXTS_RAW").is_some();
        let (case, failure) = if raw { (case.clone(), failure.clone()) } else { smallest(&checker, case, failure) };
        println!("\n=== {}\n{failure}\n{}", failure.class(), case.shown());
    }
    // With wrong Rust code beside it, a source file is neither correct nor wrong.
    let (own, failures): (Vec<_>, Vec<_>) = found.failures.iter().partition(|(_, f)| matches!(f, Failure::Rust(_)));
    assert!(failures.is_empty(), "{} of {count} texts fail", failures.len());
    assert!(own.len() <= 1 + found.accepted / 50, "the generator writes wrong Rust in {} texts", own.len());
}

//! Random graphs, compiled and run, compared with their nets.
//!
//! `APEX_ORACLE_GRAPHS` is the number of graphs (40), `APEX_ORACLE_SEED` the first seed. With `APEX_ORACLE_RAW`,
//! failing graphs are shown without reduction.

use crate::{
    compile::{How, Program, run},
    number,
};
use apex_dsl::graph::NodeId;
use apex_tests::oracle::{
    Case, Checked, Checker, Failure, Record, generate, interpret, on_threads, paced, read, with_resets, with_timeouts,
};
use std::{collections::BTreeMap, env};

/// Seeds of graphs with errors in the past, which are always tested.
const KNOWN: [u64; 13] =
    [91, 328, 1105, 1680, 5166, 5239, 91_076, 120_041, 920_020, 920_399, 930_221, 980_026, 980_087];
/// Number of programs that are compiled together.
const BATCH: usize = 120;
/// Maximum number of failures that are reduced and shown.
const SHOWN: usize = 3;
/// Maximum number of reduction steps; each compiles many graphs.
const ROUNDS: usize = 15;

/// Failure of each of the legal `cases`, or `None` if it runs correctly.
fn judge(checker: &Checker, folder: &str, ways: &[How], cases: &[&Case]) -> Vec<Option<String>> {
    if cases.is_empty() {
        return vec![];
    }
    let programs: Vec<Program> = cases
        .iter()
        .enumerate()
        .map(|(i, case)| Program { name: format!("Random{i}"), text: case.text(&format!("Random{i}")) })
        .collect();
    match run(folder, &programs, ways) {
        Ok(records) => programs.iter().enumerate().map(|(i, p)| wrong(checker, p, ways, &records, i)).collect(),
        Err(message) => {
            let blamed = |i: usize| message.contains(&format!("Random{i}.afg"));
            if cases.len() == 1 || !(0..cases.len()).any(blamed) {
                return cases.iter().map(|_| Some(message.clone())).collect();
            }
            let rest: Vec<&Case> = cases.iter().enumerate().filter(|(i, _)| !blamed(*i)).map(|(_, c)| *c).collect();
            let mut judged = judge(checker, folder, ways, &rest).into_iter();
            (0..cases.len()).map(|i| if blamed(i) { Some(message.clone()) } else { judged.next().flatten() }).collect()
        }
    }
}

/// Kind of a failure.
fn kind(why: &str) -> &str {
    why.lines().next().and_then(|line| line.split_whitespace().nth(2)).unwrap_or_default()
}

/// First failure of program `at` in any way to run it.
fn wrong(checker: &Checker, program: &Program, ways: &[How], records: &[Vec<String>], at: usize) -> Option<String> {
    let mut all = ways.iter().zip(records);
    all.find_map(|(how, records)| {
        let why = match how {
            How::Again | How::Late => Some(records[at].clone()).filter(|difference| !difference.is_empty()),
            How::InTurn | How::OnThreads => wrong_record(checker, program, *how, &records[at]),
        };
        why.map(|why| format!("{why}\n  ({how:?})"))
    })
}

fn wrong_record(checker: &Checker, program: &Program, how: How, trace: &str) -> Option<String> {
    let records = read(trace);
    if !trace.ends_with("E\n") {
        return Some(format!("the program stopped early:\n{}", last_lines(trace, 20)));
    }
    let checked = checker.check(&program.text).expect("only legal texts are compiled");
    let Err((step, why)): Result<(), Failure> = checker.judge(&checked, &records) else {
        // On threads, the order differs from run to run.
        return if how == How::InTurn { differs_interpreted(checker, &checked, &records) } else { None };
    };
    let names = |node: NodeId| {
        if node.index() < checked.program.graph.nodes.len() {
            checked.program.graph.path(node)
        } else {
            "inner".to_owned()
        }
    };
    let shown: Vec<String> =
        records[step.saturating_sub(25)..=step].iter().map(|r| r.named(&names, &checked)).collect();
    Some(format!("{why}\n  {}", shown.join("\n  ")))
}

/// The first difference between a run of a compiled program and that of the interpreter.
pub fn differs_interpreted(checker: &Checker, checked: &Checked, records: &[Record]) -> Option<String> {
    let times = records.iter().filter_map(|r| if let Record::Begin(now) = r { Some(*now as i64) } else { None });
    let times: Vec<i64> = times.collect();
    let interpreted = match interpret(&checker.catalog(), checked, &times) {
        Ok(interpreted) => interpreted.records,
        Err(why) => return Some(format!("it is not interpreted: {why}")),
    };
    let same = records.iter().zip(&interpreted).take_while(|(compiled, interpreted)| compiled == interpreted).count();
    let (compiled, interpreted) = (records.get(same), interpreted.get(same));
    (compiled.is_some() || interpreted.is_some())
        .then(|| format!("step {same} differs from the interpreter's: {compiled:?}, but {interpreted:?}"))
}

fn last_lines(text: &str, count: usize) -> String {
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(count)..].join("\n")
}

/// Reduces a failing graph. Returns a small graph that still fails, and its failure.
fn smallest(checker: &Checker, folder: &str, ways: &[How], case: Case, why: String) -> (Case, String) {
    let (mut case, mut why) = (case, why);
    for _ in 0..ROUNDS {
        let legal: Vec<Case> =
            case.smaller().into_iter().filter(|c| checker.check(&c.text("Random")).is_ok()).collect();
        let mut found = None;
        for batch in legal.chunks(BATCH) {
            let cases: Vec<&Case> = batch.iter().collect();
            let judged = judge(checker, &format!("{folder}-smaller"), ways, &cases);
            let same = batch.iter().zip(judged).filter_map(|(c, w)| Some((c.clone(), w?)));
            found = same.filter(|(_, w)| kind(w) == kind(&why)).min_by_key(|(c, _)| c.nodes.len() + c.links.len());
            if found.is_some() {
                break;
            }
        }
        match found {
            Some(smaller) => (case, why) = smaller,
            None => break,
        }
    }
    (case, why)
}

/// Shows the first failure of each kind, reduced; the others mostly have the same cause.
fn show(checker: &Checker, folder: &str, ways: &[How], failures: &[(&Case, String)]) {
    let mut shown: Vec<&str> = vec![];
    for (case, why) in failures {
        if shown.contains(&kind(why)) || shown.len() == SHOWN {
            continue;
        }
        shown.push(kind(why));
        let (small, why) = smallest(checker, folder, ways, (*case).clone(), why.clone());
        println!("seed {}: {why}\n{}", case.seed, small.text("Random"));
    }
}

/// Tests random graphs, each `made` from a seed. Their number is the wanted number divided by `share`.
fn try_all(folder: &str, ways: &[How], share: u64, made: impl Fn(u64) -> Case) {
    let count = number("APEX_ORACLE_GRAPHS").unwrap_or(40).div_ceil(share);
    let first = number("APEX_ORACLE_SEED").unwrap_or(1);
    println!("{ways:?}: {count} graphs, APEX_ORACLE_SEED={first}");
    let checker = Checker::new();
    let seeds = KNOWN.into_iter().filter(|_| count > 1).chain(first..first + count);
    let cases: Vec<Case> = seeds.map(made).filter(|case| checker.check(&case.text("Random")).is_ok()).collect();
    let mut failures: Vec<(&Case, String)> = vec![];
    for batch in cases.chunks(BATCH) {
        let batch: Vec<&Case> = batch.iter().collect();
        let judged = judge(&checker, folder, ways, &batch);
        failures.extend(batch.iter().zip(judged).filter_map(|(case, why)| Some((*case, why?))));
    }
    println!("{} legal graphs, {} of them wrong", cases.len(), failures.len());
    let mut kinds: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for (case, why) in &failures {
        kinds.entry(kind(why).to_owned()).or_default().push(case.seed);
    }
    println!("{kinds:?}");
    if env::var_os("APEX_ORACLE_RAW").is_some() {
        failures.iter().for_each(|(case, why)| println!("seed {}: {why}\n{}", case.seed, case.text("Random")));
    } else {
        show(&checker, folder, ways, &failures);
    }
    assert!(failures.is_empty(), "{} of {} programs do what their nets may not", failures.len(), cases.len());
}

#[test]
fn compiled_programs_run_as_their_nets_may() {
    try_all("oracle", &[How::InTurn], 1, |seed| generate(seed, true));
}

#[test]
fn programs_are_reset_as_in_their_nets() {
    try_all("oracle-resets", &[How::InTurn], 10, |seed| match seed % 2 {
        0 => with_resets(generate(seed, true)),
        _ => with_resets(with_timeouts(generate(seed, true))),
    });
}

#[test]
fn timeouts_come_as_in_their_nets() {
    try_all("oracle-timeouts", &[How::InTurn], 2, |seed| with_timeouts(generate(seed, true)));
}

/// The result of a late reaction is that of reactions in time.
#[test]
fn late_programs_run_as_in_time() {
    try_all("oracle-late", &[How::Late], 4, |seed| paced(with_timeouts(generate(seed, true))));
}

/// In sequence and on threads, compiled once.
#[test]
fn thread_groups_run_as_their_nets_may() {
    try_all("oracle-threads", &[How::InTurn, How::OnThreads], 4, |seed| match seed % 2 {
        0 => on_threads(generate(seed, true)),
        _ => on_threads(with_timeouts(generate(seed, true))),
    });
}

/// Also with several groups, which run in sequence here.
#[test]
fn recorded_programs_run_the_same_again() {
    try_all("oracle-again", &[How::Again], 20, |seed| match seed % 2 {
        0 => generate(seed, true),
        _ => on_threads(generate(seed, true)),
    });
}

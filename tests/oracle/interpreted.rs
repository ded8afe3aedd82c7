//! Random graphs, interpreted, compared with their nets.
//!
//! `APEX_INTERPRETED_GRAPHS` is the number of graphs (1,000), `APEX_ORACLE_SEED` the first seed.

use crate::number;
use apex_dsl::checked::CheckedProgram;
use apex_tests::oracle::{Case, Checker, Record, generate, interpret, on_threads, paced, with_resets, with_timeouts};
use apex_tests::{Compiler, SEED, cases, text};
use rayon::prelude::*;

/// Times of reactions that are in time, in ns.
const IN_TIME: [i64; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9];
/// Maximum number of failures that are reduced and shown.
const SHOWN: usize = 3;
/// Graphs that share a checker.
const BATCH: u64 = 100;

fn millis(times: &[i64]) -> Vec<i64> {
    times.iter().map(|time| time * 1_000_000).collect()
}

/// Result for the graph of a seed.
enum Tried {
    /// It is not legal.
    Illegal,
    /// It runs correctly, with this number of calls.
    Right(usize),
    Wrong(String),
}

/// Compares the interpreted run of a graph with its net.
fn as_net(checker: &Checker, case: &Case) -> Tried {
    let text = case.text("Random");
    let Ok(checked) = checker.check(&text) else { return Tried::Illegal };
    let records = match interpret(&checker.catalog(), &checked, &millis(&IN_TIME)) {
        Ok(interpreted) => interpreted.records,
        Err(why) => return Tried::Wrong(format!("seed {}: {why}\n{text}", case.seed)),
    };
    let Err((step, why)) = checker.judge(&checked, &records) else { return Tried::Right(calls(&records)) };
    let names = |node: apex_dsl::graph::NodeId| {
        if node.index() < checked.program.graph.nodes.len() {
            checked.program.graph.path(node)
        } else {
            "inner".to_owned()
        }
    };
    let shown = &records[step.saturating_sub(25)..=step.min(records.len() - 1)];
    let shown: Vec<String> = shown.iter().map(|record| record.named(&names, &checked)).collect();
    Tried::Wrong(format!("seed {}: {why}\n  {}\n{text}", case.seed, shown.join("\n  ")))
}

/// Compares the firings of late reactions with those of reactions in time.
fn late_as_in_time(checker: &Checker, case: &Case) -> Tried {
    let Ok(checked) = checker.check(&case.text("Random")) else { return Tried::Illegal };
    let steps = |times: &[i64]| {
        let records = interpret(&checker.catalog(), &checked, &millis(times))?.records;
        let is_step = |record: &Record| !matches!(record, Record::Begin(_) | Record::End);
        Ok::<_, String>(records.into_iter().filter(is_step).collect::<Vec<_>>())
    };
    let in_time = match steps(&IN_TIME) {
        Ok(steps) => steps,
        Err(why) => return Tried::Wrong(format!("seed {}: {why}", case.seed)),
    };
    let differs = [&[0, 9][..], &[0, 2, 3, 7, 9]].into_iter().any(|late| steps(late).as_ref() != Ok(&in_time));
    match differs {
        true => Tried::Wrong(format!("seed {}: a late run differs", case.seed)),
        false => Tried::Right(calls(&in_time)),
    }
}

/// Reduces a failing graph. Returns the failure of a small graph that still fails.
fn smallest(checker: &Checker, mut case: Case, test: &(dyn Fn(&Checker, &Case) -> Tried + Sync)) -> Option<String> {
    let Tried::Wrong(mut why) = test(checker, &case) else { return None };
    loop {
        let smaller = case.smaller().into_iter().find_map(|case| match test(checker, &case) {
            Tried::Wrong(why) => Some((case, why)),
            Tried::Illegal | Tried::Right(_) => None,
        });
        match smaller {
            Some(found) => (case, why) = found,
            None => return Some(why),
        }
    }
}

fn calls(records: &[Record]) -> usize {
    records.iter().filter(|record| matches!(record, Record::Fired(_) | Record::Handled(_))).count()
}

/// Tests the graphs of the wanted number of seeds, divided by `share`.
fn try_all(share: u64, made: impl Fn(u64) -> Case + Sync, test: impl Fn(&Checker, &Case) -> Tried + Sync) {
    let count = number("APEX_INTERPRETED_GRAPHS").unwrap_or(1000) / share;
    let first = number("APEX_ORACLE_SEED").unwrap_or(1);
    let batches: Vec<u64> = (0..count.div_ceil(BATCH)).collect();
    let tried: Vec<Tried> = batches
        .par_iter()
        .flat_map_iter(|batch| {
            let checker = Checker::new();
            let seeds = first + batch * BATCH..first + (batch * BATCH + BATCH).min(count);
            seeds.map(|seed| test(&checker, &made(seed))).collect::<Vec<_>>()
        })
        .collect();
    let right: Vec<usize> =
        tried.iter().filter_map(|tried| if let Tried::Right(calls) = tried { Some(*calls) } else { None }).collect();
    let wrong: Vec<u64> =
        (first..).zip(&tried).filter(|(_, tried)| matches!(tried, Tried::Wrong(_))).map(|(seed, _)| seed).collect();
    let calls: usize = right.iter().sum();
    println!(
        "{count} seeds from APEX_ORACLE_SEED={first}: {} right, {} wrong, {calls} calls",
        right.len(),
        wrong.len()
    );
    let checker = Checker::new();
    let shown: Vec<String> =
        wrong.iter().take(SHOWN).filter_map(|seed| smallest(&checker, made(*seed), &test)).collect();
    assert!(wrong.is_empty(), "{} are wrong, with the seeds {wrong:?}:\n{}", wrong.len(), shown.join("\n"));
    // Otherwise little was tested.
    assert!(right.len() as u64 * 2 > count && calls > right.len() * 5, "too few graphs are legal, or they do nothing");
}

/// Synchronous graphs, flat and with a nested graph, follow the rules R1 to R3.
#[test]
fn interpreted_synchronous_graphs_follow_the_rules() {
    const ITERATIONS: usize = 25;
    let count = (number("APEX_INTERPRETED_GRAPHS").unwrap_or(1000) / 5) as usize;
    let first = number("APEX_ORACLE_SEED").unwrap_or(1);
    let cases = cases(SEED ^ first, count);
    // A loop through the nested graph may have no delay then: such a graph is not legal.
    let tried: Vec<Option<String>> = cases
        .par_chunks(BATCH as usize)
        .flat_map_iter(|cases| {
            let mut compiler = Compiler::new();
            cases.iter().filter_map(move |case| wrong_synchronous(&mut compiler, case, ITERATIONS))
        })
        .collect();
    let wrong: Vec<&String> = tried.iter().flatten().collect();
    println!("{} of {} graphs are legal, each twice", tried.len(), cases.len());
    assert!(wrong.is_empty(), "{} are wrong:\n{}", wrong.len(), wrong[0]);
    assert!(tried.len() * 10 > cases.len() * 9, "too few graphs are legal");
}

/// Difference of the runs of a graph, flat and nested, from the rules; `None` if the graph is not legal.
fn wrong_synchronous(compiler: &mut Compiler, case: &apex_tests::Case, iterations: usize) -> Option<Option<String>> {
    let programs = compiler.programs(&text(std::slice::from_ref(case)))?;
    let expected = case.run(iterations);
    let programs: Vec<&CheckedProgram> =
        programs.iter().filter(|p| ["Flat0", "Nested0"].contains(&p.graph.name.as_str())).collect();
    assert_eq!(programs.len(), 2, "both are programs");
    let wrong = programs.into_iter().find_map(|program| {
        let trace = case.interpret(program, compiler.catalog(), iterations).expect("all nodes are known");
        (trace != expected).then(|| format!("{}: {expected:?}\n{trace:?}\n{case:?}", program.graph.name))
    });
    Some(wrong)
}

/// Claims that the compiler has not decided are looked at.
#[test]
fn interpreted_claims_are_reported_once() {
    const TEXT: &str = "use apex_tests::nodes::{ScHandler, ScSourceE};
        graph Random {
            node go = ScSourceE(id = 0, script = [1, 1, 3]) every 1ms;
            node a = ScHandler(id = 1, script = [1, 1, 9]);
            node b = ScHandler(id = 2, script = [1, 1, 9]);
            node c = ScHandler(id = 3, script = [1, 1, 0]);
            start => a;
            start => b;
            go.e -> a.s;
            a.e => c.s;
            claim exclusive(b, c);
            claim exclusive(a, go);
        }";
    let checker = Checker::new();
    let checked = checker.check_within(TEXT, 1).expect("a legal text");
    let run = interpret(&checker.catalog(), &checked, &millis(&[0, 1, 2])).expect("known nodes");
    // `b` is active from the start; then the activity of `a` goes on to `c`.
    assert_eq!(run.broken, [0]);
}

#[test]
fn interpreted_graphs_run_as_their_nets_may() {
    try_all(1, |seed| generate(seed, true), as_net);
}

/// Seeds about which the program, interpreted and compiled alike, and the net once disagreed.
const FORMER: &[u64] = &[
    3050, 5412, 6739, 6971, 500_608, 502_980, 507_263, 516_058, 518_052, 2_001_006, 2_035_091, 2_041_023, 2_049_314,
    2_072_645, 2_078_947, 2_080_385, 2_083_520, 2_094_618, 2_098_221, 3_004_335, 3_004_977, 3_011_621, 3_055_703,
    3_058_440, 3_069_987, 3_077_650, 3_090_563, 4_012_587,
];

/// The same of graphs with timeouts in thread groups.
const FORMER_OF_THREADS: &[u64] = &[
    503_825, 504_993, 1_301_522, 1_302_202, 1_302_283, 1_303_536, 1_308_026, 1_313_156, 3_003_749, 3_013_692,
    4_005_890, 4_013_520,
];

/// Seeds about which they disagree. The first two: the output of a nested graph that leads back to its input, in which
/// other outputs and an event come together, waits for the event although a delay has made it. The third: nodes that
/// take ⊥ would have to act early at one moment and late at another.
const OPEN: &[u64] = &[2_032_420, 3_085_122, 4_019_570];

fn wrong(seeds: &[u64], made: impl Fn(u64) -> Case) -> Vec<u64> {
    let checker = Checker::new();
    seeds.iter().copied().filter(|seed| matches!(as_net(&checker, &made(*seed)), Tried::Wrong(_))).collect()
}

#[test]
fn former_disagreements_with_the_nets_are_settled() {
    assert_eq!(wrong(FORMER, |seed| generate(seed, true)), [0; 0]);
    assert_eq!(wrong(FORMER_OF_THREADS, |seed| on_threads(with_timeouts(generate(seed, true)))), [0; 0]);
}

#[test]
#[ignore = "open: one of 25,000 random graphs"]
fn open_disagreements_with_the_nets() {
    assert_eq!(wrong(OPEN, |seed| generate(seed, true)), [0; 0]);
}

#[test]
fn interpreted_timeouts_come_as_in_their_nets() {
    try_all(2, |seed| with_timeouts(generate(seed, true)), as_net);
}

#[test]
fn interpreted_graphs_are_reset_as_in_their_nets() {
    try_all(4, |seed| with_resets(generate(seed, true)), as_net);
    try_all(4, |seed| with_resets(with_timeouts(generate(seed, true))), as_net);
}

#[test]
fn interpreted_thread_groups_run_as_their_nets_may() {
    try_all(4, |seed| on_threads(with_timeouts(generate(seed, true))), as_net);
}

#[test]
fn interpreted_late_reactions_run_as_in_time() {
    try_all(4, |seed| paced(with_timeouts(generate(seed, true))), late_as_in_time);
}

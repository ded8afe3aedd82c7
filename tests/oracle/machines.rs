//! Random state machines: the compiled program and the interpreter do the same, call by call. A recorded run is
//! repeated, and what happens late is what happens in time.
//!
//! Their number is a twentieth of `APEX_ORACLE_GRAPHS`, as rustc takes most of a second for each, but at least 10.
//! `APEX_ORACLE_SEED` is the first seed.

use crate::{
    compile::{How, Program, run},
    number,
    programs::differs_interpreted,
};
use apex_tests::oracle::{Checker, Record, machine, read};

/// Returns `true` if late reactions do what those in time do: all sources have a period, and there is one thread, as
/// each of several makes up for its own instants.
fn is_same_late(text: &str) -> bool {
    text.matches("ScTicker").count() == text.matches(" every ").count()
        && ![" on x;", " on y;"].iter().any(|on| text.contains(on))
}

#[test]
fn compiled_machines_run_as_interpreted() {
    let count = (number("APEX_ORACLE_GRAPHS").unwrap_or_default() / 20).max(10);
    let first = number("APEX_ORACLE_SEED").unwrap_or(1);
    let checker = Checker::new();
    let programs = (first..first + count).map(|seed| {
        let name = format!("Random{seed}");
        Program { text: machine(seed, &name), name }
    });
    let programs: Vec<Program> = programs.filter(|program| checker.check(&program.text).is_ok()).collect();
    println!("{} of {count} machines are legal, APEX_ORACLE_SEED={first}", programs.len());
    assert!(programs.len() as u64 * 2 > count, "too few machines are legal");
    let records = run("oracle-machines", &programs, &[How::InTurn, How::Again, How::Late]).expect("they compile");
    let [in_turn, again, late] = &records[..] else { unreachable!("there are three ways") };
    let ran = programs.iter().zip(in_turn).zip(again.iter().zip(late));
    let wrong: Vec<String> =
        ran.filter_map(|((program, trace), others)| wrong(&checker, program, trace, others)).collect();
    assert!(wrong.is_empty(), "{} machines do something else:\n{}", wrong.len(), wrong[0]);
    let moved: usize = programs.iter().zip(in_turn).map(|(program, trace)| moves(&checker, program, trace)).sum();
    assert!(moved > 3 * programs.len(), "the machines hardly moved: {moved} times");
}

/// The first difference of a run from the interpreter's, or of other runs from it.
fn wrong(checker: &Checker, program: &Program, trace: &str, (again, late): (&String, &String)) -> Option<String> {
    let checked = checker.check(&program.text).expect("it was legal before");
    let late = if is_same_late(&program.text) { late } else { "" };
    let others =
        [("again", again.as_str()), ("late", late)].into_iter().filter(|(_, difference)| !difference.is_empty());
    let others = others.map(|(how, difference)| format!("{how}: {difference}"));
    let why = differs_interpreted(checker, &checked, &read(trace)).into_iter().chain(others).next()?;
    Some(format!("{why}\n{}", program.text))
}

/// Number of states that a machine entered. They come behind all nodes.
fn moves(checker: &Checker, program: &Program, trace: &str) -> usize {
    let states = checker.check(&program.text).expect("it was legal before").program.graph.nodes.len();
    read(trace).iter().filter(|r| matches!(r, Record::Activity(node, true) if node.index() >= states)).count()
}

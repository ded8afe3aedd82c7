//! Random graphs, compiled, against the rules R1 to R3 applied one node at a time.
//!
//! The texts are made by `apex_tests::text` and committed; `APEX_BLESS=1` writes them anew.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Case, Log, SEED, Trace, cases, nodes::take_tape, text};

/// So many graphs there are, each of them twice.
const CASES: usize = 20;
const ITERATIONS: usize = 25;

graph!("random.afg");

#[test]
fn the_texts_are_those_of_the_generator() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/behaviour/random.afg");
    let expected = text(&cases(SEED, CASES));
    if std::env::var_os("APEX_BLESS").is_some() {
        std::fs::write(file, &expected).expect("the folder of the tests can be written");
    }
    assert!(expected == include_str!("random.afg"), "random.afg is old: run with APEX_BLESS=1");
}

/// What `program` does, in the form in which the rules tell it. Nested nodes have their plain name.
fn trace<P: Program>(mut program: P, sinks: usize) -> Trace {
    take_tape();
    let mut trace = Trace { fired: vec![], tapes: vec![vec![]; sinks] };
    for _ in 0..ITERATIONS {
        let mut log = Log::of(&program);
        program.react_with(Time::ZERO, &mut log);
        let mut fired: Vec<String> = log.fired.iter().map(|name| name.replace("group.", "")).collect();
        fired.sort();
        trace.fired.push(fired);
    }
    for (sink, token) in take_tape() {
        trace.tapes[sink as usize].push(token);
    }
    trace
}

fn compare<P: Program>(case: &Case, program: P) {
    let expected = case.run(ITERATIONS);
    let got = trace(program, case.sinks());
    for (iteration, (expected, got)) in expected.fired.iter().zip(&got.fired).enumerate() {
        assert_eq!(got, expected, "{}: nodes that fired in iteration {iteration}", P::INFO.name);
    }
    assert_eq!(got.tapes, expected.tapes, "{}: what the sinks wrote", P::INFO.name);
}

macro_rules! compare_all {
    ($($number:literal $flat:ident $nested:ident)*) => {
        $(compare(&cases(SEED, CASES)[$number], $flat::new());
        compare(&cases(SEED, CASES)[$number], $nested::new());)*
    };
}

#[test]
fn compiled_graphs_follow_the_rules() {
    compare_all! {
        0 Flat0 Nested0
        1 Flat1 Nested1
        2 Flat2 Nested2
        3 Flat3 Nested3
        4 Flat4 Nested4
        5 Flat5 Nested5
        6 Flat6 Nested6
        7 Flat7 Nested7
        8 Flat8 Nested8
        9 Flat9 Nested9
        10 Flat10 Nested10
        11 Flat11 Nested11
        12 Flat12 Nested12
        13 Flat13 Nested13
        14 Flat14 Nested14
        15 Flat15 Nested15
        16 Flat16 Nested16
        17 Flat17 Nested17
        18 Flat18 Nested18
        19 Flat19 Nested19
    }
}

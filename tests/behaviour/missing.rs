//! ⊥: its recipients, the nodes that it does not reach, and its cost.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{expand, react};

graph!("missing.afg");
graph!("silent.afg");

#[test]
fn bot_01_nothing_passes_by() {
    let mut program = Gap::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 20]);
    assert_eq!((log.count("s"), log.count("m"), log.count("k")), (5, 2, 2));
}

#[test]
fn bot_02_a_filter_prunes_everything_behind_it() {
    let mut program = Filtered::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 2, 4]);
    assert_eq!(log.order(), "s d m k s d s d m k s d s d m k");
}

#[test]
fn bot_03_an_essential_node_is_told() {
    let mut program = Told::new();
    let log = react(&mut program, 5);
    let all = [Some(0), None, Some(2), None, Some(4)];
    assert_eq!(program.nodes().k.seen, all);
    assert_eq!(program.nodes().keen.seen, all);
    assert_eq!((log.count("m"), log.count("k"), log.count("keen")), (3, 5, 5));
}

#[test]
fn bot_04_diamond() {
    let mut program = Diamond::new();
    let log = react(&mut program, 6);
    assert_eq!(program.nodes().P.seen, [(0, 0), (2, 2), (4, 4)], "what reaches `J`");
    assert_eq!(program.nodes().K.seen, [0, 4, 8]);
    let counts = ["S", "drop", "A2", "B", "J", "K"].map(|n| log.count(n));
    assert_eq!(counts, [6, 6, 3, 6, 3, 3]);
    let siblings = |name: &str| Diamond::INFO.nodes.iter().find(|n| n.name == name).map(|n| n.siblings);
    assert_eq!(["drop", "A2", "B", "K"].map(siblings), [Some(true), Some(true), Some(true), Some(false)]);
    assert!(Diamond::INFO.nodes.iter().all(|n| !n.required), "no node here is essential");
}

#[test]
fn bot_05_an_optional_input_gets_none() {
    let mut program = Optional::new();
    let log = react(&mut program, 4);
    assert_eq!(log.count("o"), 4);
    assert_eq!(program.nodes().k.seen, [11, 102, 33, 104]);
}

#[test]
fn an_optional_input_may_stay_open() {
    let mut program = Open::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [101, 102, 103]);
}

#[test]
fn a_node_with_only_optional_inputs_always_fires() {
    let mut program = Either::new();
    let log = react(&mut program, 7);
    assert_eq!(log.count("o"), 7);
    assert_eq!(program.nodes().k.seen, [Some(0), None, Some(2), Some(30), Some(4), None, Some(66)]);
}

#[test]
fn bot_07_a_switch_takes_one_branch() {
    let mut program = Branches::new();
    for i in 0..6 {
        let log = react(&mut program, 1);
        assert_eq!((log.count("even"), log.count("odd")), if i % 2 == 0 { (1, 0) } else { (0, 1) });
    }
    assert_eq!(program.nodes().k.seen, [0, 100, 2, 300, 4, 500]);
}

#[test]
fn bot_07_a_throttle_passes_every_third() {
    let mut program = Throttled::new();
    react(&mut program, 9);
    assert_eq!(program.nodes().k.seen, [2, 5, 8]);
}

#[test]
fn bot_08_nothing_costs_nothing_behind_a_source() {
    assert_eq!(react(&mut Silent10::new(), 100).order(), ["s"; 100].join(" "));
    assert_eq!(react(&mut Silent100::new(), 100).order(), ["s"; 100].join(" "));
    let log = react(&mut Silent100Told::new(), 100);
    assert_eq!(log.order(), ["s k"; 100].join(" "), "only the essential end is told");
}

#[test]
fn bot_08_one_test_spares_a_chain_of_any_length() {
    let tests = |length: usize| {
        let chain = " -> pass()".repeat(length);
        let code = expand(&format!("graph G {{ node s = silent(); node k = Snk(); s{chain} -> k; }}"));
        code.matches("if let").count()
    };
    assert_eq!([10, 100, 1000].map(tests), [1, 1, 1]);
}

#[test]
fn a_latch_fires_without_a_value() {
    let mut program = Latched::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 0, 0, 3, 3]);
}

#[test]
fn filters_on_two_ways_meet() {
    let mut program = Crossed::new();
    let log = react(&mut program, 13);
    assert_eq!(program.nodes().k.seen, [0, 12, 24]);
    assert_eq!((log.count("both"), log.count("again"), log.count("all")), (3, 3, 13));
}

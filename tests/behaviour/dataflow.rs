//! Data flow: chains, fans, joins, loops.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("chains.afg");
graph!("wide.afg");

#[test]
fn df_01_chain_multiplies() {
    let mut program = Multiplied::new();
    for i in 0..=22 {
        program.react(Time::ZERO);
        assert_eq!(program.nodes().k.seen.last(), Some(&(28 * i)));
    }
    assert_eq!(program.nodes().k.seen.len(), 23);
}

#[test]
fn df_03_chain_fires_in_order() {
    let log = react(&mut Chain::new(), 4);
    assert_eq!(log.order(), ["S A B K"; 4].join(" "));
}

#[test]
fn df_05_two_sources_into_a_product() {
    let mut program = Squares::new();
    react(&mut program, 23);
    assert_eq!(program.nodes().k.seen, (0..23).map(|i| i * i).collect::<Vec<_>>());
}

#[test]
fn df_06_one_source_to_fifty_sinks() {
    let mut program = Fifty::new();
    let log = react(&mut program, 23);
    for k in 0..50 {
        assert_eq!(log.count(&format!("k{k}")), 23);
    }
    assert_eq!(program.nodes().k0.seen, (0..23).collect::<Vec<_>>());
    assert_eq!(program.nodes().k49.seen, program.nodes().k0.seen);
}

#[test]
fn df_07_two_sources_alternate() {
    let log = react(&mut TwoSources::new(), 5);
    assert_eq!(log.order(), ["a ka b kb"; 5].join(" "));
}

#[test]
fn df_08_five_inputs_wait_for_all() {
    let mut program = Five::new();
    for round in 1..=4 {
        let log = react(&mut program, 1);
        assert_eq!(log.count("j"), 1);
        assert_eq!(log.fired[log.fired.len() - 2..], ["j", "k"], "round {round}");
    }
    assert_eq!(program.nodes().k.seen, [1, 24, 47, 70]);
}

#[test]
fn df_10_a_delay_breaks_a_loop() {
    let mut program = Counter::new();
    react(&mut program, 6);
    assert_eq!(program.nodes().k.seen, [0, 1, 3, 6, 10, 15], "sums of 1, 2, 3, … one iteration late");

    let mut program = Loop::new();
    react(&mut program, 5);
    // 1 + 0, the default; nothing; 2 + 100, because no token came back; 3 + 2·102; nothing.
    assert_eq!(program.nodes().k.seen, [1, 102, 207]);
}

#[test]
fn a_delay_of_two_tokens_keeps_nothing_as_nothing() {
    let mut program = Late::new();
    react(&mut program, 7);
    assert_eq!(program.nodes().k.seen, [Some(70), Some(80), Some(1), None, Some(3), Some(4), None]);
}

#[test]
fn buffers_are_read_by_several_nodes() {
    let mut program = Buffers::new();
    react(&mut program, 6);
    assert_eq!(program.nodes().k.seen, [(20, 2), (40, 4), (80, 8), (100, 10)]);
    assert_eq!(program.nodes().kept.seen, (0..6).map(|i| vec![i]).collect::<Vec<_>>());
    assert_eq!(program.nodes().kj.seen, [1, 2, 3, 4, 5, 6]);
}

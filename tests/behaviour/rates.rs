//! Several tokens per firing (Lee 1987): balance, ⊥ among the tokens, delays, loops.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("rates.afg");

#[test]
fn two_tokens_in_three_tokens_out() {
    let mut program = TwoToThree::new();
    let log = react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [11, 52, 101, 142]);
    assert_eq!((log.count("s"), log.count("t"), log.count("k")), (6, 4, 4));
}

#[test]
fn one_missing_token_takes_its_firing_with_it() {
    let mut program = Gaps::new();
    let log = react(&mut program, 2);
    // 10 11 ⊥ | ⊥ 30 31 | 40 41 50 | 51 60 61
    assert_eq!(program.nodes().k.seen, [None, None, Some(131), Some(172)]);
    assert_eq!((log.count("p"), log.count("k")), (5, 4));
}

#[test]
fn a_source_of_two_tokens() {
    let mut program = Source::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [3, 12, 21, 30]);
}

#[test]
fn tokens_are_written_in_place() {
    let mut program = InPlace::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [Some(0), None, None, Some(4), None, None]);
}

#[test]
fn a_delay_shifts_tokens() {
    let mut program = Shifted::new();
    react(&mut program, 3);
    // 5 6 | 7 0 | 1 10
    assert_eq!(program.nodes().k.seen, [11, 7, 11]);
}

#[test]
fn a_loop_at_two_rates() {
    let mut program = Loop::new();
    react(&mut program, 3);
    // a: 0 + 100; 1 + (1000 + 1001); 2 + (20020 + 20021)
    assert_eq!(program.nodes().k.seen, [100, 2002, 40_043]);
}

#[test]
fn ways_of_one_rate_meet() {
    let mut program = Joined::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [1, 21 + 1 + 100, 41 + 2 + 2, 61 + 3 + 100]);
}

#[test]
fn a_nested_graph_among_rates() {
    let mut program = Mixed::new();
    react(&mut program, 2);
    // 0 + 1, 2 + 3: 10 + 11, 50 + 51, all odd.
    assert!(program.nodes().k.seen.is_empty());
    assert_eq!(program.nodes().all.seen, [None, None]);
}

#[test]
fn a_node_is_told_of_each_missing_token() {
    let mut program = Told::new();
    let log = react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [Some(10), Some(11), None, None]);
    assert_eq!(log.count("k"), 4, "being told is a firing, as it is at one rate");
}

#[test]
fn a_node_that_panics_is_made_again() {
    let mut program = Restarted::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [Some(1), Some(2), None, Some(1)], "0 1 | 10 11");
}

#[test]
fn what_was_written_before_a_failure_is_not_sent() {
    let mut program = Spoiled::new();
    let log = react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [Some(0), Some(3), None, Some(9)]);
    assert_eq!(log.failed, [("f", "no 2".to_owned())]);
}

#[test]
fn a_delayed_node_without_a_taker_runs() {
    react(&mut Unused::new(), 2);
}

#[test]
fn lists_come_once_per_token() {
    let mut program = Listed::new();
    react(&mut program, 2);
    // 0 0 0 | 0 1 2 | 0 10 20 | 0 11 22
    assert_eq!(program.nodes().k.seen, [vec![0, 0, 0], vec![0, 2], vec![0, 10, 20], vec![0, 22]]);
}

#[test]
fn the_body_of_an_each_may_have_rates() {
    let mut program = Within::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [vec![1, 1, 1], vec![1, 21, 41], vec![1, 41, 81]]);
}

#[test]
fn parameters_come_with_each_token() {
    let mut program = Tuned::new();
    let log = react(&mut program, 2);
    // 0·0 + 1·1; 10·10 and a gain of 11, which is refused
    assert_eq!(program.nodes().k.seen, [Some(1), None]);
    assert_eq!(program.nodes().l.seen, [1, 20], "the gain of the struct stays at 10");
    assert_eq!(program.nodes().g.seen, [0, 1, 10, 10]);
    assert_eq!(log.count("k"), 2);
}

#[test]
fn a_delay_may_be_shorter_than_an_iteration() {
    let mut program = Short::new();
    react(&mut program, 3);
    // 5 0 | 1 10 | 11 20
    assert_eq!(program.nodes().k.seen, [5, 11, 31]);
}

#[test]
fn the_nodes_of_a_loop_take_turns() {
    let mut program = Turns::new();
    react(&mut program, 2);
    // 100 0+100 | 1+100 10+101, and 11+111 waits
    assert_eq!(program.nodes().k.seen, [200, 212]);
}

#[test]
fn nodes_that_fire_once_have_events() {
    let mut program = Evented::new();
    react(&mut program, 2);
    let nodes = program.nodes();
    assert_eq!([&nodes.k.seen, &nodes.l.seen, &nodes.m.seen], [&[0, 1], &[1, 21], &[1, 21]]);
}

#[test]
fn another_timer_meets_an_iteration() {
    let mut program = Paced::new();
    for ms in [0, 10, 20, 30, 60] {
        program.react(Time::from_millis(ms));
    }
    assert_eq!(program.nodes().k.seen, [1, 21 + 1, 41 + 2]);
}

#[test]
fn activity_passes_a_node_that_fires_once() {
    let mut program = Awake::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [1], "the gate is active once");
    assert_eq!(apex_tests::active(&program), "k");
}

#[test]
fn a_node_that_fires_twice_is_switched_off() {
    let mut program = Switched::new();
    react(&mut program, 1);
    assert_eq!(program.inputs().off.put(()), Ok(()));
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [Some(0), Some(10), None, None, None, None]);
}

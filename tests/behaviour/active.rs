//! More tests of activity: keeping and losing it, nested graphs, resets, delays, `timeout`.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, active, active_after_each, react, simulate};

graph!("active.afg");

#[test]
fn act_06_values_over_inactive_connections_leave_it_where_it_is() {
    let mut program = Kept::new();
    assert_eq!(active_after_each(&mut program), ["s"; 5]);
    assert_eq!(program.nodes().k.seen, [false; 5]);
}

#[test]
fn act_10_the_gate_lets_exactly_one_message_pass() {
    let mut program = Gated::new();
    assert_eq!(active_after_each(&mut program), ["go", "go", "g", "k", "k", "k"]);
    assert_eq!(program.nodes().k.seen, [true]);
    assert!(program.nodes().none.seen.is_empty());
}

#[test]
fn act_12_the_buffer_passes_activity_on_with_the_next_message() {
    let mut program = Waiting::new();
    assert_eq!(active_after_each(&mut program), ["go", "buffer", "buffer", "next", "next", "next"]);
    assert_eq!((program.nodes().next.seen.as_slice(), program.nodes().next.came), (&[1, 4, 5, 6][..], 1));
}

#[test]
fn act_13_through_a_nested_graph() {
    let mut program = Through::new();
    assert_eq!(active_after_each(&mut program), ["go", "s", "k", "k", "k"]);
    assert_eq!(program.nodes().inner.a.seen, [false, false, true, false, false]);
    assert_eq!(program.nodes().k.came, 1);
}

#[test]
fn act_13_a_nested_graph_keeps_it_for_a_while() {
    let mut program = Lingering::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(30));
    assert_eq!(active(&program), "room.w");
    program.react(Time::from_millis(30));
    assert_eq!((active(&program).as_str(), program.nodes().k.count), ("k", 1));
}

#[test]
fn two_starts() {
    let mut program = TwoStarts::new();
    assert_eq!(active_after_each(&mut program), ["b ka kb"; 3]);
    assert_eq!(program.nodes().ka.seen, [true; 3]);
    assert_eq!((program.nodes().b.count, program.nodes().kb.seen.len()), (1, 0));
}

#[test]
fn start_in_a_nested_graph() {
    assert_eq!(active_after_each(&mut Nested::new()), ["k"; 2]);
}

#[test]
fn act_09_activity_under_way_is_lost() {
    let mut program = UnderWay::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(200));
    assert_eq!(program.nodes().x.seen, [1, 2, 3, 9]);
    assert_eq!(log.activity, [("b", true), ("b", false), ("b", true)]);
}

#[test]
fn act_09_what_is_lost_is_told() {
    let mut program = ToldOfReset::new();
    let log = react(&mut program, 3);
    let a = |active| ("a", active);
    assert_eq!(log.activity, [a(true), a(false), a(true), a(false), a(true)]);
    assert_eq!((program.nodes().a.came, program.nodes().a.went), (3, 2));
    assert_eq!((program.nodes().came.count, program.nodes().went.count), (3, 2));
}

#[test]
fn act_08_over_an_input() {
    let mut program = Doused::new();
    assert_eq!(active_after_each(&mut program), ["k", "", ""]);
    assert_eq!(program.nodes().k.seen, [false]);
}

#[test]
fn one_emission_multiplies_activity() {
    let mut program = Multiplied::new();
    assert_eq!(active_after_each(&mut program), ["a b"; 2]);
    assert_eq!((program.nodes().a.came, program.nodes().b.came), (1, 1));
}

#[test]
fn a_node_that_is_skipped_takes_activity_all_the_same() {
    let mut program = Skipped::new();
    assert_eq!(active_after_each(&mut program), ["j"; 3]);
    assert_eq!(program.nodes().k.seen, [7, 9]);
}

#[test]
fn a_timeout_begins_anew_with_activity() {
    let mut program = Back::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(110));
    assert_eq!((active(&program).as_str(), program.nodes().late.count), ("a", 0));
    program.react(Time::from_millis(110));
    assert_eq!(program.nodes().late.count, 1);
}

#[test]
fn a_timeout_that_leads_nowhere_is_triggered_once() {
    let mut program = Patient::new();
    let mut log = Log::of(&program);
    for ms in [0, 20, 40, 60] {
        program.react_with(Time::from_millis(ms), &mut log);
    }
    assert_eq!((active(&program).as_str(), program.nodes().late.count), ("a", 1));
}

#[test]
fn activated_hands_it_on_at_once() {
    let mut program = Handed::new();
    assert_eq!(active_after_each(&mut program), ["k"; 2]);
    assert_eq!((program.nodes().a.came, program.nodes().a.went, program.nodes().k.count), (1, 1, 1));
}

#[test]
fn a_nested_graph_is_active_while_activity_is_under_way_in_it() {
    let mut program = Carried::new();
    assert_eq!(Carried::INFO.graphs, ["h"]);
    program.react(Time::ZERO);
    assert_eq!((active(&program), program.is_graph_active(0)), (String::new(), true));
    program.react(Time::from_millis(20));
    assert_eq!((active(&program), program.is_graph_active(0)), ("k".to_owned(), false));
}

#[test]
fn activity_goes_through_a_delay_with_its_token() {
    let mut program = HeldBack::new();
    assert_eq!(active_after_each(&mut program), ["", "", "k", "k", "k"]);
}

#[test]
fn a_nested_graph_that_no_token_reaches_is_never_active() {
    let mut program = Asleep::new();
    program.react(Time::ZERO);
    assert_eq!((active(&program), program.is_graph_active(0)), ("a".to_owned(), false));
}

//! Activity: active nodes, and tokens that carry activity.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, active_after_each};

graph!("activity.afg");

#[test]
fn act_01_activity_goes_to_the_end_of_the_chain() {
    assert_eq!(active_after_each(&mut Passed::new()), ["go", "k", "k", "k", "k"]);
}

#[test]
fn act_02_it_stays_where_no_active_connection_leads_on() {
    assert_eq!(active_after_each(&mut Held::new()), ["go", "m", "m", "m", "m"]);
}

#[test]
fn act_03_it_goes_with_events() {
    assert_eq!(active_after_each(&mut OverEvents::new()), ["go", "k", "k", "k", "k"]);
}

#[test]
fn act_04_from_data_to_an_event() {
    assert_eq!(active_after_each(&mut DataThenEvent::new()), ["go", "k", "k", "k", "k"]);
}

#[test]
fn act_05_no_message_carries_nothing() {
    assert_eq!(active_after_each(&mut OnlyValues::new()), ["s", "s", "b", "b", "b"]);
}

#[test]
fn act_07_only_over_active_connections() {
    assert_eq!(active_after_each(&mut OneOfTwo::new()), ["go", "b", "b", "b", "b"]);
}

#[test]
fn act_08_it_takes_activity_away_through_a_nested_graph() {
    let mut program = DampenedFromFar::new();
    let mut log = Log::of(&program);
    for _ in 0..3 {
        program.react_with(Time::ZERO, &mut log);
    }
    assert_eq!(log.activity, [("b", true), ("b", false)]);
}

#[test]
fn act_08_dampen_takes_activity_away() {
    let mut program = Dampened::new();
    let mut log = Log::of(&program);
    for _ in 0..5 {
        program.react_with(Time::ZERO, &mut log);
    }
    assert_eq!(log.activity, [("b", true), ("b", false)]);
    assert_eq!(program.nodes().told.count, 2, "it was told of both");
    assert_eq!((program.nodes().b.came, program.nodes().b.went), (1, 1));
}

#[test]
fn act_09_reset_starts_anew() {
    assert_eq!(active_after_each(&mut Restarted::new()), ["k", "k", "s", "k", "k"]);
}

#[test]
fn a_node_that_is_active_too_long_triggers_timeout() {
    let mut program = TooLong::new();
    assert_eq!(program.react(Time::ZERO), Next::At(Time::from_millis(50)));
    program.react(Time::from_millis(49));
    assert_eq!(program.nodes().b.count, 0);
    program.react(Time::from_millis(50));
    assert_eq!(program.nodes().b.count, 1);
    assert!(program.is_active(1) && !program.is_active(0));
    assert_eq!(program.react(Time::from_millis(500)), Next::Input);
    assert_eq!(program.nodes().b.count, 1);
}

//! Activity is taken out of nodes and nested graphs, and given back.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{active, react};

graph!("cancel.afg");

#[test]
fn hooks_and_events_of_a_single_node() {
    let mut program = Single::new();
    program.react(Time::ZERO);
    assert_eq!(active(&program), "taker");
    program.inputs().stop.put(1).unwrap();
    program.react(Time::from_millis(5));
    assert_eq!((active(&program).as_str(), program.nodes().taker.went), ("", 1));
    assert_eq!((program.events().cancelled.take(), program.events().went.take()), (Some(()), Some(())));
    program.inputs().stop.put(2).unwrap();
    program.react(Time::from_millis(6));
    assert_eq!((program.events().cancelled.take(), program.nodes().taker.went), (None, 1));
    program.inputs().go.put(3).unwrap();
    program.react(Time::from_millis(7));
    assert_eq!((active(&program).as_str(), program.nodes().taker.came), ("taker", 2));
}

#[test]
fn each_level_remembers_what_it_took() {
    let mut program = Levels::new();
    program.react(Time::ZERO);
    assert_eq!(active(&program), "pair.left pair.right");
    macro_rules! after {
        ($slot:ident) => {{
            program.inputs().$slot.put(()).unwrap();
            program.react(Time::ZERO);
            active(&program)
        }};
    }
    assert_eq!(after!(inner), "pair.right");
    assert_eq!(after!(outer), "");
    assert_eq!(after!(again), "pair.left");
    assert_eq!(after!(all), "pair.left pair.right");
}

#[test]
fn a_token_that_waits_in_front_of_a_nested_graph_is_on_its_way_into_it() {
    let mut program = InFront::new();
    program.inputs().begin.put(1).unwrap();
    program.react(Time::ZERO);
    assert_eq!(active(&program), "");
    program.inputs().stop.put(()).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.events().stopped.take(), Some(()));
    // The token itself goes on without activity.
    program.inputs().b.put(2).unwrap();
    program.react(Time::ZERO);
    assert_eq!((active(&program).as_str(), program.nodes().inner.k.seen.as_slice()), ("", &[3][..]));
    program.inputs().go.put(()).unwrap();
    program.react(Time::ZERO);
    assert_eq!(active(&program), "inner.s");
}

#[test]
fn loops_through_reset_and_cancel_are_reported() {
    let mut program = Endless::new();
    program.set_budget(1000);
    assert!(!react(&mut program, 1).endless.is_empty());
    let mut program = Around::new();
    program.set_budget(1000);
    assert!(react(&mut program, 1).endless.is_empty());
    program.inputs().begin.put(()).unwrap();
    assert!(!react(&mut program, 1).endless.is_empty());
}

//! Nested graphs: one node for their parent, and grouping changes nothing.

use apex_macros::graph;
use apex_rt::{Next, prelude::*};
use apex_tests::react;

graph!("nesting.afg");

#[test]
fn sub_01_a_source_inside() {
    let mut program = Quadrupled::new();
    react(&mut program, 23);
    assert_eq!(program.nodes().k.seen, (0..23).map(|i| 4 * i * i).collect::<Vec<_>>());
}

#[test]
fn sub_02_two_inputs_and_one_output_twice() {
    let mut program = FourthPower::new();
    react(&mut program, 23);
    assert_eq!(program.nodes().k.seen, (0..23).map(|i: i64| i.pow(4)).collect::<Vec<_>>());
}

#[test]
fn sub_03_a_graph_with_only_a_source_is_a_source() {
    let mut program = Wells::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [0, 1, 2]);
    assert_eq!(program.nodes().used.k.seen, [0, 1, 2]);
    assert_eq!(program.nodes().unused.k.seen, [0, 1, 2]);
}

#[test]
fn sub_04_nothing_passes_through() {
    let mut program = Gap::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [Some(0), None, Some(20), Some(30), None]);
}

#[test]
fn sub_07_grouping_changes_nothing() {
    let (mut flat, mut grouped) = (Flat::new(), Grouped::new());
    react(&mut flat, 30);
    react(&mut grouped, 30);
    assert_eq!(flat.nodes().k.seen.len(), 15);
    assert_eq!(flat.nodes().k.seen, grouped.nodes().k.seen);
}

#[test]
fn a_graph_from_another_text() {
    let mut program = Imported::new();
    let log = react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [0, 20]);
    assert_eq!(log.count("e.d"), 4, "a nested node has the name of its graph before its own");
}

#[test]
fn inputs_lead_straight_to_outputs() {
    let mut program = Swapped::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [(1, 0), (2, 1), (3, 2)]);
}

#[test]
fn a_loop_through_a_nested_graph() {
    let mut program = Summed::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [100, 101, 103, 106]);
}

#[test]
fn graph_inputs_wait_for_each_other() {
    let mut program = Ports::new();
    assert_eq!(program.react(Time::ZERO), Next::Input);
    assert_eq!(program.inputs().x.put(1), Ok(()));
    assert_eq!(program.react(Time::ZERO), Next::Input);
    assert_eq!((program.outputs().sum, program.outputs().twice), (None, Some(2)), "`m` needs `x` alone");
    assert_eq!(program.inputs().by.put(10), Ok(()));
    program.react(Time::ZERO);
    assert_eq!(program.outputs().sum, Some(11));
}

#[test]
fn a_mailbox_holds_one_token() {
    let mut program = Ports::new();
    assert_eq!(program.inputs().x.put(1), Ok(()));
    assert_eq!(program.inputs().x.put(2), Err(2));
    program.react(Time::ZERO);
    assert_eq!(program.inputs().x.put(3), Ok(()));
    program.react(Time::ZERO);
    assert!(program.inputs().x.is_full(), "the first token still waits for `by`: the connection holds one token");
    assert_eq!(program.inputs().by.put(10), Ok(()));
    program.react(Time::ZERO);
    assert_eq!(program.outputs().sum, Some(11));
    assert_eq!(program.inputs().by.put(20), Ok(()));
    program.react(Time::ZERO);
    assert_eq!(program.outputs().sum, Some(23));
}

#[test]
fn events_of_a_nested_graph_need_no_connection() {
    let mut program = NothingTold::new();
    react(&mut program, 3);
    program.inputs().n.put(1).unwrap();
    program.inputs().stop.put(()).unwrap();
    assert_eq!(program.react(Time::from_millis(15)), Next::At(Time::from_millis(20)));
}

//! Forms of nodes: generic ones, several outputs, outputs written in place.

use apex_macros::graph;
use apex_tests::{nodes::Label, react};

graph!("forms.afg");

#[test]
fn outputs_are_missing_one_by_one_or_together() {
    let mut program = Switches::new();
    let log = react(&mut program, 12);
    assert_eq!(program.nodes().aeven.seen, [0, 2]);
    assert_eq!(program.nodes().aodd.seen, [1, 3]);
    let even: Vec<i64> = program.nodes().beven.seen.iter().flatten().copied().collect();
    assert_eq!((even, program.nodes().beven.seen.len()), (vec![2, 4, 6], 12));
    assert_eq!(program.nodes().bodd.seen, [1, 3, 7]);
    assert_eq!(log.failed.len(), 3);
    assert_eq!(log.failed[1], ("b", "5 is a multiple of 5".to_owned()));
}

#[test]
fn one_output_is_there_and_one_is_not() {
    let mut program = Signs::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().plus.seen, [0, 1, 2, 3]);
    assert_eq!(program.nodes().k.seen, [(1, -1), (3, -3)]);
}

#[test]
fn outputs_written_in_place_meet_again() {
    let mut program = Split::new();
    react(&mut program, 7);
    assert_eq!(program.nodes().k.seen, [(0, 0), (6, 6)]);
    assert_eq!(program.nodes().ko.seen, [0, 2, 30, 4, 66]);
}

#[test]
fn generic_nodes() {
    let label = |i: i64| Label(i.to_string());
    let mut program = Generic::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().numbers.seen, [0, 0, 2, 2]);
    assert_eq!(program.nodes().labels.seen, (0..4).map(label).collect::<Vec<_>>());
    assert_eq!(program.nodes().firsts.seen, program.nodes().labels.seen);
}

#[test]
fn generic_graphs() {
    let mut program = Kept::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().ka.seen, [1, 1, 3]);
    assert_eq!(program.nodes().kb.seen, [1, 1, 3].map(|i: i64| Label(i.to_string())));
}

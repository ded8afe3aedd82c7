//! Any name that the language allows can be used.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{react, simulate};

graph!("names.afg");

#[test]
fn paces_with_nearly_the_same_name() {
    let mut program = Paces::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(60));
    assert_eq!(program.nodes().k.seen, [0, 1, 2, 3, 4, 5]);
    assert_eq!(program.nodes().ka.seen, [0, 1, 2]);
    assert_eq!(program.nodes().kd.seen, [2, 4]);
}

#[test]
fn words_of_rust_and_names_of_locals() {
    let mut program = Words::new();
    let log = react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [2, 6]);
    assert_eq!(program.nodes().item.seen, [None, Some(2), None, Some(6)]);
    assert_eq!(log.failed.len(), 2);
}

#[test]
fn a_node_with_the_name_of_a_held_token() {
    let mut program = Held::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [7, 0, 1]);
    assert_eq!(program.nodes().kd.seen, [2, 4]);
}

#[test]
fn names_of_indices() {
    let mut program = Loops::new();
    react(&mut program, 1);
    assert_eq!(program.nodes().count.seen, [3, 12]);
}

#[test]
fn names_of_locals() {
    let mut program = Locals::new();
    let log = react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [50 + 10, 60 + 30]);
    assert_eq!(program.nodes().kl.seen, [1 + 3, 3 + 9]);
    assert_eq!((log.failed.len(), log.refused.len()), (1, 1));
}

//! Graphs so large that the dispatcher uses tables and lists.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("large.afg");

#[test]
fn a_token_reaches_many_nodes_that_wait_for_room() {
    let mut program = Large::new();
    program.inputs().go.put(7).unwrap();
    let mut seen = vec![];
    for _ in 0..200 {
        program.react(Time::ZERO);
        seen.extend(program.events().done.take());
    }
    assert_eq!(seen, [7; 150]);
}

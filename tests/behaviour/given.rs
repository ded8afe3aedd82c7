//! `node.slot(value)`: a value comes in place of each token.

use apex_macros::graph;
use apex_rt::{Next, prelude::*};

graph!("given.afg");

#[test]
fn a_slot_gets_the_value_for_each_token() {
    let mut program = Plain::new();
    for second in 0..3 {
        program.react(Time::from_secs(second));
    }
    assert_eq!(program.nodes().take.seen, [1, 9, -7, -7, -7]);
    assert_eq!(program.nodes().slow.seen, Vec::<i64>::new());
    program.inputs().speed.put(0.5).unwrap();
    program.react(Time::from_millis(2500));
    assert_eq!(program.nodes().slow.seen, [5]);
}

#[test]
fn several_values_reach_another_thread_in_order() {
    let mut program = Elsewhere::new();
    assert_eq!(program.react(Time::ZERO), Next::Input);
    program.inputs().go.put(0.0).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().far.seen, [3, 5]);
}

//! Variants: the statements of another graph, with some nodes exchanged.

use apex_macros::graph;
use apex_rt::Time;

graph!("variants.afg");

#[test]
fn nodes_are_exchanged_and_statements_added() {
    let mut program = Thirds::new();
    program.inputs().x.put(6).unwrap();
    program.react(Time::ZERO);
    assert_eq!((program.outputs().y, program.outputs().same), (Some(60), Some(6)));
    let mut program = Fourths::new();
    program.inputs().x.put(6).unwrap();
    program.react(Time::ZERO);
    assert_eq!((program.outputs().y, program.outputs().same), (None, None));
}

#[test]
fn parameters_have_another_default() {
    let mut program = Quiet::new();
    program.inputs().x.put(5).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().y, Some(20));
    let mut program = Loud::new();
    program.inputs().x.put(5).unwrap();
    program.react(Time::ZERO);
    assert_eq!((program.outputs().y, program.outputs().z), (Some(45), Some(20)));
}

#[test]
fn what_is_made_in_rust_is_exchanged() {
    let mut program = Bench::new();
    for ms in 0..10 {
        program.react(Time::from_millis(ms));
    }
    assert_eq!(program.nodes().sink.seen, [0, 5, 10]);
}

//! Generated names do not collide with any others.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("hygiene.afg");

/// Items with the names that generated code uses, in general and for `Arm`.
#[allow(non_camel_case_types, non_upper_case_globals, dead_code)]
mod beside {
    pub const nodes: u8 = 0;
    pub static token: u8 = 0;
    pub struct state(pub u8);
    pub struct ArmState;
    pub struct ArmOutputs;
}
#[allow(unused_imports)]
use beside::*;

#[test]
fn words_of_rust_are_names_of_nodes() {
    let mut program = Words::new();
    react(&mut program, 3);
    assert_eq!(program.outputs().Ok, Some(2 + (2 + 4)));
    assert_eq!(program.nodes().ctx.seen, [0, 1, 2]);
}

#[test]
fn a_machine_has_slots_called_as_its_own_methods() {
    let mut program = Turning::new();
    program.inputs().new.put(4).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().turn.state(), TurnState::Idle, "16 is not more than 24");
    program.inputs().new.put(i64::MAX).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().turn.state(), TurnState::Type, "nothing wraps");
}

#[test]
fn graphs_have_names_of_the_types_of_others() {
    let (mut arm, mut other) = (Arm::new(), ArmNodes::new());
    assert_eq!((react(&mut arm, 1).count("s"), react(&mut other, 1).count("s")), (1, 1));
}

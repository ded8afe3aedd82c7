//! `after` in a state machine: states that are left after a time.

use apex_macros::graph;
use apex_rt::{Next, prelude::*};

graph!("waits.afg");
graph!("times.afg");

fn at(seconds: i64) -> Time {
    Time::from_secs(seconds)
}

#[test]
fn the_program_says_when_a_state_is_left() {
    let mut program = Calls::new();
    assert_eq!(program.react(at(0)), Next::Input);
    program.inputs().call.put(()).unwrap();
    assert_eq!(program.react(at(5)), Next::At(at(7)));
    assert_eq!(program.react(at(7)), Next::At(at(17)));
    program.inputs().hang_up.put(()).unwrap();
    assert_eq!(program.react(at(9)), Next::Input, "nothing is left to wait for");
}

/// All that was due happens at its own time, one after the other.
#[test]
fn a_late_reaction_makes_up_for_all_states() {
    let mut program = Calls::new();
    program.react(at(0));
    program.inputs().call.put(()).unwrap();
    program.react(at(0));
    program.react(at(13));
    assert_eq!(program.events().beeps.take(), Some(10));
    assert_eq!(program.nodes().phone.state(), PhoneState::CallingTone);
    assert_eq!(program.react(at(100)), Next::Input);
    assert_eq!(program.events().beeps.take(), Some(20));
    assert_eq!(program.events().gave_up.take(), Some(()));
    assert_eq!(program.nodes().phone.state(), PhoneState::Idle);
}

//! `fsm`: states, transitions with guards and actions, nested states.

use apex_macros::graph;
use apex_rt::prelude::*;

graph!("machines.afg");

enum Token {
    Go,
    Arrived(i64),
    Failed,
}
use Token::{Arrived, Failed, Go};

fn feed(program: &mut Machine, tokens: &[Token]) -> Vec<MissionState> {
    let states = tokens.iter().map(|token| {
        match token {
            Go => program.inputs().go.put(()).unwrap(),
            Arrived(value) => program.inputs().arrived.put(*value).unwrap(),
            Failed => program.inputs().failed.put(()).unwrap(),
        }
        program.react(Time::ZERO);
        program.nodes().mission.state()
    });
    states.collect()
}

#[test]
fn a_machine_goes_through_its_states() {
    use MissionState::{FetchApproach, FetchPlan, Waiting};
    let mut program = Machine::new();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().lamps.seen, [0], "the first state is entered at the start");
    let states = feed(&mut program, &[Failed, Go, Go, Arrived(3), Arrived(6), Arrived(0), Go, Failed]);
    let expected = [Waiting, FetchPlan, FetchPlan, FetchPlan, FetchApproach, Waiting, FetchPlan, Waiting];
    assert_eq!(states, expected);
    assert_eq!(program.nodes().drives.seen, [7, 1, 6]);
    assert_eq!(program.nodes().lamps.seen, [0, 1, 0, 1, 0]);
    assert_eq!(program.nodes().halts.count, 2, "the outer state is left twice");
}

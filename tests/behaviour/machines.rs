//! `fsm`: states, transitions with guards and actions, nested states.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, active};

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

#[test]
fn a_machine_resumes_what_it_left() {
    use WorkerState::{Charge, WorkBring, WorkFetchDrive, WorkFetchGrip, WorkIdle};
    let mut program = Working::new();
    program.react(Time::ZERO);
    let mut at = |slot: &str| {
        let inputs = program.inputs();
        match slot {
            "go" => inputs.go.put(()).unwrap(),
            "low" => inputs.low.put(()).unwrap(),
            "full" => inputs.full.put(()).unwrap(),
            number => inputs.next.put(number.parse().unwrap()).unwrap(),
        }
        program.react(Time::ZERO);
        program.nodes().worker.state()
    };
    assert_eq!(["low", "full"].map(&mut at), [Charge, WorkIdle], "the first state was never left");
    assert_eq!(["go", "1", "low", "full"].map(&mut at), [WorkFetchDrive, WorkFetchGrip, Charge, WorkFetchGrip]);
    assert_eq!(["1", "low", "full"].map(&mut at), [WorkBring, Charge, WorkBring]);
    assert_eq!(at("go"), WorkFetchGrip, "the state inside remembers its own last state");
    assert_eq!(["1", "1", "low", "3", "6"].map(&mut at), [WorkBring, WorkIdle, Charge, Charge, WorkFetchGrip]);
    assert_eq!(["low", "go"].map(&mut at), [Charge, WorkIdle], "without `resume`, it begins anew");
    assert_eq!(program.nodes().steps.seen, [10, 20, 20, 30, 30, 20, 30, 20]);
    assert_eq!(program.nodes().lamps.seen, [1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1]);
}

#[test]
fn observers_see_states_like_active_nodes() {
    let mut program = Machine::new();
    let mut log = Log::of(&program);
    program.react_with(Time::ZERO, &mut log);
    assert_eq!(active(&program), "mission.waiting");
    program.inputs().go.put(()).unwrap();
    program.react_with(Time::ZERO, &mut log);
    assert_eq!(active(&program), "mission.fetch.plan");
    // It stays in its state.
    program.inputs().arrived.put(1).unwrap();
    program.react_with(Time::ZERO, &mut log);
    program.inputs().failed.put(()).unwrap();
    program.react_with(Time::ZERO, &mut log);
    let [waiting, plan] = ["mission.waiting", "mission.fetch.plan"];
    let expected = [(waiting, true), (waiting, false), (plan, true), (plan, false), (waiting, true)];
    assert_eq!(log.activity, expected);
}

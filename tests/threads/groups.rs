//! Connections between thread groups.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{active, react, simulate};

graph!("groups.afg");

#[test]
fn data_flows_to_another_thread_and_back() {
    let mut program = There::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(50));
    assert_eq!(program.nodes().k.seen, [0, 8, 16, 24, 32]);
    assert_eq!(log.order(), "s a b c k ".repeat(5).trim_end());
}

#[test]
fn no_message_changes_threads_too() {
    let mut program = Missing::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(50));
    assert_eq!(program.nodes().k.seen, [0, 8, 16]);
    assert_eq!(program.nodes().far.seen, [0, 6, 12]);
    assert_eq!(log.count("b"), 3);
}

#[test]
fn any_number_of_inputs_from_other_threads() {
    let mut program = ManyInputs::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(3));
    assert_eq!(program.nodes().k.seen, [2000, 2004, 2008]);
}

#[test]
fn an_event_is_answered_by_another_thread() {
    let mut program = Events::new();
    for question in [1, 2, 3] {
        program.inputs().question.put(question).expect("the one before was taken");
        program.react(Time::ZERO);
        assert_eq!(program.events().answer.take(), Some(5 * question));
    }
    assert_eq!(program.nodes().heard.seen, [5, 10, 15]);
}

/// Sends requests until the queue is full, then takes all answers.
macro_rules! flood {
    ($program:expr) => {{
        let mut program = $program;
        let mut asked = 0;
        while program.inputs().question.put(asked).is_ok() {
            program.react(Time::ZERO);
            asked += 1;
        }
        let mut answers = vec![];
        while let Some(answer) = program.events().answer.take() {
            answers.push(answer);
            program.react(Time::ZERO);
        }
        assert_eq!(program.nodes().heard.seen, answers);
        answers
    }};
}

#[test]
fn there_is_no_more_room_on_the_way_to_another_thread_than_on_one() {
    let (alone, apart) = (flood!(Alone::new()), flood!(Events::new()));
    assert_eq!(alone, apart);
    assert!(alone.iter().copied().eq((0..alone.len() as i64).map(|i| 5 * i)));
}

#[test]
fn sources_of_all_groups_fire_once_a_reaction() {
    let mut program = Free::new();
    let log = react(&mut program, 3);
    assert_eq!(log.order(), "s k t l s k t l s k t l");
}

#[test]
fn df_04_a_pipelined_chain_begins_before_it_has_ended() {
    let order = |log: apex_tests::Log| log.order();
    assert_eq!(order(react(&mut Lockstep::new(), 2)), "s a b k s a b k");
    let mut program = Pipeline::new();
    assert_eq!(order(react(&mut program, 2)), "s a b k s a b k");
    assert_eq!(program.nodes().k.seen, [0, 1]);
}

#[test]
fn activity_changes_threads() {
    let mut program = Active::new();
    program.react(Time::ZERO);
    assert_eq!(active(&program), "first");
    program.inputs().go.put(1).expect("it is empty");
    program.react(Time::ZERO);
    assert_eq!(active(&program), "back");
    assert_eq!(program.nodes().far.seen, [true]);
}

#[test]
fn a_nested_graph_waits_for_its_input_from_another_thread() {
    let mut program = Together::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(90));
    assert_eq!(program.nodes().far.seen, [0, 1, 2]);
    assert_eq!(log.count("slow"), 3);
}

/// A latch is asked when its value is taken with the token of a timer, on whatever thread.
#[test]
fn what_is_taken_together_is_of_one_moment() {
    fn moments<P: Program>(mut program: P, seen: impl Fn(&P) -> Vec<i64>) -> Vec<i64> {
        simulate(&mut program, Time::ZERO, Time::from_millis(50));
        seen(&program)
    }
    let expected = [0, 11, 22, 33, 44];
    assert_eq!(moments(Moment::new(), |program| program.nodes().k.seen.clone()), expected);
    assert_eq!(moments(MomentFar::new(), |program| program.nodes().k.seen.clone()), expected);
    assert_eq!(moments(MomentFarther::new(), |program| program.nodes().k.seen.clone()), expected);
    assert_eq!(moments(MomentNested::new(), |program| program.nodes().k.seen.clone()), expected);
    assert_eq!(moments(MomentNested::new(), |program| program.nodes().l.seen.clone()), expected);
}

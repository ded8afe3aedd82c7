//! Time: exact periods, and sources that hold each other back.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, react, simulate};

graph!("timing.afg");

#[test]
fn lc_04_twenty_firings_per_simulated_second() {
    let mut program = Paced::new();
    for second in 1..=10 {
        let log = simulate(&mut program, Time::from_secs(second - 1), Time::from_secs(second));
        assert_eq!(log.count("s"), 20, "second {second}");
    }
    assert_eq!(program.nodes().k.seen, (0..200).collect::<Vec<_>>());
}

#[test]
fn lc_04_a_program_says_when_it_wants_to_be_called() {
    let mut program = Paced::new();
    assert_eq!(program.react(Time::ZERO), Next::At(Time::from_millis(50)));
    assert_eq!(program.react(Time::from_millis(49)), Next::At(Time::from_millis(50)), "nothing is due");
    assert_eq!(program.nodes().k.seen, [0]);
    assert_eq!(program.react(Time::from_millis(50)), Next::At(Time::from_millis(100)));
    assert_eq!(program.nodes().k.seen, [0, 1]);
}

#[test]
fn lc_04_a_late_call_makes_up_for_what_was_missed() {
    let mut program = Paced::new();
    program.react(Time::from_millis(999));
    assert_eq!(program.nodes().k.seen, (0..20).collect::<Vec<_>>());
}

#[test]
fn the_slower_pace_holds_back_the_faster() {
    let mut program = Held::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(90));
    assert_eq!(program.nodes().k.seen, [(0, 0), (1, 1), (2, 2)]);
    assert_eq!(program.nodes().near.seen, [0, 1, 2, 3], "one token waits for the slower one, no more");
    assert_eq!((log.count("fast"), log.count("slow")), (4, 3));
}

#[test]
fn paces_that_do_not_meet_are_free() {
    let mut program = Apart::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(90));
    assert_eq!(program.nodes().ka.seen, (0..9).map(|i| 2 * i).collect::<Vec<_>>());
    assert_eq!(program.nodes().kb.seen, [0, 3, 6]);
}

#[test]
fn a_nested_graph_takes_its_inputs_together() {
    let mut program = Together::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(90));
    assert_eq!(program.nodes().ka.seen, [0, 2, 4]);
    assert_eq!(program.nodes().kb.seen, [0, 3, 6]);
}

#[test]
fn a_token_that_waits_is_not_overwritten() {
    let mut program = Waiting::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(180));
    // Doubles of 0 and 3 are missing; the slower source sends 0 … 5.
    assert_eq!(program.nodes().k.seen, [2 + 1, 4 + 2, 8 + 4, 10 + 5]);
    assert_eq!(program.nodes().ko.seen, [0, 101, 4, 103, 8, 105]);
}

#[test]
fn a_source_without_a_pace_is_held_back_too() {
    let mut program = Free::new();
    let mut log = Log::of(&program);
    for ms in 0..90 {
        program.react_with(Time::from_millis(ms), &mut log);
    }
    assert_eq!(program.nodes().k.seen, [(0, 0), (1, 1), (2, 2)]);
    assert_eq!(program.nodes().near.seen, [0, 1, 2, 3]);
}

#[test]
fn a_graph_input_meets_a_pace() {
    let mut program = Fed::new();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().sum, None);
    assert_eq!(program.inputs().x.put(100), Ok(()));
    program.react(Time::from_millis(5));
    assert_eq!(program.outputs().sum, Some(100), "the tick of 0 ms was waiting");
    assert_eq!(program.inputs().x.put(200), Ok(()));
    program.react(Time::from_millis(6));
    assert_eq!(program.outputs().sum, Some(100), "no tick until 10 ms: what came out last");
    program.react(Time::from_millis(10));
    assert_eq!(program.outputs().sum, Some(201));
}

#[test]
fn three_paces_in_a_chain() {
    let mut program = Three::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(200));
    assert_eq!(program.nodes().kabc.seen, [0, 3, 6, 9]);
    // `ab` may be one token ahead of `abc`, `a` and `b` one ahead of `ab`, but only after their last token was taken:
    // R4 enables a source when its sinks have fired.
    assert_eq!(program.nodes().kab.seen, [0, 2, 4, 6, 8]);
    assert_eq!((log.count("a"), log.count("b"), log.count("c")), (5, 5, 4));
}

#[test]
fn a_loop_joins_the_paces_in_it() {
    let mut program = Loose::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(50));
    // sums: 0, then the previously sent sum plus the value of the other source
    assert_eq!(program.nodes().k.seen, [0, 1, 4, 9, 16]);
}

#[test]
fn time_stands_still_in_a_reaction() {
    let log = react(&mut Held::new(), 3);
    assert_eq!((log.count("fast"), log.count("slow")), (1, 1));
}

#[test]
fn a_nested_graph_without_nodes_takes_its_inputs_together() {
    let mut program = PassedTogether::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(90));
    assert_eq!(program.nodes().ka.seen, [0, 1, 2]);
    assert_eq!(program.nodes().kb.seen, [0, 1, 2]);
}

#[test]
fn a_delay_sends_to_another_pace() {
    let mut program = LateJoin::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(120));
    assert_eq!(program.nodes().k.seen, [(70, 0), (80, 1), (0, 2), (1, 3)]);
}

#[test]
fn a_loop_without_a_source_runs_once_per_reaction() {
    let mut program = Alone::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [1, 2, 4, 8]);
    assert_eq!(program.nodes().kj.seen, [1, 3, 6, 11]);
    assert_eq!(program.nodes().kf.seen, [1, 3, 9, 27]);
}

#[test]
fn a_token_that_waited_is_late() {
    let mut program = LateBehindJoin::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(50));
    assert_eq!(log.late, [("tight", 10), ("take", 10), ("tight", 10), ("take", 10)], "10 ms are still in time");
    assert_eq!(program.nodes().k.late, [10, 40].map(Time::from_millis));
    assert_eq!(program.nodes().k.ages, [10, 10], "nodes can ask");
}

#[test]
fn a_reaction_that_takes_long_makes_late() {
    let mut program = LateBehindJoin::new();
    let mut log = Log::of(&program);
    log.elapsed = std::time::Duration::from_millis(1);
    program.react_with(Time::ZERO, &mut log);
    program.react_with(Time::from_millis(10), &mut log);
    assert_eq!(log.late, [("tight", 11), ("loose", 11)], "`take` was disabled because `loose` is late");
}

#[test]
fn a_slot_that_waited_is_late() {
    let mut program = LateSlot::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(40));
    assert_eq!(log.late, [("p", 15)], "sent at 10 ms, taken when the join had fired at 25 ms");
    assert_eq!(program.nodes().said.late.len(), 1, "the event of a node that has only slots");
}

#[test]
fn a_source_that_falls_silent_times_out_once() {
    let mut program = Frozen::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(100));
    assert_eq!(program.nodes().k.seen, [1, 2], "at 0 and 10 ms");
    assert_eq!(program.nodes().said.late, [Time::from_millis(35)]);
}

/// Values at `k` if a new value is put in 5 ms before each multiple of 10 ms.
macro_rules! latched {
    ($program:ident) => {{
        let mut program = $program::new();
        for ms in (0..40).step_by(5) {
            if ms % 10 == 5 {
                program.inputs().set.put(ms + 5).unwrap();
            }
            program.react(Time::from_millis(ms));
        }
        program
    }};
}

#[test]
fn what_has_no_pace_fires_with_who_takes_its_tokens() {
    assert_eq!(latched!(Fresh).nodes().k.seen, [(1, 100), (2, 200), (3, 300)]);
}

#[test]
fn what_somebody_hears_has_a_pace_of_its_own() {
    let program = latched!(Heard);
    assert_eq!(program.nodes().k.seen.len(), 3);
    assert!(program.nodes().every.seen.len() > 3, "{:?}", program.nodes().every.seen);
}

#[test]
fn what_has_no_pace_fires_with_the_taker_that_waits_for_the_least() {
    let program = latched!(Shared);
    assert_eq!(program.nodes().k.seen, [(1, 10), (2, 30)], "the slower taker holds the clock back");
    assert_eq!(program.nodes().rare.seen, [(2, 10)]);
}

#[test]
fn what_has_no_pace_waits_for_none_of_two_takers_apart() {
    let program = latched!(Between);
    assert_eq!(program.nodes().k.seen, [(1, 10), (2, 30)]);
    assert_eq!(program.nodes().rare.seen, [(1, 10)]);
}

#[test]
fn what_has_no_pace_fires_once_in_a_reaction_with_a_taker_without_one() {
    assert_eq!(latched!(Unpaced).nodes().k.seen, [10, 10, 20, 20, 30, 30, 40]);
}

/// Times in ms at which `said` takes a timeout, if a node is disabled at `off` and enabled at `on`.
macro_rules! switched {
    ($program:ident, $off:literal, $on:literal) => {{
        let mut program = $program::new();
        for ms in (0..200).step_by(5) {
            if ms == $off {
                program.inputs().off.put(()).unwrap();
            }
            if ms == $on {
                program.inputs().on.put(()).unwrap();
            }
            program.react(Time::from_millis(ms));
        }
        program.nodes().said.late.iter().map(|time| time.as_nanos() / 1_000_000).collect::<Vec<_>>()
    }};
}

#[test]
fn a_disabled_node_times_out_when_it_is_enabled_again() {
    assert_eq!(switched!(Paused, 5, 10), [20], "its time went on");
    assert_eq!(switched!(Paused, 5, 60), [60], "its time was over long ago");
    assert_eq!(switched!(Paused, 5, 1000), [] as [i64; 0], "it is disabled");
    assert_eq!(switched!(Paused, 30, 60), [20], "it is over");
}

#[test]
fn a_disabled_source_has_not_fallen_silent() {
    assert_eq!(switched!(Hushed, 5, 60), [85], "its second value comes at 60 ms");
    assert_eq!(switched!(Hushed, 5, 1000), [] as [i64; 0], "it is to be silent");
    assert_eq!(switched!(Hushed, 100, 150), [35, 175], "its time begins anew when it is enabled");
}

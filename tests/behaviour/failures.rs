//! Failures that are reported and contained, nodes that are disabled and enabled, and the end of a program.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{react, simulate};
use std::{process::Command, time::Duration};

graph!("failures.afg");

#[test]
fn lc_01_failed_is_triggered_once_with_the_error() {
    let mut program = Told1::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 2, 3, 4]);
    assert_eq!(program.nodes().notes.seen, ["no 1"]);
    assert_eq!(log.failed, [("f", "no 1".to_owned())]);
}

#[test]
fn lc_01_what_was_written_before_the_failure_is_not_sent() {
    let mut program = InPlace::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [Some(0), Some(3), None, Some(9)]);
    assert_eq!(program.nodes().notes.seen, ["no 2"]);
}

#[test]
fn a_panic_is_a_failure_where_somebody_listens() {
    let mut program = Panics::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [1, 2, 4, 5], "its state is as the panic left it");
    assert_eq!(log.failed.len(), 1);
    assert!(program.nodes().notes.seen[0].contains("not this one"), "{:?}", program.nodes().notes.seen);
}

#[test]
fn restart_makes_a_node_anew() {
    let mut program = Restarts::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [1, 2, 1, 2]);
}

#[test]
fn restart_after_the_failure_of_a_slot() {
    let mut program = RestartsBySlot::new();
    react(&mut program, 5);
    // The slots are called after or before the firing of the same reaction, in the order of the source file.
    assert_eq!(program.nodes().k.seen, [1, 2, 1, 12, 13]);
    assert_eq!(program.nodes().notes.seen.len(), 1);
}

#[test]
fn a_slot_that_fails() {
    let mut program = SlotFails::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().f.seen, [2, 4]);
    assert_eq!(program.nodes().notes.seen, ["1 is odd", "3 is odd"]);
    let mut program = SlotFailsUnheard::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().f.seen, [2, 4]);
    assert_eq!(log.failed.len(), 2);
}

#[test]
fn activity_leaves_with_a_failure() {
    let mut program = Fallback::new();
    let log = react(&mut program, 5);
    assert_eq!(log.activity, [("f", true), ("f", false), ("plan_b", true)]);
    assert_eq!(program.nodes().k.seen, [0, 2, 3, 4]);
}

#[test]
fn lc_02_the_middle_is_switched_off() {
    let mut program = Middle::new();
    let log = react(&mut program, 8);
    assert_eq!(program.nodes().k.seen, [0, 1, 5, 6, 7], "what was missed does not come later");
    let all = [Some(0), Some(1), None, None, None, Some(5), Some(6), Some(7)];
    assert_eq!(program.nodes().all.seen, all);
    assert_eq!((log.count("s"), log.count("m"), log.count("k")), (8, 5, 5));
}

#[test]
fn lc_02_a_source_that_is_switched_off_sends_nothing() {
    let mut program = Source::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0, 1, 2]);
    assert_eq!(program.nodes().all.seen, [Some(0), None, None, Some(1), Some(2)]);
    assert_eq!(log.count("s"), 3);
}

#[test]
fn a_relay_that_is_switched_off_swallows_events() {
    let mut program = OffAndOn::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().p.seen, [3, 4]);
    assert_eq!(program.nodes().t.seen, [3, 4]);
    assert_eq!(program.nodes().said.count, 0, "`processed` is for `process`");
}

#[test]
fn lc_03_a_sink_is_toggled_while_the_source_runs() {
    let mut program = Toggled::new();
    let log = simulate(&mut program, Time::ZERO, Time::from_millis(100));
    assert_eq!(log.handled.iter().filter(|n| **n == "k").count(), 20);
    assert_eq!(log.count("s"), 100);
    let on: Vec<i64> = (0..100).filter(|ms| ms / 5 % 2 == 1).collect();
    assert_eq!(program.nodes().k.seen, on);
}

/// A clock whose waits end late, by up to 7 ms, as on a busy machine.
struct Jitter {
    now: Time,
    seed: u32,
}

impl Clock for Jitter {
    fn now(&mut self) -> Time {
        self.now
    }
    fn wait_until(&mut self, time: Time) -> bool {
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.now = time + Duration::from_micros(u64::from(self.seed >> 16) % 7_000);
        self.now < Time::from_secs(10)
    }
}

#[test]
fn lc_04_no_drift_over_ten_seconds() {
    let (mut program, mut clock) = (Stamped::new(), Jitter { now: Time::ZERO, seed: 1 });
    while let Next::At(time) = program.react(clock.now()) {
        if !clock.wait_until(time) {
            break;
        }
    }
    let stamps = &program.nodes().s.seen;
    assert_eq!(stamps.len(), 200);
    for (k, stamp) in stamps.iter().enumerate() {
        let late = stamp.as_nanos() - 50_000_000 * k as i64;
        assert!((0..7_000_000).contains(&late), "firing {k} is {late} ns late");
    }
}

#[test]
fn lc_05_exit_and_abort_end_the_run() {
    assert_eq!(apex_rt::drive(Ends::new(), SimClock::until(Time::from_secs(1))), 0);
    assert_eq!(apex_rt::drive(Aborts::new(), SimClock::until(Time::from_secs(1))), 1);
    let mut program = Ends::new();
    assert_eq!(program.react(Time::from_millis(10)), Next::Exit(0));
    assert_eq!(program.react(Time::from_millis(11)), Next::Exit(0), "it stays ended");
}

#[test]
fn lc_05_nothing_fires_after_exit() {
    let mut program = EndsAtOnce::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [0]);
}

/// Program of the process that `lc_05_the_process_ends_with_the_code` starts.
#[test]
#[ignore = "a process of its own"]
fn lc_05_child() {
    match std::env::var("APEX_CHILD").as_deref() {
        Ok("exit") => run(Ends::new(), WallClock::new()),
        Ok("abort") => run(Aborts::new(), WallClock::new()),
        _ => {}
    }
}

#[test]
fn lc_05_the_process_ends_with_the_code() {
    let code = |how: &str| {
        let mut child = Command::new(std::env::current_exe().expect("this test has a program"));
        child.args(["--exact", "failures::lc_05_child", "--ignored"]).env("APEX_CHILD", how);
        child.output().expect("it can be run").status.code()
    };
    assert_eq!((code("exit"), code("abort")), (Some(0), Some(1)));
}

#[test]
fn nodes_of_every_form_are_switched_off() {
    let mut program = AllForms::new();
    react(&mut program, 6);
    let n = program.nodes();
    let some = |values: [i64; 4]| {
        let [a, b, c, d] = values.map(|v| Some(v).filter(|v| *v != 99));
        [a, b, None, None, c, d]
    };
    assert_eq!(n.a_even.seen, some([0, 99, 4, 99]));
    assert_eq!(n.a_odd.seen, some([99, 1, 99, 5]));
    assert_eq!(n.b_plus.seen, some([0, 1, 4, 5]));
    assert_eq!(n.b_minus.seen, some([99, -1, 99, -5]));
    assert_eq!(n.c_out.seen, some([99, 2, 8, 10]));
    assert_eq!(n.d_twos.seen, some([0, 99, 4, 99]));
    assert_eq!(n.d_threes.seen, some([0, 99, 99, 99]));
    assert_eq!(n.e_out.seen, some([0, 1, 4, 5]));
    assert_eq!(n.f_even.seen, some([99, 99, 4, 99]));
    assert_eq!(n.f_odd.seen, some([99, 1, 99, 99]));
    assert_eq!(n.g_out.seen, some([0, 1, 4, 5]));
    assert_eq!(n.h_out.seen, some([100, 101, 104, 105]));
    assert_eq!(n.i_out.seen, some([0, 3, 12, 15]));
    assert_eq!(n.j_out.seen, some([0, 99, 4, 99]));
    assert_eq!(n.told.seen, [0, 1, 4, 5].map(Some));
    assert_eq!(n.g.seen, [0, 1, 4, 5]);
    assert_eq!(n.notes.seen, ["0 is a multiple of 5", "odd", "5 is a multiple of 5", "odd"]);
}

#[test]
fn a_panic_that_nobody_listens_to_is_one() {
    let mut program = PanicsUnheard::new();
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| react(&mut program, 5)));
    assert!(caught.is_err());
}

#[test]
fn a_nested_graph_is_switched_off_and_fails_as_one() {
    let mut program = Group::new();
    let log = react(&mut program, 9);
    // Of 0, 1, … every fourth passes, the odd ones fail; 2, 3 and 4 meet a disabled graph.
    assert_eq!(program.nodes().k.seen, [0, 8]);
    assert_eq!(program.nodes().notes.seen, ["odd"; 3], "1, 5 and 7");
    assert_eq!((log.count("g.f"), log.count("s")), (6, 9));
}

#[test]
fn restart_keeps_the_parameters() {
    let mut program = Restarts::new();
    apex_rt::params::set_text(&mut program, "f.at", "1").expect("a parameter");
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [1, 1, 2, 3]);
    assert!(apex_rt::params::save(&mut program).contains("at = 1"), "{}", apex_rt::params::save(&mut program));
}

#[test]
fn a_program_ends_before_anything_fires() {
    let mut program = EndsAtStart::new();
    assert_eq!(program.react(Time::ZERO), Next::Exit(0));
    assert!(program.nodes().k.seen.is_empty());
    let mut program = EndsFromOutside::new();
    program.inputs().stop.put(()).expect("room");
    assert_eq!(program.react(Time::ZERO), Next::Exit(0));
    assert!(program.nodes().k.seen.is_empty());
}

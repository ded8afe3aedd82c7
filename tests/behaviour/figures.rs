//! Figures of the thesis, as source files in `../figures`: each test asserts the point of its figure.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, active, active_after_each, react, simulate};

graph!("../figures/fig_3_20.afg");
graph!("../figures/fig_3_21.afg");
graph!("../figures/fig_3_22.afg");
graph!("../figures/fig_5_03.afg");
graph!("../figures/fig_5_04.afg");
graph!("../figures/fig_5_05.afg");
graph!("../figures/fig_5_06.afg");
graph!("../figures/fig_5_07.afg");
graph!("../figures/fig_5_08.afg");
graph!("../figures/fig_7_02.afg");
graph!("../figures/fig_7_03.afg");
graph!("../figures/fig_8_01.afg");
graph!("../figures/fig_8_02.afg");
graph!("../figures/fig_8_10.afg");
graph!("../figures/fig_8_11.afg");
mod by_activity {
    apex_macros::graph!("../figures/fig_7_04.afg");
}

#[test]
fn figure_3_20_a_value_takes_one_of_two_ways() {
    let mut program = Branch::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().v_true.seen, [None, Some(1), None, Some(3)]);
    assert_eq!(program.nodes().v_false.seen, [Some(0), None, Some(2), None]);
}

#[test]
fn figure_3_21_a_filter_sends_nothing_for_what_it_drops() {
    let mut program = Filter::new();
    let log = react(&mut program, 6);
    assert_eq!(program.nodes().k.seen, [2, 5]);
    assert_eq!(program.nodes().all.seen, [None, None, Some(2), None, None, Some(5)]);
    assert_eq!(log.count("k"), 2, "what nobody wants to know of costs nothing");
}

#[test]
fn figure_3_22_buffers_and_emitters() {
    let mut program = Buffers::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().again.seen, [None, Some(5), Some(5), Some(6), Some(6)]);
    assert_eq!(program.nodes().once.seen, [None, Some(5), None, Some(6), None]);
    let mut program = Emitter::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().taker.seen, [0, 1, 2]);
}

#[test]
fn figure_5_03_an_event_is_disabled_until_the_region_is_done() {
    let mut program = EventToSink::new();
    let mut log = Log::of(&program);
    program.react_with(Time::from_millis(2), &mut log);
    assert_eq!(log.order(), "v sink v sink v sink");
    let mut program = EventToRegion::new();
    let mut log = Log::of(&program);
    program.react_with(Time::from_millis(2), &mut log);
    assert_eq!(program.nodes().near.seen, [10, 20, 30]);
    assert_eq!(program.nodes().far.seen, [30, 60, 90]);
    let rounds = log.fired.chunks(6);
    assert_eq!(rounds.len(), 3);
    assert!(rounds.into_iter().all(|round| round[0] == "v" && !round[1..].contains(&"v")), "{}", log.order());
}

#[test]
fn figure_5_04_slots_take_data_flow() {
    let mut program = SlotAsSink::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().sink.seen, [0, 1, 2, 3]);
    assert_eq!(program.nodes().taker.seen, [0, 1, 2, 3]);
    let mut program = TwoStreams::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(100));
    let (a, b) = (|i| ('a', i), |i| ('b', i));
    assert_eq!(program.nodes().v.seen, [a(0), b(0), b(1), a(1), b(2), a(2), b(3), b(4), a(3)]);
}

#[test]
fn figure_5_05_a_nested_graph_is_a_node() {
    let (mut node, mut graph) = (AsNode::new(), AsGraph::new());
    react(&mut node, 4);
    react(&mut graph, 4);
    assert_eq!((node.nodes().k.seen.as_slice(), node.nodes().t.seen.as_slice()), (&[0, 3, 6][..], &[7, 8][..]));
    assert_eq!(node.nodes().k.seen, graph.nodes().k.seen);
    assert_eq!(node.nodes().t.seen, graph.nodes().t.seen);
}

#[test]
fn figure_5_06_with_and_without_translation() {
    let (mut translated, mut direct) = (Translated::new(), Direct::new());
    react(&mut translated, 5);
    let log = react(&mut direct, 5);
    assert_eq!(translated.nodes().to.seen, [10, 20, 30]);
    assert_eq!(direct.nodes().to.seen, [10, 20, 30]);
    assert_eq!(log.count("m"), 3);
}

#[test]
fn figure_5_07_a_black_box_does_the_same() {
    let (mut open, mut closed) = (Open::new(), Closed::new());
    react(&mut open, 5);
    react(&mut closed, 5);
    assert_eq!(open.nodes().k.seen, [0, 2, 4, 6]);
    assert_eq!(open.nodes().k.seen, closed.nodes().k.seen);
    assert_eq!(open.nodes().t.seen, closed.nodes().t.seen);
}

#[test]
fn figure_5_08_every_event_is_answered() {
    let mut program = Answered::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(200));
    assert_eq!(program.nodes().answer.seen, [10, 20, 30, 40, 50]);
    assert_eq!(program.nodes().k.seen, [(10, 0), (20, 1), (30, 2), (40, 3), (50, 4)]);
}

#[test]
fn figure_5_08_streams_converge() {
    let mut program = Converging::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(60));
    let seen = [('b', 0), ('c', 0), ('a', 2), ('b', 2), ('c', 1), ('b', 4), ('a', 5), ('c', 2)];
    assert_eq!(program.nodes().v.seen, seen);
}

#[test]
fn figure_7_02_a_machine_waits_for_a_message() {
    let mut program = Asked::new();
    assert_eq!(active_after_each(&mut program), ["s_2", "s_2", "s_q", "s_q"]);
    assert_eq!(program.nodes().s_q.came, 1);
}

#[test]
fn figure_7_03_a_machine_of_nodes_and_active_connections() {
    assert_eq!(active_after_each(&mut Machine::new()), ["even", "odd", "even", "odd", "accept", "accept"]);
}

#[test]
fn figure_7_04_a_buffer_waits_for_a_message() {
    let mut program = by_activity::Waiting::new();
    assert_eq!(active_after_each(&mut program), ["s_1", "v_b", "v_b", "s_q", "s_q"]);
    assert_eq!((program.nodes().s_q.seen.as_slice(), program.nodes().s_q.came), (&[5, 6, 7][..], 1));
}

#[test]
fn figure_8_01_waits_for_the_word_that_starts() {
    let mut program = Robot::new();
    assert_eq!(active_after_each(&mut program), ["wait.streq", "wait.streq", "next", "next"]);
}

#[test]
fn figure_8_01_switches_the_lamp_once() {
    let mut program = SwitchLamp::new();
    assert_eq!(active_after_each(&mut program), ["turn", "next", "next", "next"]);
    assert_eq!(program.nodes().lamp.sent, [true]);
}

#[test]
fn figure_8_02_activity_takes_the_way_of_the_message() {
    let mut known = Known::new();
    assert_eq!(active_after_each(&mut known), ["cube", "cube", "drive"]);
    assert_eq!(known.nodes().drive.seen, [700]);
    let mut unknown = Unknown::new();
    assert_eq!(active_after_each(&mut unknown), ["cube", "explore", "explore"]);
    assert_eq!(unknown.nodes().explore.seen, [9]);
}

#[test]
fn figure_8_10_follows_until_it_is_there_or_gives_up() {
    let mut program = Follow::new();
    simulate(&mut program, Time::ZERO, Time::from_secs(3));
    assert_eq!(
        program.nodes().follow.follower.steps,
        2 + 6,
        "there, and given up after half a second, a last step included"
    );
    assert_eq!((program.nodes().done.count, program.nodes().no_path.seen.as_slice()), (2, &[20][..]));
    assert_eq!(active(&program), "no_path");
}

#[test]
fn figure_8_11_follows_fast_and_slowly() {
    let mut program = Runner::new();
    let mut came = vec![];
    for ms in (0..5000).step_by(50) {
        let mut log = Log::of(&program);
        program.react_with(Time::from_millis(ms), &mut log);
        came.extend(log.activity.into_iter().filter(|(_, active)| *active).map(|(node, _)| node));
        assert_eq!(active(&program).split(' ').count(), 1, "exactly one node is active at {ms} ms");
    }
    let fast = ["track", "fast.planner", "fast.follower"];
    let slow = ["track", "fast.planner", "slow.planner", "slow.follower"];
    let none = ["track", "fast.planner", "slow.planner", "signal_1"];
    let all = [&["detect"][..], &fast, &fast, &slow, &none, &fast, &["track"]].concat();
    assert_eq!(came, all);
    let nodes = program.nodes();
    assert_eq!((nodes.fast.follower.steps, nodes.slow.follower.steps), (1 + 3 + 2, 4));
}

//! Events and slots in contact with inputs, ⊥, timers, other rates, nested graphs, and each other.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Log, react, simulate};

graph!("borders.afg");

const END: Time = Time::from_millis(100);

#[test]
fn ev_04_a_slot_that_is_busy_holds_the_sender_back() {
    let mut program = Hurried::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(200));
    assert_eq!(program.nodes().x.seen, [1, 2, 3, 4, 5, 6]);
    assert_eq!(program.nodes().k.seen, [(1, 0), (2, 1), (3, 2), (4, 3), (5, 4), (6, 5)]);
}

#[test]
fn ev_04_on_the_clock_on_the_wall() {
    let mut program = HurriedForReal::new();
    let mut clock = WallClock::new();
    while program.nodes().b.seen.len() < 6 && clock.now() < Time::from_secs(10) {
        if let Next::At(time) = program.react(clock.now()) {
            clock.wait_until(time);
        }
    }
    assert_eq!(program.nodes().b.seen, [1, 2, 3, 4, 5, 6]);
}

#[test]
fn ev_07_a_node_whose_event_is_undelivered_does_not_fire() {
    let mut program = Undelivered::new();
    let log = simulate(&mut program, Time::ZERO, END);
    assert_eq!(program.nodes().k.seen, [(1, 0), (2, 1), (3, 2), (4, 3), (5, 4)]);
    // One token is after `x`, one before it.
    assert_eq!((log.count("a"), program.nodes().x.seen.len()), (7, 6));
}

#[test]
fn ev_08_a_slot_is_called_between_firings() {
    let mut program = OneAtATime::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [('p', 0), ('s', 0), ('p', 1), ('s', 1), ('p', 2), ('s', 2)]);
}

#[test]
fn ev_09_processed_is_triggered_once_per_firing() {
    let mut program = Processed::new();
    react(&mut program, 3);
    let nodes = program.nodes();
    assert_eq!((nodes.s_told.count, nodes.told.count, nodes.k_told.count), (3, 2, 2));
}

#[test]
fn ev_10_the_slot_of_a_disabled_node_swallows_tokens() {
    let mut program = DisabledSlot::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().b.seen, [1, 4]);
}

#[test]
fn ev_13_an_event_that_feeds_a_join_of_its_own_region() {
    let mut program = Hybrid::new();
    react(&mut program, 7);
    assert_eq!(program.nodes().k.seen, [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4)]);
}

#[test]
fn ev_13_without_the_event_the_region_waits() {
    let mut program = HybridWithout::new();
    let log = react(&mut program, 10);
    assert_eq!(program.nodes().k.seen, [(0, 0)]);
    assert_eq!(log.count("s"), 2, "its second token still waits");
    let mut missing = vec![];
    program.waiting(|connection| missing.push(&HybridWithout::INFO.connections[connection]));
    let names = |node: usize| HybridWithout::INFO.nodes[node].name;
    let missing: Vec<_> = missing.iter().map(|c| (names(c.from), c.output, names(c.to))).collect();
    assert_eq!(missing, [("m", "e", "k")]);
}

#[test]
fn one_event_for_slots_and_inputs() {
    let mut program = FanOut::new();
    react(&mut program, 5);
    let nodes = program.nodes();
    assert_eq!([&nodes.b.seen, &nodes.c.seen, &nodes.d.seen, &nodes.e.seen, &nodes.f.seen], [&[1, 2, 3]; 5]);
}

#[test]
fn two_tokens_for_one_slot_wait_for_each_other() {
    let mut program = TwoForOne::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().x.seen, [1, -1, 2, -2]);
    assert_eq!(program.nodes().y.seen, [1, -1, 2, -2]);
}

#[test]
fn four_tokens_through_a_chain_of_slots() {
    let mut program = FourThroughThree::new();
    simulate(&mut program, Time::ZERO, Time::from_millis(20));
    assert_eq!(program.nodes().z.seen, [1, 2, 3, 4, 1, 2, 3, 4]);
}

#[test]
fn one_event_by_process_and_by_a_slot() {
    let mut program = ProcessAndSlot::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().y.seen, [0, 100, 1, 101, 2, 102]);
}

#[test]
fn a_slot_that_is_held_back_is_passed_over() {
    let mut program = PassedOver::new();
    simulate(&mut program, Time::ZERO, END);
    assert_eq!(program.nodes().x.seen, [1, 2, 3, 4, 5, 6]);
    assert_eq!(program.nodes().y.seen, [-1, -2, -3, -4, -5, -6, -7]);
}

#[test]
fn par_01_over_an_event() {
    let mut program = GainByEvent::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().g.seen, [5, 6, 7]);
    assert_eq!(program.nodes().k.seen, [5, 6, 7]);
}

#[test]
fn bot_06_no_message_calls_no_slot() {
    let mut program = NothingForASlot::new();
    let log = react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [1, 5]);
    assert_eq!(program.nodes().n.seen, [None, Some(1), None, None, Some(5)]);
    assert_eq!((log.count("s"), log.handled.len()), (5, 2));
}

#[test]
fn a_node_with_optional_inputs_waits_for_the_event_too() {
    let mut program = OptionalByEvent::new();
    let log = react(&mut program, 6);
    assert_eq!(program.nodes().e.seen, [7, 8]);
    assert_eq!(log.count("k"), 2);
}

#[test]
fn an_event_meets_a_pace() {
    let mut program = EventMeetsPace::new();
    let log = simulate(&mut program, Time::ZERO, END);
    assert_eq!(program.nodes().k.seen, [(1, 0), (2, 1)]);
    assert_eq!(log.count("b"), 3);
}

#[test]
fn an_event_that_nobody_takes_holds_back() {
    let mut program = Untaken::new();
    let mut log = Log::of(&program);
    let mut taken = vec![];
    for round in 0..30 {
        program.react_with(Time::ZERO, &mut log);
        if round % 3 == 2 {
            taken.extend(program.events().e.take());
        }
    }
    assert_eq!(taken, [0, 1, 2, 3, 4]);
}

#[test]
fn ticks() {
    let mut program = Clocks::new();
    simulate(&mut program, Time::ZERO, END);
    assert_eq!((program.nodes().a.count, program.nodes().b.count), (10, 1));
}

#[test]
fn a_nested_graph_with_every_kind_of_port() {
    let mut program = EveryTwice::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [6, 12, 18]);
    assert_eq!(program.nodes().t.seen, [10, 20, 30]);
    let mut program = EveryCrossed::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [20, 40, 60]);
    assert_eq!(program.nodes().t.seen, [3, 6, 9]);
}

#[test]
fn a_slot_port_that_leads_to_an_input_and_a_slot() {
    let mut program = SplitUsed::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().k.seen, [10, 20, 30]);
    assert_eq!(program.nodes().t.seen, [1, 2, 3]);
}

#[test]
fn an_event_port_with_two_connections() {
    let mut program = TwoIntoEventUsed::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [0, 0, 1, 1, 2, 2]);
}

#[test]
fn a_relay_is_free_when_what_it_leads_to_is() {
    let mut program = Wired::new();
    let log = simulate(&mut program, Time::ZERO, END);
    assert_eq!(program.nodes().k.seen, [(1, 0), (2, 1), (3, 2), (4, 3), (5, 4)]);
    assert_eq!(log.count("a"), 6, "the wire itself has no room");
}

#[test]
fn ports_of_a_graph_turn_one_kind_into_the_other() {
    let mut program = Turned::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().t.seen, [0, 1, 2]);
    assert_eq!(program.nodes().k.seen, [10, 20, 30]);
}

#[test]
fn relays_two_graphs_deep() {
    let mut program = DeepUsed::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().t.seen, [1, 2, 3]);
}

#[test]
fn sub_03_a_graph_with_only_a_clock_inside_sends_events() {
    let mut program = Bells::new();
    simulate(&mut program, Time::ZERO, END);
    assert_eq!(program.nodes().k.count, 20);
}

#[test]
fn what_is_inside_is_switched_and_fails() {
    let mut program = CarefulUsed::new();
    react(&mut program, 6);
    assert_eq!(program.nodes().k.seen, [0, 2, 3, 5]);
    assert_eq!(program.nodes().notes.seen, ["no 4"]);
}

#[test]
fn events_of_one_region_come_in_the_order_of_firing() {
    let mut program = InOrder::new();
    let log = react(&mut program, 3);
    let two_first = log.order().find("two") < log.order().find("one");
    let seen = if two_first { [0, 0, 10, 1, 20, 2] } else { [0, 0, 1, 10, 2, 20] };
    assert_eq!(program.nodes().k.seen, seen);
}

#[test]
fn lc_05_the_end_may_come_from_inside() {
    let mut program = QuitsUsed::new();
    assert_eq!(program.react(Time::ZERO), Next::Now);
    assert_eq!(program.react(Time::ZERO), Next::Exit(0));
}

#[test]
fn one_event_over_two_ways() {
    let mut program = TwoWays::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().k.seen, [1, 1, 2, 2]);
}

#[test]
fn ev_11_an_endless_loop_lets_nothing_else_in() {
    let mut program = SecondHop::new();
    program.set_budget(100);
    let log = react(&mut program, 4);
    assert_eq!(log.count("go"), 1, "slots come first, as long as there are steps left");
    assert!(program.nodes().b.seen.iter().all(|token| *token == 7));
    program.set_budget(1_000);
    let before = program.nodes().b.seen.len();
    react(&mut program, 1);
    assert!((300..=334).contains(&(program.nodes().b.seen.len() - before)), "the token is still on its way");
}

#[test]
fn a_source_does_not_wait_for_what_holds_back_a_loop_beside_it() {
    let mut program = HeldAround::new();
    react(&mut program, 3);
    let nodes = program.nodes();
    assert_eq!((nodes.k.seen.as_slice(), nodes.j.seen.as_slice()), (&[0, 1][..], &[(0, 0)][..]));
    assert_eq!(program.inputs().n.put(9), Ok(()));
    react(&mut program, 3);
    let nodes = program.nodes();
    assert_eq!((nodes.x.seen.as_slice(), nodes.j.seen.as_slice()), (&[(0, 9)][..], &[(0, 0), (1, 0)][..]));
    assert_eq!(nodes.k.seen, [0, 1, 2], "it may fire once more");
}

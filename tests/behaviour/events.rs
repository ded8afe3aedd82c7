//! Slots, events, and connections between synchronous and asynchronous ports.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("events.afg");

#[test]
fn ev_01_one_call_for_each_trigger() {
    let mut program = EventToSlot::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().b.seen, [42, 23]);
}

#[test]
fn ev_02_events_of_one_firing_are_delivered_in_port_order() {
    let mut program = FourToOne::new();
    react(&mut program, 1);
    assert_eq!(program.nodes().b.seen, [1, 2, 3, 4]);
}

#[test]
fn ev_05_an_event_drives_a_region() {
    let mut program = EventToInput::new();
    let log = react(&mut program, 12);
    assert_eq!(program.nodes().c.seen, [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]);
    assert_eq!(log.count("c"), 10);
}

#[test]
fn ev_06_one_call_for_each_message() {
    let mut program = OutputToSlot::new();
    react(&mut program, 5);
    assert_eq!(program.nodes().b.seen, [1, 3]);
}

#[test]
fn ev_11_an_endless_loop_is_reported() {
    let mut program = PingPong::new();
    program.set_budget(10_000);
    let log = react(&mut program, 1);
    let hops = program.nodes().a.seen.len() + program.nodes().b.seen.len();
    assert!((9_900..=10_000).contains(&hops), "{hops} hops");
    assert_eq!(log.endless.iter().map(|(node, _)| *node).collect::<Vec<_>>(), ["b", "a"]);
}

#[test]
fn ev_12_slots_and_events_of_a_nested_graph() {
    let mut program = Relayed::new();
    let log = react(&mut program, 4);
    assert_eq!(program.nodes().inner.pass.seen, [0, 1, 2]);
    assert_eq!(program.nodes().outer.seen, [0, 1, 2]);
    assert_eq!(log.handled.join(" "), "inner.pass outer inner.pass outer inner.pass outer");
}

#[test]
fn a_program_has_slots_and_events() {
    let mut program = Ports::new();
    program.inputs().s.put(1).unwrap();
    program.react(Time::ZERO);
    program.inputs().s.put(2).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().pass.seen, [1, 2]);
    assert_eq!(program.outputs().y, Some(2));
    // The event has room for one token, and so has the connection to it.
    assert_eq!(program.events().e.take(), Some(1));
    program.inputs().x.put(3).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.nodes().pass.seen, [1, 2, 3]);
    assert_eq!(program.events().e.take(), Some(2));
    program.react(Time::ZERO);
    assert_eq!(program.events().e.take(), Some(3));
}

/// Connections whose tokens were said to wait forever.
#[derive(Default)]
struct Knots(Vec<usize>);

impl Observer for Knots {
    fn stuck(&mut self, connection: usize) {
        self.0.push(connection);
    }
}

#[test]
fn tokens_that_wait_for_one_another_are_reported_once() {
    let (mut program, mut knots) = (Knot::new(), Knots::default());
    program.react_with(Time::ZERO, &mut knots);
    program.inputs().press.put(1).expect("it is empty");
    program.react_with(Time::from_millis(1), &mut knots);
    let connection = |knot: &usize| &<Knot as Program>::INFO.connections[*knot];
    let names: Vec<&str> = knots.0.iter().map(|knot| <Knot as Program>::INFO.nodes[connection(knot).to].name).collect();
    assert_eq!(names, ["on", "off"]);
    assert!(knots.0.iter().all(|knot| connection(knot).output == "e"));
    // The rest of the program goes on, and it is not said again.
    program.inputs().other.put(7).expect("it is empty");
    program.react_with(Time::from_millis(2), &mut knots);
    assert_eq!((program.nodes().sink.seen.as_slice(), knots.0.len()), (&[7][..], 2));
}

/// Claims that were broken.
#[derive(Default)]
struct Broken(Vec<usize>);

impl Observer for Broken {
    fn claim_failed(&mut self, claim: usize) {
        self.0.push(claim);
    }
}

#[test]
fn the_claim_that_no_tokens_wait_is_checked_where_it_is_not_decided() {
    let (mut program, mut broken) = (ActiveKnot::new(), Broken::default());
    program.react_with(Time::ZERO, &mut broken);
    assert!(broken.0.is_empty());
    for _ in 0..2 {
        program.inputs().press.put(1).expect("it is empty");
        program.react_with(Time::from_millis(1), &mut broken);
        assert_eq!(broken.0, [0]);
    }
}

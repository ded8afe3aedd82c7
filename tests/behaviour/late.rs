//! Late reactions, a time that goes back, silence, and the end of a program.

use apex_macros::graph;
use apex_rt::{drive_with, prelude::*};
use std::{cell::RefCell, time::Duration};

/// Writes down when it is called, by which time, and how late.
#[node]
#[derive(Default)]
pub struct Diary {
    /// Name of the entries: its first letter.
    #[param]
    name: String,
}

thread_local! {
    static ENTRIES: RefCell<Vec<(char, i64)>> = const { RefCell::new(vec![]) };
}

/// Takes all entries: name and time in ms.
fn entries() -> Vec<(char, i64)> {
    ENTRIES.take()
}

fn note(name: char, ctx: &Ctx) {
    ENTRIES.with_borrow_mut(|entries| entries.push((name, ctx.now().as_nanos() / 1_000_000)));
}

#[node]
impl Diary {
    #[slot]
    fn put(&mut self, ctx: &Ctx) {
        note(self.name.chars().next().unwrap_or_default(), ctx);
    }
}

/// Drives while its input says so: it must be called, too, if nothing comes.
#[node]
#[derive(Default)]
pub struct Motor {
    /// Time without a command after which it stops.
    #[param(unit = "s", default = 0.2, silence)]
    silence: f64,
}

#[node]
impl Motor {
    fn process(&mut self, ctx: &Ctx, command: Option<&f64>) -> f64 {
        note(if command.is_some() { 'c' } else { '-' }, ctx);
        command.copied().unwrap_or(0.0)
    }

    /// The end of the program.
    #[on_stop]
    fn halt(&mut self) {
        ENTRIES.with_borrow_mut(|entries| entries.push(('!', 0)));
    }
}

/// Sends `true` from its third call on, and panics at the fifth.
#[node]
#[derive(Default)]
pub struct Brittle {
    calls: u32,
}

#[node]
impl Brittle {
    fn process(&mut self) -> f64 {
        self.calls += 1;
        assert!(self.calls < 5, "it breaks");
        f64::from(self.calls)
    }
}

/// Waits for two tokens.
#[node]
#[derive(Default)]
pub struct Meet;

#[node]
impl Meet {
    fn process(&mut self, ctx: &Ctx, _one: &(), _other: &f64) {
        note('m', ctx);
    }
}

graph! {
    use apex_nodes::flow::{Await, Relay, Wait, constant, tick};
    use crate::late::{Brittle, Diary, Meet, Motor};

    /// Timers and timeouts of several periods, and tokens from outside.
    graph Busy {
        slot  stop;
        slot  go;
        node fast  = tick() every 20ms;
        node slow  = tick() every 50ms;
        node work  = Relay() timeout 90ms;
        node rest  = Wait() timeout 30ms;
        node late  = Wait() timeout 40ms;
        start         => work.enable;
        go            -> work.put;
        work.signal   => late.activate;
        late.timeout  => rest.activate;
        work.timeout  => rest.activate;
        rest.timeout  => work.enable;
        stop          -> [work.cancel, Diary(name = "s")];
        go            -> Diary(name = "g");
        fast          -> Diary(name = "f");
        slow          -> Diary(name = "l");
        work.timeout  -> Diary(name = "w");
        late.timeout  -> Diary(name = "a");
        rest.timeout  -> Diary(name = "r");
    }

    /// Writes down that the time went back.
    graph Told {
        set_back -> Diary(name = "b");
    }

    graph Looped {
        node told = Told();
    }

    /// The same, on another thread, and in a nested graph.
    graph LoopedFar {
        node told = Told() on motors;
        set_back -> Diary(name = "a");
        tick() every 50ms -> Diary(name = "t");
    }

    /// The event leads to a slot that has to wait for a source.
    graph LoopedSlowly {
        node relay = Relay();
        node pair  = Meet();
        set_back                     -> relay.put;
        relay.signal                 -> pair.one;
        constant(value = 1.0) after 1s -> pair.other;
    }

    /// A ring in which nothing circulates, and a timer.
    graph Ring {
        node one = Relay();
        node two = Await();
        tick() every 1ms -> one.put;
        one.signal       -> two.put;
        two.signal       -> one.put;
    }

    /// A token from outside and a timer at the same instant.
    graph Both {
        slot go;
        go                 -> Diary(name = "g");
        tick() every 100Hz -> Diary(name = "t");
    }

    /// The same on another thread.
    graph BothFar {
        slot go;
        node both = Nested() on other;
        go -> both.go;
    }

    graph Nested {
        slot go;
        go                -> Diary(name = "g");
        tick() every 10ms -> Diary(name = "t");
    }

    /// A late source that skips, beside one that does not.
    graph Skipping {
        node one = tick() every 10ms skip;
        node all = tick() every 10ms;
        one -> Diary(name = "s");
        all -> Diary(name = "a");
    }

    /// The order in which tokens come from outside.
    graph Order {
        slot a;
        slot b;
        slot c;
        a -> Diary(name = "a");
        b -> Diary(name = "b");
        c -> Diary(name = "c");
    }

    /// A success and a timeout.
    graph Race {
        slot  done;
        node work = Relay() timeout 1s;
        node good = Wait();
        node bad  = Wait();
        start        => work.enable;
        done         -> work.put;
        work.signal  => good.activate;
        work.timeout => bad.activate;
    }

    /// A source that is to be heard.
    graph Sensor {
        node sensor = tick() every 100ms timeout 250ms;
        sensor         -> Diary(name = "v");
        sensor.timeout -> Diary(name = "?");
    }

    /// A motor behind an input of the program.
    graph Driving {
        in  command: f64;
        out sent: f64;
        node motor = Motor();
        command -> motor -> sent;
    }

    /// A motor that joins two inputs, one of which may be silent.
    graph Joined {
        in  a: f64;
        in  b: f64;
        out sent: f64;
        node sum   = apex_nodes::math::add();
        node motor = Motor();
        a -> sum.a;
        b -> sum.b;
        sum -> motor -> sent;
    }

    /// A motor behind an event.
    graph ByEvent {
        slot  command: f64;
        out   sent: f64;
        node relay = Relay<f64>();
        node motor = Motor();
        command      -> relay.put;
        relay.signal -> motor -> sent;
    }

    /// A motor on another thread than its commands.
    graph Apart {
        out  sent: f64;
        node source = Brittle() every 50ms on other;
        node motor  = Motor();
        source -> motor -> sent;
        source.failed -> apex_nodes::flow::Signal();
    }

    /// Ends by a panic.
    graph Breaking {
        node source = Brittle() every 50ms;
        node motor  = Motor();
        source -> motor;
    }
}

/// Reacts at each of `times`, in ms, and puts tokens in before with `put`.
fn react<P: Program>(program: &mut P, times: impl IntoIterator<Item = i64>, put: impl Fn(&mut P, i64)) {
    for ms in times {
        put(program, ms);
        program.react_with(Time::from_millis(ms), &mut ());
    }
}

/// Reacts whenever the program wants to, until `end` ms.
fn on_time<P: Program>(program: &mut P, end: i64) {
    let mut now = Time::ZERO;
    while now <= Time::from_millis(end) {
        match program.react_with(now, &mut ()) {
            Next::At(time) => now = time,
            next => panic!("{next:?}"),
        }
    }
}

#[test]
fn a_late_reaction_is_the_reactions_that_were_missed() {
    on_time(&mut Busy::new(), 1000);
    let expected = entries();
    assert!(expected.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{expected:?}");
    assert!(['f', 'l', 'w', 'r'].iter().all(|name| expected.iter().any(|(entry, _)| entry == name)), "{expected:?}");
    // However long the program was busy with something else, and at which times.
    for times in [vec![0, 1000], vec![0, 7, 333, 334, 1000], (0..=1000).step_by(25).collect(), vec![1000]] {
        react(&mut Busy::new(), times.iter().copied(), |_, _| {});
        assert_eq!(entries(), expected, "with reactions at {times:?}");
    }
}

#[test]
fn what_came_in_time_counts_before_a_timeout() {
    let mut race = Race::new();
    react(&mut race, [0, 850], |_, _| {});
    assert_eq!(race.inputs().done.put(()), Ok(()));
    race.react(Time::from_millis(1050));
    let active = |name| Race::INFO.nodes.iter().position(|node| node.name == name).is_some_and(|n| race.is_active(n));
    assert!(active("good") && !active("bad"));
    // The sensor was read at 200, 300 and 400 ms.
    react(&mut Sensor::new(), [0, 100, 400], |_, _| {});
    assert_eq!(entries(), [('v', 0), ('v', 100), ('v', 200), ('v', 300), ('v', 400)]);
}

#[test]
fn tokens_from_outside_keep_the_order_in_which_they_were_put_in() {
    for order in ["abc", "cba", "bca", "cab"] {
        let mut program = Order::new();
        for port in order.chars() {
            let inputs = program.inputs();
            let slot = match port {
                'a' => &mut inputs.a,
                'b' => &mut inputs.b,
                _ => &mut inputs.c,
            };
            assert_eq!(slot.put(()), Ok(()));
        }
        program.react(Time::ZERO);
        let came: String = entries().into_iter().map(|(name, _)| name).collect();
        assert_eq!(came, order);
    }
}

#[test]
fn a_source_may_skip_what_it_has_missed() {
    react(&mut Skipping::new(), [0, 10, 20, 75, 80, 90], |_, _| {});
    let entries = entries();
    let of = |name| entries.iter().filter(|entry| entry.0 == name).map(|entry| entry.1).collect::<Vec<_>>();
    assert_eq!(of('s'), [0, 10, 20, 70, 80, 90]);
    assert_eq!(of('a'), [0, 10, 20, 30, 40, 50, 60, 70, 80, 90]);
}

/// Observer of times that were set back.
#[derive(Default)]
struct SetBack(Vec<Duration>);

impl Observer for SetBack {
    fn set_back(&mut self, by: Duration) {
        self.0.push(by);
    }
}

#[test]
fn a_time_that_goes_back_is_reported_and_the_programs_own_time_goes_on() {
    let (mut program, mut seen) = (Sensor::new(), SetBack::default());
    for ms in [0, 100, 200] {
        program.react_with(Time::from_millis(ms), &mut seen);
    }
    assert!(seen.0.is_empty());
    // The recording begins again.
    let next = program.react_with(Time::ZERO, &mut seen);
    assert_eq!((next, seen.0.as_slice()), (Next::At(Time::from_millis(100)), &[Duration::from_millis(200)][..]));
    for ms in [100, 200] {
        program.react_with(Time::from_millis(ms), &mut seen);
    }
    assert_eq!(seen.0.len(), 1, "it is said once");
    assert_eq!(entries(), [('v', 0), ('v', 100), ('v', 200), ('v', 300), ('v', 400)]);
}

#[test]
fn an_event_says_that_the_time_has_gone_back() {
    let mut program = Looped::new();
    for ms in [10, 20, 20, 0, 10, 5, 30] {
        program.react(Time::from_millis(ms));
    }
    assert_eq!(entries(), [('b', 20), ('b', 30)], "in the program's own time");

    let mut program = LoopedFar::new();
    for ms in [0, 50, 0, 50] {
        program.react(Time::from_millis(ms));
    }
    assert_eq!(entries(), [('t', 0), ('t', 50), ('a', 50), ('b', 50), ('t', 100)]);

    // It is not forgotten while its slot waits; several times count as one.
    let mut program = LoopedSlowly::new();
    for ms in [500, 400, 300, 200, 100, 90] {
        program.react(Time::from_millis(ms));
    }
    assert_eq!(entries(), []);
    program.react(Time::from_millis(600));
    assert_eq!(entries(), [('m', 1000)]);
}

/// Observer of endless loops.
#[derive(Default)]
struct Endless(usize);

impl Observer for Endless {
    fn endless(&mut self, _nodes: &[usize], _counts: &[u32]) {
        self.0 += 1;
    }
}

#[test]
fn what_is_made_up_for_is_not_an_endless_loop() {
    let (mut program, mut seen) = (Ring::new(), Endless::default());
    program.set_budget(10);
    for ms in [0, 10_000] {
        program.react_with(Time::from_millis(ms), &mut seen);
    }
    assert_eq!(seen.0, 0);
}

#[test]
fn a_token_from_outside_comes_before_the_timers_of_its_instant_on_any_thread() {
    let (mut one, mut two) = (Both::new(), BothFar::new());
    for ms in [0, 5, 10, 20] {
        for slot in [&mut one.inputs().go, &mut two.inputs().go] {
            assert_eq!(slot.put(()), Ok(()));
        }
        one.react(Time::from_millis(ms));
        let expected = entries();
        two.react(Time::from_millis(ms));
        assert_eq!(entries(), expected, "at {ms} ms");
        assert_eq!(expected.first().map(|entry| entry.0), Some('g'));
    }
}

#[test]
fn nothing_that_comes_is_an_input() {
    let mut program = Driving::new();
    assert_eq!(program.react(Time::ZERO), Next::Input, "nothing has ever come: nothing moves");
    assert_eq!(program.inputs().command.put(0.5), Ok(()));
    assert_eq!(program.react(Time::from_millis(100)), Next::At(Time::from_millis(300)));
    assert_eq!(program.outputs().sent, Some(0.5));
    program.react(Time::from_millis(299));
    assert_eq!(program.outputs().sent, Some(0.5));
    program.react(Time::from_millis(300));
    assert_eq!(program.outputs().sent, Some(0.0));
    // A parameter of the node, which can change.
    assert!(program.set_param("motor.silence", 1.0).is_ok());
    assert_eq!(program.inputs().command.put(0.7), Ok(()));
    assert_eq!(program.react(Time::from_millis(400)), Next::At(Time::from_millis(1400)));
    assert_eq!(entries(), [('c', 100), ('-', 300), ('c', 400)]);
}

#[test]
fn one_of_two_inputs_is_silent() {
    let mut program = Joined::new();
    let put = |program: &mut Joined, ms: i64| {
        // A token that finds no room waits outside.
        let _ = program.inputs().a.put(1.0);
        if ms < 100 {
            let _ = program.inputs().b.put(1.0);
        }
    };
    react(&mut program, (0..1000).step_by(50), put);
    assert_eq!(entries(), [('c', 0), ('c', 50), ('-', 250), ('-', 450), ('-', 650), ('-', 850)]);
    assert_eq!(program.outputs().sent, Some(0.0));
    // It is heard again.
    assert_eq!(program.inputs().b.put(1.0), Ok(()));
    let _ = program.inputs().a.put(1.0);
    program.react(Time::from_millis(1000));
    assert_eq!(program.outputs().sent, Some(2.0));
    entries();
}

#[test]
fn an_event_is_silent() {
    let mut program = ByEvent::new();
    assert_eq!(program.inputs().command.put(0.5), Ok(()));
    react(&mut program, [0, 100, 199, 200, 300, 400, 450], |_, _| {});
    assert_eq!(program.outputs().sent, Some(0.0));
    assert_eq!(program.inputs().command.put(0.7), Ok(()));
    program.react(Time::from_millis(460));
    assert_eq!(program.outputs().sent, Some(0.7));
    assert_eq!(entries(), [('c', 0), ('-', 200), ('-', 400), ('c', 460)]);
}

#[test]
fn a_thread_group_is_silent() {
    let mut program = Apart::new();
    react(&mut program, (0..=600).step_by(10), |_, _| {});
    // The node fails from its fifth call on, and sends ⊥ then, which is not silence.
    let entries = entries();
    assert_eq!(entries[..6], [('c', 0), ('c', 50), ('c', 100), ('c', 150), ('-', 200), ('-', 250)]);
}

#[test]
fn a_program_stops_however_it_ends() {
    let stops = |entries: Vec<(char, i64)>| entries.into_iter().filter(|entry| entry.0 == '!').count();
    // The clock ends.
    drive_with(Joined::new(), SimClock::until(Time::from_secs(1)), ());
    assert_eq!(stops(entries()), 1);
    // A panic unwinds.
    let ends = std::panic::catch_unwind(|| drive_with(Breaking::new(), SimClock::until(Time::from_secs(1)), ()));
    assert!(ends.is_err());
    assert_eq!(stops(entries()), 1);
}

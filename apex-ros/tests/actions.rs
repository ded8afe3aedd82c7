//! Actions both ways: between two nodes of Apex, with servers that misbehave, and with a program in Python.

mod common;

use apex_macros::graph;
use apex_messages::{
    Action, Service,
    action_msgs::{CancelGoal, CancelGoalResponse, GoalInfo, GoalStatusArray},
    example_interfaces::{
        Fibonacci, FibonacciFeedback, FibonacciGetResult, FibonacciGetResultRequest, FibonacciGetResultResponse,
        FibonacciGoal, FibonacciResult, FibonacciSendGoal, FibonacciSendGoalResponse,
    },
    unique_identifier_msgs::UUID,
};
use apex_ros::{Endpoint, Kind, Opening, Qos, Ros, Token, key, wire_type};
use apex_rt::{PortReceiver, PortSender, Ports, Switch, UntilStopped, drive_from, prelude::*};
use common::{
    Collected, Router,
    python::{Peer, python},
    within,
};
use std::{
    env,
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};
use zenoh::Wait as _;

/// Counts in the way of Fibonacci while it is active.
#[node]
#[derive(Default)]
pub struct Count {
    order: usize,
    sequence: Vec<i32>,
}

#[node]
impl Count {
    fn process(&mut self, ctx: &Ctx, feedback: Event<FibonacciFeedback>, result: Event<FibonacciResult>) {
        if !ctx.active() {
            return;
        }
        match self.sequence[..] {
            [.., a, b] if self.sequence.len() < self.order => {
                self.sequence.push(a.wrapping_add(b));
                feedback.emit(FibonacciFeedback { sequence: self.sequence.clone() });
            }
            _ => result.emit(FibonacciResult { sequence: self.sequence.clone() }),
        }
    }

    /// Begins.
    #[slot]
    fn begin(&mut self, goal: &FibonacciGoal) {
        self.order = goal.order.try_into().unwrap_or(0);
        self.sequence = vec![0, 1];
    }
}

graph!("actions.afg");

/// A program that runs beside ROS until it is dropped.
struct Running {
    stop: &'static Switch,
    driver: Option<JoinHandle<u8>>,
    ros: Option<Ros>,
}

impl Running {
    fn start<P: Program + Send + 'static>(ros: Ros, mut program: P, ports: Ports<P>) -> Self
    where
        Ports<P>: Send,
    {
        let stop: &'static Switch = Box::leak(Box::default());
        ros.set_params(&mut program).expect("parameters");
        let clock = UntilStopped::new(ros.clock(), stop);
        Self { stop, driver: Some(thread::spawn(move || drive_from(program, clock, ports))), ros: Some(ros) }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.set();
        drop(self.driver.take().map(JoinHandle::join));
        drop(self.ros.take());
    }
}

/// A node that serves `/fibonacci`.
fn counting(opening: Opening) -> Running {
    let ros = opening.open().expect("a node");
    let mut ports = Ports::<Counting>::new();
    let (orders, reports) = (ports.input(|inputs| &mut inputs.orders), ports.event(|events| &mut events.reports));
    ros.serve_goals::<Fibonacci>("fibonacci").through(orders, reports).expect("an action");
    Running::start(ros, Counting::new(), ports)
}

/// A node that sends goals to `/fibonacci`, and what becomes of them.
struct Asker {
    action: String,
    want: PortSender<FibonacciGoal>,
    stop: PortSender<()>,
    /// Words for what becomes of the goals, in its order.
    fates: Collected<String>,
    feedback: Collected<Vec<i32>>,
    results: Collected<Vec<i32>>,
    said: Collected<String>,
    running: Running,
}

fn collect<T: Send + 'static>(port: PortReceiver<T>, add: impl Fn(T) + Send + 'static) {
    thread::spawn(move || std::iter::from_fn(|| port.receive()).for_each(add));
}

impl Asker {
    fn start(opening: Opening, timeout: Duration) -> Self {
        Self::of("fibonacci", opening, timeout)
    }

    fn of(action: &str, opening: Opening, timeout: Duration) -> Self {
        let said = Collected::new();
        let say = said.collector();
        let ros = opening.tell(move |text| say(text.to_owned())).open().expect("a node");
        let mut ports = Ports::<Asking>::new();
        let (orders, reports) = (ports.event(|events| &mut events.orders), ports.input(|inputs| &mut inputs.reports));
        let goals = ros.send_goals::<Fibonacci>(action).timeout(timeout);
        goals.through(orders, reports).expect("an action");
        let (fates, feedback, results) = (Collected::new(), Collected::new(), Collected::new());
        collect(ports.event(|events| &mut events.fates), fates.collector());
        let add = feedback.collector();
        collect(ports.event(|events| &mut events.feedback), move |feedback| add(feedback.sequence));
        let add = results.collector();
        collect(ports.event(|events| &mut events.result), move |result| add(result.sequence));
        let (want, stop) = (ports.input(|inputs| &mut inputs.want), ports.input(|inputs| &mut inputs.stop));
        let (action, running) = (format!("/{action}"), Running::start(ros, Asking::new(), ports));
        Self { action, want, stop, fates, feedback, results, said, running }
    }

    fn at(router: &Router, name: &str) -> Self {
        Self::start(router.node(name), Duration::from_secs(10))
    }

    /// An asker that sees its server.
    fn ready(router: &Router, name: &str) -> Self {
        let asker = Self::at(router, name);
        asker.meets();
        asker
    }

    /// Waits until the node sees a server.
    fn meets(&self) {
        let ros = self.running.ros.as_ref().expect("it runs");
        let goals = format!("{}/_action/send_goal", self.action);
        within(15.0, "a server", || ros.sees(Kind::Server, &goals, FibonacciSendGoal::NAME));
        // A route comes a moment after the token.
        thread::sleep(Duration::from_millis(200));
    }

    fn want(&self, order: i32) {
        self.want.send(FibonacciGoal { order }).expect("it runs");
    }

    fn stop(&self) {
        self.stop.send(()).expect("it runs");
    }

    /// Waits until exactly this has become of the goals. Returns how long it took.
    fn expect(&self, seconds: f32, fates: &[&str]) -> Duration {
        let start = Instant::now();
        self.fates.wait(Duration::from_secs_f32(seconds), |all| all == fates);
        assert_eq!(self.fates.all(), fates, "within {seconds} s; said: {:?}", self.said.all());
        start.elapsed()
    }

    /// The result of order 8, and parts of it before.
    fn expect_fibonacci_of_8(&self) {
        let result = [0, 1, 1, 2, 3, 5, 8, 13];
        self.results.expect(&[result]);
        // The result may overtake the last ones.
        within(15.0, "feedback", || self.feedback.all().len() > 2);
        let feedback = self.feedback.all();
        assert!(feedback.iter().all(|some| result.starts_with(some)), "{feedback:?}");
    }

    /// Nothing more happens.
    fn expect_no_more(&self, fates: &[&str]) {
        thread::sleep(Duration::from_millis(500));
        assert_eq!(self.fates.all(), fates);
    }
}

/// States of the goals of `/fibonacci`, of which the last message comes to those who are late.
fn states(ros: &Ros) -> Collected<Vec<i8>> {
    let states = Collected::new();
    let add = states.collector();
    ros.subscribe("/fibonacci/_action/status")
        .transient_local()
        .each(move |array: GoalStatusArray| add(array.status_list.iter().map(|status| status.status).collect()))
        .expect("a topic");
    states
}

#[test]
fn a_goal_is_carried_out_by_another_node() {
    let router = Router::start();
    let _server = counting(router.node("counter"));
    let asker = Asker::ready(&router, "asker");
    asker.want(8);
    asker.expect(15.0, &["accepted", "succeeded"]);
    asker.expect_fibonacci_of_8();

    // Whoever comes late finds the state and the result.
    let late = router.node("late").open().expect("a node");
    let ids = Collected::new();
    let add = ids.collector();
    late.subscribe("/fibonacci/_action/status")
        .transient_local()
        .depth(1)
        .each(move |array: GoalStatusArray| {
            array.status_list.into_iter().for_each(|status| add((status.status, status.goal_info.goal_id)));
        })
        .expect("a topic");
    within(15.0, "the state", || ids.all().len() == 1 && ids.all()[0].0 == 4);
    let get = late.call::<FibonacciGetResult>("/fibonacci/_action/get_result").open().expect("a client");
    within(15.0, "a server", || late.sees(Kind::Server, "/fibonacci/_action/get_result", FibonacciGetResult::NAME));
    for _ in 0..2 {
        let response = get.ask(&FibonacciGetResultRequest { goal_id: ids.all()[0].1.clone() }).expect("a result");
        assert_eq!((response.status, response.result.sequence.len()), (4, 8));
    }
    let unknown = get.ask(&FibonacciGetResultRequest { goal_id: UUID { uuid: [9; 16] } }).expect("an answer");
    assert_eq!(unknown.status, 0);
}

#[test]
fn whoever_loses_its_activity_calls_its_goal_off() {
    let router = Router::start();
    let _server = counting(router.node("counter"));
    let asker = Asker::ready(&router, "asker");
    let witness = router.node("witness").open().expect("a node");
    let states = states(&witness);
    asker.want(1000);
    asker.expect(15.0, &["accepted"]);
    within(15.0, "it is carried out", || states.all().last().is_some_and(|last| last == &[2]));
    asker.stop();
    within(15.0, "it is called off", || states.all().last().is_some_and(|last| last == &[5]));
    assert!(states.all().contains(&vec![3]), "{:?}", states.all());
    let count = asker.feedback.all().len();
    asker.expect_no_more(&["accepted"]);
    assert_eq!(asker.feedback.all().len(), count);
    // The server is ready for the next one, and the end of a program is the end of its goals.
    asker.want(1000);
    asker.expect(15.0, &["accepted", "accepted"]);
    drop(asker);
    within(15.0, "it is called off", || states.all().last().is_some_and(|last| last == &[5, 5]));
}

#[test]
fn a_second_goal_takes_the_place_of_the_first_or_is_refused() {
    let router = Router::start();
    let server = counting(router.node("counter"));
    let (first, second) = (Asker::ready(&router, "first"), Asker::ready(&router, "second"));
    first.want(1000);
    first.expect(15.0, &["accepted"]);
    second.want(4);
    second.expect(15.0, &["accepted", "succeeded"]);
    first.expect(15.0, &["accepted", "aborted"]);
    drop(server);
    let args = ["--ros-args", "-p", "serve.preempts:=false"];
    let _server = counting(router.node("counter").args(args));
    let (first, second) = (Asker::ready(&router, "third"), Asker::ready(&router, "fourth"));
    first.want(50);
    first.expect(15.0, &["accepted"]);
    second.want(4);
    second.expect(15.0, &["rejected"]);
    first.expect(15.0, &["accepted", "succeeded"]);
}

#[test]
fn without_a_server_a_goal_is_lost_in_three_seconds_and_in_words() {
    let router = Router::start();
    let asker = Asker::at(&router, "asker");
    asker.want(3);
    asker.expect(3.0, &["lost"]);
    within(1.0, "words", || asker.said.all().iter().any(|text| text == "no node serves `/fibonacci`"));
    // One comes.
    let _server = counting(router.node("counter"));
    asker.meets();
    asker.want(3);
    asker.expect(15.0, &["lost", "accepted", "succeeded"]);
}

/// Services of an action, answered by functions.
struct Odd {
    ros: Ros,
    cancels: Collected<UUID>,
}

impl Odd {
    fn start(
        router: &Router,
        accept: impl FnMut() -> bool + Send + 'static,
        end: impl FnMut() -> FibonacciGetResultResponse + Send + 'static,
    ) -> Self {
        let (ros, cancels) = (router.node("odd").open().expect("a node"), Collected::new());
        let (mut accept, mut end, add) = (accept, end, cancels.collector());
        ros.serve::<FibonacciGetResult>("/fibonacci/_action/get_result").by(move |_| end()).expect("a service");
        ros.serve::<CancelGoal>("/fibonacci/_action/cancel_goal")
            .by(move |request| {
                let goal_id = request.goal_info.goal_id;
                add(goal_id.clone());
                let goals_canceling = vec![GoalInfo { goal_id, ..GoalInfo::default() }];
                CancelGoalResponse { goals_canceling, ..CancelGoalResponse::default() }
            })
            .expect("a service");
        ros.serve::<FibonacciSendGoal>("/fibonacci/_action/send_goal")
            .by(move |_| FibonacciSendGoalResponse { accepted: accept(), ..FibonacciSendGoalResponse::default() })
            .expect("a service");
        Self { ros, cancels }
    }
}

fn pause<T>(ms: u64, then: T) -> T {
    thread::sleep(Duration::from_millis(ms));
    then
}

fn response(status: i8) -> FibonacciGetResultResponse {
    FibonacciGetResultResponse { status, result: FibonacciResult { sequence: vec![7] } }
}

#[test]
fn a_server_that_accepts_after_the_cancel_gets_it() {
    let router = Router::start();
    let server = Odd::start(&router, || pause(800, true), || pause(100, response(4)));
    let asker = Asker::ready(&router, "asker");
    asker.want(3);
    thread::sleep(Duration::from_millis(200));
    asker.stop();
    assert!(server.cancels.all().is_empty(), "there is nothing to call off yet");
    within(3.0, "the cancel", || server.cancels.all().len() == 1);
    asker.expect_no_more(&[]);
}

#[test]
fn a_server_that_never_answers_is_said_and_given_up() {
    let router = Router::start();
    let is_awake = Arc::new(AtomicBool::new(false));
    let wakes = Arc::clone(&is_awake);
    let sleeps = move || {
        while !wakes.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(10));
        }
        true
    };
    let server = Odd::start(&router, sleeps, || response(4));
    let asker = Asker::start(router.node("asker"), Duration::from_secs(4));
    asker.meets();
    asker.want(3);
    within(3.0, "words", || {
        asker
            .said
            .all()
            .iter()
            .any(|text| text == "`/fibonacci`: the server is there, but has neither accepted nor rejected a goal")
    });
    asker.expect(3.0, &["lost"]);
    // It accepts after all.
    is_awake.store(true, Ordering::Relaxed);
    within(3.0, "the cancel", || server.cancels.all().len() == 1);
    asker.expect_no_more(&["lost"]);
}

#[test]
fn a_slow_server_may_take_its_time() {
    let router = Router::start();
    let server = Odd::start(&router, || pause(1000, true), || pause(4000, response(6)));
    let asker = Asker::ready(&router, "asker");
    asker.want(3);
    asker.expect(20.0, &["accepted", "aborted"]);
    asker.results.expect(&[[7]]);
    asker.expect_no_more(&["accepted", "aborted"]);
    assert_eq!((server.cancels.all().len(), asker.said.all()), (0, vec![]));
    drop(server.ros);
}

#[test]
fn a_status_that_is_no_end_is_no_success() {
    let router = Router::start();
    let _server = Odd::start(&router, || true, || response(0));
    let asker = Asker::ready(&router, "asker");
    asker.want(3);
    asker.expect(15.0, &["accepted", "lost"]);
}

/// Answers each request twice.
#[test]
fn a_server_that_answers_twice_is_heard_once() {
    use apex_messages::Message as _;
    let router = Router::start();
    let mut config = zenoh::Config::default();
    for (name, value) in [
        ("mode", "\"client\"".to_owned()),
        ("connect/endpoints", format!("[{:?}]", router.address)),
        ("scouting/multicast/enabled", "false".to_owned()),
    ] {
        config.insert_json5(name, &value).expect("a setting");
    }
    let session = zenoh::open(config).wait().expect("a session");
    let serve = |part: &str, (ty, hash): (&str, &str), answers: [Vec<u8>; 2]| {
        let name = format!("/fibonacci/_action/{part}");
        let key = key(0, &name, &wire_type(ty), hash);
        let to = key.clone();
        let answer = move |query: zenoh::query::Query| {
            for bytes in &answers {
                drop(query.reply(&to, bytes.clone()).wait());
            }
        };
        let queryable = session.declare_queryable(key).complete(true).callback(answer).wait().expect("a service");
        let (wire_type, hash) = (wire_type(ty), hash.to_owned());
        let token = Token {
            domain: 0,
            session: session.zid().to_string(),
            node_id: 0,
            id: part.len() as u64,
            enclave: String::new(),
            namespace: "/".to_owned(),
            node: "twice".to_owned(),
            endpoint: Some(Endpoint { kind: Kind::Server, name, wire_type, hash, qos: Qos::DEFAULT }),
        };
        (queryable, session.liveliness().declare_token(token.to_string()).wait().expect("a token"))
    };
    let answer = |accepted| FibonacciSendGoalResponse { accepted, ..FibonacciSendGoalResponse::default() }.to_bytes();
    let of = |service: &'static str, hash: &'static str| (service, hash);
    let kept = (
        serve(
            "get_result",
            of(FibonacciGetResult::NAME, FibonacciGetResult::HASH),
            [response(4).to_bytes(), response(6).to_bytes()],
        ),
        serve("send_goal", of(FibonacciSendGoal::NAME, FibonacciSendGoal::HASH), [answer(true), answer(false)]),
    );
    let asker = Asker::ready(&router, "asker");
    let mut expected = vec![];
    for _ in 0..10 {
        asker.want(3);
        expected.extend(["accepted", "succeeded"]);
        asker.expect(15.0, &expected);
    }
    asker.expect_no_more(&expected);
    drop(kept);
}

/// Environment variable with the address of the router for the other process of these tests.
const ADDRESS: &str = "APEX_ROS_TEST_COUNTER";

/// The other process: a server, until it is killed.
#[test]
fn other_process() {
    let Ok(address) = env::var(ADDRESS) else { return };
    let _server = counting(Ros::node("counter").args([""; 0]).domain(0).router(&address));
    thread::sleep(Duration::from_secs(60));
}

fn other(router: &Router) -> Child {
    let child = Command::new(env::current_exe().expect("this test"))
        .args(["other_process", "--exact", "--quiet"])
        .env(ADDRESS, &router.address)
        .stdout(Stdio::null())
        .spawn();
    child.expect("it starts")
}

#[test]
fn a_server_that_is_killed_loses_its_goals_in_three_seconds_and_in_words() {
    let router = Router::start();
    let asker = Asker::at(&router, "asker");
    let mut server = other(&router);
    asker.meets();
    asker.want(1000);
    asker.expect(15.0, &["accepted"]);
    within(15.0, "feedback", || !asker.feedback.all().is_empty());
    server.kill().expect("it runs");
    server.wait().expect("it ends");
    let took = asker.expect(3.0, &["accepted", "lost"]);
    println!("lost after {took:?}");
    within(1.0, "words", || asker.said.all().iter().any(|text| text == "no node serves `/fibonacci`"));
    // One that is started again at once does not know the goal.
    let mut server = other(&router);
    asker.meets();
    asker.want(1000);
    asker.expect(15.0, &["accepted", "lost", "accepted"]);
    server.kill().expect("it runs");
    server.wait().expect("it ends");
    let mut server = other(&router);
    asker.expect(20.0, &["accepted", "lost", "accepted", "lost"]);
    asker.meets();
    asker.want(3);
    asker.expect(20.0, &["accepted", "lost", "accepted", "lost", "accepted", "succeeded"]);
    server.kill().expect("it runs");
    server.wait().expect("it ends");
}

#[test]
fn goals_of_a_run_with_a_seed_have_the_same_identifications() {
    let ids = || {
        let router = Router::start();
        let (node, ids) = (router.node("odd").open().expect("a node"), Collected::new());
        let add = ids.collector();
        node.serve::<FibonacciSendGoal>("/fibonacci/_action/send_goal")
            .by(move |request| {
                add(request.goal_id.uuid);
                FibonacciSendGoalResponse::default()
            })
            .expect("a service");
        let asker = Asker::start(router.node("asker").seed(5), Duration::from_secs(10));
        asker.meets();
        for count in 1..=3 {
            asker.want(3);
            within(15.0, "a goal", || ids.all().len() == count && asker.fates.all().len() == count);
        }
        ids.all()
    };
    let first = ids();
    assert_eq!(first, ids());
    assert!(first[0] != first[1] && first[1] != first[2]);
    // Names of types follow from the action.
    assert_eq!(<Fibonacci as Action>::SendGoal::NAME, FibonacciSendGoal::NAME);
}

/// A program in Python with an action, and with a client of another one.
fn peer() -> Option<Peer> {
    let types = [
        format!("{}={}", FibonacciSendGoal::NAME, FibonacciSendGoal::HASH),
        format!("{}={}", FibonacciGetResult::NAME, FibonacciGetResult::HASH),
        format!("{}={}", CancelGoal::NAME, CancelGoal::HASH),
    ];
    Some(Peer::start(&*python()?, "action_peer.py", &types.each_ref().map(String::as_str)))
}

#[test]
fn a_program_in_python_carries_goals_out() {
    let Some(peer) = peer() else { return };
    let opening = Ros::node("asker").args([""; 0]).domain(0).router(&peer.address);
    let asker = Asker::of("py_fibonacci", opening, Duration::from_secs(10));
    asker.meets();
    asker.want(8);
    asker.expect(15.0, &["accepted", "succeeded"]);
    asker.expect_fibonacci_of_8();
    asker.want(66);
    asker.expect(15.0, &["accepted", "succeeded", "rejected"]);
    asker.want(99);
    asker.expect(15.0, &["accepted", "succeeded", "rejected", "accepted"]);
    asker.stop();
    within(15.0, "the cancel", || peer.says("cancel 0 0") && peer.says("ended 5"));
    for line in ["goal 8 v4", "goal 66 v4", "goal 99 v4"] {
        assert!(peer.says(line), "{line}");
    }
    asker.expect_no_more(&["accepted", "succeeded", "rejected", "accepted"]);
}

#[test]
fn a_program_in_python_has_its_goals_carried_out() {
    let Some(mut peer) = peer() else { return };
    let _server = counting(Ros::node("counter").args([""; 0]).domain(0).router(&peer.address));
    // Each line, by waiting for its answer.
    let does = |peer: &mut Peer, word: &str, answer: &str| {
        peer.does(word);
        within(20.0, &format!("{answer} after {word}, but {:?}", peer.lines.all()), || peer.says(answer));
    };
    within(20.0, "an answer", || {
        peer.does("result 9");
        thread::sleep(Duration::from_millis(200));
        peer.says("result 0")
    });
    does(&mut peer, "goal 1 6", "accepted");
    // It asks while the goal is under way, and again when it has ended.
    does(&mut peer, "result 1", "result 4 0 1 1 2 3 5");
    does(&mut peer, "result 1", "result 4 0 1 1 2 3 5");
    does(&mut peer, "goal 1 6", "refused");
    does(&mut peer, "goal 2 1000", "feedback 0 1 1");
    does(&mut peer, "cancel 2", "canceling 0 1");
    within(15.0, "the states", || peer.says("states 4 5"));
    does(&mut peer, "result 2", "result 5");
    does(&mut peer, "cancel 2", "canceling 3 0");
    does(&mut peer, "cancel 7", "canceling 2 0");
}

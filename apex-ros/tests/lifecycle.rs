//! A managed node: its services, its transitions, and its silence.

mod common;

use apex_macros::graph;
use apex_messages::{
    Service,
    lifecycle_msgs::{
        ChangeState, ChangeStateRequest, GetAvailableStates, GetAvailableStatesRequest, GetAvailableTransitions,
        GetAvailableTransitionsRequest, GetState, GetStateRequest, Transition, TransitionEvent,
    },
};
use apex_nodes::lifecycle::Outcome;
use apex_ros::{Client, Distribution, Kind, Ros};
use apex_rt::{PortReceiver, PortSender, Ports, Switch, UntilStopped, drive_from};
use common::{
    Collected, Router,
    python::{Peer, python},
    within,
};
use std::{
    sync::{Arc, Mutex},
    thread::{self, JoinHandle},
    time::Duration,
};

graph!("lifecycle.afg");

fn client<S: Service + 'static>(ros: &Ros, name: &str) -> Client<S>
where
    S::Request: Send,
{
    let client = ros.call::<S>(name).timeout(Duration::from_secs(5)).open().expect("a client");
    within(15.0, "a server", || ros.sees(Kind::Server, name, S::NAME));
    client
}

/// Manager of `/robot`.
struct Manager {
    ros: Ros,
    change: Client<ChangeState>,
    state: Client<GetState>,
    events: Collected<String>,
}

impl Manager {
    fn new(router: &Router) -> Self {
        let ros = router.node("manager").open().expect("a node");
        let (change, state) = (client(&ros, "/robot/change_state"), client(&ros, "/robot/get_state"));
        let events = Collected::new();
        let add = events.collector();
        ros.subscribe("/robot/transition_event")
            .each(move |event: TransitionEvent| {
                assert!(event.timestamp > 0);
                let TransitionEvent { transition, start_state, goal_state, .. } = event;
                add(format!("{}: {} -> {}", transition.label, start_state.label, goal_state.label));
            })
            .expect("a topic");
        // A route for data comes a moment after the token.
        thread::sleep(Duration::from_millis(300));
        Self { ros, change, state, events }
    }

    fn change(&self, label: &str) -> bool {
        let transition = Transition { id: 0, label: label.to_owned() };
        self.change.ask(&ChangeStateRequest { transition }).expect("an answer").success
    }

    fn state(&self) -> String {
        self.state.ask(&GetStateRequest {}).expect("an answer").current_state.label
    }
}

/// A robot beside ROS, until it is dropped.
struct Running {
    opened: PortSender<()>,
    broken: PortSender<()>,
    seen: Collected<&'static str>,
    stop: &'static Switch,
    driver: Option<JoinHandle<u8>>,
    ros: Option<Ros>,
}

impl Running {
    fn start(router: &Router, starts: bool) -> Self {
        let ros = router.node("robot").open().expect("a node");
        let mut ports = Ports::<Robot>::new();
        let manage = if starts { ros.manage().starting() } else { ros.manage() };
        let (order, outcome) = (ports.input(|inputs| &mut inputs.order), ports.event(|events| &mut events.outcome));
        manage.through(order, outcome).expect("services");
        ros.publish("beats").take_ending_with(ports.event(|events| &mut events.beats), 0).expect("a topic");
        let seen = Collected::new();
        let collect = |port: PortReceiver<()>, name| {
            let seen = seen.clone();
            thread::spawn(move || std::iter::from_fn(|| port.receive()).for_each(|()| seen.add(name)));
        };
        collect(ports.event(|events| &mut events.configure), "configure");
        collect(ports.event(|events| &mut events.works), "works");
        collect(ports.event(|events| &mut events.rests), "rests");
        let (opened, broken) = (ports.input(|inputs| &mut inputs.opened), ports.input(|inputs| &mut inputs.broken));
        let stop: &'static Switch = Box::leak(Box::default());
        let clock = UntilStopped::new(ros.clock(), stop);
        let driver = Some(thread::spawn(move || drive_from(Robot::new(), clock, ports)));
        Self { opened, broken, seen, stop, driver, ros: Some(ros) }
    }

    fn opens(&self) {
        within(15.0, "it is to be configured", || self.seen.all().last() == Some(&"configure"));
        self.opened.send(()).expect("it runs");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.set();
        drop(self.driver.take().map(JoinHandle::join));
        drop(self.ros.take());
    }
}

#[test]
fn a_manager_starts_and_stops_the_robot() {
    let router = Router::start();
    let robot = Running::start(&router, false);
    let manager = Manager::new(&router);
    let beats = Collected::new();
    manager.ros.subscribe("beats").depth(1000).each::<u64>(beats.collector()).expect("a topic");
    assert_eq!(manager.state(), "unconfigured");
    assert!(!manager.change("activate"), "it is not configured");
    // Its device is opened a moment later.
    thread::scope(|scope| {
        let configured = scope.spawn(|| manager.change("configure"));
        within(15.0, "it is to be configured", || manager.state() == "configuring");
        robot.opens();
        assert_eq!(configured.join().ok(), Some(true));
    });
    assert_eq!((manager.state().as_str(), robot.seen.all().len(), beats.all().len()), ("inactive", 1, 0));
    assert!(manager.change("activate"));
    within(15.0, "it works", || robot.seen.all() == ["configure", "works"] && beats.all().len() > 10);
    assert!(manager.change("deactivate"));
    robot.seen.expect(&["configure", "works", "rests"]);
    within(15.0, "its last word", || beats.all().last() == Some(&0));
    let count = beats.all().len();
    thread::sleep(Duration::from_millis(200));
    assert_eq!(beats.all().len(), count, "it is silent");
    assert!(manager.change("activate"));
    within(15.0, "it works again", || beats.all().len() > count);
    assert!(!manager.change("cleanup"), "it is active");
    // Shut down, its program ends.
    assert!(manager.change("shutdown"));
    within(15.0, "the end", || robot.driver.as_ref().is_some_and(JoinHandle::is_finished));
    assert_eq!(manager.state(), "finalized");
    let expected = [
        "configure: unconfigured -> configuring",
        "transition_success: configuring -> inactive",
        "activate: inactive -> activating",
        "transition_success: activating -> active",
        "deactivate: active -> deactivating",
        "transition_success: deactivating -> inactive",
        "activate: inactive -> activating",
        "transition_success: activating -> active",
        "shutdown: active -> shuttingdown",
        "transition_success: shuttingdown -> finalized",
    ];
    manager.events.expect(&expected);
}

#[test]
fn a_robot_that_breaks_has_to_be_configured_again() {
    let router = Router::start();
    let robot = Running::start(&router, true);
    let manager = Manager::new(&router);
    robot.opens();
    // What it has done before the manager came may be heard or not.
    manager.events.expect_at_end(&["transition_success: activating -> active"]);
    assert_eq!(manager.state(), "active", "it has started by itself");
    robot.broken.send(()).expect("it runs");
    manager.events.expect_at_end(&[
        "transition_success: activating -> active",
        "deactivate: active -> deactivating",
        "transition_error: deactivating -> errorprocessing",
        "transition_success: errorprocessing -> unconfigured",
    ]);
    assert_eq!(manager.state(), "unconfigured");
    within(15.0, "it has stopped", || robot.seen.all().last() == Some(&"rests"));
    thread::scope(|scope| {
        let configured = scope.spawn(|| manager.change("configure"));
        robot.opens();
        assert_eq!(configured.join().ok(), Some(true));
    });
    // A program that ends does not let its manager wait.
    thread::scope(|scope| {
        let cleaned = scope.spawn(|| manager.change("cleanup"));
        within(15.0, "it is to be cleaned up", || manager.state() == "cleaningup");
        robot.stop.set();
        assert_eq!(cleaned.join().ok(), Some(false));
    });
}

#[test]
fn states_and_transitions_are_listed() {
    let router = Router::start();
    let ros = router.node("robot").open().expect("a node");
    let orders = Arc::new(Mutex::new(vec![]));
    let seen = Arc::clone(&orders);
    ros.manage()
        .by(move |order| {
            let mut seen = seen.lock().expect("no panic");
            seen.push(order);
            if seen.len() == 1 { Outcome::Failure } else { Outcome::Success }
        })
        .expect("services");
    let manager = Manager::new(&router);
    let states = client::<GetAvailableStates>(&manager.ros, "/robot/get_available_states");
    let states = states.ask(&GetAvailableStatesRequest {}).expect("an answer").available_states;
    assert_eq!((states.len(), states[1].id, states[1].label.as_str()), (11, 1, "unconfigured"));
    let transitions = |name: &str| {
        let client = client::<GetAvailableTransitions>(&manager.ros, name);
        let all = client.ask(&GetAvailableTransitionsRequest {}).expect("an answer").available_transitions;
        all.into_iter().map(|it| it.transition.label).collect::<Vec<_>>()
    };
    assert_eq!(transitions("/robot/get_transition_graph").len(), 25);
    assert_eq!(transitions("/robot/get_available_transitions"), ["configure", "shutdown"]);
    assert!(!manager.change("configure"), "it fails once");
    assert!(manager.change("configure") && manager.change("activate"));
    assert_eq!(transitions("/robot/get_available_transitions"), ["deactivate", "shutdown"]);
    assert_eq!(orders.lock().expect("no panic").len(), 3);
}

#[test]
fn transitions_have_another_form_since_lyrical() {
    let router = Router::start();
    let ros = router.node("robot").distribution(Distribution::Lyrical).open().expect("a node");
    ros.manage().by(|_| Outcome::Success).expect("services");
    let said = Collected::new();
    let add = said.collector();
    let jazzy = router.node("manager").tell(move |text| add(text.to_owned())).open().expect("a node");
    jazzy.subscribe("/robot/transition_event").each(|_: TransitionEvent| {}).expect("a topic");
    let why = "with another definition of `lifecycle_msgs/msg/TransitionEvent` (`RIHS01_78b19e2b…`";
    within(3.0, why, || said.all().iter().any(|text| text.contains(why)));
}

#[test]
fn a_manager_in_python_starts_and_stops_the_robot() {
    let Some(python) = python() else { return };
    let types =
        [format!("{}={}", ChangeState::NAME, ChangeState::HASH), format!("{}={}", GetState::NAME, GetState::HASH)];
    let mut manager = Peer::start(&*python, "lifecycle_peer.py", &types.each_ref().map(String::as_str));
    let ros = manager.node("robot");
    ros.manage().by(|_| Outcome::Success).expect("services");
    within(20.0, "the state", || manager.does("state").iter().any(|line| line == "state 1 unconfigured"));
    let mut change = |id: u8, events: [&str; 2]| {
        let lines = manager.does(&format!("change {id}"));
        assert!(lines.iter().any(|line| line == "changed 1"), "{lines:?}");
        within(15.0, events[1], || events.iter().all(|event| manager.says(event)));
    };
    change(1, ["event 1 unconfigured configuring", "event 10 configuring inactive"]);
    change(3, ["event 3 inactive activating", "event 30 activating active"]);
    change(4, ["event 4 active deactivating", "event 40 deactivating inactive"]);
    assert!(manager.does("change 4").iter().any(|line| line == "changed 0"), "it is not active");
    assert!(manager.does("state").iter().any(|line| line == "state 2 inactive"));
}

//! A program as a node: services, parameters, problems, transforms, simulated time.

mod common;

use apex_macros::graph;
use apex_messages::{
    Service, builtin_interfaces,
    diagnostic_msgs::{DiagnosticArray, DiagnosticStatus},
    rcl_interfaces::{
        DescribeParameters, DescribeParametersRequest, GetParameters, GetParametersRequest, ListParameters,
        ListParametersRequest, Log, Parameter, ParameterEvent, ParameterType, ParameterValue, SetParameters,
        SetParametersAtomically, SetParametersAtomicallyRequest, SetParametersRequest,
    },
    rosgraph_msgs,
    std_srvs::{SetBool, SetBoolRequest, SetBoolResponse, Trigger, TriggerRequest, TriggerResponse},
    tf2_msgs::TFMessage,
};
use apex_nodes::scan::Pose2;
use apex_ros::{Client, Ros};
use apex_rt::{Ports, Switch, UntilStopped, drive_from, prelude::*};
use common::{
    Collected, Router,
    python::{Peer, python},
    within,
};
use std::{
    thread,
    time::{Duration, Instant},
};

/// Multiplies commands.
#[node]
#[derive(Default)]
pub struct Speed {
    /// Factor of commands.
    #[param(unit = "m", default = 1.0, range = 0.0..=10.0)]
    factor: f32,
    /// Stops everything.
    #[param(default = false)]
    locked: bool,
    /// Name in messages, which has no value of ROS.
    #[param]
    label: &'static str,
}

#[node]
impl Speed {
    /// Multiplies a command.
    #[slot]
    fn put(&mut self, command: &f64, speed: Event<f64>) {
        speed.emit(if self.locked || !self.label.is_empty() { 0.0 } else { f64::from(self.factor) * command });
    }
}

/// Answers a request.
#[node]
#[derive(Default)]
#[allow(non_camel_case_types, reason = "as a function")]
pub struct answer;

#[node]
impl answer {
    /// Answers with the data of the request.
    #[slot]
    fn put(&mut self, request: &SetBoolRequest, given: Event<SetBoolResponse>) {
        given.emit(SetBoolResponse { success: request.data, message: format!("it is {}", request.data) });
    }
}

/// Fails.
#[node]
#[derive(Default)]
#[allow(non_camel_case_types, reason = "as a function")]
pub struct complain;

#[node]
impl complain {
    /// Fails.
    #[slot]
    fn put(&mut self) -> Result<(), &'static str> {
        Err("the motor is hot")
    }
}

graph!("robot.afg");

/// Opens a client that meets its server.
fn client<S: Service + 'static>(ros: &Ros, name: &str) -> Client<S> {
    let client = ros.call::<S>(name).timeout(Duration::from_secs(2)).open().expect("a client");
    within(15.0, "a server", || ros.sees(apex_ros::Kind::Server, name, S::NAME));
    client
}

/// Lets the robot run beside ROS until the end of `act`, with its problems in `/rosout`.
fn beside(router: &Router, args: &'static [&'static str], act: impl FnOnce(&Ros)) {
    let stop: &'static Switch = Box::leak(Box::default());
    let robot = router.node("robot").args(args.iter().copied()).open().expect("a node");
    let mut ports = Ports::<Robot>::new();
    robot.subscribe("command").feed(ports.input(|inputs| &mut inputs.command)).expect("a topic");
    robot.subscribe("broken").feed(ports.input(|inputs| &mut inputs.broken)).expect("a topic");
    robot.publish("speed").take(ports.event(|events| &mut events.speed)).expect("a topic");
    robot.publish("ticks").take(ports.event(|events| &mut events.ticks)).expect("a topic");
    let (asked, answered) = (ports.input(|inputs| &mut inputs.asked), ports.event(|events| &mut events.answered));
    robot.serve::<SetBool>("~/set").through(asked, answered).expect("a service");
    robot.serve_params(ports.params()).expect("services");
    robot.report("Robot").expect("topics");
    let mut program = Robot::new();
    robot.set_params(&mut program).expect("parameters");
    let clock = robot.clock();
    let driver = thread::spawn(move || drive_from(program, UntilStopped::new(clock, stop), ports));
    act(&router.node("tools").open().expect("a node"));
    stop.set();
    assert_eq!(driver.join().ok(), Some(0));
    drop(robot);
}

#[test]
fn services_are_answered_and_called() {
    let router = Router::start();
    beside(&router, &[], |tools| {
        let set = client::<SetBool>(tools, "/robot/set");
        for data in [true, false, true] {
            let response = set.ask(&SetBoolRequest { data }).expect("an answer");
            assert_eq!(response, SetBoolResponse { success: data, message: format!("it is {data}") });
        }
        tools.serve::<Trigger>("again").by(|_| TriggerResponse { success: true, message: "yes".into() }).expect("it");
        let other = router.node("other").open().expect("a node");
        let again = client::<Trigger>(&other, "/again");
        assert_eq!(again.ask(&TriggerRequest {}).map(|response| response.message), Ok("yes".to_owned()));
    });
    let alone = router.node("alone").open().expect("a node");
    let lost = alone.call::<Trigger>("/nobody").timeout(Duration::from_millis(300)).open().expect("a client");
    let error = lost.ask(&TriggerRequest {}).map(drop).expect_err("no node is there").to_string();
    assert!(error.starts_with("no node serves `/nobody`"), "{error}");
    alone
        .serve::<Trigger>("slow")
        .by(|_| {
            thread::sleep(Duration::from_secs(1));
            TriggerResponse::default()
        })
        .expect("a service");
    let other = router.node("other").open().expect("a node");
    let slow = other.call::<Trigger>("/slow").timeout(Duration::from_millis(300)).open().expect("a client");
    within(15.0, "a server", || other.sees(apex_ros::Kind::Server, "/slow", "std_srvs/srv/Trigger"));
    let start = Instant::now();
    let error = slow.ask(&TriggerRequest {}).map(drop).expect_err("it is slow").to_string();
    assert!(error.contains("no response has come within 0.3 s"), "{error}");
    assert!(start.elapsed() < Duration::from_millis(900));
}

#[test]
fn parameters_are_those_of_ros() {
    let router = Router::start();
    beside(&router, &["--ros-args", "-p", "drive.factor:=3.5"], |tools| {
        let events = Collected::<ParameterEvent>::new();
        tools.subscribe("/parameter_events").each(events.collector()).expect("a topic");
        let list = client::<ListParameters>(tools, "/robot/list_parameters");
        let names = list.ask(&ListParametersRequest::default()).expect("a list").result;
        assert_eq!(names.names, ["drive.factor", "drive.locked", "use_sim_time"]);
        assert_eq!(names.prefixes, ["drive"]);
        let get = client::<GetParameters>(tools, "/robot/get_parameters");
        let value = |name: &str| {
            let values = get.ask(&GetParametersRequest { names: vec![name.to_owned()] }).expect("values").values;
            values.into_iter().next().expect("a value")
        };
        assert_eq!((value("drive.factor").r#type, value("drive.factor").double_value), (3, 3.5));
        assert_eq!((value("drive.locked").r#type, value("none").r#type), (1, 0));
        let describe = client::<DescribeParameters>(tools, "/robot/describe_parameters");
        let request = DescribeParametersRequest { names: vec!["drive.factor".to_owned()] };
        let described = describe.ask(&request).expect("a description").descriptors.remove(0);
        let range = &described.floating_point_range[0];
        assert_eq!((described.description.as_str(), range.from_value, range.to_value), ("in m", 0.0, 10.0));

        let double = |name: &str, double_value| Parameter {
            name: name.to_owned(),
            value: ParameterValue { r#type: ParameterType::PARAMETER_DOUBLE, double_value, ..Default::default() },
        };
        let set = client::<SetParameters>(tools, "/robot/set_parameters");
        let parameters = vec![double("drive.factor", 4.0), double("drive.factor", 40.0), double("use_sim_time", 1.0)];
        let results = set.ask(&SetParametersRequest { parameters }).expect("results").results;
        assert_eq!(results.iter().map(|result| result.successful).collect::<Vec<_>>(), [true, false, false]);
        assert_eq!(results[1].reason, "the value of `drive.factor` is out of range: its range is 0..=10 (m)");
        assert_eq!(value("drive.factor").double_value, 4.0);
        within(15.0, "an event", || events.all().iter().any(|event| event.node == "/robot"));

        let all = client::<SetParametersAtomically>(tools, "/robot/set_parameters_atomically");
        let parameters = vec![double("drive.factor", 5.0), double("drive.none", 1.0)];
        let result = all.ask(&SetParametersAtomicallyRequest { parameters }).expect("a result").result;
        assert!(!result.successful && result.reason.contains("no parameter of this name"), "{}", result.reason);
        assert_eq!(value("drive.factor").double_value, 4.0);
    });
}

#[test]
fn a_program_in_python_sets_parameters_and_has_its_own_read() {
    let Some(python) = python() else { return };
    let hashes = [(GetParameters::NAME, GetParameters::HASH), (SetParameters::NAME, SetParameters::HASH)];
    let types = hashes.map(|(name, hash)| format!("{name}={hash}"));
    let mut peer = Peer::start(&*python, "params_peer.py", &types.each_ref().map(String::as_str));
    beside(&Router::at(&peer.address.clone()), &["--ros-args", "-p", "drive.factor:=3.5"], |tools| {
        let mut says = |word: &str, line: &str| {
            within(20.0, word, || peer.does(word).iter().any(|said| said.trim_end() == line));
        };
        says("get drive.factor", "value 3 3.5");
        says("set drive.factor 4.25", "result True");
        for wrong in ["nan", "inf", "-1"] {
            says(
                &format!("set drive.factor {wrong}"),
                "result False the value of `drive.factor` is out of range: its range is 0..=10 (m)",
            );
        }
        says("get drive.factor", "value 3 4.25");
        let get = client::<GetParameters>(tools, "/peer/get_parameters");
        let values = get.ask(&GetParametersRequest { names: vec!["odd".to_owned(), "none".to_owned()] });
        let [odd, none] = values.expect("an answer").values.try_into().expect("two values");
        let bits: Vec<_> = odd.double_array_value.iter().map(|value| value.to_bits()).collect();
        assert_eq!(bits, [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -0.0, 5e-324].map(f64::to_bits));
        assert_eq!((odd.r#type, none.r#type), (ParameterType::PARAMETER_DOUBLE_ARRAY, 0));
    });
}

#[test]
fn a_file_has_parameters_by_the_names_of_nodes() {
    let router = Router::start();
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("robot.yaml");
    let path = path.to_str().expect("a path");
    let text = |factor| {
        format!(
            "/**:\n  ros__parameters:\n    none: 1\n/robot1/second:\n  ros__parameters:\n    drive: {{factor: {factor}}}\n\
             robot:\n  ros__parameters:\n    drive.factor: 99\n"
        )
    };
    let args = ["--ros-args", "--params-file", path, "-r", "__node:=second", "-r", "__ns:=/robot1"];
    let set = |more: &[&str]| {
        let robot = router.node("robot").args(args.iter().chain(more).copied()).open()?;
        let mut program = Robot::new();
        robot.set_params(&mut program)?;
        Ok::<f32, apex_ros::Error>(program.param("drive.factor").expect("a parameter"))
    };
    std::fs::write(path, text("2.5")).expect("a file");
    assert_eq!((set(&[]), set(&["-p", "drive.factor:=3"])), (Ok(2.5), Ok(3.0)));
    for (factor, expected) in [
        ("25", ":6:13: the value of `drive.factor` is out of range: its range is 0..=10 (m)"),
        ("fast", ":6:13: `drive.factor` (f32) takes a number, not a string"),
    ] {
        std::fs::write(path, text(factor)).expect("a file");
        assert_eq!(set(&[]).map_err(|error| error.to_string()), Err(format!("{path}{expected}")));
    }
    std::fs::write(path, "/robot1/second:\n  ros__parameters:\n    drive.factr: 1\n").expect("a file");
    let error = set(&[]).expect_err("no such parameter").to_string();
    assert!(error.starts_with(&format!("{path}:3:5: `drive.factr`: ")) && error.contains("drive.factor"), "{error}");
    std::fs::write(path, "").expect("a file");
    let error = set(&["-p", "speed:=1"]).expect_err("no such parameter").to_string();
    assert!(
        error.starts_with("`-p speed:=1`: there is no parameter of this name; those of the program are `"),
        "{error}"
    );
    assert!(error.contains("`drive.factor`"), "{error}");
}

/// Messages that find the program waiting go straight to it, others wait for it: their order stays.
#[test]
fn messages_come_in_their_order_however_fast() {
    let router = Router::start();
    beside(&router, &["--ros-args", "-p", "drive.factor:=1"], |tools| {
        let speeds = Collected::<f64>::new();
        tools.subscribe("speed").depth(10_000).each(speeds.collector()).expect("a topic");
        let command = tools.publish("command").depth(10_000).open::<f64>().expect("a topic");
        within(15.0, "a route", || {
            command.send(&0.0).expect("it is there");
            thread::sleep(Duration::from_millis(20));
            !speeds.all().is_empty()
        });
        for number in 1..=3000_u32 {
            command.send(&number.into()).expect("it is there");
            // Bursts, and pauses in which the program waits.
            if number % 100 < 50 {
                thread::sleep(Duration::from_micros(u64::from(number % 7) * 50));
            }
        }
        within(15.0, "the last one", || speeds.all().last() == Some(&3000.0));
        let all: Vec<_> = speeds.all().into_iter().filter(|speed| *speed > 0.0).collect();
        assert!(all.len() > 500 && all.is_sorted_by(|a, b| a < b), "{} of 3000", all.len());
    });
}

#[test]
fn problems_are_in_rosout_and_diagnostics() {
    let router = Router::start();
    beside(&router, &[], |tools| {
        let (logs, states) = (Collected::<Log>::new(), Collected::<DiagnosticArray>::new());
        tools.subscribe("/rosout").transient_local().each(logs.collector()).expect("a topic");
        tools.subscribe("/diagnostics").each(states.collector()).expect("a topic");
        let broken = tools.publish("broken").open::<()>().expect("a topic");
        within(15.0, "a state", || states.all().iter().any(|state| state.status[0].level == DiagnosticStatus::OK));
        broken.send(&()).expect("it is there");
        let hot = "Robot: `bad` failed: the motor is hot";
        within(15.0, "a log", || logs.all().iter().any(|log| log.msg == hot && log.name == "robot"));
        within(15.0, "a state", || {
            states
                .all()
                .iter()
                .any(|state| state.status[0].level == DiagnosticStatus::WARN && state.status[0].message == hot)
        });
        let state = states.all().pop().expect("a state");
        assert_eq!(
            (state.status[0].name.as_str(), state.status[1].name.as_str()),
            ("/robot: program", "/robot: topics")
        );
        assert!(state.header.stamp.as_nanos() > 0);
        assert!(state.status[1].values.iter().any(|value| value.key == "/broken"));
    });
}

#[test]
fn transforms_are_messages_of_tf() {
    let router = Router::start();
    let robot = router.node("robot").open().expect("a node");
    robot.static_transform("base_link", "laser", &Pose2::new(0.2, 0.0, 0.5)).expect("a topic");
    robot.static_transform("base_link", "camera", &Pose2::new(0.1, 0.0, 0.0)).expect("a topic");
    let tools = router.node("tools").open().expect("a node");
    let transforms = Collected::<TFMessage>::new();
    tools.subscribe("/tf_static").transient_local().depth(100).each(transforms.collector()).expect("a topic");
    within(15.0, "both", || transforms.all().len() == 2);
    let mut frames: Vec<_> =
        transforms.all().iter().map(|message| message.transforms[0].child_frame_id.clone()).collect();
    frames.sort();
    assert_eq!(frames, ["camera", "laser"]);
    assert!(transforms.all()[0].transforms[0].header.frame_id == "base_link");
}

#[test]
fn a_simulation_has_the_time() {
    let router = Router::start();
    let simulator = router.node("simulator").open().expect("a node");
    let clock = simulator.publish("/clock").best_effort().depth(1).open::<rosgraph_msgs::Clock>().expect("a topic");
    let ticks = Collected::<u64>::new();
    simulator.subscribe("ticks").each(ticks.collector()).expect("a topic");
    let at = |second: i64| {
        let time = builtin_interfaces::Time::from_nanos(second * 1_000_000_000);
        clock.send(&rosgraph_msgs::Clock { clock: time }).expect("it is there");
    };
    beside(&router, &["--ros-args", "-p", "use_sim_time:=true"], |_| {
        // A tick that comes before would be lost.
        within(15.0, "the ticks", || simulator.sees(apex_ros::Kind::Publisher, "ticks", "std_msgs/msg/UInt64"));
        within(15.0, "the first tick", || {
            at(1_700_000_000);
            thread::sleep(Duration::from_millis(10));
            ticks.all().len() == 1
        });
        // Ten simulated seconds.
        for second in 1..=10 {
            at(1_700_000_000 + second);
            within(15.0, "a tick for each second", || ticks.all().len() as i64 == second + 1);
        }
        thread::sleep(Duration::from_millis(100));
        assert_eq!(ticks.all(), (1..=11).collect::<Vec<u64>>());
    });
}

//! Nodes of Apex over DDS, with one another.

mod common;

use apex_macros::graph;
use apex_messages::{
    rcl_interfaces::{ListParameters, ListParametersRequest},
    sensor_msgs::{Image, LaserScan},
    std_srvs::{SetBool, SetBoolRequest, SetBoolResponse},
};
use apex_ros::{Distribution, Kind};
use apex_ros_dds::Vendor;
use apex_rt::{Ports, Switch, UntilStopped, drive_from};
use common::{Collected, domain, node, within};
use std::{process::Command, thread, time::Duration};

graph! {
    use apex_nodes::math::LowPass;

    graph Smooth {
        in  x: f64;
        out y: f64;
        node low = LowPass(weight = 0.5);
        x -> low -> y;
    }
}

#[test]
fn messages_arrive_in_their_order_and_whole() {
    let domain = domain();
    let open = |name| node(name, domain, Vendor::Cyclone).open().expect("a node");
    let (sender, receiver) = (open("camera"), open("rover"));
    let (numbers, images) = (Collected::new(), Collected::new());
    receiver.subscribe("number").depth(1000).each::<f64>(numbers.collector()).expect("a topic");
    let add = images.collector();
    receiver.subscribe("image").each(move |image: Image| add(image.data)).expect("a topic");
    let number = sender.publish("number").depth(1000).open::<f64>().expect("a topic");
    let image = sender.publish("image").open::<Image>().expect("a topic");
    // Discovery shows both ends a little before they exchange messages.
    within(20.0, "the first number", || {
        number.send(&-1.0).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !numbers.all().is_empty()
    });
    let expected: Vec<f64> = (0..200).map(f64::from).collect();
    expected.iter().for_each(|it| number.send(it).expect("it is there"));
    within(20.0, "all numbers", || numbers.all().last() == Some(&199.0));
    let all: Vec<f64> = numbers.all().into_iter().filter(|it| *it >= 0.0).collect();
    assert_eq!(all, expected);
    let data: Vec<u8> = (0..1_000_000_u32).map(|i| (i % 251) as u8).collect();
    let whole = Image { data: data.clone(), ..Image::default() };
    within(20.0, "an image of 1 MB", || {
        image.send(&whole).expect("it is there");
        thread::sleep(Duration::from_millis(100));
        !images.all().is_empty()
    });
    assert!(images.all()[0] == data);
}

#[test]
fn services_go_both_ways_for_each_vendor() {
    for vendor in [Vendor::Cyclone, Vendor::Fast] {
        let domain = domain();
        let open = |name| node(name, domain, vendor).open().expect("a node");
        let (server, client) = (open("server"), open("client"));
        let late = client.call::<SetBool>("/flip").timeout(Duration::from_secs(2)).open().expect("a client");
        let why = late.ask(&SetBoolRequest { data: true }).expect_err("no server").to_string();
        assert_eq!(why, "no node serves `/flip`, or its server ended before it answered");
        let answer = |SetBoolRequest { data }| SetBoolResponse { success: !data, message: "flipped".to_owned() };
        server.serve::<SetBool>("/flip").by(answer).expect("a service");
        within(20.0, "the server", || late.ask(&SetBoolRequest { data: true }).is_ok());
        for data in [true, false, true] {
            let response = late.ask(&SetBoolRequest { data });
            assert_eq!(response, Ok(SetBoolResponse { success: !data, message: "flipped".to_owned() }), "{vendor:?}");
        }
        // Two clients: each gets its own responses.
        let third = open("third");
        let other = third.call::<SetBool>("/flip").open().expect("a client");
        within(20.0, "the other client", || other.ask(&SetBoolRequest { data: true }).is_ok());
        thread::scope(|scope| {
            for (client, data) in [(&late, true), (&other, false)] {
                scope.spawn(move || {
                    for _ in 0..50 {
                        let response = client.ask(&SetBoolRequest { data }).expect("a response");
                        assert_eq!(response.success, !data);
                    }
                });
            }
        });
    }
}

#[test]
fn those_who_are_late_get_what_is_kept() {
    let domain = domain();
    let open = |name| node(name, domain, Vendor::Fast).open().expect("a node");
    let (sender, receiver) = (open("maps"), open("rover"));
    let map = sender.publish("map").transient_local().depth(1).open::<String>().expect("a topic");
    for text in ["old", "new"] {
        map.send(&text.to_owned()).expect("it is there");
    }
    let maps = Collected::new();
    receiver.subscribe("map").transient_local().depth(1).each::<String>(maps.collector()).expect("a topic");
    // RustDDS tidies up every few seconds: until then a message before the last one may come, too, and both may come to
    // those who did not ask for what was before.
    within(20.0, "the map", || maps.all().last().is_some_and(|text| text == "new"));
}

#[test]
fn silence_has_its_reasons() {
    let domain = domain();
    let told = Collected::new();
    let add = told.collector();
    let lidar = node("lidar", domain, Vendor::Cyclone).open().expect("a node");
    let kept = (
        lidar.publish("scan").best_effort().open::<LaserScan>().expect("a topic"),
        lidar.publish("text").open::<String>().expect("a topic"),
    );
    let ros = node("rover", domain, Vendor::Cyclone).tell(move |text| add(text.to_owned())).open().expect("a node");
    for topic in ["scan", "front", "text"] {
        ros.subscribe(topic).each(|_: LaserScan| {}).expect("a topic");
    }
    for text in [
        "`/lidar` publishes `/scan` as best effort, and this program asks for reliable messages: subscribe with \
         `.best_effort()`",
        "no node publishes `/front`; `/scan` has its type: if you mean that, start with `--ros-args -r /front:=/scan`",
        "`/lidar` publishes `/text` as `std_msgs/msg/String`, and this program has `sensor_msgs/msg/LaserScan` there",
    ] {
        within(20.0, text, || told.all().iter().any(|told| told == text));
    }
    let there = lidar.publish("front").open::<LaserScan>().expect("a topic");
    within(20.0, "a node publishes", || told.all().iter().any(|text| text == "a node publishes `/front` now"));
    drop(there);
    within(20.0, "it has gone", || {
        told.all().iter().filter(|text| text.starts_with("no node publishes `/front`")).count() == 2
    });
    drop(kept);
}

#[test]
fn parameters_are_those_of_the_node_in_each_distribution() {
    for distribution in [Distribution::Humble, Distribution::Jazzy] {
        let domain = domain();
        let open = |name| node(name, domain, Vendor::Fast).distribution(distribution).open().expect("a node");
        let (robot, tool) = (open("robot"), open("tool"));
        let ports = Ports::<Smooth>::new();
        robot.serve_params(ports.params()).expect("services");
        let (stop, clock): (&'static Switch, _) = (Box::leak(Box::default()), robot.clock());
        let driver = thread::spawn(move || drive_from(Smooth::new(), UntilStopped::new(clock, stop), ports));
        let list = tool.call::<ListParameters>("/robot/list_parameters").open().expect("a client");
        within(20.0, "the parameters", || {
            let listed = list.ask(&ListParametersRequest::default());
            listed.is_ok_and(|response| response.result.names.iter().any(|name| name == "use_sim_time"))
        });
        within(20.0, "the server in the graph", || {
            tool.sees(Kind::Server, "/robot/list_parameters", "rcl_interfaces/srv/ListParameters")
        });
        stop.set();
        driver.join().expect("it ends");
    }
}

#[test]
fn a_program_over_dds_does_not_need_zenoh() {
    let tree = Command::new(env!("CARGO"))
        .args(["tree", "--package", "apex-ros-dds", "--edges", "normal", "--prefix", "none", "--offline"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let tree = String::from_utf8_lossy(&tree.stdout).into_owned();
    assert!(tree.contains("rustdds") && !tree.contains("zenoh"), "{tree}");
}

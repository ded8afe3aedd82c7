//! A node beside programs of others: Python with `eclipse-zenoh`, whose session is the router, and `rosbags`, which
//! knows the messages and their hashes; and `zenoh-ros2-sdk`, which lists topics as `ros2 topic list` does.

mod common;

use apex_messages::{
    Message,
    diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue},
    geometry_msgs::{Pose, Quaternion, Transform, TransformStamped, Twist, Vector3},
    nav_msgs::{OccupancyGrid, Odometry},
    sensor_msgs::{Image, LaserScan, PointCloud2, PointField},
    std_msgs::{Empty, Header},
    std_srvs::{SetBool, SetBoolRequest, SetBoolResponse},
    tf2_msgs::TFMessage,
};
use apex_nodes::map::{Grid, Occupancy};
use apex_ros::{Kind, Publisher, Ros};
use apex_rt::Time;
use common::{
    Collected,
    python::{Interpreter, Peer, python, with_zenoh},
    raw::Raw,
    within,
};
use std::{process::Command, time::Duration};

/// The peer of this file.
fn peer(python: impl Into<Interpreter>) -> Peer {
    Peer::start(python, "peer.py", &[&format!("std_srvs/srv/SetBool={}", <SetBool as apex_messages::Service>::HASH)])
}

/// Sends messages, and expects each back, bit by bit. A message that was dropped is sent again: a route for data comes
/// a moment after the token, and a publisher that keeps a number of messages drops large ones on a busy machine, as
/// those of `rmw_zenoh` do.
fn echo<M: Message + Send + 'static>(ros: &Ros, index: usize, messages: &[M]) {
    let back = Collected::new();
    let add = back.collector();
    let pong = format!("/pong_{index}");
    let subscription = ros.subscribe(&pong).depth(1000).each(move |message: Raw<M>| add(message.0));
    subscription.expect("a topic");
    let ping = ros.publish(&format!("/ping_{index}")).depth(1000).open::<Raw<M>>().expect("a topic");
    within(20.0, "the peer", || {
        ros.sees(Kind::Publisher, &pong, M::NAME) && ros.sees(Kind::Subscription, &format!("/ping_{index}"), M::NAME)
    });
    let sent: Vec<_> = messages.iter().map(|message| Raw::of(message).0).collect();
    for (message, bytes) in messages.iter().zip(&sent) {
        within(20.0, M::NAME, || {
            ping.send(&Raw::of(message)).expect("it is there");
            back.wait(Duration::from_millis(500), |back| back.contains(bytes))
        });
    }
    assert!(back.all().iter().all(|bytes| sent.contains(bytes)), "{}", M::NAME);
}

const ODD: [f32; 6] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, f32::MIN_POSITIVE, 1.5];

/// Header with a time of the program, which becomes one of ROS on the way there, and is the same when it is back.
fn header() -> Header {
    Header::new(Time::from_nanos(5_123_456_789), "laser")
}

#[test]
fn messages_come_back_from_python_bit_by_bit() {
    let Some(python) = python() else { return };
    all_come_back(&peer(&*python));
}

/// Lets the peer send messages of ten types back.
fn all_come_back(peer: &Peer) {
    let ros = peer.node("robot");
    let scan = |count| LaserScan { header: header(), ranges: ODD.repeat(count), ..LaserScan::default() };
    echo(&ros, 0, &[scan(0), scan(1), scan(300)]);
    let twists = ODD.map(|x| Twist { linear: Vector3 { x: x.into(), y: f64::MAX, z: f64::NAN }, ..Twist::default() });
    echo(&ros, 1, &twists);
    let mut odometry = Odometry { header: header(), child_frame_id: "base_link".to_owned(), ..Odometry::default() };
    odometry.pose.covariance = std::array::from_fn(|i| i as f64);
    odometry.pose.pose =
        Pose { orientation: Quaternion { x: 0.0, y: 0.0, z: 1.0, w: f64::INFINITY }, ..Pose::default() };
    echo(&ros, 2, &[odometry, Odometry { header: header(), ..Odometry::default() }]);
    echo(&ros, 3, &[OccupancyGrid { header: header(), data: (-1..=100).collect(), ..OccupancyGrid::default() }]);
    let transform =
        TransformStamped { header: header(), child_frame_id: "ä".to_owned(), transform: Transform::default() };
    echo(&ros, 4, &[TFMessage { transforms: vec![transform; 3] }, TFMessage::default()]);
    let data: Vec<u8> = (0..1_000_000_u32).map(|i| (i % 251) as u8).collect();
    let image = Image {
        header: header(),
        height: 1000,
        width: 1000,
        encoding: "mono8".to_owned(),
        step: 1000,
        data,
        ..Image::default()
    };
    echo(&ros, 5, &[image.clone(), image]);
    echo(&ros, 6, &["zwölf".to_owned(), String::new()]);
    let field = PointField { name: "x".to_owned(), offset: 0, datatype: PointField::FLOAT32, count: 1 };
    let data = ODD.iter().flat_map(|x| x.to_le_bytes()).collect();
    echo(
        &ros,
        7,
        &[PointCloud2 { header: header(), fields: vec![field], point_step: 4, data, ..PointCloud2::default() }],
    );
    let value = KeyValue { key: "a".to_owned(), value: "b".to_owned() };
    let status =
        DiagnosticStatus { level: 1, name: "n".to_owned(), values: vec![value], ..DiagnosticStatus::default() };
    echo(&ros, 8, &[DiagnosticArray { header: header(), status: vec![status] }]);
    echo(&ros, 9, &[Empty {}, Empty {}]);
    let pings: Vec<_> = peer.lines.all().into_iter().filter(|line| line.starts_with("ping")).collect();
    assert!(pings.len() > 20 && pings.iter().all(|line| line.ends_with("right")), "{pings:?}");
}

#[test]
fn services_and_late_maps_go_both_ways() {
    let Some(python) = python() else { return };
    answers_and_maps(&mut peer(&*python));
}

/// Routers of earlier versions: 1.6.2 is that of Jazzy and Kilted; 1.8, that of Humble and Lyrical, is between them.
#[test]
fn earlier_routers_carry_the_same() {
    let Some(python) = python() else { return };
    for version in ["1.6.2", "1.9.0"] {
        let Some(earlier) = with_zenoh(&python, version) else { return };
        let mut peer = peer(earlier);
        all_come_back(&peer);
        answers_and_maps(&mut peer);
        tokens_are_seen(&mut peer);
    }
}

/// Calls a service of the peer and answers one, and lets maps come late.
fn answers_and_maps(peer: &mut Peer) {
    let ros = peer.node("robot");
    let flip = ros.call::<SetBool>("/flip").open().expect("a client");
    within(20.0, "the server", || ros.sees(Kind::Server, "/flip", "std_srvs/srv/SetBool"));
    for data in [true, false] {
        let response = flip.ask(&SetBoolRequest { data });
        assert_eq!(response, Ok(SetBoolResponse { success: !data, message: "flipped".to_owned() }));
    }
    within(15.0, "both requests", || peer.says("request 1 1") && peer.says("request 0 2"));

    ros.serve::<SetBool>("~/shout")
        .by(|request| SetBoolResponse { success: request.data, message: "HEY".to_owned() })
        .expect("a service");
    within(20.0, "an answer", || peer.does("call").iter().any(|line| line == "response 1 HEY 7 same"));

    let maps = Collected::new();
    let add = maps.collector();
    ros.subscribe("/map_of_peer")
        .transient_local()
        .depth(1)
        .each(move |map: Grid<Occupancy>| add(map.cells().to_vec()))
        .expect("a topic");
    within(20.0, "the map", || maps.all() == [[Occupancy::Occupied, Occupancy::Free]]);
    let publisher = ros.publish("/map_of_robot").frame("map").transient_local().depth(1).open().expect("a topic");
    publisher.send(&OccupancyGrid { data: vec![7, -1], ..OccupancyGrid::default() }).expect("it is there");
    within(20.0, "the map at the peer", || peer.says("map map 7 -1"));
}

#[test]
fn tools_see_the_node_and_its_topics() {
    let Some(python) = python() else { return };
    let mut peer = peer(&*python);
    let kept = tokens_are_seen(&mut peer);
    let address = peer.address.trim_start_matches("tcp/");
    let sdk = python.with_file_name("zenoh-ros2");
    let mut listed = String::new();
    within(20.0, "the list of zenoh-ros2-sdk", || {
        let output = Command::new(&sdk)
            .args(["--no-daemon", "--domain-id", "0", "--router", address, "--timeout", "2", "topic", "list", "-t"])
            .output()
            .expect("it runs");
        listed = String::from_utf8_lossy(&output.stdout).into_owned();
        listed.contains("/cmd_vel [geometry_msgs/msg/Twist]") && listed.contains("/scan [sensor_msgs/msg/LaserScan]")
    });
    drop(kept);
}

/// Waits for the tokens of a node with two topics, which is returned.
fn tokens_are_seen(peer: &mut Peer) -> (Ros, Publisher<Twist>) {
    let ros = peer.node("robot");
    ros.subscribe("scan").best_effort().each(|_: LaserScan| {}).expect("a topic");
    let twist = ros.publish("cmd_vel").open::<Twist>().expect("a topic");
    let wanted = [
        "/NN/%/%/robot".to_owned(),
        format!("/MS/%/%/robot/%scan/sensor_msgs::msg::dds_::LaserScan_/{}/2::,10:,:,:,,", LaserScan::HASH),
        format!("/MP/%/%/robot/%cmd_vel/geometry_msgs::msg::dds_::Twist_/{}/::,10:,:,:,,", Twist::HASH),
    ];
    within(20.0, "the tokens", || {
        let tokens = peer.does("tokens");
        wanted.iter().all(|wanted| tokens.iter().any(|token| token.ends_with(wanted.as_str())))
    });
    (ros, twist)
}

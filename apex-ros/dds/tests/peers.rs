//! A node beside Cyclone DDS in Python, which knows topics, services and nodes as `rmw_cyclonedds` writes them.

mod common;

use apex_messages::{
    Message,
    geometry_msgs::{Twist, Vector3},
    sensor_msgs::{Image, LaserScan},
    std_msgs::Header,
    std_srvs::{SetBool, SetBoolRequest, SetBoolResponse},
};
use apex_ros::{Kind, Ros};
use apex_ros_dds::Vendor;
use apex_rt::Time;
use common::{Collected, domain, node, raw::Raw, speaker::Speaker, within};
use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
    thread,
    time::Duration,
};

/// Settings of Cyclone DDS: this machine alone, without multicast.
const SETTINGS: &str = "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface name=\"lo\"/></Interfaces>\
    <AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>\
    <Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";

/// Python with Cyclone DDS; `None` if there is none, which is an error in CI.
fn python() -> Option<PathBuf> {
    let environment = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/python/bin/python3");
    let python = [environment, PathBuf::from("python3")].into_iter().find(|python| {
        let test = Command::new(python).args(["-c", "import cyclonedds.domain"]).output();
        test.is_ok_and(|output| output.status.success())
    });
    if python.is_none() {
        assert!(env::var_os("CI").is_none(), "no Python has `cyclonedds`");
        println!("skipped: no Python has `cyclonedds`");
    }
    python
}

/// The peer in Python, and its domain.
struct Peer {
    speaker: Speaker,
    domain: u32,
}

impl Peer {
    fn start() -> Option<Self> {
        let domain = domain();
        let mut python = Command::new(python()?);
        python.env("CYCLONEDDS_URI", SETTINGS);
        Some(Self { speaker: Speaker::start(python, "dds_peer.py", &[&domain.to_string()]), domain })
    }

    fn says(&self, start: &str) -> bool {
        self.speaker.says(start)
    }

    fn node(&self, name: &str) -> Ros {
        node(name, self.domain, Vendor::Cyclone).open().expect("a node")
    }
}

/// Sends messages, and expects them back, bit by bit.
fn echo<M: Message + Send + 'static>(ros: &Ros, index: usize, messages: &[M]) {
    let back = Collected::new();
    let add = back.collector();
    let subscription = ros.subscribe(&format!("/pong_{index}")).depth(100).each(move |message: Raw<M>| add(message.0));
    subscription.expect("a topic");
    let ping = ros.publish(&format!("/ping_{index}")).depth(100).open::<Raw<M>>().expect("a topic");
    // Some are lost until both ends know each other. An echo of one of them may come late: each is waited for.
    within(20.0, "the first one comes back", || {
        ping.send(&Raw::of(&messages[0])).expect("it is there");
        thread::sleep(Duration::from_millis(100));
        !back.all().is_empty()
    });
    thread::sleep(Duration::from_millis(500));
    let before = back.all().len();
    for message in messages {
        ping.send(&Raw::of(message)).expect("it is there");
    }
    within(20.0, M::NAME, || back.all().len() >= before + messages.len());
    let sent: Vec<_> = messages.iter().map(|message| Raw::of(message).0).collect();
    let all = back.all();
    assert!(all[all.len() - messages.len()..] == sent, "{}", M::NAME);
}

/// Header with a time of the program, which becomes one of ROS on the way there, and is the same when it is back.
fn header() -> Header {
    Header::new(Time::from_nanos(5_123_456_789), "laser")
}

const ODD: [f64; 5] = [f64::INFINITY, f64::NEG_INFINITY, -0.0, f64::MIN_POSITIVE, 1.5];

#[test]
fn messages_come_back_from_cyclone_bit_by_bit() {
    let Some(peer) = Peer::start() else { return };
    let ros = peer.node("robot");
    let ranges: Vec<f32> = [f32::NAN, f32::INFINITY, -0.0, 1.5].repeat(75);
    echo(&ros, 0, &[LaserScan { header: header(), ranges, ..LaserScan::default() }]);
    let twists = ODD.map(|x| Twist { linear: Vector3 { x, y: f64::MAX, z: f64::NAN }, ..Twist::default() });
    echo(&ros, 1, &twists);
    let data: Vec<u8> = (0..1_000_000_u32).map(|i| (i % 251) as u8).collect();
    echo(
        &ros,
        2,
        &[Image {
            header: header(),
            encoding: "mono8".to_owned(),
            width: 1000,
            height: 1000,
            data,
            ..Image::default()
        }],
    );
    echo(&ros, 3, &["zwölf".to_owned(), String::new()]);
}

#[test]
fn services_nodes_and_late_messages_go_both_ways() {
    let Some(mut peer) = Peer::start() else { return };
    let ros = peer.node("robot");
    let flip = ros.call::<SetBool>("/flip").open().expect("a client");
    within(20.0, "the server", || flip.ask(&SetBoolRequest { data: true }).is_ok());
    for data in [true, false] {
        let response = flip.ask(&SetBoolRequest { data });
        assert_eq!(response, Ok(SetBoolResponse { success: !data, message: "flipped".to_owned() }));
    }
    ros.serve::<SetBool>("~/shout")
        .by(|request| SetBoolResponse { success: request.data, message: "HEY".to_owned() })
        .expect("a service");
    within(20.0, "a response", || {
        peer.speaker.hears("call");
        thread::sleep(Duration::from_millis(200));
        peer.says("response True HEY 7 0x102030405060708")
    });
    // Nodes, with their endpoints: the lists of the tools.
    within(20.0, "the node at the peer", || peer.says("node / robot "));
    within(20.0, "the node here", || ros.sees(Kind::Server, "/flip", "std_srvs/srv/SetBool"));

    let maps = Collected::new();
    ros.subscribe("/map_of_peer").transient_local().depth(1).each::<String>(maps.collector()).expect("a topic");
    within(20.0, "the text", || !maps.all().is_empty());
    maps.expect(&["grün"]);
    let map = ros.publish("/map_of_robot").transient_local().depth(1).open::<String>().expect("a topic");
    map.send(&"blau".to_owned()).expect("it is there");
    within(20.0, "the text at the peer", || peer.says("map blau"));
}

#[test]
fn quality_that_does_not_fit_is_told_with_the_node() {
    let Some(peer) = Peer::start() else { return };
    let told = Collected::new();
    let add = told.collector();
    let ros = node("robot", peer.domain, Vendor::Cyclone).tell(move |text| add(text.to_owned()));
    let ros = ros.open().expect("a node");
    ros.subscribe("/best").each(|_: String| {}).expect("a topic");
    let expected = "`/peer` publishes `/best` as best effort, and this program asks for reliable messages: subscribe \
                    with `.best_effort()`";
    within(20.0, expected, || told.all().iter().any(|text| text == expected));
}

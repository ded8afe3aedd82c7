//! Reasons for silence, within three seconds.

mod common;

use apex_messages::sensor_msgs::{LaserScan, PointCloud2};
use apex_ros::{Distribution, Ros};
use common::{Collected, Router, free_address, within};
use std::{thread, time::Duration};

/// Time within which a silence is explained, in s.
const SOON: f32 = 3.0;

/// A node, and what it is told.
fn node(router: &Router, name: &str) -> (Ros, Collected<String>) {
    let told = Collected::new();
    let add = told.collector();
    (router.node(name).tell(move |text| add(text.to_owned())).open().expect("a node"), told)
}

#[test]
fn a_router_that_does_not_run_is_missed_and_found() {
    let mut router = Router::at(&free_address());
    let (ros, told) = node(&router, "rover");
    ros.subscribe("scan").each(|_: LaserScan| {}).expect("a topic");
    let has = |part: &str| told.all().iter().any(|text| text.contains(part));
    within(SOON, "a router is missed", || has("no router of Zenoh answers at `tcp/127.0.0.1:"));
    assert!(told.all()[0].contains("rmw_zenohd`, or `zenohd`"), "{:?}", told.all());
    assert!(!has("no node publishes"), "without a router nothing is known about the others");
    router.resume();
    within(15.0, "the router is found", || has("a router answers at"));
    within(15.0, "no node publishes", || has("no node publishes `/scan`"));
    let (sender, _) = node(&router, "lidar");
    sender.publish("scan").open::<LaserScan>().expect("a topic");
    within(15.0, "a node publishes", || has("a node publishes `/scan` now"));
    router.stop();
    within(SOON + 1.0, "the router has gone", || {
        told.all().iter().filter(|text| text.contains("no router of Zenoh")).count() == 2
    });
    router.resume();
    within(15.0, "the router is back", || {
        told.all().iter().filter(|text| text.contains("a router answers at")).count() == 2
    });
}

#[test]
fn a_router_elsewhere_that_does_not_run_is_missed_and_found() {
    let mut router = Router::at(&free_address());
    // An address that does not look like one of this machine.
    let address = router.address.replace("127.0.0.1", "127.1");
    let told = Collected::new();
    let add = told.collector();
    let ros = thread::spawn(move || {
        let opening = Ros::node("rover").args([""; 0]).domain(0).router(&address);
        opening.tell(move |text| add(text.to_owned())).open().expect("a node")
    });
    let has = |part: &str| told.all().iter().any(|text| text.contains(part));
    within(SOON, "a router is missed", || has("no router of Zenoh answers at `tcp/127.1:"));
    assert!(!ros.is_finished(), "a client waits for its router");
    router.resume();
    within(15.0, "the router is found", || has("a router answers at") && ros.is_finished());
    let scans = Collected::<LaserScan>::new();
    let ros = ros.join().expect("no panic");
    ros.subscribe("scan").quiet().each(scans.collector()).expect("a topic");
    let (lidar, _) = node(&router, "lidar");
    let publisher = lidar.publish("scan").quiet().open::<LaserScan>().expect("a topic");
    within(15.0, "a scan comes through the router", || {
        publisher.send(&LaserScan::default()).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !scans.all().is_empty()
    });
}

#[test]
fn others_that_mean_something_else_are_named() {
    let router = Router::start();
    let (lidar, _) = node(&router, "lidar");
    let humble = router.node("old").distribution(Distribution::Humble).open().expect("a node");
    let elsewhere = router.node("far").domain(7).open().expect("a node");
    let kept = (
        lidar.publish("cloud").open::<PointCloud2>().expect("a topic"),
        lidar.publish("front").open::<LaserScan>().expect("a topic"),
        humble.publish("old").open::<f64>().expect("a topic"),
        elsewhere.publish("far").open::<f64>().expect("a topic"),
    );
    let (ros, told) = node(&router, "rover");
    ros.subscribe("cloud").each(|_: LaserScan| {}).expect("a topic");
    ros.subscribe("scan").each(|_: LaserScan| {}).expect("a topic");
    ros.subscribe("old").each(|_: f64| {}).expect("a topic");
    ros.subscribe("far").each(|_: f64| {}).expect("a topic");
    let unheard = ros.publish("alone").open::<String>().expect("a topic");
    for text in [
        "`/lidar` publishes `/cloud` as `sensor_msgs/msg/PointCloud2`, and this program has `sensor_msgs/msg/LaserScan` \
         there",
        "no node publishes `/scan`; `/front` has its type: if you mean that, start with `--ros-args -r /scan:=/front`",
        "`/old` publishes `/old` as a program of Humble, whose types have no hash: set `ROS_DISTRO=humble`",
        "no node publishes `/far` in domain 0, but `/far` does in domain 7: set `ROS_DOMAIN_ID=7`",
        "no node subscribes to `/alone`",
    ] {
        within(SOON, text, || told.all().iter().any(|told| told == text));
    }
    drop((kept, unheard));
}

#[test]
fn a_publisher_that_sends_nothing_is_noticed() {
    let router = Router::start();
    let (lidar, _) = node(&router, "lidar");
    let publisher = lidar.publish("scan").quiet().open::<LaserScan>().expect("a topic");
    let (ros, told) = node(&router, "rover");
    let _heard = ros.subscribe("scan").each(|_: LaserScan| {}).expect("a topic");
    let has = |text: &str| told.all().iter().any(|told| told == text);
    within(SOON + 1.0, "nothing comes", || has("a node publishes `/scan`, and no message has come so far"));
    publisher.send(&LaserScan::default()).expect("it is there");
    within(15.0, "a scan has come", || has("what was missing of `/scan` comes now"));
}

#[test]
fn a_publisher_that_falls_silent_is_noticed() {
    let router = Router::start();
    let (lidar, _) = node(&router, "lidar");
    let (ros, told) = node(&router, "rover");
    let subscription = ros.subscribe("scan").each(|_: LaserScan| {}).expect("a topic");
    let publisher = lidar.publish("scan").open::<LaserScan>().expect("a topic");
    within(15.0, "scans", || {
        publisher.send(&LaserScan::default()).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        subscription.heard() > 20
    });
    within(SOON + 1.0, "silence", || told.all().iter().any(|text| text.starts_with("no message of `/scan` has come")));
}

#[test]
fn a_transform_that_never_comes_is_missed() {
    use apex_messages::{geometry_msgs::TransformStamped, std_msgs::Header, tf2_msgs::TFMessage};
    use apex_nodes::scan::Pose2;
    let router = Router::start();
    let (sender, _) = node(&router, "wheels");
    let (ros, told) = node(&router, "rover");
    let subscription = ros.subscribe("/tf").of::<TFMessage>().part("map -> odom").each(|_: Pose2| {}).expect("a topic");
    let publisher = sender.publish("/tf").open::<TFMessage>().expect("a topic");
    let transform = |parent: &str, child: &str| TransformStamped {
        header: Header { frame_id: parent.to_owned(), ..Header::default() },
        child_frame_id: child.to_owned(),
        ..TransformStamped::default()
    };
    let mut sent = TFMessage { transforms: vec![transform("odom", "base_link")] };
    within(15.0, "transforms", || {
        publisher.send(&sent).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        subscription.heard() > 0
    });
    let has = |text: &str| told.all().iter().any(|told| told == text);
    within(SOON + 1.0, "the transform is missed", || {
        drop(publisher.send(&sent));
        has("no message of `/tf` has `map -> odom` so far")
    });
    sent.transforms.push(transform("map", "odom"));
    within(15.0, "the transform has come", || {
        drop(publisher.send(&sent));
        has("what was missing of `/tf` comes now")
    });
}

#[test]
fn messages_in_another_frame_are_told() {
    use apex_messages::std_msgs::Header;
    let router = Router::start();
    let (sender, _) = node(&router, "lidar");
    let (ros, told) = node(&router, "rover");
    let frames = Collected::new();
    let add = frames.collector();
    ros.subscribe("scan").in_frame("laser").each(move |scan: LaserScan| add(scan.header.frame_id)).expect("a topic");
    let publisher = sender.publish("scan").open::<LaserScan>().expect("a topic");
    let scan = |frame: &str| LaserScan { header: Header::new(apex_rt::Time::ZERO, frame), ..LaserScan::default() };
    within(15.0, "a scan of another scanner", || {
        publisher.send(&scan("rear")).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        told.all().iter().any(|text| {
            text == "`/scan`: a message cannot be read: it is in the frame `rear`, and not in `laser` (1 of them so far)"
        })
    });
    within(15.0, "a scan in the frame", || {
        publisher.send(&scan("/laser")).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !frames.all().is_empty()
    });
    assert!(frames.all().iter().all(|frame| frame == "/laser"), "{:?}", frames.all());
}

#[test]
fn messages_that_cannot_be_read_are_told() {
    use apex_messages::{geometry_msgs::Pose, nav_msgs::OccupancyGrid};
    use apex_nodes::map::{Grid, Occupancy};
    let router = Router::start();
    let (sender, _) = node(&router, "maps");
    let (ros, told) = node(&router, "rover");
    let maps = Collected::new();
    ros.subscribe("map")
        .each::<Grid<Occupancy>>({
            let maps = maps.clone();
            move |map| maps.add(map.raster().width)
        })
        .expect("a topic");
    let publisher = sender.publish("map").open::<OccupancyGrid>().expect("a topic");
    let mut turned = OccupancyGrid::default();
    turned.info.resolution = 0.05;
    turned.info.origin = Pose::from(&apex_nodes::scan::Pose2::new(0.0, 0.0, 0.5));
    within(15.0, "a turned map", || {
        publisher.send(&turned).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        told.all().iter().any(|text| {
            text == "`/map`: a message cannot be read: its origin is turned by 28.6°: only maps along the axes can be \
                     read (1 of them so far)"
        })
    });
    assert!(maps.all().is_empty());
}

//! Topics between two nodes, through a router.

mod common;

use apex_messages::{
    geometry_msgs::{PoseWithCovarianceStamped, TransformStamped, TwistStamped},
    nav_msgs::{OccupancyGrid, Odometry},
    sensor_msgs::LaserScan,
    std_msgs::{Float64, Header},
    tf2_msgs::TFMessage,
};
use apex_nodes::{
    nav::Twist,
    scan::{Pose2, Scan, UncertainPose},
};
use apex_ros::{Distribution, Kind};
use apex_rt::{Clock as _, Time};
use common::{Collected, Router, within};
use std::{thread, time::Duration};

/// Waits until another program subscribes.
macro_rules! heard {
    ($ros:expr, $topic:expr, $ty:ty) => {
        within(15.0, "a subscription is seen", || {
            $ros.sees(Kind::Subscription, $topic, <$ty as apex_messages::Message>::NAME)
        })
    };
}

#[test]
fn scans_arrive_bit_by_bit_with_times_of_the_program() {
    let router = Router::start();
    let (sender, receiver) = (router.node("lidar").open().expect("a"), router.node("rover").open().expect("b"));
    let (tokens, messages) = (Collected::new(), Collected::new());
    receiver.subscribe("scan").best_effort().each::<Scan>(tokens.collector()).expect("a topic");
    receiver.subscribe("/scan").each::<LaserScan>(messages.collector()).expect("a topic");
    let publisher = sender.publish("scan").best_effort().frame("laser").open::<Scan>().expect("a topic");
    heard!(sender, "scan", Scan);
    let ranges = [f32::INFINITY, f32::NEG_INFINITY, f32::from_bits(0x7fc0_1234), -0.0, 1.5];
    let stamp = sender.clock().now();
    let scan = Scan { stamp, angle_increment: 0.1, ranges: ranges.into_iter().collect(), ..Scan::default() };
    within(15.0, "a scan", || {
        publisher.send(&scan).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !tokens.all().is_empty() && !messages.all().is_empty()
    });
    let bits = |ranges: &[f32]| ranges.iter().map(|range| range.to_bits()).collect::<Vec<_>>();
    let got = &tokens.all()[0];
    assert_eq!(bits(&got.ranges), bits(&ranges));
    // The receiver started later: by its clock, the scan is older than by the sender's.
    assert!(got.stamp < scan.stamp && receiver.clock().now().since(got.stamp) < Duration::from_secs(6));
    let message = messages.all().remove(0);
    assert_eq!(message.header.frame_id, "laser");
    let again = message.header.stamp.as_nanos();
    assert_eq!(Time::from_nanos(again), got.stamp, "both are times of the receiver");
}

#[test]
fn tokens_are_read_from_and_written_as_other_messages() {
    let router = Router::start();
    let (sender, receiver) = (router.node("base").open().expect("a"), router.node("rover").open().expect("b"));
    let (poses, twists, parts) = (Collected::new(), Collected::new(), Collected::new());
    receiver.subscribe("odom").of::<Odometry>().each::<Pose2>(poses.collector()).expect("a topic");
    receiver.subscribe("cmd_vel").of::<TwistStamped>().each::<Twist>(twists.collector()).expect("a topic");
    let tf = receiver.subscribe("/tf").of::<TFMessage>().part("odom -> base_link");
    tf.each::<Pose2>(parts.collector()).expect("a topic");
    let odometry = sender.publish("odom").frame("odom").open::<Odometry>().expect("a topic");
    let stamped = sender.publish("cmd_vel").open::<TwistStamped>().expect("a topic");
    let transforms = sender.publish("/tf").open::<TFMessage>().expect("a topic");
    let (pose, twist) = (Pose2::new(1.0, -2.0, 0.5), Twist::new(0.5, 0.0, -0.1));
    let transform = TransformStamped {
        header: Header::new(Time::ZERO, "odom"),
        child_frame_id: "base_link".to_owned(),
        transform: (&pose).into(),
    };
    within(15.0, "all three", || {
        odometry.send(&(&pose).into()).expect("it is there");
        stamped.send(&(&twist).into()).expect("it is there");
        transforms.send(&TFMessage { transforms: vec![transform.clone()] }).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !poses.all().is_empty() && !twists.all().is_empty() && !parts.all().is_empty()
    });
    assert_eq!((poses.all()[0], twists.all()[0], parts.all()[0]), (pose, twist, pose));
    let error = receiver.subscribe("odom").of::<Float64>().each::<Pose2>(|_| {}).map(drop).expect_err("no pose");
    assert!(error.to_string().contains("is not read from `std_msgs/msg/Float64`, but from"), "{error}");
}

#[test]
fn how_sure_a_pose_is_goes_along() {
    let router = Router::start();
    let (sender, receiver) = (router.node("localizer").open().expect("a"), router.node("planner").open().expect("b"));
    let (estimates, messages, poses) = (Collected::new(), Collected::new(), Collected::new());
    receiver.subscribe("amcl_pose").each::<UncertainPose>(estimates.collector()).expect("a topic");
    receiver.subscribe("amcl_pose").each::<PoseWithCovarianceStamped>(messages.collector()).expect("a topic");
    // As RViz sends it to a robot whose place it knows.
    let initial = receiver.subscribe("amcl_pose").of::<PoseWithCovarianceStamped>();
    initial.each::<Pose2>(poses.collector()).expect("a topic");
    let publisher = sender.publish("amcl_pose").frame("map").open::<UncertainPose>().expect("a topic");
    let covariance = [[0.25, 0.1, 0.0], [0.1, 0.5, 0.0], [0.0, 0.0, 0.0625]];
    let estimate = UncertainPose { pose: Pose2::new(1.0, -2.0, 0.5), covariance };
    within(15.0, "all three", || {
        publisher.send(&estimate).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !estimates.all().is_empty() && !messages.all().is_empty() && !poses.all().is_empty()
    });
    assert_eq!((estimates.all()[0], poses.all()[0]), (estimate, estimate.pose));
    let message = messages.all().remove(0);
    let [x, y, turn] = [0, 7, 35].map(|at| message.pose.covariance[at]);
    assert_eq!((message.header.frame_id.as_str(), [x, y, turn]), ("map", [0.25, 0.5, 0.0625]));
}

#[test]
fn a_map_comes_to_those_who_are_late() {
    let router = Router::start();
    let sender = router.node("maps").open().expect("a node");
    let publisher = sender.publish("/map").transient_local().depth(1).open::<OccupancyGrid>().expect("a topic");
    for cell in [1, 2, 3] {
        publisher.send(&OccupancyGrid { data: vec![cell], ..OccupancyGrid::default() }).expect("it is there");
    }
    let (receiver, maps, late) = (router.node("rover").open().expect("a node"), Collected::new(), Collected::new());
    let map = |all: &Collected<OccupancyGrid>| all.all().iter().map(|map| map.data.clone()).collect::<Vec<_>>();
    receiver.subscribe("/map").transient_local().depth(1).each(maps.collector()).expect("a topic");
    receiver.subscribe("/map").depth(1).each(late.collector()).expect("a topic");
    within(15.0, "the last map", || map(&maps) == [[3]]);
    publisher.send(&OccupancyGrid { data: vec![4], ..OccupancyGrid::default() }).expect("it is there");
    within(15.0, "the next map", || map(&maps) == [[3], [4]] && map(&late) == [[4]]);
}

#[test]
fn names_are_remapped_and_domains_are_apart() {
    let router = Router::start();
    let args = ["--ros-args", "-r", "__ns:=/robot1", "-r", "__node:=second", "-r", "value:=other"];
    let sender = router.node("first").args(args).open().expect("a node");
    assert_eq!(sender.name(), "/robot1/second");
    let (receiver, elsewhere) = (router.node("b").open().expect("b"), router.node("c").domain(5).open().expect("c"));
    let (here, there) = (Collected::new(), Collected::new());
    receiver.subscribe("/robot1/other").each::<f64>(here.collector()).expect("a topic");
    elsewhere.subscribe("/robot1/other").each::<f64>(there.collector()).expect("a topic");
    let publisher = sender.publish("value").open::<f64>().expect("a topic");
    within(15.0, "a number", || {
        publisher.send(&1.5).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !here.all().is_empty()
    });
    thread::sleep(Duration::from_millis(50));
    assert_eq!((here.all()[0], there.all().len()), (1.5, 0));
}

#[test]
fn programs_of_humble_have_no_hashes() {
    let router = Router::start();
    let humble = |name| router.node(name).distribution(Distribution::Humble).open().expect("a node");
    let (sender, receiver, jazzy) = (humble("a"), humble("b"), router.node("c").open().expect("c"));
    let (here, there) = (Collected::new(), Collected::new());
    receiver.subscribe("value").each::<f64>(here.collector()).expect("a topic");
    jazzy.subscribe("value").each::<f64>(there.collector()).expect("a topic");
    let publisher = sender.publish("value").open::<f64>().expect("a topic");
    within(15.0, "a number", || {
        publisher.send(&1.5).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !here.all().is_empty()
    });
    assert!(there.all().is_empty());
}

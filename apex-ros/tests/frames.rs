//! Transforms beside a program of others: Python with `eclipse-zenoh`, `rosbags` and NumPy.

mod common;

use apex_messages::nav_msgs::Odometry;
use apex_nodes::{
    frames::{Kind, Pose3, Rotation, Transform, TransformBuffer, Transforms, frame_name},
    scan::Pose2,
};
use apex_ros::Kind as Endpoint;
use apex_rt::{Clock as _, Ports, Switch, UntilStopped, drive_from};
use common::{
    Collected, Router,
    python::{Peer, python},
    within,
};
use std::{thread, time::Duration};

apex_macros::graph!("frames.afg");

fn transform(parent: &str, child: &str, pose: Pose3) -> Transform {
    let name = |name| frame_name(name).expect("a short name");
    Transform { parent: name(parent), child: name(child), pose, ..Transform::default() }
}

#[test]
fn scans_are_placed_by_the_transforms_of_others() {
    let Some(python) = python() else { return };
    let peer = Peer::start(&*python, "frames_peer.py", &[]);
    let ros = peer.node("robot");
    let mut ports = Ports::<Turned>::new();
    ros.subscribe("/tf").depth(100).feed(ports.input(|inputs| &mut inputs.moving)).expect("a topic");
    let fixed = ros.subscribe("/tf_static").transient_local().depth(100);
    fixed.feed(ports.input(|inputs| &mut inputs.fixed)).expect("a topic");
    ros.subscribe("scan").feed(ports.input(|inputs| &mut inputs.scan)).expect("a topic");
    ros.publish("~/placed").frame("odom").take(ports.event(|events| &mut events.placed)).expect("a topic");
    let (stop, clock): (&'static Switch, _) = (Box::leak(Box::default()), ros.clock());
    let driver = thread::spawn(move || drive_from(Turned::new(), UntilStopped::new(clock, stop), ports));
    let placed = || peer.lines.all().iter().filter(|line| line.starts_with("placed")).cloned().collect::<Vec<_>>();
    within(15.0, "fifty scans", || placed().len() >= 50);
    assert!(placed().iter().all(|line| line == "placed odom right"), "{:?}", placed());
    // And transforms of the program reach the others.
    let sender = ros.publish("/tf").depth(100).open::<Transforms>().expect("a topic");
    let pose = Pose3::new([1.5, -2.5, 0.25], Rotation::new([0.6, 0.0, 0.0, 0.8]).expect("a rotation"));
    let all = Transforms { transforms: [transform("map", "odom", pose)].into_iter().collect() };
    within(20.0, "the transform at the peer", || {
        sender.send(&all).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        peer.says("tf map odom 1.5 -2.5 0.25 0.6 0.8 now")
    });
    stop.set();
    driver.join().expect("it ends");
}

#[test]
fn odometry_is_a_transform_with_its_frames() {
    let router = Router::start();
    let (sender, receiver) = (router.node("base").open().expect("a"), router.node("rover").open().expect("b"));
    let all = Collected::new();
    receiver.subscribe("odom").of::<Odometry>().each::<Transforms>(all.collector()).expect("a topic");
    let odometry = sender.publish("odom").frame("odom").open::<Odometry>().expect("a topic");
    within(15.0, "a subscription is seen", || sender.sees(Endpoint::Subscription, "odom", "nav_msgs/msg/Odometry"));
    within(15.0, "odometry", || {
        odometry.send(&(&Pose2::new(1.0, -2.0, 0.0)).into()).expect("it is there");
        thread::sleep(Duration::from_millis(20));
        !all.all().is_empty()
    });
    let mut buffer = TransformBuffer::<4, 2, 8>::default();
    let got = all.all().remove(0);
    buffer.insert_all(&got, Kind::Moving).expect("a tree");
    let at = got.transforms[0].stamp;
    assert!(receiver.clock().now().since(at) < Duration::from_secs(6));
    assert_eq!(buffer.look_up("base_link", "odom", at).map(|pose| pose.position()), Ok([1.0, -2.0, 0.0]));
}

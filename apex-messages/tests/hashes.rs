//! Hashes that others have published: rmw_zenoh (docs/design.md), and tables of clients that talk to it.

use apex_messages::{
    Action, Message, Service, action_msgs, example_interfaces, nav_msgs, rcl_interfaces, sensor_msgs, std_msgs,
};

fn service<S: Service>() -> &'static str {
    S::HASH
}

#[test]
fn hashes_are_those_of_ros() {
    type SendGoal = <example_interfaces::Fibonacci as Action>::SendGoal;
    type GetResult = <example_interfaces::Fibonacci as Action>::GetResult;
    for (ours, published) in [
        (std_msgs::String::HASH, "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"),
        (sensor_msgs::LaserScan::HASH, "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828"),
        (rcl_interfaces::Log::HASH, "e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"),
        (action_msgs::GoalStatusArray::HASH, "6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e"),
        (
            service::<example_interfaces::AddTwoInts>(),
            "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
        ),
        (service::<SendGoal>(), "d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557"),
        (service::<GetResult>(), "1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57"),
        (service::<action_msgs::CancelGoal>(), "573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a"),
        (
            service::<rcl_interfaces::SetParametersAtomically>(),
            "0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd",
        ),
        (
            service::<rcl_interfaces::DescribeParameters>(),
            "845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
        ),
    ] {
        assert_eq!(ours.strip_prefix("RIHS01_"), Some(published));
    }
}

#[test]
fn values_by_default_are_those_of_the_definitions() {
    let pose = nav_msgs::Odometry::default().pose;
    assert_eq!((pose.pose.orientation.w, pose.covariance), (1.0, [0.0; 36]));
}

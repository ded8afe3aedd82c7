//! The mission of `robots/rover` as a node of ROS 2, which drives a base that only Zenoh connects:
//! `cargo run --example rover`.

use apex_macros::graph;
use apex_messages::nav_msgs::Odometry;
use apex_nodes::nav::Twist;
use apex_ros::{Error, Ros};
use apex_rt::Ports;
use std::process::ExitCode;

// What the text takes from its crate.
pub use rover::{AskBattery, Drive, Retrace, Turn, free_ahead};

graph!("../../robots/rover/apart.afg");

/// Runs the mission until Ctrl-C.
pub fn main() -> Result<ExitCode, Error> {
    let ros = Ros::open("rover")?;
    let mut ports = Ports::<Apart>::new();
    ros.subscribe("scan").best_effort().depth(1).feed(ports.input(|inputs| &mut inputs.scan))?;
    ros.subscribe("odom").of::<Odometry>().depth(1).feed(ports.input(|inputs| &mut inputs.odometry))?;
    ros.subscribe("battery").depth(1).feed(ports.input(|inputs| &mut inputs.battery))?;
    ros.publish("cmd_vel").take_ending_with(ports.event(|events| &mut events.twist), Twist::ZERO)?;
    ros.publish("~/says").take(ports.event(|events| &mut events.says))?;
    ros.publish("~/home").take(ports.event(|events| &mut events.home))?;
    ros.drive(Apart::new(), ports).map(ExitCode::from)
}

//! A simulated base and its scanner as a node of ROS 2: `cargo run --example base`.

use apex_macros::graph;
use apex_messages::nav_msgs::Odometry;
use apex_ros::{Error, Ros};
use apex_rt::Ports;
use std::process::ExitCode;

graph!("base.afg");

/// Runs the base until Ctrl-C.
pub fn main() -> Result<ExitCode, Error> {
    let ros = Ros::open("base")?;
    let mut ports = Ports::<Base>::new();
    ros.subscribe("cmd_vel").feed(ports.input(|inputs| &mut inputs.twist))?;
    ros.publish("odom").frame("odom").of::<Odometry>().take(ports.event(|events| &mut events.odometry))?;
    ros.publish("scan").best_effort().frame("laser").take(ports.event(|events| &mut events.scan))?;
    ros.publish("battery").take(ports.event(|events| &mut events.battery))?;
    ros.drive(Base::new(), ports).map(ExitCode::from)
}

//! A mission beside a TurtleBot: `cargo run --example turtlebot`.

use apex_macros::graph;
use apex_messages::{geometry_msgs::TwistStamped, nav_msgs::Odometry};
use apex_nodes::nav::Twist;
use apex_ros::{Error, Ros};
use apex_rt::Ports;
use std::process::ExitCode;

graph!("turtlebot.afg");

fn main() -> Result<ExitCode, Error> {
    let ros = Ros::open("forward")?;
    let mut ports = Ports::<Forward>::new();
    ros.subscribe("odom").of::<Odometry>().depth(1).feed(ports.input(|inputs| &mut inputs.odometry))?;
    ros.subscribe("scan").best_effort().depth(1).feed(ports.input(|inputs| &mut inputs.scan))?;
    let twist = ports.event(|events| &mut events.twist);
    ros.publish("cmd_vel").of::<TwistStamped>().take_ending_with(twist, Twist::ZERO)?;
    ros.publish("~/there").take(ports.event(|events| &mut events.there))?;
    ros.drive(Forward::new(), ports).map(ExitCode::from)
}

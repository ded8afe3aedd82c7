//! A managed node that serves an action: `cargo run --example goals`.

use apex_macros::graph;
use apex_messages::example_interfaces::Fibonacci;
use apex_ros::{Error, Ros};
use apex_rt::Ports;
use std::process::ExitCode;

mod tokens;

graph!("goals.afg");

fn main() -> Result<ExitCode, Error> {
    let ros = Ros::open("worker")?;
    let mut ports = Ports::<Worker>::new();
    let (manage, managed) = (ports.input(|inputs| &mut inputs.manage), ports.event(|events| &mut events.managed));
    ros.manage().through(manage, managed)?;
    let (orders, reports) = (ports.input(|inputs| &mut inputs.orders), ports.event(|events| &mut events.reports));
    ros.serve_goals::<Fibonacci>("fibonacci").through(orders, reports)?;
    ros.drive(Worker::new(), ports).map(ExitCode::from)
}

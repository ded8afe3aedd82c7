//! An action over DDS: the example `goals`, as two nodes.

mod common;
#[path = "../../examples/goals/tokens.rs"]
mod tokens;

use apex_macros::graph;
use apex_messages::example_interfaces::{Fibonacci, FibonacciGoal};
use apex_nodes::lifecycle::Transition;
use apex_ros::Kind;
use apex_ros_dds::Vendor;
use apex_rt::{Ports, Switch, UntilStopped, drive_from};
use common::{Collected, domain, node, within};
use std::{thread, time::Duration};

graph!("../../examples/goals/goals.afg");

/// Switch that ends a program, which may outlive the test.
fn switch() -> &'static Switch {
    Box::leak(Box::default())
}

#[test]
fn goals_are_reached_and_called_off_for_each_vendor() {
    for vendor in [Vendor::Cyclone, Vendor::Fast] {
        goals(vendor);
    }
}

fn goals(vendor: Vendor) {
    let domain = domain();
    let open = |name| node(name, domain, vendor).open().expect("a node");
    let (worker, asker) = (open("worker"), open("asker"));
    let mut ports = Ports::<Worker>::new();
    let manage = ports.input(|inputs| &mut inputs.manage);
    let (orders, reports) = (ports.input(|inputs| &mut inputs.orders), ports.event(|events| &mut events.reports));
    worker.serve_goals::<Fibonacci>("fibonacci").through(orders, reports).expect("an action");
    let (stop_worker, clock) = (switch(), worker.clock());
    let works = thread::spawn(move || drive_from(Worker::new(), UntilStopped::new(clock, stop_worker), ports));
    manage.put(Transition::Activate).expect("room");

    let mut ports = Ports::<Asker>::new();
    let (go, stop) = (ports.input(|inputs| &mut inputs.go), ports.input(|inputs| &mut inputs.stop));
    let (orders, reports) = (ports.event(|events| &mut events.orders), ports.input(|inputs| &mut inputs.reports));
    let (reached, failed) = (ports.event(|events| &mut events.reached), ports.event(|events| &mut events.failed));
    asker.send_goals::<Fibonacci>("fibonacci").through(orders, reports).expect("an action");
    let (stop_asker, clock) = (switch(), asker.clock());
    let asks = thread::spawn(move || drive_from(Asker::new(), UntilStopped::new(clock, stop_asker), ports));
    let ends = Collected::new();
    for (event, word) in [(reached, "reached"), (failed, "failed")] {
        let add = ends.collector();
        thread::spawn(move || {
            while event.receive().is_some() {
                add(word);
            }
        });
    }
    within(20.0, "the server", || {
        asker.sees(Kind::Server, "fibonacci/_action/send_goal", "example_interfaces/action/Fibonacci_SendGoal")
    });
    // The work takes three seconds. A goal is lost if both ends have not met yet.
    within(60.0, "a goal that is reached", || {
        ends.clear();
        go.put(FibonacciGoal { order: 5 }).expect("room");
        within(40.0, "its end", || !ends.all().is_empty());
        ends.all() == ["reached"]
    });
    ends.clear();
    within(10.0, "the next goal", || go.put(FibonacciGoal { order: 5 }).is_ok());
    thread::sleep(Duration::from_secs(1));
    within(5.0, "it is called off", || stop.put(()).is_ok());
    thread::sleep(Duration::from_millis(500));
    assert_eq!(ends.all().iter().filter(|end| **end == "failed").count(), 0);
    within(10.0, "one more goal", || go.put(FibonacciGoal { order: 5 }).is_ok());
    within(20.0, "it is reached", || ends.all().contains(&"reached"));
    stop_asker.set();
    stop_worker.set();
    asks.join().expect("it ends");
    works.join().expect("it ends");
}

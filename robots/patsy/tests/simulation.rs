//! The rates of experiment 1 (thesis 6.10.2, table 6.2) in simulation, with nodes connected by hand.

use apex_rt::{Clock, Construct, Ctx, Event, Next, Out, SimClock, Time};
use core::f32::consts::PI;
use patsy::{
    Finder, Search,
    experiments::{Ends, Evaluate},
    programs::Simulated,
    world::SimLaser,
};
use std::time::{Duration, Instant};

/// Plays the simulation. Returns the results and the computing time per scan.
fn play(seed: u64) -> (Evaluate, Duration) {
    let mut laser = SimLaser::construct((seed, 20, 50, 1.5 * PI, PI / 360.0, 0.01, 0.005));
    let mut finder = Finder::new(&Search::CART);
    let mut evaluate = Evaluate::construct((0.3, 0.35));
    let (mut scan, mut truth, mut pose) = (Out::new(), Out::new(), Out::new());
    let (mut busy, mut scans) = (Duration::ZERO, 0);
    loop {
        let ctx = Ctx::new(Time::from_millis(40 * i64::from(scans)));
        laser.process(&ctx, &mut scan, &mut truth, &mut pose, Event::unconnected(), Event::unconnected());
        if laser.finished() {
            return (evaluate, busy / scans);
        }
        let start = Instant::now();
        let found = finder.find(scan.get().expect("a scan")).expect("few segments");
        busy += start.elapsed();
        scans += 1;
        evaluate.process(truth.get().expect("a truth"), found.as_ref());
    }
}

#[test]
fn finds_nearly_all_carts_and_hardly_anything_else() {
    for seed in [1, 2, 3] {
        let (evaluate, time) = play(seed);
        println!("seed {seed}, {time:?} per scan\n{evaluate}\n");
        let all = evaluate.combined();
        assert_eq!(all.scans, 5 * 20 * 50);
        assert!(all.true_rate() >= Some(0.95) && all.false_rate() <= Some(0.01), "{evaluate}");
    }
}

#[test]
fn the_compiled_robot_does_what_the_hand_written_one_does() {
    let mut robot = Simulated::new();
    let mut clock = SimClock::until(Time::MAX);
    while !robot.nodes().laser.finished() {
        if let Next::At(time) = robot.react(clock.now()) {
            clock.wait_until(time);
        }
    }
    let (by_hand, _) = play(1);
    assert_eq!(robot.nodes().evaluate.to_string(), by_hand.to_string());
    // A search begins with every run. In 80 of them there is a container.
    let ends = Ends { searches: 100, at_container: 80, at_nothing: 0, rightly_given_up: 20, wrongly_given_up: 0 };
    assert_eq!(robot.nodes().referee.ends(), ends);
}

//! The rates of experiment 1 (thesis 6.10.2, table 6.2) in simulation, with nodes connected by hand.

use apex_nodes::scan::{ContainerSearch, JumpDistance, RangeFilter, SegmentFilter};
use apex_rt::{Clock, Construct, Ctx, Event, Next, Out, SimClock, Time};
use core::f32::consts::PI;
use patsy::{Evaluate, LENGTH, SimLaser, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH, programs::Simulated};
use std::time::{Duration, Instant};

fn search() -> ContainerSearch {
    ContainerSearch::construct((
        WIDTH,
        LENGTH,
        WHEEL_WIDTH,
        WHEEL_LENGTH,
        0.15,                   // width_tolerance
        1,                      // min_points
        4,                      // min_inliers
        3,                      // max_outliers
        3,                      // min_wheels
        0,                      // max_missing
        0.0,                    // clearance
        120.0_f32.to_radians(), // max_view_angle: near wheels are in front, or just hidden by each other
        WHEEL_BOXES,
    ))
}

/// Plays the simulation. Returns the results and the computing time per scan.
fn play(seed: u64) -> (Evaluate, Duration) {
    let mut laser = SimLaser::construct((seed, 20, 50, 1.5 * PI, PI / 360.0, 0.01, 0.005));
    let mut filter = RangeFilter::construct((0.05, 10.0));
    let mut jumps = JumpDistance::construct((0.15, 1));
    let mut wheels = SegmentFilter::construct((0.2, 5.0, 1));
    let mut search = search();
    let mut evaluate = Evaluate::construct((0.3, 0.35));
    let (mut scan, mut truth, mut pose) = (Out::new(), Out::new(), Out::new());
    let (mut filtered, mut segments, mut candidates) = (Out::new(), Out::new(), Out::new());
    let (mut busy, mut scans) = (Duration::ZERO, 0);
    loop {
        let ctx = Ctx::new(Time::from_millis(40 * i64::from(scans)));
        laser.process(&ctx, &mut scan, &mut truth, &mut pose, Event::unconnected(), Event::unconnected());
        if laser.finished() {
            return (evaluate, busy / scans);
        }
        let start = Instant::now();
        filter.process(scan.get().expect("a scan"), &mut filtered);
        let filtered = filtered.get().expect("a scan");
        jumps.process(filtered, &mut segments).expect("few segments");
        wheels.process(segments.get().expect("segments"), &mut candidates);
        let found = search.process(filtered, candidates.get().expect("segments"));
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
    // A search begins with every run. In 80 of them there is a container, and in two empty rooms a similar object.
    assert_eq!(robot.nodes().drive.counts(), (100, 82));
}

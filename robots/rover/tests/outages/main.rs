//! Sensors of the robot that fail while it drives. Its base keeps the last twist.

mod faults;

use apex_nodes::nav::Twist;
use apex_rt::prelude::*;
use apex_sim::{MotionWatch, OutageTable, Promise, Stops, in_order, outages};
use faults::Fault;
use std::time::Duration;

apex_macros::graph!("outages.afg");

const PERIOD: Duration = Duration::from_millis(50);
const END: Time = Time::from_secs(60);

/// Promise about a fault. The base brakes with 1 m/s² from 0.6 m/s; the nodes send zero one firing after the last
/// measurement is too old at the latest.
const fn promise(fault: Fault) -> Promise {
    const fn after(ms: u64) -> Duration {
        Duration::from_millis(ms + 50 + 600)
    }
    let stops = match fault {
        // `OdometryGuard` waits for more than 0.4 s until it takes a pose that does not change for a frozen one.
        Fault::PoseFrozen => Stops::Tries(after(400 + 50)),
        Fault::PoseSilent | Fault::PoseNan | Fault::PoseFar => Stops::Within(after(0)),
        _ => Stops::Within(after(500)),
    };
    Promise { fault: fault.name(), period: PERIOD, stops }
}

/// Runs the robot with outages that the seed draws.
fn run(seed: u64) -> MotionWatch {
    let outages = outages(seed, Fault::ALL.len(), [Time::ZERO, END]);
    let mut watch = MotionWatch::new(&Fault::ALL.map(promise), outages.clone());
    let mut robot = Box::new(Failing::new());
    let (mut last, mut told, mut clock) = (None, Fault::None, SimClock::until(END));
    loop {
        let now = clock.now();
        let present = outages.iter().find(|outage| outage.from <= now && now < outage.until);
        let fault = present.map_or(Fault::None, |outage| Fault::ALL[outage.kind]);
        if fault != told {
            assert!(robot.inputs().fault.put(fault).is_ok(), "it is taken at once");
            told = fault;
        }
        let next = robot.react(now);
        robot.events().sent.take();
        assert!(robot.events().bumped.take().is_none(), "seed {seed}: it touches something at {now:?}");
        if let Some(pose) = robot.outputs().pose {
            let (before, then) = last.replace((pose, now)).unwrap_or((pose, Time::ZERO));
            if now > then {
                let (way, rate) = (pose.relative_to(&before), 1.0 / now.since(then).as_secs_f32());
                watch.see(now, &Twist::of(way.position().scaled(rate), way.theta * rate));
            }
        }
        let Next::At(next) = next else { continue };
        if !clock.wait_until(next) {
            break;
        }
    }
    watch
}

fn runs(count: u64) -> Vec<MotionWatch> {
    let seeds: Vec<u64> = (1..=count).collect();
    in_order(&seeds, None, |seed| run(*seed), |_| ()).expect("threads")
}

#[test]
fn no_motion_is_longer_than_promised() {
    let watches = runs(25);
    assert!(watches.iter().all(|watch| watch.broken().is_empty()), "{}", OutageTable(&watches));
}

/// The table of `docs/safety.md`: `cargo test --release -p rover --test outages -- --ignored --nocapture`.
#[test]
#[ignore = "takes ten seconds"]
fn a_hundred_runs() {
    let watches = runs(100);
    println!("{}", OutageTable(&watches));
    for (seed, watch) in (1..).zip(&watches) {
        watch.broken().iter().for_each(|(outage, time)| println!("seed {seed}: {outage:?}, {time:?}"));
    }
    assert!(watches.iter().all(|watch| watch.broken().is_empty()));
}

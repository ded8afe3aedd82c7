//! `contract.afg`: programs with the nodes of the contract, in simulated time.

use apex_macros::graph;
use apex_nodes::{
    nav::{BackPath, BackPiece, Path, Twist},
    scan::{Point2, Pose2, Scan},
};
use apex_rt::prelude::*;
use std::time::Duration;

graph!("contract.afg");

/// Room with a wall 5 m ahead.
pub const ROOM: &str = "\
##############################
#                            #
#                            #
#    >                       #
#                            #
#                            #
##############################";

/// Scanner that works, is in the open, or has failed in one of several ways after a second.
#[node]
pub struct Sensor {
    /// Failure: 0 for none, 1 for nothing in range, then NaN, no beams, the same scan, and another clock.
    #[param(range = 0..=5)]
    failure: u8,
}

#[node]
impl Sensor {
    fn process(&mut self, ctx: &Ctx) -> Scan {
        let mut scan =
            Scan { angle_min: -1.5, angle_increment: 0.1, range_max: 30.0, stamp: ctx.now(), ..Scan::default() };
        scan.ranges.extend([4.0; 31]);
        if ctx.now() < Time::from_secs(1) {
            return scan;
        }
        match self.failure {
            1 => scan.ranges.iter_mut().for_each(|range| *range = f32::INFINITY),
            2 => scan.ranges.iter_mut().for_each(|range| *range = f32::NAN),
            3 => scan.ranges.clear(),
            4 => scan.stamp = Time::from_secs(1),
            5 => scan.stamp = ctx.now() + Duration::from_secs(3600),
            _ => {}
        }
        scan
    }
}

/// Twists of all movements.
fn react(program: &mut Movements, now: Time) -> [Option<Twist>; 8] {
    program.react(now);
    let events = program.events();
    [
        events.moved.take(),
        events.ahead.take(),
        events.positioned.take(),
        events.followed.take(),
        events.backed.take(),
        events.backed_path.take(),
        events.reacted.take(),
        events.planned.take(),
    ]
}

fn put(program: &mut Movements, now: Time) {
    let inputs = program.inputs();
    assert!(inputs.pose.put(Pose2::default()).is_ok());
    assert!(inputs.trailer.put(Pose2::new(-0.65, 0.0, 0.0)).is_ok());
    assert!(inputs.target.put(Pose2::new(4.0, 0.0, core::f32::consts::PI)).is_ok());
    assert!(inputs.container.put(Pose2::new(6.0, 0.0, 0.0)).is_ok());
    let mut scan = Scan { angle_min: -0.1, angle_increment: 0.1, range_max: 30.0, stamp: now, ..Scan::default() };
    scan.ranges.extend([4.0; 3]);
    assert!(inputs.scan.put(scan).is_ok());
}

/// Movements that drive since 200 ms.
fn driving() -> Movements {
    let mut program = Movements::new();
    let path = Path { points: [0.0, 3.0].map(|x| Point2::new(x, 0.0)).into(), heading: 0.0 };
    assert!(program.inputs().path.put(path).is_ok());
    let back = BackPath { pieces: vec![BackPiece { bend: 0.0, length: 2.0 }] };
    assert!(program.inputs().back_path.put(back).is_ok());
    for ms in [0, 100, 200] {
        put(&mut program, Time::from_millis(ms));
        let twists = react(&mut program, Time::from_millis(ms));
        assert!(ms == 0 || twists.iter().all(|twist| twist.is_some_and(|t| t != Twist::ZERO)), "{twists:?}");
    }
    program
}

#[test]
fn movements_stop_in_silence_and_go_on() {
    let mut program = driving();
    assert_eq!(react(&mut program, Time::from_millis(699)), [None; 8]);
    assert_eq!(react(&mut program, Time::from_millis(700)), [Some(Twist::ZERO); 8]);
    put(&mut program, Time::from_millis(900));
    react(&mut program, Time::from_millis(900));
    put(&mut program, Time::from_millis(1000));
    let twists = react(&mut program, Time::from_millis(1000));
    assert!(twists.iter().all(|twist| twist.is_some_and(|t| t != Twist::ZERO)), "{twists:?}");
}

/// The sensors fall silent, and a watchdog interrupts the movements.
#[test]
fn movements_that_are_interrupted_in_silence_send_zero() {
    let mut program = driving();
    assert!(program.inputs().stop.put(()).is_ok());
    assert_eq!(react(&mut program, Time::from_millis(300)), [None; 8]);
    assert_eq!(react(&mut program, Time::from_millis(700)), [Some(Twist::ZERO); 8]);
    assert_eq!(react(&mut program, Time::from_millis(1200)), [None; 8]);
}

#[test]
fn movements_that_are_interrupted_send_zero_with_the_next_token() {
    let mut program = driving();
    assert!(program.inputs().stop.put(()).is_ok());
    react(&mut program, Time::from_millis(210));
    put(&mut program, Time::from_millis(300));
    assert_eq!(react(&mut program, Time::from_millis(300)), [Some(Twist::ZERO); 8]);
}

/// Scan that sees a wall far away.
fn scan(stamp: Time) -> Scan {
    let mut scan = Scan { angle_increment: 0.1, stamp, ..Scan::default() };
    scan.ranges.extend([9.0; 3]);
    scan
}

/// Twist that the field lets pass when a twist and a scan come.
fn passed(program: &mut Outside, now: Time, stamp: Time) -> Option<Twist> {
    let inputs = program.inputs();
    assert!(inputs.twist.put(AHEAD).is_ok() && inputs.scan.put(scan(stamp)).is_ok());
    program.react(now);
    program.events().sent.take()
}

const AHEAD: Twist = Twist::new(0.4, 0.0, 0.0);

#[test]
fn a_field_stops_in_silence_once() {
    let mut program = Outside::new();
    assert_eq!(passed(&mut program, Time::ZERO, Time::ZERO), Some(AHEAD));
    let sent = [499, 500, 1000, 1500].map(|ms| {
        program.react(Time::from_millis(ms));
        program.events().sent.take()
    });
    assert_eq!(sent, [None, Some(Twist::ZERO), None, None]);
}

/// A simulator was restarted: its clock begins again, and the scan is from before that.
#[test]
fn an_old_scan_is_not_young_after_the_clock_was_set_back() {
    let mut program = Outside::new();
    let [before, after] = [Time::from_secs(100), Time::from_secs(1)];
    assert_eq!(passed(&mut program, before, before), Some(AHEAD));
    program.react(after);
    program.events().sent.take();
    for seconds in 1..60 {
        let now = after + Duration::from_secs(seconds);
        assert_eq!(passed(&mut program, now, before), Some(Twist::ZERO), "{seconds} s after the jump");
    }
}

//! `CatchUp` makes of a scan that is late, or bent by the motion of the scanner, the one that would be measured now.

use apex_nodes::scan::{CatchUp, Point2, Pose2, Scan};
use apex_rt::{Construct as _, Ctx, Out, Time};
use apex_sim::{Laser, Random, World};

const LASER: Laser = Laser { noise: 0.0, dropout: 0.0, ..Laser::S300 };

fn room() -> World {
    let mut world = World::default();
    world.block(&Pose2::default(), 8.0, 5.0);
    world.block(&Pose2::new(1.5, 1.0, 0.3), 0.4, 0.3);
    world.disc(Point2::new(1.2, -1.0), 0.06);
    world
}

/// Scan of a scanner whose pose at a time after `ms`, in s, is given.
fn scan_at(laser: &Laser, pose_at: impl Fn(f32) -> Pose2, ms: i64) -> Scan {
    let mut scan = Scan { stamp: Time::from_millis(ms), ..Scan::default() };
    laser.sweep(&room(), pose_at, &mut Random::new(1), &mut scan);
    scan
}

fn fire(node: &mut CatchUp, ms: i64, scan: Option<&Scan>, pose: &Pose2) -> Option<Scan> {
    let mut now = Out::new();
    node.process(&Ctx::new(Time::from_millis(ms)), scan, Some(pose), &mut now);
    now.get().cloned()
}

/// Share of the beams whose ranges are alike.
fn alike(a: &Scan, b: &Scan) -> f32 {
    let pairs = a.ranges.iter().zip(b.ranges.iter());
    pairs.filter(|(a, b)| (*a - *b).abs() < 0.02).count() as f32 / a.ranges.len() as f32
}

#[test]
fn a_late_scan_becomes_the_present_one() {
    let poses = [Pose2::new(-0.5, 0.1, 0.2), Pose2::new(-0.44, 0.12, 0.3)];
    let mut node = CatchUp::construct(());
    let late = scan_at(&LASER, |_| poses[0], 80);
    assert!(fire(&mut node, 80, None, &poses[0]).is_none());
    let now = fire(&mut node, 160, Some(&late), &poses[1]).expect("a scan");
    let true_one = scan_at(&LASER, |_| poses[1], 160);
    assert!(alike(&late, &true_one) < 0.4, "{}", alike(&late, &true_one));
    // What was out of view is not seen: 6° of 270°, and beside edges.
    assert!(alike(&now, &true_one) > 0.93, "{}", alike(&now, &true_one));
    assert_eq!((now.stamp, now.ranges.len()), (late.stamp, late.ranges.len()));
}

/// A scanner that turns at 1.5 rad/s and drives, and whose mirror needs 75 ms for its beams: at once, and 60 ms late.
#[test]
fn a_bent_scan_is_straightened() {
    let laser = Laser { turn: 0.1, ..LASER };
    let pose = |ms: f32| Pose2::new(-0.5 + 0.0008 * ms, 0.1, 0.2 + 0.0015 * ms);
    for (first, now) in [(85, 160), (25, 160)] {
        let mut node = CatchUp::construct(());
        for ms in (0..now).step_by(20) {
            fire(&mut node, ms, None, &pose(ms as f32));
        }
        let bent = scan_at(&laser, |time| pose(first as f32 + 1000.0 * time), first);
        assert!((bent.time_increment * 540.0 - 0.075).abs() < 1e-4, "{}", bent.time_increment);
        let straight = fire(&mut node, now, Some(&bent), &pose(now as f32)).expect("a scan");
        let true_one = scan_at(&LASER, |_| pose(now as f32), now);
        assert!(alike(&bent, &true_one) < 0.6, "{}", alike(&bent, &true_one));
        assert!(alike(&straight, &true_one) > 0.93, "{first}: {}", alike(&straight, &true_one));
        assert_eq!((straight.stamp, straight.time_increment), (bent.stamp, 0.0));
    }
}

#[test]
fn a_scan_in_time_or_without_motion_passes_unchanged() {
    let pose = Pose2::new(-0.5, 0.1, 0.2);
    let mut node = CatchUp::construct(());
    for (ms, stamp) in [(0, 0), (80, 80), (160, 80)] {
        let scan = scan_at(&LASER, |_| pose, stamp);
        assert_eq!(fire(&mut node, ms, Some(&scan), &pose), Some(scan));
    }
}

#[test]
fn a_scan_of_before_all_poses_passes_unchanged() {
    let mut node = CatchUp::construct(());
    let scan = scan_at(&LASER, |_| Pose2::default(), 0);
    fire(&mut node, 80, None, &Pose2::default());
    assert_eq!(fire(&mut node, 160, Some(&scan), &Pose2::new(1.0, 0.0, 0.0)), Some(scan));
}

/// Drivers may send anything for the time between two beams.
#[test]
fn odd_times_between_beams_count_as_none() {
    let pose = |ms: i64| Pose2::new(0.001 * ms as f32, 0.0, 0.0);
    let late = |time_increment: f32| {
        let mut node = CatchUp::construct(());
        fire(&mut node, 80, None, &pose(80));
        let scan = Scan { time_increment, ..scan_at(&LASER, |_| pose(80), 80) };
        fire(&mut node, 160, Some(&scan), &pose(160)).expect("a scan")
    };
    for odd in [f32::NAN, -1.0, f32::NEG_INFINITY, -f32::MIN_POSITIVE, f32::INFINITY, f32::MAX] {
        assert!(alike(&late(odd), &late(0.0)) > 0.99, "{odd}");
    }
}

//! An arena that looks nearly the same after a rotation (thesis 4.3.5): a border of 20 sides around an octagon.

use apex_nodes::scan::{Point2, Pose2, Scan};
use apex_rt::Time;
use apex_sim::{Laser, Odometry, OdometryNoise, Random, World};
use std::f32::consts::TAU;

mod programs {
    #![allow(missing_docs)]
    apex_macros::graph!("hall.afg");
}

/// Time between two scans, in s.
const STEP: f32 = 0.04;
/// Mean distance of the robot from the middle of the island, in m.
const RADIUS: f32 = 3.8;
/// Angular velocity of the robot around the island, in rad/s.
const SPEED: f32 = 0.25;

/// A border 12 m wide, and an island with sides of 1.2 m.
fn arena() -> World {
    let mut world = World::default();
    for (sides, radius) in [(20_u8, 6.07), (8, 1.57)] {
        let corner = |i: u8| Point2::polar(radius, TAU * (f32::from(i) + 0.5) / f32::from(sides));
        world.polygon(&(0..sides).map(corner).collect::<Vec<_>>());
    }
    world
}

/// True pose of the robot after a time: it circles the island at a varying distance.
fn truth(seconds: f32) -> Pose2 {
    let around = SPEED * seconds;
    let place = Point2::polar(RADIUS + 0.6 * (3.0 * around).sin(), around);
    Pose2::new(place.x, place.y, around + TAU / 4.0 - 0.4 * (3.0 * around).cos())
}

/// Largest errors in m of the estimated pose and of odometry during a minute, among this number of other robots that
/// also circle the island.
fn drive(others: u8) -> (f32, f32) {
    let (mut robot, mut world) = (programs::LocalizeInHall::new(), arena());
    let (mut wheels, mut random) = (Odometry::new(OdometryNoise::PIONEER, 3), Random::new(4));
    (0..others).for_each(|_| world.disc(Point2::default(), 0.3));
    let (mut odometry, mut scan) = (truth(0.0), Scan::default());
    let (mut worst, mut off) = (0.0_f32, 0.0_f32);
    for step in 0..1500_u16 {
        let seconds = STEP * f32::from(step);
        let at = truth(seconds);
        if step > 0 {
            odometry = truth(0.0).compose(&wheels.measure(&truth(seconds - STEP), &at));
        }
        for (i, disc) in (0_u8..).zip(world.discs_mut()) {
            disc.centre = Point2::polar(4.8, 0.8 + 1.7 * f32::from(i) - 0.2 * seconds);
            if (disc.centre - at.position()).norm() < 0.7 {
                disc.centre = Point2::polar(2.3, disc.centre.angle());
            }
        }
        Laser::LMS100.measure(&world, &at, &mut random, &mut scan);
        robot.inputs().odometry.put(odometry).expect("an empty mailbox");
        robot.inputs().scan.put(scan.clone()).expect("an empty mailbox");
        robot.react(Time::ZERO);
        let pose = robot.outputs().pose.expect("a pose");
        worst = worst.max((pose.position() - at.position()).norm());
        off = off.max((odometry.position() - at.position()).norm());
    }
    (worst, off)
}

#[test]
fn a_robot_is_not_lost_where_all_sides_look_alike() {
    for others in [0, 3] {
        let (worst, off) = drive(others);
        println!("{others} other robots: at most {worst:.3} m, odometry {off:.3} m");
        assert!(worst < 0.2 && off > 0.5, "{worst} m, odometry {off} m");
    }
}

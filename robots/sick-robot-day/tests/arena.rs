//! Tests that a robot can operate in the arena, and that the camera sees it at the right place.

use apex_nodes::scan::{Point2, Pose2, Scan};
use apex_sim::{Laser, Light, Random};
use sick_robot_day::{
    camera,
    world::{Arena, Sensors, TARGET_HEIGHT},
};
use std::f32::consts::{PI, TAU};

#[test]
fn a_laser_sees_walls_everywhere() {
    let laser = Laser { field_of_view: TAU, noise: 0.0, dropout: 0.0, ..Laser::LMS100 };
    for seed in 0..50 {
        let (arena, mut random, mut scan) = (Arena::new(seed), Random::new(seed), Scan::default());
        assert!((16..=24).contains(&arena.border.len()));
        let mut places = 0;
        while places < 5 {
            let place = Point2::new(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0));
            if arena.is_free(place, 0.3) {
                laser.measure(&arena.world, &Pose2::new(place.x, place.y, 0.0), &mut random, &mut scan);
                assert!(scan.ranges.iter().all(|range| (0.29..12.5).contains(range)), "seed {seed}, {place:?}");
                places += 1;
            }
        }
    }
}

#[test]
fn stations_can_be_reached_and_told_apart() {
    for seed in 0..50 {
        let arena = Arena::new(seed);
        let stations: Vec<_> = arena.stations().collect();
        for (i, station) in stations.iter().enumerate() {
            let before = station.pose.to_outer(Point2::new(0.35, 0.0));
            assert!(arena.is_free(before, 0.3), "seed {seed}: no room before {station:?}");
            let gap = |other: &Pose2| (other.position() - station.pose.position()).norm();
            assert!(stations[..i].iter().all(|other| gap(&other.pose) > 1.4), "seed {seed}: {station:?} is too near");
        }
        assert!(arena.filling.iter().all(|station| station.number.is_none()));
        assert_eq!(arena.delivery.map(|station| station.number), [Some(1), Some(2), Some(3), Some(4)]);
        assert!(!arena.is_free(Point2::default(), 0.1) && !arena.is_free(Point2::new(7.0, 0.0), 0.1));
    }
}

/// A robot that faces a station from straight ahead.
fn before(arena: &Arena, station: usize, distance: f32) -> Pose2 {
    let pose = arena.stations().nth(station).expect("one of eight").pose;
    let place = pose.to_outer(Point2::new(distance, 0.0));
    Pose2::new(place.x, place.y, pose.theta + PI)
}

#[test]
fn the_same_seed_is_the_same_arena_and_the_same_view() {
    let view = |seed: u64| {
        let (arena, mut random) = (Arena::new(seed), Random::new(seed));
        let pose = before(&arena, 3, 1.0);
        Sensors::new().expect("a level camera").see(&arena, &pose, 0.3, &Light::default(), &mut random)
    };
    assert_eq!(view(3), view(3));
    assert!(view(3).image != view(4).image && view(3).scan != view(4).scan);
}

#[test]
fn targets_are_where_the_camera_projects_them() {
    let mut sensors = Sensors::new().expect("a level camera");
    for (seed, station) in (0..8).zip(0..) {
        let arena = Arena::new(seed);
        let robot = before(&arena, station, 1.2);
        let image = sensors.see(&arena, &robot, 0.0, &Light::default(), &mut Random::new(seed)).image;
        let target = arena.stations().nth(station).expect("one of eight").pose;
        let at = |y: f32, z: f32| {
            let place = robot.to_inner(target.to_outer(Point2::new(0.01, y)));
            let [u, v] = camera().project([place.x, place.y, TARGET_HEIGHT + z]).expect("in front");
            image.pixels[(u.round() as u32, v.round() as u32)].0[0]
        };
        // The cross is dark; the plate between its arms and beside the rings is light.
        assert!(at(0.0, 0.0) < 60 && at(0.065, 0.0) < 60 && at(0.0, 0.065) < 60, "seed {seed}");
        assert!(at(0.02, 0.02) > 180 && at(-0.02, 0.02) > 180 && at(0.11, 0.11) > 180, "seed {seed}");
    }
}

//! `seam.afg`: what stands across the seam of a full turn is seen as anywhere else. The scanner turns on the spot by
//! whole beams, so that the seam passes over everything around it.

use apex_macros::graph;
use apex_nodes::scan::{Point2, Pose2, Scan};
use apex_rt::prelude::*;
use apex_sim::{Laser, Random, World};
use core::f32::consts::{PI, TAU};

graph!("seam.afg");

/// Beams of a full turn.
const BEAMS: u16 = 720;
/// Pose of a container.
const CONTAINER: Pose2 = Pose2::new(-2.0, 0.3, PI);

/// A room with a person, a container on four wheels, and a wall of 1.2 m.
fn world() -> World {
    let mut world = World::default();
    world.block(&Pose2::new(0.3, -0.2, 0.0), 9.0, 7.0);
    for leg in [Point2::new(0.2, 1.6), Point2::new(0.45, 1.6)] {
        world.disc(leg, 0.06);
    }
    for (x, y) in [(-0.5375, 0.33), (-0.5375, -0.33), (0.5375, 0.33), (0.5375, -0.33)] {
        world.disc(CONTAINER.to_outer(Point2::new(x, y)), 0.04);
    }
    world.wall(Point2::new(1.5, -0.6), Point2::new(1.5, 0.6));
    world
}

/// Beams on walls, number of segments, and places of the legs and of the container in the frame of the room, seen by a
/// scanner that is turned by some beams.
fn seen(turned: u16) -> (usize, usize, Vec<Point2>, Option<Pose2>) {
    let step = TAU / f32::from(BEAMS);
    let laser = Laser {
        field_of_view: TAU - step,
        resolution: step,
        range_min: 0.01,
        range_max: 30.0,
        noise: 0.0,
        dropout: 0.0,
        turn: 0.0,
    };
    let pose = Pose2::new(0.0, 0.0, step * f32::from(turned));
    let mut scan = Scan::default();
    laser.measure(&world(), &pose, &mut Random::new(1), &mut scan);
    assert!(scan.ranges.len() == usize::from(BEAMS) && scan.is_full_turn());
    let mut program = Neighbours::new();
    assert!(program.inputs().scan.put(scan).is_ok());
    program.react(Time::ZERO);
    let outputs = program.outputs();
    let walls = outputs.walls.as_ref().map_or(0, |walls| walls.points().count());
    let mut legs: Vec<Point2> =
        outputs.legs.iter().flat_map(|legs| legs.list.iter()).map(|leg| pose.to_outer(leg.position)).collect();
    // Some wheels look like legs.
    legs.retain(|leg| leg.y > 1.0);
    legs.sort_by(|a, b| a.x.total_cmp(&b.x));
    let container = outputs.container.map(|container| pose.compose(&container.pose));
    (walls, outputs.segments.as_ref().map_or(0, |list| list.len()), legs, container)
}

#[test]
fn the_place_of_the_seam_does_not_matter() {
    let (walls, segments, legs, container) = seen(0);
    let container = container.expect("a container");
    assert!((container.position() - CONTAINER.position()).norm() < 0.05, "{container:?}");
    assert!(legs.len() == 2 && legs.iter().all(|leg| (leg.y - 1.56).abs() < 0.05), "{legs:?}");
    for turned in 0..BEAMS {
        let (other_walls, other_segments, other_legs, other) = seen(turned);
        // A beam that grazes an edge may hit it or not.
        assert!(
            other_walls.abs_diff(walls) <= 3,
            "{other_walls} beams on walls instead of {walls}, turned by {turned}"
        );
        assert!(
            other_segments.abs_diff(segments) <= 1,
            "{other_segments} segments, not {segments}, turned by {turned}"
        );
        let is_near = |(a, b): (&Point2, &Point2)| (*a - *b).norm() < 0.02;
        let are_same = other_legs.len() == 2 && legs.iter().zip(&other_legs).all(is_near);
        assert!(are_same, "legs at {other_legs:?}, turned by {turned}");
        let other = other.unwrap_or_else(|| panic!("no container, turned by {turned}"));
        assert!((other.position() - container.position()).norm() < 0.02, "{other:?}, turned by {turned}");
    }
}

use crate::{
    camera,
    world::{Arena, NUMBER_HEIGHT, NUMBER_WIDTH, Station},
};
use apex_nodes::scan::{Point2, Pose2};
use apex_sim::Random;
use std::f32::consts::TAU;

/// Radius of the robot, in m.
const RADIUS: f32 = 0.3;

/// Maximum number of tries.
const TRIES: u32 = 1000;

/// A robot pose with the camera `distance` m in front of a station, at most `slant` rad from straight ahead, and with a
/// free line of sight. `None` if none is found.
pub fn before(arena: &Arena, station: &Station, distance: f32, slant: f32, random: &mut Random) -> Option<Pose2> {
    let target = station.pose.position();
    (0..TRIES).find_map(|_| {
        let eye = station.pose.to_outer(Point2::polar(distance, random.uniform(-slant, slant)));
        let theta = (target - eye).angle() + random.uniform(-0.15, 0.15);
        let robot = eye - Point2::polar(camera().position[0], theta);
        let sees = arena.is_free(robot, RADIUS) && arena.is_clear(eye, target);
        sees.then(|| Pose2::new(robot.x, robot.y, theta))
    })
}

/// A random pose of the robot, or `None` if none is found.
pub fn anywhere(arena: &Arena, random: &mut Random) -> Option<Pose2> {
    (0..TRIES).find_map(|_| {
        let place = Point2::new(random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0));
        let theta = random.uniform(0.0, TAU);
        arena.is_free(place, RADIUS).then(|| Pose2::new(place.x, place.y, theta))
    })
}

/// Numbers of the signs in the image of the camera, including those of which only a corner is visible.
pub fn numbers_in_view(arena: &Arena, robot: &Pose2) -> impl Iterator<Item = u32> {
    let camera = camera();
    let inside = move |place: Point2, z: f32| {
        let pixel = camera.project([place.x, place.y, z]);
        pixel.is_some_and(|[u, v]| (0.0..camera.width as f32).contains(&u) && (0.0..camera.height as f32).contains(&v))
    };
    let sides = [-0.5, 0.5].map(|side| side * NUMBER_WIDTH);
    arena.delivery.iter().filter_map(move |station| {
        let seen = sides.iter().any(|y| {
            let place = robot.to_inner(station.pose.to_outer(Point2::new(0.0, *y)));
            sides.iter().any(|z| inside(place, NUMBER_HEIGHT + z))
        });
        station.number.filter(|_| seen)
    })
}

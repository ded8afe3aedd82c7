//! `persons.afg`, the tracking of persons who walk past a robot.

use apex_macros::graph;
use apex_nodes::{
    persons::{Detections, Persons, View},
    scan::{Point2, Pose2, Scan},
};
use apex_rt::prelude::*;
use apex_sim::{Laser, Random, World};

graph!("persons.afg");

/// Pose of the robot in the fixed frame.
const ROBOT: Pose2 = Pose2::new(2.0, 1.0, 0.5);

/// Source of sensor data: one person walks past a robot, whose camera does not see another one that stands behind it.
#[node]
#[derive(Default)]
pub struct Street {}

#[node]
impl Street {
    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>, pose: &mut Out<Pose2>, camera: Event<Detections>) {
        let walker = Point2::new(2.0, -1.5 + 0.7 * ctx.now().as_secs_f64() as f32);
        let stander = Point2::new(-1.8, 0.3);
        let scan = scan.get_mut();
        measure(&[walker, stander], scan);
        scan.stamp = ctx.now();
        pose.set(ROBOT);
        camera.emit(Detections {
            stamp: ctx.now(),
            view: View { pose: ROBOT, angle: 1.8, nearest: 0.0, range: 6.0 },
            positions: [ROBOT.to_outer(walker)].into_iter().collect(),
        });
    }
}

/// Scan of the legs of persons at these positions, in the frame of the robot, in a hall.
fn measure(persons: &[Point2], scan: &mut Scan) {
    let laser = Laser { field_of_view: 6.2, resolution: 0.006, noise: 0.005, dropout: 0.0, ..Laser::default() };
    let mut world = World::default();
    world.block(&Pose2::default(), 10.0, 8.0);
    for position in persons {
        for side in [-0.13, 0.13] {
            world.disc(*position + Point2::new(0.1 * side, side), 0.06);
        }
    }
    laser.measure(&world, &Pose2::default(), &mut Random::new(1), scan);
}

/// Number of persons.
#[node]
pub fn count(persons: &Persons) -> u32 {
    persons.len() as u32
}

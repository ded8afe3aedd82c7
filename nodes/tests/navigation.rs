//! `navigation.afg`, a robot that navigates, in a simulated arena.

use apex_macros::graph;
use apex_nodes::{
    map::{Grid, Occupancy, Raster},
    nav::Twist,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::prelude::*;
use apex_sim::{Laser, Random, World};
use std::time::Duration;

graph!("navigation.afg");

/// Radius of the robot, in m.
const RADIUS: f32 = 0.3;
/// Start of the robot, and its goal on the other side of a wall.
const START: Pose2 = Pose2::new(1.0, 1.0, 0.0);
const GOAL: Pose2 = Pose2::new(9.0, 1.0, 1.5);

/// Source of the robot's sensor data: a hall of 10 m by 8 m, with a wall to its middle and a pillar behind it that is
/// not on the map.
#[node]
pub struct Arena {
    #[param(default = 1)]
    seed: u64,
    hall: Hall,
    twist: Twist,
    last: Option<Time>,
    random: Option<Random>,
}

struct Hall {
    world: World,
    map: Grid<Occupancy>,
    pose: Pose2,
}

impl Default for Hall {
    fn default() -> Self {
        let at = Point2::new;
        let mut world = World::default();
        for (a, b) in [
            (at(0.0, 0.0), at(10.0, 0.0)),
            (at(10.0, 0.0), at(10.0, 8.0)),
            (at(10.0, 8.0), at(0.0, 8.0)),
            (at(0.0, 8.0), at(0.0, 0.0)),
            (at(5.0, 0.0), at(5.0, 4.0)),
        ] {
            world.wall(a, b);
        }
        let map = draw(&world);
        world.disc(at(6.8, 3.2), 0.5);
        Self { world, map, pose: START }
    }
}

/// Map of the walls, with cells of 10 cm.
fn draw(world: &World) -> Grid<Occupancy> {
    let raster = Raster { corner: Point2::new(-0.05, -0.05), resolution: 0.1, width: 101, height: 81 };
    let mut map = Grid::new(raster, Occupancy::Free).expect("a small map");
    for wall in world.walls() {
        for i in 0..=200 {
            let point = wall.a + (wall.b - wall.a).scaled(i as f32 / 200.0);
            let cell = map.raster().cell(point).and_then(|cell| map.get_mut(cell)).expect("walls are on the map");
            *cell = Occupancy::Occupied;
        }
    }
    map
}

#[node]
impl Arena {
    fn process(
        &mut self,
        ctx: &Ctx,
        pose: &mut Out<Pose2>,
        scan: &mut Out<Scan>,
        map: &mut Out<Grid<Occupancy>>,
        goal: Event<Pose2>,
        crash: Event<()>,
    ) {
        match self.last.replace(ctx.now()) {
            Some(last) => self.drive_on(ctx.now().since(last)),
            None => goal.emit(GOAL),
        }
        let Hall { world, map: walls, pose: at } = &self.hall;
        let laser = Laser { range_min: 0.01, ..Laser::default() };
        let random = self.random.get_or_insert_with(|| Random::new(self.seed));
        let scan = scan.get_mut();
        scan.stamp = ctx.now();
        laser.measure(world, at, random, scan);
        map.get_mut().clone_from(walls);
        pose.set(*at);
        if self.is_in_contact() {
            crash.emit(());
        }
    }

    /// Sets the twist that the robot drives from now on.
    #[slot]
    fn drive(&mut self, twist: &Twist) {
        self.twist = *twist;
    }

    fn drive_on(&mut self, time: Duration) {
        let (twist, dt) = (self.twist, time.as_secs_f32());
        let moved = Pose2::new(dt * twist.x, dt * twist.y, dt * twist.omega);
        self.hall.pose = self.hall.pose.compose(&moved);
    }

    fn is_in_contact(&self) -> bool {
        let ranges = (0..360).map(|degree| {
            let direction = Point2::polar(1.0, (degree as f32).to_radians());
            self.hall.world.cast(self.hall.pose.position(), direction)
        });
        ranges.flatten().any(|range| range < RADIUS)
    }
}

//! World of a robot that does what it is told, and goes on with the last twist until the next one.

use super::token::Token;
use apex_nodes::{
    cloud::{Hazard, HazardKind},
    map::{Grid, Occupancy, Raster},
    nav::{Articulated, BackPath, BackPiece, Path, Twist},
    persons::{Person, Persons},
    scan::{Point2, Pose2, Scan},
};
use apex_rt::Time;
use std::time::Duration;

/// Distance of the wall, of the target and of the hazard from the start, in m.
const WALL: f32 = 6.0;

/// Robot with a trailer, in front of a wall.
#[derive(Clone)]
pub struct World {
    pub now: Time,
    pub twist: Twist,
    base: Pose2,
    trailer: f32,
    map: Grid<Occupancy>,
}

impl World {
    pub fn new() -> Self {
        let raster = Raster { corner: Point2::new(-10.0, -10.0), resolution: 0.2, width: 100, height: 100 };
        let map = Grid::new(raster, Occupancy::Free).expect("a small map");
        Self { now: Time::ZERO, twist: Twist::ZERO, base: Pose2::default(), trailer: 0.0, map }
    }

    /// Goes on with the twist for a time.
    pub fn advance(&mut self, time: Duration) {
        let (twist, dt) = (self.twist, time.as_secs_f32());
        self.trailer += dt * Articulated::PATSY.trailer_rotation(twist.x, twist.omega, self.base.theta - self.trailer);
        self.base = self.base.compose(&Pose2::new(dt * twist.x, dt * twist.y, dt * twist.omega));
        self.now += time;
    }

    /// Token of a sensor that works, at an input with this name and type. `None` is ⊥: a path comes once.
    pub fn token(&self, port: &str, ty: &str) -> Option<Box<dyn Token>> {
        let is_start = self.now == Time::ZERO;
        Some(match (port, ty) {
            ("twist", "Twist") => Box::new(Twist::new(0.3, 0.0, 0.0)),
            ("pose" | "base" | "odometry", "Pose2") => Box::new(self.base),
            ("trailer", "Pose2") => Box::new(Articulated::PATSY.trailer(&self.base, self.trailer)),
            ("container", "Pose2") => Box::new(Pose2::new(WALL, 0.0, 0.0)),
            ("target", "Pose2") => Box::new(Pose2::new(WALL, 0.0, std::f32::consts::PI).relative_to(&self.base)),
            ("scan" | "ahead" | "behind", "Scan") => Box::new(self.scan(port != "behind")),
            ("map" | "ground", "Grid") => Box::new(self.map.clone()),
            ("hazard", "Hazard") => {
                Box::new(Hazard { kind: HazardKind::Obstacle, position: Point2::new(WALL - self.base.x, 0.0) })
            }
            ("persons", "Vec" | "Persons") => {
                let person = Person { position: Point2::new(9.0, 5.0), ..Person::default() };
                Box::new([person].into_iter().collect::<Persons>())
            }
            ("path", "Path") if is_start => {
                Box::new(Path { points: [0.0, 3.0, WALL].map(|x| Point2::new(x, 0.0)).into(), heading: 0.0 })
            }
            ("path", "BackPath") if is_start => {
                Box::new(BackPath { pieces: vec![BackPiece { bend: 0.0, length: 3.0 }] })
            }
            ("path", _) => return None,
            _ => panic!("no token for the input `{port}: {ty}`: add one here"),
        })
    }

    /// Scan of the wall ahead, or of nothing near.
    fn scan(&self, is_ahead: bool) -> Scan {
        let mut scan =
            Scan { angle_min: -1.2, angle_increment: 0.05, range_max: 30.0, stamp: self.now, ..Scan::default() };
        scan.ranges.extend((0..49).map(|beam| {
            let wall = (WALL - self.base.x) / (0.05 * f32::from(beam as u8) - 1.2).cos();
            if is_ahead { wall } else { 20.0 }
        }));
        scan
    }
}

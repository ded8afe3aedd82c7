//! `fusion.afg`: the tests of the source file, and sensors of a robot that drives to the north with 1 m/s.

use apex_nodes::{
    localize::{GeoFix, Inertial, TangentPlane},
    scan::Pose2,
};
use apex_rt::prelude::*;

apex_macros::graph!("fusion.afg");

/// Wheels, which begin at the origin of their own frame.
#[node]
pub fn ahead(ctx: &Ctx) -> Pose2 {
    Pose2::new(ctx.now().as_secs_f64() as f32, 0.0, 0.0)
}

/// Gyroscope that is never turned.
#[node]
pub fn still() -> Inertial {
    Inertial::level(0.0)
}

/// Receiver whose positions are too far to the east, or missing, from one time to another.
#[node]
pub struct Receiver {
    /// Error to the east.
    #[param(unit = "m", default = 0.0)]
    jump: f64,
    #[param(default = false)]
    silent: bool,
    #[param(unit = "s", default = 0.0)]
    from: f64,
    #[param(unit = "s", default = 0.0)]
    until: f64,
}

#[node]
impl Receiver {
    fn process(&mut self, ctx: &Ctx) -> GeoFix {
        let time = ctx.now().as_secs_f64();
        let is_odd = time >= self.from && time < self.until;
        let [latitude, longitude] =
            TangentPlane::new(0.85, 0.16).geodetic([if is_odd { self.jump } else { 0.0 }, time]);
        GeoFix {
            stamp: ctx.now(),
            has_position: !(is_odd && self.silent),
            latitude: latitude.to_degrees(),
            longitude: longitude.to_degrees(),
            ..GeoFix::default()
        }
    }
}

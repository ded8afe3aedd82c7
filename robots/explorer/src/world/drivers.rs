use super::{FaultKind, Kind, Planet};
use apex_nodes::{
    image::{Camera, ColorImage},
    map::{Grid, Occupancy, Signs},
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::{Ctx, Out, Time, node};
use apex_sim::{ColorCamera, Laser, Random, stream};
use std::{f32::consts::PI, time::Duration};

/// Time between two images.
const IMAGES: Duration = Duration::from_millis(200);
/// Size of the images, in pixels, angle of view across, in rad, and height of the camera above the ground, in m.
const SIZE: (u32, u32) = (320, 240);
const VIEW: f32 = 1.2;
const HEIGHT: f32 = 0.5;

/// Laser scanner in the middle of the robot that sees all around, with a beam for each degree.
const LASER: Laser = Laser { field_of_view: 359.0 / 180.0 * PI, resolution: PI / 180.0, ..Laser::LMS100 };

/// Laser scanner: a source of scans.
#[node]
#[derive(Debug)]
pub struct Scanner {
    planet: Planet,
    random: Random,
    last: Scan,
}

#[node]
impl Scanner {
    /// Creates the scanner of the robot in a world.
    pub fn new(planet: &Planet) -> Self {
        Self { planet: planet.clone(), random: stream(planet.present().seed(), 3), last: Scan::default() }
    }

    fn process(&mut self, ctx: &Ctx, scan: &mut Out<Scan>) {
        let state = self.planet.at(ctx.now());
        if state.has(FaultKind::LaserSilent) {
            return;
        }
        if !state.has(FaultKind::LaserRepeated) {
            self.last.stamp = ctx.now();
            LASER.measure(&state.field.world, &state.pose(), &mut self.random, &mut self.last);
        }
        if state.has(FaultKind::BeamsInfinite) {
            self.last.ranges.iter_mut().for_each(|range| *range = f32::INFINITY);
        }
        scan.get_mut().clone_from(&self.last);
    }
}

/// Wheels: a source of the pose relative to the station, which drifts.
#[node]
#[derive(Debug)]
pub struct Wheels {
    planet: Planet,
    last: Pose2,
}

#[node]
impl Wheels {
    /// Creates the wheels of the robot in a world.
    pub fn new(planet: &Planet) -> Self {
        Self { planet: planet.clone(), last: Pose2::default() }
    }

    fn process(&mut self, ctx: &Ctx) -> Option<Pose2> {
        let state = self.planet.at(ctx.now());
        if !state.has(FaultKind::WheelsStopped) {
            self.last = state.wheels();
        }
        let pose = if state.has(FaultKind::WheelsNan) { Pose2 { x: f32::NAN, ..self.last } } else { self.last };
        (!state.has(FaultKind::WheelsSilent)).then_some(pose)
    }
}

/// Gauge of the battery: a source of its charge, from 1 (full) to 0 (empty).
#[node]
#[derive(Debug)]
pub struct Charge {
    planet: Planet,
}

#[node]
impl Charge {
    /// Creates the gauge of the robot in a world.
    pub fn new(planet: &Planet) -> Self {
        Self { planet: planet.clone() }
    }

    fn process(&mut self, ctx: &Ctx) -> Option<f32> {
        let state = self.planet.at(ctx.now());
        (!state.has(FaultKind::ChargeSilent)).then(|| state.charge())
    }
}

/// Colour camera in the middle of the robot: a source of images, and of its geometry with each. It sends ⊥ when it
/// fires between two images.
#[node]
#[derive(Debug)]
pub struct ColorEye {
    planet: Planet,
    camera: ColorCamera,
    random: Random,
    due: Time,
}

#[node]
impl ColorEye {
    /// Creates the camera of the robot in a world.
    pub fn new(planet: &Planet) -> Self {
        let camera = Camera { position: [0.0, 0.0, HEIGHT], ..Camera::new(SIZE.0, SIZE.1, VIEW) };
        let random = stream(planet.present().seed(), 4);
        let camera = ColorCamera { camera, noise: 6.0, grain: 0.08 };
        Self { planet: planet.clone(), camera, random, due: Time::ZERO }
    }

    fn process(&mut self, ctx: &Ctx, image: &mut Out<ColorImage>, camera: &mut Out<Camera>) {
        if ctx.now() < self.due {
            return;
        }
        self.due = ctx.now() + IMAGES;
        let state = self.planet.at(ctx.now());
        let image = image.get_mut();
        if state.has(FaultKind::EyeBlack) {
            image.reset(ctx.now(), SIZE);
        } else {
            self.camera.take(&state.field.scene, &state.pose(), ctx.now(), &mut self.random, image);
        }
        camera.set(self.camera.camera);
    }
}

/// Motors: a sink. They brake if no twist comes for 0.3 s.
#[node]
#[derive(Debug)]
pub struct Motors {
    planet: Planet,
}

#[node]
impl Motors {
    /// Creates the motors of the robot in a world.
    pub fn new(planet: &Planet) -> Self {
        Self { planet: planet.clone() }
    }

    /// Sets the desired twist.
    #[slot]
    fn drive(&mut self, twist: &Twist, ctx: &Ctx) {
        self.planet.at(ctx.now()).drive(*twist);
    }
}

/// Referee: a sink, to which the robot shows its map and the objects that it knows, and says when it has finished.
#[node]
#[derive(Debug)]
pub struct Judge {
    planet: Planet,
}

#[node]
impl Judge {
    /// Creates the referee of a world.
    pub fn new(planet: &Planet) -> Self {
        Self { planet: planet.clone() }
    }

    fn process(&mut self, ctx: &Ctx, map: Option<&Grid<Occupancy>>, cups: Option<&Signs>, batteries: Option<&Signs>) {
        let mut state = self.planet.at(ctx.now());
        if let Some(map) = map {
            state.take_map(map);
        }
        for (kind, objects) in Kind::ALL.into_iter().zip([cups, batteries]) {
            if let Some(objects) = objects {
                state.take_objects(kind, objects);
            }
        }
    }

    /// Notes that the robot is at home, and nothing is left.
    #[slot]
    fn finish(&mut self, ctx: &Ctx) {
        self.planet.at(ctx.now()).finish();
    }
}

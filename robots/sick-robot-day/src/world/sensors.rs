use super::Arena;
use crate::{LASER, camera};
use apex_nodes::{
    image::GrayImage,
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::Time;
use apex_sim::{CameraSim, Light, NotLevel, Random};

/// Sensor data of the robot at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct View {
    /// Image of the camera.
    pub image: GrayImage,
    /// Scan of the scanner.
    pub scan: Scan,
}

/// Camera and scanner of the robot.
#[derive(Debug, Clone)]
pub struct Sensors {
    camera: CameraSim,
}

impl Sensors {
    /// Creates the camera and the scanner of the robot.
    ///
    /// # Errors
    /// If the [`camera`] is not level.
    pub fn new() -> Result<Self, NotLevel> {
        Ok(Self { camera: CameraSim::new(camera())? })
    }

    /// Sensor data at a pose in the arena, for a robot that turns with `turn` rad/s.
    pub fn see(&mut self, arena: &Arena, pose: &Pose2, turn: f32, light: &Light, random: &mut Random) -> View {
        let mut view = View::default();
        LASER.measure(&arena.world, pose, random, &mut view.scan);
        let twist = Twist { omega: turn, ..Twist::ZERO };
        self.camera.take(&arena.scene, pose, &twist, light, Time::ZERO, random, &mut view.image);
        view
    }
}

/// Random lighting of a hall: brighter or darker, possibly from the side.
pub fn hall_light(random: &mut Random) -> Light {
    Light { gain: random.uniform(0.6, 1.1), slope: random.uniform(-0.3, 0.3), haze: random.uniform(0.0, 20.0) }
}

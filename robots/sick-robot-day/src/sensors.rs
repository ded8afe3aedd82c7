use apex_nodes::image::Camera;
use apex_sim::Laser;

/// Scanner at the front of the robot, at the origin of its frame.
pub const LASER: Laser = Laser::LMS100;

/// Camera at the front: level, 40 cm above the floor, with a field of view of 70°.
pub fn camera() -> Camera {
    Camera { position: [0.05, 0.0, 0.4], ..Camera::new(960, 720, 70.0_f32.to_radians()) }
}

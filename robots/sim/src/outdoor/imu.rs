use super::Sample;
use crate::Random;
use apex_nodes::{frames::Rotation, localize::Inertial};
use libm::sqrtf;

/// Errors of an inertial sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuErrors {
    /// Noise of the angular velocity, in rad/s/√Hz.
    pub noise: f32,
    /// Standard deviation of the bias at the beginning, in rad/s.
    pub bias: f32,
    /// Standard deviation of the change of the bias in 1 s, in rad/s.
    pub walk: f32,
    /// Standard deviation of roll and pitch, in rad.
    pub tilt: f32,
}

impl ImuErrors {
    /// Micromechanical sensor whose bias was measured before the start: twice the noise of an ITG-3200 (0.03 °/s/√Hz in
    /// its data sheet), as on the Razor 9DOF of the robot.
    pub const RAZOR: Self = Self { noise: 1e-3, bias: 4e-4, walk: 2e-5, tilt: 4e-3 };
}

/// Inertial sensor on a base: angular velocity with white noise and a bias that walks at random, and inclination.
#[derive(Debug, Clone)]
pub struct Imu {
    errors: ImuErrors,
    bias: [f32; 3],
    random: Random,
}

impl Imu {
    /// Creates a sensor with a random bias.
    pub fn new(errors: ImuErrors, mut random: Random) -> Self {
        let bias = [0; 3].map(|_| random.normal(errors.bias));
        Self { errors, bias, random }
    }

    /// Measures the motion between two poses that are `dt` s apart: the mean angular velocity in the frame of the base,
    /// and the inclination at the end.
    pub fn measure(&mut self, before: &Sample, after: &Sample, dt: f32) -> Inertial {
        let Self { errors, bias, random } = self;
        let noise = errors.noise / sqrtf(dt);
        let walk = errors.walk * sqrtf(dt);
        let [x, y, z, w] = rotation(before).inverse().then(rotation(after)).quaternion();
        // The shorter of the two ways round; its vector is half of the small rotation.
        let factor = 2.0 / f64::from(dt) * if w < 0.0 { -1.0 } else { 1.0 };
        let mut angular_velocity = [x, y, z].map(|part| factor * part);
        for (value, bias) in angular_velocity.iter_mut().zip(bias) {
            *value += f64::from(*bias + random.normal(noise));
            *bias += random.normal(walk);
        }
        let [roll, pitch] = [after.attitude.roll, after.attitude.pitch].map(|angle| angle + random.normal(errors.tilt));
        let rotation = Rotation::from_rpy(f64::from(roll), f64::from(pitch), 0.0);
        Inertial { rotation, angular_velocity }
    }
}

fn rotation(sample: &Sample) -> Rotation {
    let angles = [sample.attitude.roll, sample.attitude.pitch, sample.pose.theta].map(f64::from);
    Rotation::from_rpy(angles[0], angles[1], angles[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outdoor::Attitude;
    use apex_nodes::scan::Pose2;

    #[test]
    fn the_turn_on_a_slope_is_that_of_the_heading() {
        let errors = ImuErrors { noise: 0.0, bias: 0.0, walk: 0.0, tilt: 0.0 };
        let mut imu = Imu::new(errors, Random::new(1));
        let at = |t: f32| Sample {
            pose: Pose2::new(0.0, 0.0, 3.0 + 0.8 * t),
            attitude: Attitude { height: 0.0, roll: 0.3 - t, pitch: 0.2 + 0.5 * t },
        };
        let rate = imu.measure(&at(0.0), &at(0.01), 0.01).turn_rate().expect("a rate");
        assert!((rate - 0.8).abs() < 0.01, "{rate}");
    }

    #[test]
    fn noise_and_bias_are_those_of_the_errors() {
        let errors = ImuErrors { noise: 0.01, bias: 0.1, walk: 0.0, tilt: 0.0 };
        let mut imu = Imu::new(errors, Random::new(2));
        let bias = imu.bias[2];
        let rates: Vec<f32> = (0..4000)
            .map(|_| imu.measure(&Sample::default(), &Sample::default(), 0.01).angular_velocity[2] as f32)
            .collect();
        let mean = rates.iter().sum::<f32>() / 4000.0;
        let variance = rates.iter().map(|rate| (rate - mean).powi(2)).sum::<f32>() / 4000.0;
        assert!((mean - bias).abs() < 0.005 && (variance / 0.01 - 1.0).abs() < 0.1, "{mean} {bias} {variance}");
    }
}

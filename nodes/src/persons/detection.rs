use crate::scan::{Point2, Pose2};
use apex_rt::Time;
use core::f32::consts::TAU;
use heapless::Vec;

/// Maximum number of detections of one measurement.
pub const MAX_DETECTIONS: usize = 64;

/// Maximum number of persons that are tracked at once.
pub const MAX_PERSONS: usize = 128;

/// Persons at one time, in the order in which they were first seen.
pub type Persons = Vec<Person, MAX_PERSONS>;

/// Tracked person, in the fixed frame of the detections.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Person {
    /// Number of the person, the same as long as the person is tracked.
    pub id: u32,
    /// Position, in m.
    pub position: Point2,
    /// Velocity, in m/s.
    pub velocity: Point2,
    /// Standard deviation of the position along each axis, in m.
    pub deviation: f32,
    /// Probability that the person is still there, from 0 to 1.
    pub presence: f32,
}

/// Persons that a sensor detected in one measurement, in a fixed frame.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "record", derive(serde::Serialize, serde::Deserialize))]
pub struct Detections {
    /// Time of the measurement.
    pub stamp: Time,
    /// Area that the sensor can see. A person outside of it does not count as missed.
    pub view: View,
    /// Positions of the detected persons, in m.
    pub positions: Vec<Point2, MAX_DETECTIONS>,
}

/// Field of view of a sensor: a sector of a ring. The default is unlimited.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct View {
    /// Pose of the sensor, which looks along its x axis, in the fixed frame.
    pub pose: Pose2,
    /// Angle of the sector, in rad.
    pub angle: f32,
    /// Distance from which on the sensor sees something, in m.
    pub nearest: f32,
    /// Radius of the sector, in m.
    pub range: f32,
}

impl Default for View {
    fn default() -> Self {
        Self { pose: Pose2::default(), angle: TAU, nearest: 0.0, range: f32::MAX }
    }
}

impl View {
    /// Returns `true` if a point of the fixed frame is in view.
    pub fn contains(&self, point: Point2) -> bool {
        let seen = self.pose.to_inner(point);
        (self.nearest..=self.range).contains(&seen.norm()) && 2.0 * seen.angle().abs() <= self.angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn a_view_is_a_sector() {
        let view = View { pose: Pose2::new(1.0, 0.0, FRAC_PI_2), angle: FRAC_PI_2, nearest: 0.5, range: 2.0 };
        assert!(view.contains(Point2::new(1.0, 0.6)) && !view.contains(Point2::new(1.0, 0.4)));
        assert!(view.contains(Point2::new(1.0, 1.9)) && view.contains(Point2::new(0.5, 1.0)));
        assert!(!view.contains(Point2::new(1.0, 2.1)) && !view.contains(Point2::new(2.0, 0.5)));
        assert!(View::default().contains(Point2::new(-1e6, 0.0)));
    }
}

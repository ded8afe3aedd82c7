use super::{Pose2, wrap_angle};
use apex_rt::{Event, node};

/// Pose, and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct UncertainPose {
    /// The pose that is most likely.
    pub pose: Pose2,
    /// Covariance of x, y and heading along the axes of the outer frame, in m², m rad and rad².
    pub covariance: [[f32; 3]; 3],
}

impl UncertainPose {
    /// Standard deviation of the position: the root of the sum of both variances, in m.
    pub fn deviation(&self) -> f32 {
        libm::sqrtf(self.covariance[0][0] + self.covariance[1][1])
    }

    /// Standard deviation of the heading, in rad.
    pub fn heading_deviation(&self) -> f32 {
        libm::sqrtf(self.covariance[2][2])
    }

    /// Squared error of x, y and heading, normalised by the covariance (NEES): 3 in the mean, if that is right. `None`
    /// if the covariance has no inverse.
    pub fn normalized_error(&self, truth: &Pose2) -> Option<f64> {
        let (offset, turn) = (self.pose.position() - truth.position(), wrap_angle(self.pose.theta - truth.theta));
        let error = [offset.x, offset.y, turn].map(f64::from);
        let [a, b, c] = self.covariance.map(|row| row.map(f64::from));
        // The columns of the inverse, times the determinant.
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, columns[0]);
        let sum: f64 = columns.iter().zip(error).map(|(column, part)| part * dot(error, *column)).sum();
        (determinant > 0.0).then_some(sum / determinant)
    }
}

/// Change of what is known about the pose of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PoseChange {
    /// Pose known from now on.
    Localized,
    /// Pose contradicted by measurements, and no longer known.
    Lost,
}

impl PoseChange {
    /// Triggers the event of a node that tells of this change; `localized` with the present pose.
    pub fn emit(self, pose: Pose2, localized: Event<'_, Pose2>, lost: Event<'_, ()>) {
        match self {
            Self::Localized => localized.emit(pose),
            Self::Lost => lost.emit(()),
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Standard deviation of the position of an estimated pose: the root of the sum of both variances.
#[node]
#[unit("m")]
pub fn position_deviation(estimate: &UncertainPose) -> f32 {
    estimate.deviation()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_normalized_by_their_covariance() {
        let error = |[x, y, theta]: [f32; 3], covariance| {
            UncertainPose { pose: Pose2::new(x, y, theta), covariance }.normalized_error(&Pose2::default())
        };
        let covariance = [[4.0, 1.0, 0.0], [1.0, 9.0, 0.5], [0.0, 0.5, 1.0]];
        assert!((error([1.0, 2.0, 3.0], covariance).expect("an inverse") - 9.257352941).abs() < 1e-6);
        assert_eq!(error([1.0, 2.0, 3.0], [[1.0; 3]; 3]), None);
    }

    #[test]
    fn deviations_are_those_of_the_position_and_of_the_heading() {
        let covariance = [[9.0, 1.0, 0.0], [1.0, 16.0, 0.5], [0.0, 0.5, 0.04]];
        let estimate = UncertainPose { pose: Pose2::default(), covariance };
        assert_eq!((position_deviation(&estimate), estimate.heading_deviation()), (5.0, 0.2));
    }
}

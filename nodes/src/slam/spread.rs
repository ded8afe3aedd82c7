use super::{Pose, heading};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Covariances of the kept poses along the axes of the map, by their number: what is known about a pose when its
/// measurements are added, by the one path of measurements that says most. Measurements along other paths would make it
/// less, and are not independent.
#[derive(Debug, Clone, Default)]
pub(super) struct Spread {
    covariances: Vec<Option<Matrix3<f64>>>,
}

impl Spread {
    /// The first pose is known exactly.
    pub fn begin(&mut self) {
        self.set(0, Matrix3::zeros());
    }

    /// Takes in a measurement of the pose `to` at the pose `from`.
    pub fn learn(&mut self, from: usize, to: usize, pose: &Pose, measured: &Pose, information: &Matrix3<f64>) {
        let Some(new) = self.ahead(from, pose, measured, information) else { return };
        let old = self.covariances.get(to).copied().flatten();
        if old.is_none_or(|old| position(&new) < position(&old)) {
            self.set(to, new);
        }
    }

    /// Covariance of a pose that was measured at the pose `from`.
    pub fn ahead(&self, from: usize, pose: &Pose, measured: &Pose, information: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        let spread = self.covariances.get(from).copied().flatten()?;
        let there = pose * measured;
        let axes = Rotation3::from_axis_angle(&Vector3::z_axis(), heading(&there)).into_inner();
        let error = axes * information.try_inverse()? * axes.transpose();
        Some(carried(&spread, &(there.translation.vector - pose.translation.vector)) + error)
    }

    /// The poses from `first` on are known as well as one of them: they have moved as one.
    pub fn carry(&mut self, known: usize, first: usize, poses: &[Pose]) {
        let Some(spread) = self.covariances.get(known).copied().flatten() else { return };
        for (k, pose) in poses.iter().enumerate().skip(first) {
            let arm = pose.translation.vector - poses[known].translation.vector;
            self.set(k, carried(&spread, &arm));
        }
    }

    pub fn truncate(&mut self, poses: usize) {
        self.covariances.truncate(poses);
    }

    fn set(&mut self, pose: usize, covariance: Matrix3<f64>) {
        if self.covariances.len() <= pose {
            self.covariances.resize(pose + 1, None);
        }
        self.covariances[pose] = Some(covariance);
    }
}

/// Covariance at the other end of an arm that is fixed to a pose.
fn carried(spread: &Matrix3<f64>, arm: &nalgebra::Vector2<f64>) -> Matrix3<f64> {
    let mut jacobian = Matrix3::identity();
    jacobian[(0, 2)] = -arm.y;
    jacobian[(1, 2)] = arm.x;
    jacobian * spread * jacobian.transpose()
}

/// Sum of the variances of x and y.
fn position(covariance: &Matrix3<f64>) -> f64 {
    covariance[(0, 0)] + covariance[(1, 1)]
}

/// Information of odometry on a short path: a tenth of the distance and a tenth of the turn are uncertain.
pub(super) fn odometry_information(moved: &Pose) -> Matrix3<f64> {
    let (way, turn) = (moved.translation.vector.norm(), heading(moved).abs());
    let (distance, angle) = (0.02 + 0.1 * way, 0.02 + 0.1 * turn + 0.05 * way);
    Matrix3::from_diagonal(&Vector3::new(distance.powi(-2), distance.powi(-2), angle.powi(-2)))
}

use super::{Pose, RobustKernel, heading};
use nalgebra::{Matrix3, Vector2, Vector3};

/// Edge of a pose graph: the measured pose of one pose relative to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// Number of the pose from which the measurement was taken.
    pub from: usize,
    /// Number of the measured pose.
    pub to: usize,
    /// Measured pose `to` in the frame of the pose `from`.
    pub measured: Pose,
    /// Inverse of the covariance of x, y (in m) and heading (in rad) of the measurement, along the axes of the measured
    /// pose.
    pub information: Matrix3<f64>,
    /// Kernel that bounds the influence of the measurement if it is an outlier.
    pub kernel: RobustKernel,
}

impl Edge {
    /// eᵀ Ω e with the error e and the information Ω: χ² of the measurement if the poses are right.
    pub(super) fn chi2(&self, poses: &[Pose]) -> f64 {
        let error = self.error(&poses[self.from], &poses[self.to]);
        error.dot(&(self.information * error))
    }

    /// Cost ρ(χ²) of the measurement with its kernel ρ.
    pub(super) fn cost(&self, poses: &[Pose]) -> f64 {
        self.kernel.cost(self.chi2(poses))
    }

    /// Information of the measurement, weighted by its kernel.
    pub(super) fn weighted_information(&self, poses: &[Pose]) -> Matrix3<f64> {
        match self.kernel {
            RobustKernel::Square => self.information,
            kernel => self.information * kernel.weight(self.chi2(poses)),
        }
    }

    /// Deviation of the poses from the measurement, in the frame of the measured pose: x, y and heading. The program
    /// g2o has the same error.
    pub(super) fn error(&self, from: &Pose, to: &Pose) -> Vector3<f64> {
        let difference = self.measured.inv_mul(&from.inv_mul(to));
        Vector3::new(difference.translation.x, difference.translation.y, heading(&difference))
    }

    /// Derivatives of the error with respect to x, y and heading of the two poses.
    pub(super) fn jacobians(&self, from: &Pose, to: &Pose) -> (Matrix3<f64>, Matrix3<f64>) {
        let back = self.measured.rotation.inverse();
        let turn = (back * from.rotation.inverse()).to_rotation_matrix().into_inner();
        let seen = from.inv_mul(to).translation;
        let mut a = -Matrix3::identity();
        a.fixed_view_mut::<2, 2>(0, 0).copy_from(&-turn);
        a.fixed_view_mut::<2, 1>(0, 2).copy_from(&(back * Vector2::new(seen.y, -seen.x)));
        let mut b = Matrix3::identity();
        b.fixed_view_mut::<2, 2>(0, 0).copy_from(&turn);
        (a, b)
    }
}

#[cfg(test)]
mod tests {
    use super::{super::pose, *};

    fn edge() -> Edge {
        let information = Matrix3::from_diagonal(&Vector3::new(4.0, 9.0, 100.0));
        Edge { from: 0, to: 1, measured: pose(0.2, 0.4, 1.1), information, kernel: RobustKernel::Square }
    }

    #[test]
    fn the_error_is_that_of_g2o() {
        // The measured pose is 1 m ahead and turned by a quarter; the real one is 10 cm farther and 20 cm to the right.
        let quarter = std::f64::consts::FRAC_PI_2;
        let edge = Edge { measured: pose(1.0, 0.0, quarter), ..edge() };
        let error = edge.error(&pose(0.0, 0.0, 0.0), &pose(1.1, -0.2, quarter + 0.3));
        assert!((error - Vector3::new(-0.2, -0.1, 0.3)).norm() < 1e-12, "{error}");
        assert!((edge.chi2(&[pose(0.0, 0.0, 0.0), pose(1.1, -0.2, quarter + 0.3)]) - 9.25).abs() < 1e-9);
    }

    #[test]
    fn derivatives_are_those_of_the_error() {
        let (from, to, edge) = (pose(0.3, -1.0, 2.0), pose(1.4, 0.2, -2.9), edge());
        let (a, b) = edge.jacobians(&from, &to);
        let moved = |p: &Pose, i: usize, h: f64| {
            let d = Vector3::ith(i, h);
            pose(p.translation.x + d.x, p.translation.y + d.y, heading(p) + d.z)
        };
        for i in 0..3 {
            let h = 1e-6;
            let da = (edge.error(&moved(&from, i, h), &to) - edge.error(&moved(&from, i, -h), &to)) / (2.0 * h);
            let db = (edge.error(&from, &moved(&to, i, h)) - edge.error(&from, &moved(&to, i, -h))) / (2.0 * h);
            assert!((a.column(i) - da).norm() < 1e-6 && (b.column(i) - db).norm() < 1e-6, "{i}");
        }
    }
}

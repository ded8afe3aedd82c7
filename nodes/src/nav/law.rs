use super::Projection;
use libm::{atanf, expf, fmaxf};

/// Control law by which an omnidirectional robot follows a path by its orthogonal projection (thesis 4.3.6, after
/// Mojaev and Zell 2004).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowingLaw {
    /// Decay rate of the offset from the path, in 1/m (k).
    pub convergence: f32,
    /// Nominal speed on a straight path far from obstacles and the goal, in m/s (v_n).
    pub speed: f32,
    /// Minimum speed, in m/s. Without it, the robot would never reach the goal.
    pub min_speed: f32,
    /// Gain of the slowdown by curves, in 1/rad (K_κ).
    pub turning_gain: f32,
    /// Gain of the slowdown by the robot's own rotation, in s/rad (K_ω).
    pub rotation_gain: f32,
    /// Gain of the slowdown by near obstacles, in m (K_o).
    pub obstacle_gain: f32,
    /// Gain of the slowdown near the goal, in m (K_g).
    pub goal_gain: f32,
}

impl FollowingLaw {
    /// Driving direction in the frame of the path, in rad (α of eq. 4.4).
    ///
    /// The offset then decays as x_n = x_n0·exp(−k·x_t) (eq. 4.2), whose slope is −k·x_n. So the angle φ_c is
    /// atan(−k·x_n), as in Mojaev and Zell; equation 4.3 of the thesis is printed with x_t.
    pub fn direction(&self, projection: &Projection) -> f32 {
        projection.tangent + atanf(-self.convergence * projection.offset)
    }

    /// Speed, in m/s (eq. 4.5). `turning` is the total turning of the path ahead, in rad: the sum of its curvatures,
    /// each multiplied by the length of path it stands for, so that the number of points does not matter. `rotation` is
    /// in rad/s; the distances to the nearest obstacle and to the goal are in m.
    pub fn speed(&self, turning: f32, rotation: f32, obstacle: f32, goal: f32) -> f32 {
        let near = |gain: f32, distance: f32| if gain > 0.0 { gain / fmaxf(distance, 0.0) } else { 0.0 };
        let brake = self.turning_gain * turning
            + self.rotation_gain * rotation.abs()
            + near(self.obstacle_gain, obstacle)
            + near(self.goal_gain, goal);
        fmaxf(self.speed * expf(-brake), self.min_speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Point2;

    const LAW: FollowingLaw = FollowingLaw {
        convergence: 2.0,
        speed: 1.0,
        min_speed: 0.05,
        turning_gain: 0.5,
        rotation_gain: 0.5,
        obstacle_gain: 0.2,
        goal_gain: 0.2,
    };

    #[test]
    fn it_drives_back_to_the_path() {
        let start = Projection {
            segment: 0,
            point: Point2::default(),
            tangent: 1.0,
            offset: 0.0,
            distance: 0.0,
            remaining: 5.0,
            stop: 1,
            to_stop: 5.0,
        };
        let at = |offset| Projection { offset, ..start };
        assert_eq!(LAW.direction(&at(0.0)), 1.0);
        // To the left of the path it turns right.
        assert_eq!(LAW.direction(&at(0.5)), 1.0 - core::f32::consts::FRAC_PI_4);
        assert!(LAW.direction(&at(-0.5)) > 1.0);
    }

    #[test]
    fn everything_slows_it_down() {
        let far = f32::INFINITY;
        assert_eq!(LAW.speed(0.0, 0.0, far, far), 1.0);
        for slower in [LAW.speed(2.0, 0.0, far, far), LAW.speed(0.0, -2.0, far, far)] {
            assert!((slower - expf(-1.0)).abs() < 1e-6);
        }
        for slower in [LAW.speed(0.0, 0.0, 0.4, far), LAW.speed(0.0, 0.0, far, 0.4)] {
            assert!((slower - expf(-0.5)).abs() < 1e-6);
        }
        for min_speed in
            [LAW.speed(0.0, 0.0, 0.0, far), LAW.speed(0.0, 0.0, far, -1.0), LAW.speed(f32::NAN, 0.0, far, far)]
        {
            assert_eq!(min_speed, 0.05);
        }
    }
}

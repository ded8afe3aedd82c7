//! ROS 2 messages of paths and twists, which Foxglove and Python can show.

use super::{Path, Twist};
use crate::scan::{
    Point2, Pose2,
    message::{FRAME, seen},
};
use apex_messages::{
    Foreign, Reason, converted,
    geometry_msgs::{self, PoseStamped, TwistStamped, TwistWithCovarianceStamped, Vector3},
    nav_msgs::{self, Odometry},
    std_msgs::Header,
};
use apex_rt::Time;

/// The poses face along the path. One more pose is at the goal and has the goal heading. In the paths of other programs
/// the last pose is the goal itself.
impl From<&Path> for nav_msgs::Path {
    fn from(path: &Path) -> Self {
        let along = path.points.iter().enumerate().map(|(i, point)| Pose2::new(point.x, point.y, path.direction(i)));
        // The goal of an empty path is NaN, which viewers do not show.
        let goal = path.goal().unwrap_or(Point2::new(f32::NAN, f32::NAN));
        let poses = along.chain([Pose2::new(goal.x, goal.y, path.heading)]);
        Self { header: Header::new(Time::ZERO, FRAME), poses: poses.map(|pose| PoseStamped::from(&pose)).collect() }
    }
}

impl TryFrom<nav_msgs::Path> for Path {
    type Error = Reason;

    fn try_from(message: nav_msgs::Path) -> Result<Self, Reason> {
        let poses = message.poses.iter().map(|pose| Pose2::from(&pose.pose));
        let mut path = Self::default();
        for pose in poses {
            path.points.push(pose.position());
            path.heading = pose.theta;
        }
        let bits = |point: &Point2| (point.x.to_bits(), point.y.to_bits());
        let is_no_point = match path.points.as_slice() {
            [.., before, goal] => bits(before) == bits(goal),
            [goal] => goal.x.is_nan(),
            [] => false,
        };
        if is_no_point {
            path.points.pop();
        }
        Ok(path)
    }
}

converted!(
    Path as nav_msgs::Path,
    outside = |path| {
        let mut message = nav_msgs::Path::from(path);
        // The poses along the path have headings of less than half a turn.
        if let (Some(goal), Some(end)) = (message.poses.last_mut(), path.goal()) {
            goal.pose = seen(&Pose2::new(end.x, end.y, path.heading));
        }
        message
    }
);

impl Path {
    /// Direction of the segment after a point, in rad; for the last point, of the segment before it.
    fn direction(&self, i: usize) -> f32 {
        let first = i.min(self.points.len().saturating_sub(2));
        match self.points.get(first..first + 2) {
            Some(ends) => (ends[1] - ends[0]).angle(),
            None => self.heading,
        }
    }
}

impl From<&Twist> for geometry_msgs::Twist {
    fn from(twist: &Twist) -> Self {
        Self {
            linear: Vector3 { x: f64::from(twist.x), y: f64::from(twist.y), z: 0.0 },
            angular: Vector3 { x: 0.0, y: 0.0, z: f64::from(twist.omega) },
        }
    }
}

impl From<&Twist> for TwistStamped {
    fn from(twist: &Twist) -> Self {
        Self { header: Header::new(Time::ZERO, FRAME), twist: twist.into() }
    }
}

impl TryFrom<geometry_msgs::Twist> for Twist {
    type Error = Reason;

    fn try_from(geometry_msgs::Twist { linear, angular }: geometry_msgs::Twist) -> Result<Self, Reason> {
        Ok(Self::new(linear.x as f32, linear.y as f32, angular.z as f32))
    }
}

converted!(
    Twist as geometry_msgs::Twist,
    others = vec![
        Foreign::of::<TwistStamped>(|message, _| Self::try_from(TwistStamped::read(message)?.twist).map(Some)),
        Foreign::of::<TwistWithCovarianceStamped>(|message, _| {
            Self::try_from(TwistWithCovarianceStamped::read(message)?.twist.twist).map(Some)
        }),
        // The twist of odometry is that of the robot, in its own frame.
        Foreign::of::<Odometry>(|message, _| {
            let odometry = Odometry::read(message)?;
            message.set_frame(&odometry.child_frame_id);
            Self::try_from(odometry.twist.twist).map(Some)
        }),
    ]
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes};
    use apex_messages::Message as _;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn paths_and_twists_come_back() {
        let points = [(0.1, 0.2), (1.0, f32::INFINITY), (-0.0, 1e-40)].map(|(x, y)| Point2::new(x, y));
        for count in 0..=points.len() {
            for heading in [0.0, -3.0, 100.0] {
                let path = Path { points: points[..count].to_vec(), heading };
                assert_eq!(again(&bytes(&path)), Some(path));
            }
        }
        let twist = Twist::new(0.3, -0.1, 1e-40);
        assert_eq!(again(&bytes(&twist)), Some(twist));
    }

    #[test]
    fn paths_of_other_programs_end_at_their_last_pose() {
        let write = |poses: &[(f32, f32)]| {
            let poses = poses.iter().map(|(x, y)| PoseStamped::from(&Pose2::new(*x, *y, 1.5)));
            nav_msgs::Path { poses: poses.collect(), ..nav_msgs::Path::default() }.to_bytes()
        };
        for poses in [&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)][..], &[(2.0, 3.0)], &[]] {
            let path: Path = again(&write(poses)).expect("a path");
            let points = path.points.iter().map(|point| (point.x, point.y)).collect::<Vec<_>>();
            assert_eq!((points.as_slice(), path.heading), (poses, if poses.is_empty() { 0.0 } else { 1.5 }));
        }
    }

    #[test]
    fn a_part_of_a_path_is_none() {
        let path = bytes(&Path { points: vec![Point2::default(); 3], heading: 1.0 });
        assert!((0..path.len()).all(|length| again::<Path>(&path[..length]).is_none()));
        let twist = bytes(&Twist::ZERO);
        assert!((0..twist.len()).all(|length| again::<Twist>(&twist[..length]).is_none()));
    }

    #[test]
    fn poses_look_along_the_path() {
        let path =
            Path { points: [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0)].map(|(x, y)| Point2::new(x, y)).into(), heading: 3.0 };
        assert_eq!([0, 1, 2].map(|i| path.direction(i)), [FRAC_PI_2, 0.0, 0.0]);
        assert_eq!(Path { points: vec![Point2::default()], heading: 3.0 }.direction(0), 3.0);
    }
}

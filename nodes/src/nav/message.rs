//! ROS 2 messages of paths and twists, which Foxglove and Python can show.

use super::{Path, Twist};
use crate::scan::{
    Point2, Pose2,
    message::{FRAME, pose_definition},
};
use apex_rt::{
    Time,
    record::{
        Foreign, Message, Reason,
        cdr::{Reader, Writer},
    },
};

/// Number of numbers in a `geometry_msgs/PoseWithCovariance`.
const POSE_WITH_COVARIANCE: usize = 7 + 36;

/// The poses face along the path. One more pose is at the goal and has the goal heading. In the paths of other programs
/// the last pose is the goal itself.
impl Message for Path {
    const NAME: &'static str = "nav_msgs/msg/Path";
    const DEFINITION: &'static str = concat!(
        "\
std_msgs/Header header
geometry_msgs/PoseStamped[] poses
================================================================================
MSG: geometry_msgs/PoseStamped
std_msgs/Header header
geometry_msgs/Pose pose",
        pose_definition!()
    );

    fn write(&self, message: &mut Writer<'_>) {
        message.header(Time::ZERO, FRAME);
        message.u32(self.points.len() as u32 + 1);
        for (i, point) in self.points.iter().enumerate() {
            Pose2::new(point.x, point.y, self.direction(i)).write(message);
        }
        // The goal of an empty path is NaN, which viewers do not show.
        let goal = self.goal().unwrap_or(Point2::new(f32::NAN, f32::NAN));
        Pose2::new(goal.x, goal.y, self.heading).write(message);
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        message.header()?;
        let mut path = Self::default();
        for _ in 0..message.u32()? {
            let pose = Pose2::read(message)?;
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

impl Message for Twist {
    const NAME: &'static str = "geometry_msgs/msg/Twist";
    const DEFINITION: &'static str = "\
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z";

    fn write(&self, message: &mut Writer<'_>) {
        [self.x, self.y, 0.0, 0.0, 0.0, self.omega].into_iter().for_each(|number| message.f64(f64::from(number)));
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        let (x, y) = (message.f64()?, message.f64()?);
        let (_, _, _) = (message.f64()?, message.f64()?, message.f64()?);
        Ok(Self::new(x as f32, y as f32, message.f64()? as f32))
    }

    fn others() -> Vec<Foreign<Self>> {
        let message = |name, read| Foreign { name, definition: "", read };
        vec![
            message("geometry_msgs/msg/TwistStamped", |message, _| {
                message.header()?;
                Self::read(message).map(Some)
            }),
            message("geometry_msgs/msg/TwistWithCovarianceStamped", |message, _| {
                message.header()?;
                Self::read(message).map(Some)
            }),
            // The twist of odometry is that of the robot, in its own frame.
            message("nav_msgs/msg/Odometry", |message, _| {
                message.header()?;
                message.text()?;
                for _ in 0..POSE_WITH_COVARIANCE {
                    message.f64()?;
                }
                Self::read(message).map(Some)
            }),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes};
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
            let mut bytes = vec![];
            let mut message = Writer::new(&mut bytes);
            message.header(Time::ZERO, "map");
            message.u32(poses.len() as u32);
            poses.iter().for_each(|(x, y)| Pose2::new(*x, *y, 1.5).write(&mut message));
            bytes
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

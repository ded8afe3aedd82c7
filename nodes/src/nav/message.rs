//! ROS 2 messages of paths and twists, which Foxglove and Python can show.

use super::{Path, Twist};
use crate::scan::{
    Point2, Pose2,
    message::{FRAME, pose_definition},
};
use apex_rt::{
    Time,
    record::{
        Message,
        cdr::{Reader, Writer},
    },
};

/// The poses face along the path. One more pose is at the goal and has the goal heading.
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

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        message.header()?;
        let points = message.u32()?.checked_sub(1)?;
        let points: Option<_> = (0..points).map(|_| Pose2::read(message).map(|pose| pose.position())).collect();
        Some(Self { points: points?, heading: Pose2::read(message)?.theta })
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

    fn read(message: &mut Reader<'_>) -> Option<Self> {
        let (x, y) = (message.f64()?, message.f64()?);
        let (_, _, _) = (message.f64()?, message.f64()?, message.f64()?);
        Some(Self::new(x as f32, y as f32, message.f64()? as f32))
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

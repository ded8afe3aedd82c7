//! Messages of other programs that hold a pose: odometry, estimates, transforms.

use super::{Pose2, message::heading};
use apex_messages::{
    Foreign, Message, Others, Reason,
    cdr::Reader,
    geometry_msgs::{self, Pose, PoseWithCovariance, PoseWithCovarianceStamped, TransformStamped},
    nav_msgs::Odometry,
    tf2_msgs::TFMessage,
};

/// Messages that hold a pose. A height, a tilt and a covariance are left out: poses are seen from above.
pub(super) fn poses() -> Others<Pose2> {
    /// Foreign message with the function that takes its pose.
    macro_rules! with_pose {
        ($message:ident, $pose:expr) => {
            Foreign::of::<$message>(|message, _| {
                let pose: fn(&$message) -> &Pose = $pose;
                Ok(Some(pose(&$message::read(message)?).into()))
            })
        };
    }
    vec![
        with_pose!(Pose, |message| message),
        Foreign::of::<geometry_msgs::Pose2D>(|message, _| {
            let pose = geometry_msgs::Pose2D::read(message)?;
            Ok(Some(Pose2::new(pose.x as f32, pose.y as f32, pose.theta as f32)))
        }),
        with_pose!(PoseWithCovariance, |message| &message.pose),
        with_pose!(PoseWithCovarianceStamped, |message| &message.pose.pose),
        with_pose!(Odometry, |message| &message.pose.pose),
        Foreign::of::<TransformStamped>(|message, _| Ok(Some(pose(&TransformStamped::read(message)?)))),
        Foreign::of::<TFMessage>(one_of),
        // The name in old bags of ROS 1.
        Foreign { name: "tf/msg/tfMessage", ..Foreign::of::<TFMessage>(one_of) },
    ]
}

/// Name of a frame, which may begin with `/` in ROS 1.
fn frame(name: &str) -> &str {
    name.trim().trim_start_matches('/')
}

/// Pose of the second frame of a transform in the first one.
fn pose(of: &TransformStamped) -> Pose2 {
    let (position, rotation) = (&of.transform.translation, &of.transform.rotation);
    Pose2::new(position.x as f32, position.y as f32, heading(rotation))
}

/// Reads the transform between the frames `part` (`odom -> base_link`).
fn one_of(message: &mut Reader<'_>, part: &str) -> Result<Option<Pose2>, Reason> {
    let transforms = TFMessage::read(message)?.transforms;
    let name = |of: &TransformStamped| format!("{} -> {}", frame(&of.header.frame_id), frame(&of.child_frame_id));
    let names: Vec<String> = transforms.iter().map(name).collect();
    match names.first() {
        Some(first) if part.is_empty() => {
            let names = names.join("`, `");
            Err(format!("it has the transforms `{names}`: name one behind the topic, as `: {first}`").into())
        }
        _ => {
            let wanted = part.split("->").map(frame).collect::<Vec<_>>().join(" -> ");
            Ok(names.iter().rposition(|name| *name == wanted).map(|at| pose(&transforms[at])))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_messages::{
        geometry_msgs::{Point, Quaternion, Transform, Vector3},
        std_msgs::Header,
    };
    use core::f64::consts::FRAC_1_SQRT_2;

    const TURNED: Quaternion = Quaternion { x: 0.0, y: 0.0, z: FRAC_1_SQRT_2, w: FRAC_1_SQRT_2 };
    const POSE: Pose = Pose { position: Point { x: 1.0, y: 2.0, z: 9.0 }, orientation: TURNED };

    /// Pose that a foreign message gives.
    fn read<M: Message>(message: &M, part: &str) -> Result<Option<Pose2>, Reason> {
        let known = poses().into_iter().find(|known| known.name == M::NAME).expect("known");
        (known.read)(&mut Reader::new(&message.to_bytes())?, part)
    }

    fn is_right(found: Result<Option<Pose2>, Reason>) {
        let pose = found.expect("a message").expect("a pose");
        let turned = pose.theta - core::f32::consts::FRAC_PI_2;
        assert!(pose.x == 1.0 && pose.y == 2.0 && turned.abs() < 1e-6, "{pose:?}");
    }

    #[test]
    fn poses_are_in_many_messages() {
        is_right(read(&POSE, ""));
        is_right(read(&geometry_msgs::Pose2D { x: 1.0, y: 2.0, theta: core::f64::consts::FRAC_PI_2 }, ""));
        let covered = PoseWithCovariance { pose: POSE, covariance: [0.5; 36] };
        is_right(read(&covered, ""));
        is_right(read(&PoseWithCovarianceStamped { pose: covered.clone(), ..Default::default() }, ""));
        is_right(read(&Odometry { pose: covered, ..Default::default() }, ""));
    }

    #[test]
    fn a_transform_is_chosen_by_its_frames() {
        let transform = |parent: &str, child: &str, x| TransformStamped {
            header: Header { frame_id: parent.to_owned(), ..Default::default() },
            child_frame_id: child.to_owned(),
            transform: Transform { translation: Vector3 { x, y: 2.0, z: 0.0 }, rotation: TURNED },
        };
        let message =
            TFMessage { transforms: vec![transform("/map", "odom", 5.0), transform("odom", "base_link", 1.0)] };
        is_right(read(&message.transforms[1], ""));
        let read = |part| read(&message, part);
        is_right(read("odom->base_link"));
        assert_eq!(read("map -> odom").map(|pose| pose.map(|pose| pose.x)), Ok(Some(5.0)));
        assert_eq!(read("map -> base_link"), Ok(None));
        let why = read("").expect_err("which one?");
        let names = "`map -> odom`, `odom -> base_link`";
        assert_eq!(why, format!("it has the transforms {names}: name one behind the topic, as `: map -> odom`"));
    }
}

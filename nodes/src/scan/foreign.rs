//! Messages of other programs that hold a pose: odometry, estimates, transforms.

use super::Pose2;
use crate::frames::Rotation;
use apex_messages::{
    Foreign, Message, Others, Reason,
    cdr::Reader,
    geometry_msgs::{self, Point, Pose, PoseWithCovariance, PoseWithCovarianceStamped, TransformStamped},
    nav_msgs::Odometry,
    tf2_msgs::TFMessage,
};

/// Pose that is read from those of messages.
pub(crate) trait FromPose: Sized {
    /// Converts a pose.
    fn from_pose(pose: &Pose) -> Result<Self, Reason>;
}

/// A height and a tilt are left out: the pose is seen from above.
impl FromPose for Pose2 {
    fn from_pose(pose: &Pose) -> Result<Self, Reason> {
        // Zeros, which a program has not set, would look like the heading of the x axis.
        Rotation::try_from(&pose.orientation)?;
        Ok(pose.into())
    }
}

/// Messages that hold a pose. A covariance is left out.
pub(crate) fn poses<T: FromPose>() -> Others<T> {
    /// Foreign message with the function that takes its pose.
    macro_rules! with_pose {
        ($message:ident, $pose:expr) => {
            Foreign::of::<$message>(|message, _| {
                let pose: fn(&$message) -> &Pose = $pose;
                T::from_pose(pose(&$message::read(message)?)).map(Some)
            })
        };
    }
    vec![
        with_pose!(Pose, |message| message),
        Foreign::of::<geometry_msgs::Pose2D>(|message, _| {
            let geometry_msgs::Pose2D { x, y, theta } = geometry_msgs::Pose2D::read(message)?;
            let (z, w) = libm::sincos(0.5 * theta);
            let orientation = geometry_msgs::Quaternion { x: 0.0, y: 0.0, z, w };
            T::from_pose(&Pose { position: Point { x, y, z: 0.0 }, orientation }).map(Some)
        }),
        with_pose!(PoseWithCovariance, |message| &message.pose),
        with_pose!(PoseWithCovarianceStamped, |message| &message.pose.pose),
        with_pose!(Odometry, |message| &message.pose.pose),
        Foreign::of::<TransformStamped>(|message, _| pose(&TransformStamped::read(message)?).map(Some)),
        Foreign::of::<TFMessage>(one_of),
        // The name in old bags of ROS 1.
        Foreign { name: "tf/msg/tfMessage", ..Foreign::of::<TFMessage>(one_of) },
    ]
}

/// Name of a frame, which may begin with `/` in ROS 1.
fn frame(name: &str) -> &str {
    name.trim().trim_start_matches('/')
}

/// Frames of a transform: `odom -> base_link`.
fn frames(of: &TransformStamped) -> String {
    format!("{} -> {}", frame(&of.header.frame_id), frame(&of.child_frame_id))
}

/// Pose of the second frame of a transform in the first one.
fn pose<T: FromPose>(of: &TransformStamped) -> Result<T, Reason> {
    let geometry_msgs::Vector3 { x, y, z } = of.transform.translation;
    T::from_pose(&Pose { position: Point { x, y, z }, orientation: of.transform.rotation.clone() })
        .map_err(|reason| format!("`{}`: {reason}", frames(of)).into())
}

/// Reads the transform between the frames `part` (`odom -> base_link`).
fn one_of<T: FromPose>(message: &mut Reader<'_>, part: &str) -> Result<Option<T>, Reason> {
    let transforms = TFMessage::read(message)?.transforms;
    let names: Vec<String> = transforms.iter().map(frames).collect();
    match names.first() {
        Some(first) if part.is_empty() => {
            let names = names.join("`, `");
            Err(format!("it has the transforms `{names}`: name one behind the topic, as `: {first}`").into())
        }
        _ => {
            let wanted = part.split("->").map(frame).collect::<Vec<_>>().join(" -> ");
            let Some(at) = names.iter().rposition(|name| *name == wanted) else { return Ok(None) };
            message.set_frame(&transforms[at].header.frame_id);
            pose(&transforms[at]).map(Some)
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

    #[test]
    fn what_is_not_a_rotation_has_no_heading() {
        let unset = || Pose { orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 0.0 }, ..POSE };
        let why = "the length of a quaternion is 0.000: its sender has not set it";
        assert_eq!(read(&unset(), ""), Err(why.into()));
        let mut odometry = Odometry::default();
        odometry.pose.pose = unset();
        assert_eq!(read(&odometry, ""), Err(why.into()));
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
        let mut half = message.clone();
        half.transforms[0].transform.rotation.w = 0.0;
        let of_half = |part| super::one_of::<Pose2>(&mut Reader::new(&half.to_bytes())?, part);
        is_right(of_half("odom -> base_link"));
        let why = "`map -> odom`: the length of a quaternion is 0.707: that of a rotation is 1";
        assert_eq!(of_half("map -> odom"), Err(why.into()));
        let why = read("").expect_err("which one?");
        let names = "`map -> odom`, `odom -> base_link`";
        assert_eq!(why, format!("it has the transforms {names}: name one behind the topic, as `: map -> odom`"));
    }
}

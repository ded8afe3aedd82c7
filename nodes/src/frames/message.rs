//! ROS 2 messages of poses in space, transforms and joints.

use super::{
    FrameName, JointPosition, JointPositions, MAX_JOINTS, MAX_TRANSFORMS, Pose3, Rotation, Transform, Transforms,
    frame_name,
};
use crate::scan::message::{self, FRAME, FromPose};
use apex_messages::{
    Foreign, Reason, converted,
    geometry_msgs::{self, Point, Pose, PoseStamped, Quaternion, TransformStamped, Vector3},
    nav_msgs::Odometry,
    sensor_msgs::JointState,
    std_msgs::Header,
    tf2_msgs::TFMessage,
};
use apex_rt::Time;
use heapless::Vec;

impl From<&Rotation> for Quaternion {
    fn from(rotation: &Rotation) -> Self {
        let [x, y, z, w] = rotation.quaternion();
        Self { x, y, z, w }
    }
}

impl TryFrom<&Quaternion> for Rotation {
    type Error = Reason;

    fn try_from(&Quaternion { x, y, z, w }: &Quaternion) -> Result<Self, Reason> {
        Self::new([x, y, z, w]).map_err(|error| error.to_string().into())
    }
}

impl FromPose for Pose3 {
    fn from_pose(Pose { position: Point { x, y, z }, orientation }: &Pose) -> Result<Self, Reason> {
        Ok(Self::new([*x, *y, *z], orientation.try_into()?))
    }
}

impl From<&Pose3> for PoseStamped {
    fn from(pose: &Pose3) -> Self {
        let (Pose3 { x, y, z, .. }, orientation) = (*pose, (&pose.rotation).into());
        Self { header: Header::new(Time::ZERO, FRAME), pose: Pose { position: Point { x, y, z }, orientation } }
    }
}

impl TryFrom<PoseStamped> for Pose3 {
    type Error = Reason;

    fn try_from(message: PoseStamped) -> Result<Self, Reason> {
        Self::from_pose(&message.pose)
    }
}

converted!(Pose3 as PoseStamped, others = message::poses());

/// Name of a frame or joint, or the reason for which it is not one.
fn name(text: &str) -> Result<FrameName, Reason> {
    frame_name(text).map_err(|error| format!("`{text}`: {error}").into())
}

impl From<&Transform> for TransformStamped {
    fn from(transform: &Transform) -> Self {
        let Transform { stamp, parent, child, pose: Pose3 { x, y, z, rotation } } = transform;
        Self {
            header: Header::new(*stamp, parent),
            child_frame_id: child.as_str().to_owned(),
            transform: geometry_msgs::Transform {
                translation: Vector3 { x: *x, y: *y, z: *z },
                rotation: rotation.into(),
            },
        }
    }
}

impl TryFrom<TransformStamped> for Transform {
    type Error = Reason;

    fn try_from(TransformStamped { header, child_frame_id, transform }: TransformStamped) -> Result<Self, Reason> {
        let (parent, child) = (name(&header.frame_id)?, name(&child_frame_id)?);
        let Vector3 { x, y, z } = transform.translation;
        let rotation = Rotation::try_from(&transform.rotation);
        let rotation = rotation.map_err(|reason| format!("`{parent} -> {child}`: {reason}"))?;
        Ok(Self { stamp: header.stamp.into(), parent, child, pose: Pose3::new([x, y, z], rotation) })
    }
}

impl From<&Transforms> for TFMessage {
    fn from(all: &Transforms) -> Self {
        Self { transforms: all.transforms.iter().map(TransformStamped::from).collect() }
    }
}

impl TryFrom<TFMessage> for Transforms {
    type Error = Reason;

    fn try_from(message: TFMessage) -> Result<Self, Reason> {
        let count = message.transforms.len();
        if count > MAX_TRANSFORMS {
            return Err(format!("it has {count} transforms, of which {MAX_TRANSFORMS} fit into a token").into());
        }
        let transforms = message.transforms.into_iter().map(Transform::try_from);
        Ok(Self { transforms: transforms.collect::<Result<_, _>>()? })
    }
}

/// One transform alone.
fn one(transform: TransformStamped) -> Result<Option<Transforms>, Reason> {
    Ok(Some(Transforms { transforms: Vec::from_iter([transform.try_into()?]) }))
}

converted!(
    Transforms as TFMessage,
    others = vec![
        Foreign::of::<TransformStamped>(|message, _| one(TransformStamped::read(message)?)),
        Foreign::of::<Odometry>(|message, _| {
            let Odometry { header, child_frame_id, pose, .. } = Odometry::read(message)?;
            let Pose { position: Point { x, y, z }, orientation: rotation } = pose.pose;
            let transform = geometry_msgs::Transform { translation: Vector3 { x, y, z }, rotation };
            one(TransformStamped { header, child_frame_id, transform })
        }),
        // The name in old bags of ROS 1.
        Foreign { name: "tf/msg/tfMessage", ..Foreign::itself() },
    ]
);

impl From<&JointPositions> for JointState {
    fn from(JointPositions { stamp, joints }: &JointPositions) -> Self {
        Self {
            header: Header::new(*stamp, ""),
            name: joints.iter().map(|joint| joint.name.as_str().to_owned()).collect(),
            position: joints.iter().map(|joint| joint.position).collect(),
            velocity: vec![],
            effort: vec![],
        }
    }
}

impl TryFrom<JointState> for JointPositions {
    type Error = Reason;

    fn try_from(JointState { header, name: names, position, .. }: JointState) -> Result<Self, Reason> {
        let (count, positions) = (names.len(), position.len());
        if count > MAX_JOINTS {
            return Err(format!("it has {count} joints, of which {MAX_JOINTS} fit into a token").into());
        }
        // Some messages have velocities alone.
        if !position.is_empty() && count != positions {
            return Err(format!("it has {count} names of joints and {positions} positions").into());
        }
        let joint = |(text, position): (String, f64)| Ok(JointPosition { name: name(&text)?, position });
        let joints = names.into_iter().zip(position).map(joint).collect::<Result<_, Reason>>()?;
        Ok(Self { stamp: header.stamp.into(), joints })
    }
}

converted!(JointPositions as JointState);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frames::frame_name,
        scan::message::tests::{again, bytes, reason},
    };
    use apex_messages::{Message, cdr::Reader};

    fn transforms() -> Transforms {
        let [parent, child] = ["odom", "base_link"].map(|name| frame_name(name).expect("a short name"));
        let pose = Pose3::new([1.0, -2.0, 0.1], Rotation::from_rpy(0.1, 0.2, 0.3));
        Transforms { transforms: Vec::from_iter([Transform { stamp: Time::from_nanos(-7), parent, child, pose }]) }
    }

    /// Token that another message gives.
    fn read<T: Message, M: Message>(message: &M, part: &str) -> Result<Option<T>, Reason> {
        let known = T::others().into_iter().find(|known| known.name == M::NAME).expect("known");
        (known.read)(&mut Reader::new(&message.to_bytes())?, part)
    }

    #[test]
    fn tokens_come_back_and_parts_of_them_do_not() {
        let all = transforms();
        let pose = all.transforms[0].pose;
        let name = frame_name("elbow").expect("a short name");
        let mut joints = JointPositions { stamp: Time::from_nanos(3), ..JointPositions::default() };
        joints.joints.extend([JointPosition { name, position: -1.5 }]);
        assert_eq!(again(&bytes(&all)), Some(all.clone()));
        assert_eq!(again(&bytes(&pose)), Some(pose));
        assert_eq!(again(&bytes(&joints)), Some(joints.clone()));
        let (all, joints) = (bytes(&all), bytes(&joints));
        assert!((0..all.len()).all(|len| again::<Transforms>(&all[..len]).is_none()));
        assert!((0..joints.len()).all(|len| again::<JointPositions>(&joints[..len]).is_none()));
    }

    #[test]
    fn rotations_of_many_angles_come_back_bit_by_bit() {
        for i in 0..10_000 {
            let angle = |factor: f64| (f64::from(i) * factor).sin() * 3.2;
            let rotation =
                Rotation::from_rpy(angle(0.7), angle(1.3), angle(2.1)).then(Rotation::from_rpy(1.0, 2.0, 3.0));
            let pose = Pose3::new([angle(1.0), f64::NAN, -0.0], rotation);
            let back: Pose3 = again(&bytes(&pose)).expect("what was written");
            assert_eq!(back.rotation, rotation);
            assert!(back.y.is_nan() && back.z.is_sign_negative());
        }
    }

    #[test]
    fn other_messages_have_transforms_and_poses() {
        let all = transforms();
        let message = TransformStamped::from(&all.transforms[0]);
        assert_eq!(read(&message, ""), Ok(Some(all.clone())));
        let Pose3 { x, y, z, rotation } = all.transforms[0].pose;
        let mut odometry =
            Odometry { header: message.header, child_frame_id: message.child_frame_id, ..Odometry::default() };
        odometry.pose.pose = Pose { position: Point { x, y, z }, orientation: (&rotation).into() };
        assert_eq!(read(&odometry, ""), Ok(Some(all.clone())));
        let pose = all.transforms[0].pose;
        assert_eq!(read(&odometry, ""), Ok(Some(pose)));
        assert_eq!(read(&TFMessage::from(&all), "odom -> base_link"), Ok(Some(pose)));
    }

    #[test]
    fn what_does_not_fit_is_refused_in_words() {
        let mut message = TFMessage::from(&transforms());
        message.transforms[0].transform.rotation.w = 0.0;
        let why = reason::<Transforms>(&message.to_bytes()).expect_err("not a rotation");
        assert!(why.starts_with("`odom -> base_link`: the length of a quaternion is 0."), "{why}");
        let many = TFMessage { transforms: vec![TransformStamped::from(&transforms().transforms[0]); 65] };
        let why = reason::<Transforms>(&many.to_bytes()).expect_err("too many");
        assert_eq!(why, "it has 65 transforms, of which 64 fit into a token");
        message.transforms[0].child_frame_id = "x".repeat(41);
        let why = reason::<Transforms>(&message.to_bytes()).expect_err("too long");
        assert!(why.ends_with("`: the name of a frame has 41 bytes, of which there may be 40: choose a shorter one"));
        let joints =
            JointState { name: vec!["a".to_owned(), "b".to_owned()], position: vec![1.0], ..Default::default() };
        let why = reason::<JointPositions>(&joints.to_bytes()).expect_err("one is missing");
        assert_eq!(why, "it has 2 names of joints and 1 positions");
    }
}

//! Messages of other programs that hold a pose: odometry, estimates, transforms.

use super::{
    Pose2,
    message::{heading, read_pose},
};
use apex_rt::record::{Foreign, Reason, cdr::Reader};

/// Messages that hold a pose. A height, a tilt and a covariance are left out: poses are seen from above.
pub(super) fn poses() -> Vec<Foreign<Pose2>> {
    let message = |name, read| Foreign { name, definition: "", read };
    vec![
        message("geometry_msgs/msg/Pose", |message, _| read_pose(message).map(Some)),
        message("geometry_msgs/msg/Pose2D", |message, _| {
            Ok(Some(Pose2::new(message.f64()? as f32, message.f64()? as f32, message.f64()? as f32)))
        }),
        message("geometry_msgs/msg/PoseWithCovariance", |message, _| read_pose(message).map(Some)),
        message("geometry_msgs/msg/PoseWithCovarianceStamped", |message, _| {
            message.header()?;
            read_pose(message).map(Some)
        }),
        message("nav_msgs/msg/Odometry", |message, _| {
            message.header()?;
            message.text()?;
            read_pose(message).map(Some)
        }),
        message("geometry_msgs/msg/TransformStamped", |message, _| transform(message).map(|(_, pose)| Some(pose))),
        message("tf2_msgs/msg/TFMessage", one_of),
        message("tf/msg/tfMessage", one_of),
    ]
}

/// Reads a `geometry_msgs/TransformStamped`: its frames, as `odom -> base_link`, and the pose of the second one in the
/// first one.
fn transform(message: &mut Reader<'_>) -> Result<(String, Pose2), Reason> {
    let frame = |name: &str| name.trim_start_matches('/').to_owned();
    let (_, parent) = message.header_with_frame()?;
    let (parent, child) = (frame(parent), frame(message.text()?));
    let (x, y, _) = (message.f64()?, message.f64()?, message.f64()?);
    let rotation = [message.f64()?, message.f64()?, message.f64()?, message.f64()?];
    Ok((format!("{parent} -> {child}"), Pose2::new(x as f32, y as f32, heading(rotation))))
}

/// Reads the transform between the frames `part` (`odom -> base_link`) in a `tf2_msgs/TFMessage`.
fn one_of(message: &mut Reader<'_>, part: &str) -> Result<Option<Pose2>, Reason> {
    let (mut names, mut found) = (vec![], None);
    let wanted = part.split("->").map(|frame| frame.trim().trim_start_matches('/')).collect::<Vec<_>>().join(" -> ");
    for _ in 0..message.u32()? {
        let (name, pose) = transform(message)?;
        if name == wanted {
            found = Some(pose);
        }
        names.push(name);
    }
    match names.first() {
        Some(first) if part.is_empty() => {
            let names = names.join("`, `");
            Err(format!("it has the transforms `{names}`: name one behind the topic, as `: {first}`").into())
        }
        _ => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{
        Time,
        record::{Message, cdr::Writer},
    };
    use core::f64::consts::FRAC_1_SQRT_2;

    /// Pose that a foreign message gives.
    fn read(name: &str, part: &str, write: impl Fn(&mut Writer<'_>)) -> Result<Option<Pose2>, Reason> {
        let mut bytes = vec![];
        write(&mut Writer::new(&mut bytes));
        let known = poses().into_iter().find(|message| message.name == name).expect("known");
        (known.read)(&mut Reader::new(&bytes)?, part)
    }

    fn numbers(message: &mut Writer<'_>, numbers: &[f64]) {
        numbers.iter().for_each(|number| message.f64(*number));
    }

    const POSE: [f64; 7] = [1.0, 2.0, 9.0, 0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2];

    fn is_right(found: Result<Option<Pose2>, Reason>) {
        let pose = found.expect("a message").expect("a pose");
        let turned = pose.theta - core::f32::consts::FRAC_PI_2;
        assert!(pose.x == 1.0 && pose.y == 2.0 && turned.abs() < 1e-6, "{pose:?}");
    }

    #[test]
    fn poses_are_in_many_messages() {
        is_right(read("geometry_msgs/msg/Pose", "", |message| numbers(message, &POSE)));
        is_right(read("geometry_msgs/msg/Pose2D", "", |m| numbers(m, &[1.0, 2.0, core::f64::consts::FRAC_PI_2])));
        is_right(read("geometry_msgs/msg/PoseWithCovarianceStamped", "", |message| {
            message.header(Time::ZERO, "map");
            numbers(message, &POSE);
            numbers(message, &[0.5; 36]);
        }));
        is_right(read("nav_msgs/msg/Odometry", "", |message| {
            message.header(Time::ZERO, "odom");
            message.text("base_link");
            numbers(message, &POSE);
            numbers(message, &[0.5; 36 + 6 + 36]);
        }));
        let cut = read("nav_msgs/msg/Odometry", "", |message| message.header(Time::ZERO, "odom"));
        assert_eq!(cut, Err("bytes are missing".into()));
    }

    #[test]
    fn a_transform_is_chosen_by_its_frames() {
        let write = |message: &mut Writer<'_>| {
            message.u32(2);
            for (parent, child, x) in [("/map", "odom", 5.0), ("odom", "base_link", 1.0)] {
                message.header(Time::ZERO, parent);
                message.text(child);
                numbers(message, &[x]);
                numbers(message, &POSE[1..]);
            }
        };
        let read = |part| read("tf2_msgs/msg/TFMessage", part, write);
        is_right(read("odom->base_link"));
        assert_eq!(read("map -> odom").map(|pose| pose.map(|pose| pose.x)), Ok(Some(5.0)));
        assert_eq!(read("map -> base_link"), Ok(None));
        let why = read("").expect_err("which one?");
        assert_eq!(
            why,
            "it has the transforms `map -> odom`, `odom -> base_link`: name one behind the topic, as `: map -> odom`"
        );
        assert_eq!(Pose2::NAME, "geometry_msgs/msg/PoseStamped");
    }
}

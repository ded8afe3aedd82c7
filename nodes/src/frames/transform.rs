use super::Pose3;
use crate::scan::Pose2;
use apex_rt::{Ctx, Time, node};
use core::fmt;
use heapless::{String, Vec};

/// Maximum length of the name of a frame, in bytes.
pub const MAX_NAME: usize = 40;
/// Maximum number of transforms in one token.
pub const MAX_TRANSFORMS: usize = 64;

/// Name of a frame.
pub type FrameName = String<MAX_NAME, u8>;

/// Transforms that were sent together.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Transforms {
    /// Transforms, in any order.
    pub transforms: Vec<Transform, MAX_TRANSFORMS>,
}

/// Pose of one frame in another one, at one time.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Transform {
    /// Time at which the frame has this pose.
    pub stamp: Time,
    /// Frame in which the pose is.
    pub parent: FrameName,
    /// Frame of which the pose is.
    pub child: FrameName,
    /// Pose of the child in the parent.
    pub pose: Pose3,
}

/// Error of a frame's name that is too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NameTooLong {
    /// Length of the name, in bytes.
    pub length: usize,
}

impl fmt::Display for NameTooLong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the name of a frame has {} bytes, of which there may be {MAX_NAME}: choose a shorter one",
            self.length
        )
    }
}

impl core::error::Error for NameTooLong {}

/// Returns the name of a frame. In ROS 1 it may begin with `/`, which is left out.
///
/// # Errors
/// The name is too long.
pub fn frame_name(name: &str) -> Result<FrameName, NameTooLong> {
    let name = name.trim().trim_start_matches('/');
    FrameName::try_from(name).map_err(|_| NameTooLong { length: name.len() })
}

/// Pose that changes, such as that of odometry, as the transform of the frame `child` in the frame `parent`. Its time
/// is the stamp of the token.
///
/// Fails if a name is too long.
#[node]
pub fn transform_of(
    ctx: &Ctx,
    pose: &Pose2,
    #[param] parent: &'static str,
    #[param] child: &'static str,
) -> Result<Transforms, NameTooLong> {
    let (parent, child) = (frame_name(parent)?, frame_name(child)?);
    let transform = Transform { stamp: ctx.stamp(), parent, child, pose: pose.into() };
    Ok(Transforms { transforms: Vec::from_iter([transform]) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odometry_becomes_a_transform_at_its_time() {
        let ctx = Ctx::new(Time::from_millis(20));
        let sent = transform_of(&ctx, &Pose2::new(1.0, 2.0, 0.0), "/odom", "base_link").expect("short names");
        let [transform] = &sent.transforms[..] else { panic!("{sent:?}") };
        assert_eq!((transform.parent.as_str(), transform.child.as_str()), ("odom", "base_link"));
        assert_eq!((transform.stamp, transform.pose.position()), (Time::from_millis(20), [1.0, 2.0, 0.0]));
        let long = "camera_of_the_left_arm_of_the_second_robot";
        let error = transform_of(&ctx, &Pose2::default(), long, "base").expect_err("too long");
        let text = "the name of a frame has 42 bytes, of which there may be 40: choose a shorter one";
        assert_eq!(std::format!("{error}"), text);
    }
}

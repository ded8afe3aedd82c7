use super::{JointPositions, Transforms, Urdf, UrdfError};
use apex_rt::{Event, node};

/// Sends the transforms of a robot's model (URDF), as `robot_state_publisher` of ROS does: those of fixed joints after
/// `load`, and those of joints that turn or slide with each token at `joints`, at its time.
///
/// A joint may follow another one (`mimic`). Joints that are not in the token are left out, and so are those of the
/// types `floating` and `planar`, whose poses come from elsewhere, such as from odometry. Angles are in rad, distances
/// in m; limits are not regarded.
///
/// The file is read at `load`, which fails with line and column if it is not a model. Connect it with `start`.
#[node]
#[derive(Debug, Clone)]
pub struct RobotModel {
    /// Path of the file; `.xacro` files have to be expanded before.
    #[param]
    file: &'static str,
    model: Urdf,
}

#[node]
impl RobotModel {
    /// Reads the file.
    #[slot]
    fn load(&mut self, fixed: Event<Transforms>) -> Result<(), UrdfError> {
        self.model = Urdf::open(self.file)?;
        fixed.emit(self.model.fixed());
        Ok(())
    }

    /// Takes the positions of joints.
    #[slot]
    fn joints(&mut self, positions: &JointPositions, moving: Event<Transforms>) {
        let transforms = self.model.moving(positions);
        if !transforms.transforms.is_empty() {
            moving.emit(transforms);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{JointPosition, frame_name};
    use apex_rt::{Construct, Time, event};
    use core::f64::consts::FRAC_PI_2;
    use std::{env, fs, process};

    const ARM: &str = r#"<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/> <link name="upper"/> <link name="lower"/> <link name="finger"/> <link name="thumb"/>
  <link name="laser"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="mount" type="fixed">
    <parent link="base"/><child link="laser"/><origin xyz="0.2 0 0.1" rpy="0 0 1.5707963267948966"/>
  </joint>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 1"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/><axis xyz="0 -1 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="lower"/><child link="finger"/></joint>
  <joint name="thumb" type="prismatic">
    <parent link="lower"/><child link="thumb"/><mimic joint="grip" multiplier="-2" offset="0.5"/>
  </joint>
</robot>"#;

    /// Node with this text as its file.
    fn node(name: &str, text: &str) -> RobotModel {
        let file = env::temp_dir().join(format!("apex-{name}-{}.urdf", process::id()));
        fs::write(&file, text).expect("a temporary file");
        RobotModel::construct((file.to_str().expect("a readable path").to_owned().leak(),))
    }

    #[test]
    fn a_model_moves_with_its_joints() {
        let mut node = node("arm", ARM);
        let mut fixed = None;
        node.load(event(&mut fixed)).expect("a model");
        let fixed = fixed.expect("transforms").transforms;
        assert_eq!((fixed.len(), fixed[0].parent.as_str(), fixed[0].child.as_str()), (1, "base", "laser"));
        let joint = |name, position| JointPosition { name: frame_name(name).expect("short"), position };
        let mut positions = JointPositions { stamp: Time::from_millis(5), ..JointPositions::default() };
        positions.joints.extend([joint("shoulder", FRAC_PI_2), joint("grip", 0.1), joint("elbow", f64::NAN)]);
        let mut moving = None;
        node.joints(&positions, event(&mut moving));
        let moving = moving.expect("transforms").transforms;
        let names: Vec<&str> = moving.iter().map(|transform| transform.child.as_str()).collect();
        assert_eq!(names, ["upper", "finger", "thumb"], "the elbow is not known");
        assert!(moving.iter().all(|transform| transform.stamp == positions.stamp));
        let [x, y, z] = moving[0].pose.to_outer([1.0, 0.0, 0.0]);
        assert!(x.abs() < 1e-12 && (y - 1.0).abs() < 1e-12 && z == 1.0);
        assert!((moving[1].pose.x - 0.1).abs() < 1e-12 && (moving[2].pose.x - 0.3).abs() < 1e-12);
        let mut none = None;
        node.joints(&JointPositions::default(), event(&mut none));
        assert_eq!(none, None);
    }

    #[test]
    fn mistakes_have_their_place() {
        for (old, new, expected) in [
            (
                r#"<link name="laser">"#,
                r#"<link name="lazer">"#,
                "5:3: the joint `mount` has the link `laser`, which is not in the file",
            ),
            (
                r#"<axis xyz="0 0 2"/>"#,
                r#"<axis xyz="0 0 0"/>"#,
                "9:68: an axis has the length 0 or is too long to compute with: it needs a direction",
            ),
            ("0.2 0 0.1", "0.2 0,1", "6:47: `xyz` has `0,1`, which is not a number"),
            ("0.2 0 0.1", "0.2 0", "6:47: `xyz` has 2 numbers, and needs three"),
            (
                "continuous",
                "ball",
                "12:3: a joint cannot be `ball`, but `fixed`, `revolute`, `continuous`, `prismatic`, `floating` or `planar`",
            ),
            (
                r#"<child link="thumb"/>"#,
                r#"<child link="finger"/>"#,
                "14:3: the link `finger` has two parents, by the joints `grip` and `thumb`",
            ),
            (
                r#"<child link="finger"/>"#,
                r#"<child link="base"/>"#,
                "13:3: the joint `grip` closes a cycle: the link `lower` is below `base`",
            ),
            (r#"<child link="laser"/>"#, "", "5:3: the joint has no `<child>`"),
            (r#"name="grip" "#, "", "13:3: `<joint>` has no attribute `name`"),
            (r#"name="grip" "#, r#"name="elbow" "#, "13:3: there are two joints `elbow`"),
            (
                r#"mimic joint="grip""#,
                r#"mimic joint="thumb""#,
                "14:3: the joint `thumb` follows `thumb`, which is not a joint that moves by itself",
            ),
            ("</robot>", "", "1:1: this is not XML: the root node was opened but never closed"),
            ("robot", "html", "2:1: the root is `<html>` and not `<robot>`; a `.xacro` file has to be expanded first"),
        ] {
            let mut node = node("wrong", &ARM.replace(old, new));
            let error = node.load(event(&mut None)).expect_err(expected).to_string();
            assert_eq!(error, format!("{}:{expected}", node.file));
        }
        let error = RobotModel::construct(("/nowhere.urdf",)).load(event(&mut None)).expect_err("nothing");
        assert!(error.to_string().starts_with("/nowhere.urdf: "), "{error}");
    }
}

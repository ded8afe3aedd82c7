use super::{Detections, View};
use crate::scan::{Pose2, PoseHistory};
use apex_rt::{Ctx, Event, node};

/// Number of poses that are kept: 1.6 s of 20 in a second.
const POSES: usize = 32;

/// Turns detections of persons in the frame of a robot into a fixed frame, by the pose of the robot at their time:
/// images take a while until persons are found in them, and the robot has moved on.
///
/// `pose` is that of the robot in the fixed frame. The view of the detections is that of a sensor of the robot.
/// Detections from before the first pose that is kept, or from the future, are dropped.
#[node]
#[derive(Debug, Clone, Default)]
pub struct PlaceDetections {
    poses: PoseHistory<POSES>,
}

#[node]
impl PlaceDetections {
    fn process(&mut self, ctx: &Ctx, pose: &Pose2) {
        self.poses.keep(ctx.stamp(), pose);
    }

    /// Takes detections in the frame of the robot.
    #[slot]
    fn put(&mut self, detections: &Detections, placed: Event<Detections>) {
        let stamp = detections.stamp;
        let Some(pose) = self.poses.at(stamp) else { return };
        let view = View { pose: pose.compose(&detections.view.pose), ..detections.view };
        let positions = detections.positions.iter().map(|place| pose.to_outer(*place)).collect();
        placed.emit(Detections { stamp, view, positions });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Point2;
    use apex_rt::{Time, event};

    fn placed(stamp: i64) -> Option<Detections> {
        let mut node = PlaceDetections::default();
        for ms in (100..=400).step_by(100) {
            let pose = Pose2::new(0.01 * ms as f32, 2.0, 0.0);
            node.process(&Ctx::new(Time::from_millis(ms)), &pose);
        }
        let mut detections = Detections { stamp: Time::from_millis(stamp), ..Detections::default() };
        detections.positions.push(Point2::new(5.0, 1.0)).expect("room");
        let mut out = None;
        node.put(&detections, event(&mut out));
        out
    }

    #[test]
    fn detections_are_placed_by_the_pose_at_their_time() {
        let found = placed(250).expect("between two poses");
        assert!((found.positions[0] - Point2::new(7.5, 3.0)).norm() < 1e-5, "{found:?}");
        assert!((found.view.pose.x - 2.5).abs() < 1e-5);
        assert!(placed(100).is_some() && placed(400).is_some());
        assert!(placed(50).is_none() && placed(450).is_none());
    }
}

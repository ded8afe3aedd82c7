use super::{Detections, View};
use crate::scan::Pose2;
use apex_rt::{Ctx, Event, Time, node};
use heapless::Deque;

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
    poses: Deque<(Time, Pose2), POSES>,
}

#[node]
impl PlaceDetections {
    fn process(&mut self, ctx: &Ctx, pose: &Pose2) {
        // The clock was set back.
        if self.poses.back().is_some_and(|(last, _)| *last > ctx.stamp()) {
            self.poses.clear();
        }
        if !pose.is_usable() {
            return;
        }
        if self.poses.is_full() {
            self.poses.pop_front();
        }
        // Cannot fail: there is room.
        let _ = self.poses.push_back((ctx.stamp(), *pose));
    }

    /// Takes detections in the frame of the robot.
    #[slot]
    fn put(&mut self, detections: &Detections, placed: Event<Detections>) {
        let stamp = detections.stamp;
        let is_past = self.poses.back().is_some_and(|(last, _)| stamp <= *last);
        let next = self.poses.iter().position(|(time, _)| *time >= stamp).filter(|_| is_past);
        let Some(((after, pose), next)) = next.and_then(|i| Some((self.poses.iter().nth(i)?, i))) else { return };
        let before = next.checked_sub(1).and_then(|i| self.poses.iter().nth(i));
        let pose = match before {
            Some((time, last)) if after > time => {
                let part = stamp.since(*time).as_secs_f32() / after.since(*time).as_secs_f32();
                let step = pose.relative_to(last);
                last.compose(&Pose2::new(part * step.x, part * step.y, part * step.theta))
            }
            _ if *after == stamp => *pose,
            _ => return,
        };
        let view = View { pose: pose.compose(&detections.view.pose), ..detections.view };
        let positions = detections.positions.iter().map(|place| pose.to_outer(*place)).collect();
        placed.emit(Detections { stamp, view, positions });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Point2;
    use apex_rt::event;

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

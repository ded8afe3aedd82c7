use super::{Container, Pose2};
use apex_rt::{Ctx, Out, Time, node};
use heapless::Vec;

/// Maximum number of containers that are remembered.
const MAX_CONTAINERS: usize = 16;

/// Containers around a robot.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "record", derive(serde::Serialize, serde::Deserialize))]
pub struct Containers {
    /// Centres and headings in a fixed frame, in the order in which they were seen last.
    pub poses: Vec<Pose2, MAX_CONTAINERS>,
}

/// Remembers where containers were seen: one beside or behind a robot is still there, although no wheels show it.
///
/// `container` is a confirmed detection in the frame of the robot, and ⊥ between detections. `pose` is that of the
/// robot in a fixed frame such as that of odometry, which is that of the output. A detection replaces those of the same
/// container. Of more than 16 containers, the ones that were seen last are remembered.
#[node]
#[derive(Debug, Clone)]
pub struct RememberContainers {
    /// Distance within which two detections are of the same container.
    #[param(unit = "m", default = 0.7, range = 0.0..=10.0)]
    apart: f32,
    /// Time for which a container is remembered.
    #[param(unit = "s", default = 60.0, range = 0.0..=86400.0)]
    memory: f32,
    /// Distance from the robot up to which `forget` forgets containers.
    #[param(unit = "m", default = 1.8, range = 0.0..=100.0)]
    forgotten: f32,
    /// Last pose of the robot.
    here: Pose2,
    known: Vec<Known, MAX_CONTAINERS>,
}

/// Container in the fixed frame, and the time when it was seen.
#[derive(Debug, Clone, Copy)]
struct Known {
    pose: Pose2,
    seen: Time,
}

#[node]
impl RememberContainers {
    fn process(&mut self, ctx: &Ctx, container: Option<&Container>, pose: &Pose2, containers: &mut Out<Containers>) {
        let memory = self.memory;
        self.known.retain(|known| ctx.now().since(known.seen).as_secs_f32() <= memory);
        if pose.is_finite() {
            self.here = *pose;
            if let Some(container) = container.filter(|container| container.pose.is_finite()) {
                self.remember(Known { pose: pose.compose(&container.pose), seen: ctx.now() });
            }
        }
        containers.get_mut().poses = self.known.iter().map(|known| known.pose).collect();
    }

    /// Forgets the containers around the robot, for example when one of them was lifted.
    #[slot]
    fn forget(&mut self) {
        self.drop_around(self.here, self.forgotten);
    }

    fn remember(&mut self, new: Known) {
        self.drop_around(new.pose, self.apart);
        if self.known.is_full() {
            self.known.remove(0);
        }
        // Cannot fail: there is room.
        let _ = self.known.push(new);
    }

    fn drop_around(&mut self, place: Pose2, distance: f32) {
        self.known.retain(|known| (known.pose.position() - place.position()).norm() > distance);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    const CONTAINER: Container =
        Container { pose: Pose2::new(2.0, 0.0, 0.0), error: 0.0, inliers: 8, outliers: 0, wheels: 4, model: 0 };

    fn remembered(node: &mut RememberContainers, second: i64, pose: Pose2, seen: Option<Pose2>) -> Vec<f32, 16> {
        let container = seen.map(|pose| Container { pose, ..CONTAINER });
        let mut out = Out::new();
        node.process(&Ctx::new(Time::from_secs(second)), container.as_ref(), &pose, &mut out);
        out.get().expect("containers").poses.iter().map(|pose| pose.x).collect()
    }

    #[test]
    fn containers_are_remembered_where_they_were_seen() {
        let (mut node, here) = (RememberContainers::construct((0.7, 10.0, 1.8)), Pose2::default());
        assert!(remembered(&mut node, 0, here, None).is_empty());
        assert_eq!(remembered(&mut node, 1, here, Some(CONTAINER.pose)), [2.0]);
        let further = Pose2::new(4.0, 0.0, 0.0);
        assert_eq!(remembered(&mut node, 5, further, Some(CONTAINER.pose)), [2.0, 6.0]);
        assert_eq!(remembered(&mut node, 6, here, Some(Pose2::new(2.1, 0.1, 0.0))), [6.0, 2.1], "the same one again");
        assert_eq!(remembered(&mut node, 16, further, None), [2.1]);
        assert!(remembered(&mut node, 17, further, None).is_empty());
    }

    #[test]
    fn those_around_the_robot_are_forgotten() {
        let (mut node, here) = (RememberContainers::construct((0.7, 10.0, 1.8)), Pose2::default());
        remembered(&mut node, 0, here, Some(Pose2::new(5.0, 0.0, 0.0)));
        remembered(&mut node, 0, here, Some(Pose2::new(1.0, 0.0, 0.0)));
        node.forget();
        assert_eq!(remembered(&mut node, 0, here, None), [5.0]);
    }

    #[test]
    fn too_many_and_what_is_no_number() {
        let mut node = RememberContainers::construct((0.7, 60.0, 1.8));
        for x in 0..40 {
            remembered(&mut node, 0, Pose2::new(x as f32, 0.0, 0.0), Some(CONTAINER.pose));
        }
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        remembered(&mut node, 0, nan, Some(CONTAINER.pose));
        let left = remembered(&mut node, 0, Pose2::default(), Some(nan));
        assert_eq!((left.len(), left[0], left[15]), (16, 26.0, 41.0));
    }
}

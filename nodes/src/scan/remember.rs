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

/// Remembers where containers were seen or set down: one beside or behind a robot is still there, although no wheels
/// show it.
///
/// `container` is a confirmed detection in the frame of the robot, and ⊥ between detections. `load` is the pose of the
/// container that the robot carries, in the same frame, and ⊥ without one. A load is forgotten where it was picked up,
/// and remembered where it is set down: at its last pose when `load` becomes ⊥. `pose` is that of the robot in a fixed
/// frame such as that of odometry, which is that of the output. A detection replaces those of the same container. Of
/// more than 16 containers, the ones that were seen last are remembered.
#[node]
#[derive(Debug, Clone)]
pub struct RememberContainers {
    /// Distance within which two detections are of the same container.
    #[param(unit = "m", default = 0.7, range = 0.0..=10.0)]
    apart: f32,
    /// Time for which a container is remembered.
    #[param(unit = "s", default = 60.0, range = 0.0..=86400.0)]
    memory: f32,
    /// Load in the fixed frame.
    load: Option<Pose2>,
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
    fn process(
        &mut self,
        ctx: &Ctx,
        container: Option<&Container>,
        load: Option<&Pose2>,
        pose: &Pose2,
        containers: &mut Out<Containers>,
    ) {
        let memory = self.memory;
        self.known.retain(|known| ctx.now().since(known.seen).as_secs_f32() <= memory);
        if pose.is_usable() {
            let outer = |inner: &Pose2| inner.is_usable().then(|| pose.compose(inner));
            let load = load.and_then(outer);
            let set_down = core::mem::replace(&mut self.load, load).filter(|_| load.is_none());
            let seen = container.and_then(|container| outer(&container.pose));
            let new = [set_down, seen].into_iter().flatten();
            new.for_each(|pose| self.remember(Known { pose, seen: ctx.now() }));
            self.load.iter().for_each(|load| drop_around(&mut self.known, load, self.apart));
        }
        containers.get_mut().poses = self.known.iter().map(|known| known.pose).collect();
    }

    fn remember(&mut self, new: Known) {
        drop_around(&mut self.known, &new.pose, self.apart);
        if self.known.is_full() {
            self.known.remove(0);
        }
        // Cannot fail: there is room.
        let _ = self.known.push(new);
    }
}

/// Forgets what is at a place.
fn drop_around(known: &mut Vec<Known, MAX_CONTAINERS>, place: &Pose2, distance: f32) {
    known.retain(|known| (known.pose.position() - place.position()).norm() > distance);
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
        node.process(&Ctx::new(Time::from_secs(second)), container.as_ref(), None, &pose, &mut out);
        out.get().expect("containers").poses.iter().map(|pose| pose.x).collect()
    }

    #[test]
    fn containers_are_remembered_where_they_were_seen() {
        let (mut node, here) = (RememberContainers::construct((0.7, 10.0)), Pose2::default());
        assert!(remembered(&mut node, 0, here, None).is_empty());
        assert_eq!(remembered(&mut node, 1, here, Some(CONTAINER.pose)), [2.0]);
        let further = Pose2::new(4.0, 0.0, 0.0);
        assert_eq!(remembered(&mut node, 5, further, Some(CONTAINER.pose)), [2.0, 6.0]);
        assert_eq!(remembered(&mut node, 6, here, Some(Pose2::new(2.1, 0.1, 0.0))), [6.0, 2.1], "the same one again");
        assert_eq!(remembered(&mut node, 16, further, None), [2.1]);
        assert!(remembered(&mut node, 17, further, None).is_empty());
    }

    #[test]
    fn a_load_is_remembered_where_it_was_set_down() {
        let mut node = RememberContainers::construct((0.7, 10.0));
        let mut at = |second, x, load: Option<f32>, seen: Option<Container>| -> Vec<f32, 16> {
            let (load, mut out) = (load.map(|x| Pose2::new(x, 0.0, 0.0)), Out::new());
            let ctx = Ctx::new(Time::from_secs(second));
            node.process(&ctx, seen.as_ref(), load.as_ref(), &Pose2::new(x, 0.0, 0.0), &mut out);
            out.get().expect("containers").poses.iter().map(|pose| pose.x).collect()
        };
        assert_eq!(at(0, 0.0, None, Some(CONTAINER)), [2.0]);
        assert!(at(5, 2.3, Some(-0.3), Some(Container { pose: Pose2::new(-0.2, 0.0, 0.0), ..CONTAINER })).is_empty());
        assert!(at(6, 7.3, Some(-0.3), None).is_empty());
        assert_eq!(at(7, 7.3, None, None), [7.0]);
        assert_eq!(at(8, 9.0, None, None), [7.0]);
    }

    #[test]
    fn too_many_and_what_is_no_number() {
        let mut node = RememberContainers::construct((0.7, 60.0));
        for x in 0..40 {
            remembered(&mut node, 0, Pose2::new(x as f32, 0.0, 0.0), Some(CONTAINER.pose));
        }
        let nan = Pose2::new(f32::NAN, 0.0, 0.0);
        remembered(&mut node, 0, nan, Some(CONTAINER.pose));
        let left = remembered(&mut node, 0, Pose2::default(), Some(nan));
        assert_eq!((left.len(), left[0], left[15]), (16, 26.0, 41.0));
    }
}

use super::{Container, Point2, Pose2, Scan};
use apex_rt::{Ctx, Out, Time, node};
use heapless::Vec;

/// Maximum number of containers that are remembered.
const MAX_CONTAINERS: usize = 16;
/// Distances of the castors from the middle of a container, along and across, in m.
const CASTORS: [f32; 2] = [0.54, 0.32];
/// Distance of a point from the place of a castor up to which it shows the castor, in m: poses drift.
const CASTOR: f32 = 0.35;
/// Distance beside the place of a castor within which beams go through it, in m.
const THROUGH: f32 = 0.1;
/// Distances between which a scanner sees a castor well, in m.
const SEEN: [f32; 2] = [0.5, 4.0];
/// Number of consecutive scans after which a container that they see through is forgotten.
const EMPTY: u8 = 5;

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
///
/// A container of which no castor is seen from up to 4 m, although beams of `scan` go through the places of its
/// castors, is forgotten: it is no longer there, or persons who stood together were taken for it. The scan is in the
/// frame of the robot. Without it, nothing is forgotten earlier.
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
    /// Number of the last scans that saw through it.
    empty: u8,
}

#[node]
impl RememberContainers {
    fn process(
        &mut self,
        ctx: &Ctx,
        container: Option<&Container>,
        load: Option<&Pose2>,
        pose: &Pose2,
        scan: Option<&Scan>,
        containers: &mut Out<Containers>,
    ) {
        let memory = self.memory;
        self.known.retain(|known| ctx.now().since(known.seen).as_secs_f32() <= memory);
        if pose.is_usable() {
            let outer = |inner: &Pose2| inner.is_usable().then(|| pose.compose(inner));
            let load = load.and_then(outer);
            let set_down = core::mem::replace(&mut self.load, load).filter(|_| load.is_none());
            let seen = container.and_then(|container| outer(&container.pose));
            scan.into_iter().for_each(|scan| self.look(scan, pose));
            let new = [set_down, seen].into_iter().flatten();
            new.for_each(|pose| self.remember(Known { pose, seen: ctx.now(), empty: 0 }));
            self.load.iter().for_each(|load| drop_around(&mut self.known, load, self.apart));
        }
        containers.get_mut().poses = self.known.iter().map(|known| known.pose).collect();
    }

    /// Forgets the containers that a scan does not see although it should.
    fn look(&mut self, scan: &Scan, pose: &Pose2) {
        for known in &mut self.known {
            let is_empty = is_seen_through(scan, &known.pose.relative_to(pose));
            known.empty = if is_empty { known.empty.saturating_add(1) } else { 0 };
        }
        self.known.retain(|known| known.empty < EMPTY);
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

/// Returns `true` if beams go through the places of at least two castors of a container, and none shows one.
fn is_seen_through(scan: &Scan, container: &Pose2) -> bool {
    let [x, y] = CASTORS;
    let castors = [(x, y), (x, -y), (-x, y), (-x, -y)].map(|(x, y)| container.to_outer(Point2::new(x, y)));
    let sees = |castor: &Point2| (SEEN[0]..=SEEN[1]).contains(&castor.norm());
    if !castors.iter().all(sees) {
        return false;
    }
    let views = castors.map(|castor| view(scan, castor));
    let count = |view: View| views.iter().filter(|other| **other == view).count();
    count(View::Castor) == 0 && count(View::Through) >= 2
}

/// View of a scan at the place of a castor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum View {
    Castor,
    /// The beams end behind it.
    Through,
    /// Something hides it, or nothing is measured there.
    Nothing,
}

fn view(scan: &Scan, castor: Point2) -> View {
    let (distance, increment) = (castor.norm(), scan.angle_increment.abs());
    let Some(middle) = scan.beam_towards(castor.angle()) else { return View::Nothing };
    let beams = |beside: f32| {
        // Not more beams than there are.
        let count = (beside / (distance * increment)).min(scan.ranges.len() as f32) as usize;
        let beams = middle.saturating_sub(count)..=middle + count;
        beams.filter_map(|beam| scan.range(beam).map(|range| (range, scan.angle(beam))))
    };
    if beams(CASTOR).any(|(range, angle)| (Point2::polar(range, angle) - castor).norm() <= CASTOR) {
        return View::Castor;
    }
    let is_through = beams(THROUGH).all(|(range, _)| range > distance);
    if is_through && beams(THROUGH).next().is_some() { View::Through } else { View::Nothing }
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
        node.process(&Ctx::new(Time::from_secs(second)), container.as_ref(), None, &pose, None, &mut out);
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
            node.process(&ctx, seen.as_ref(), load.as_ref(), &Pose2::new(x, 0.0, 0.0), None, &mut out);
            out.get().expect("containers").poses.iter().map(|pose| pose.x).collect()
        };
        assert_eq!(at(0, 0.0, None, Some(CONTAINER)), [2.0]);
        assert!(at(5, 2.3, Some(-0.3), Some(Container { pose: Pose2::new(-0.2, 0.0, 0.0), ..CONTAINER })).is_empty());
        assert!(at(6, 7.3, Some(-0.3), None).is_empty());
        assert_eq!(at(7, 7.3, None, None), [7.0]);
        assert_eq!(at(8, 9.0, None, None), [7.0]);
    }

    /// Persons who had stood together closed a corridor for minutes.
    #[test]
    fn what_is_seen_through_is_forgotten() {
        let (mut node, pose) = (RememberContainers::construct((0.7, 60.0)), Pose2::new(1.0, 2.0, 0.5));
        // Scan of a wall at 8 m, and of what stands before it.
        let scan = |places: &[(f32, f32)]| {
            let mut scan =
                Scan { angle_min: -1.5, angle_increment: 0.01, range_max: 20.0, range_min: 0.05, ..Scan::default() };
            scan.ranges.extend([8.0; 301]);
            for (x, y) in places {
                let place = Point2::new(*x, *y);
                let beam = scan.beam_towards(place.angle()).expect("in view");
                scan.ranges[beam - 2..=beam + 2].fill(place.norm());
            }
            scan
        };
        let mut count = |container: Option<&Container>, scan: &Scan| {
            let mut out = Out::new();
            node.process(&Ctx::new(Time::ZERO), container, None, &pose, Some(scan), &mut out);
            out.get().expect("containers").poses.len()
        };
        let castors = scan(&[(1.5, 0.3), (1.5, -0.3)]);
        assert_eq!(count(Some(&CONTAINER), &castors), 1);
        // One of its castors is seen, or all are hidden.
        let hidden = scan(&[(1.0, 0.2), (1.0, -0.2), (1.0, 0.12), (1.0, -0.12)]);
        for _ in 0..9 {
            assert_eq!([count(None, &scan(&[(1.6, 0.4)])), count(None, &hidden)], [1, 1]);
        }
        let counts: Vec<usize, 6> = (0..6).map(|_| count(None, &scan(&[]))).collect();
        assert_eq!(counts, [1, 1, 1, 1, 0, 0]);
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

use apex_nodes::{
    math::normalize_angle,
    scan::{BeamDirections, Point2, Pose2, Scan},
};
use apex_rt::{Ctx, Out, Time, node};
use heapless::Deque;

/// Number of remembered poses: those of more than a second.
const POSES: usize = 16;
/// Greatest difference between the ranges of two neighbouring beams that end on one surface, as a share of the range,
/// and in m.
const STEEP: f32 = 0.1;
const GAP: f32 = 0.08;

/// Turns a scan that arrives late into the one that the scanner would measure now, if nothing but the scanner moves.
///
/// `pose` is the pose of the scanner in a fixed frame such as that of odometry, with each firing. The motion since the
/// stamp of the scan is taken out of it: its points are put into the present frame. Between two neighbouring points of
/// one surface there is surface; where no point is, nothing was measured. The stamp stays, as it is the age of what is
/// seen. A scan without motion, or whose stamp is before all that is remembered, passes unchanged.
#[node]
#[derive(Debug, Clone, Default)]
pub struct CatchUp {
    poses: Deque<(Time, Pose2), POSES>,
    directions: BeamDirections,
}

#[node]
impl CatchUp {
    fn process(&mut self, ctx: &Ctx, scan: Option<&Scan>, pose: Option<&Pose2>, now: &mut Out<Scan>) {
        if let Some(pose) = pose.filter(|pose| pose.is_usable()) {
            self.keep(ctx.now(), *pose);
        }
        let Some(scan) = scan else { return };
        match self.motion_since(scan.stamp).filter(|motion| *motion != Pose2::default()) {
            Some(motion) => self.moved(scan, &motion, now.get_mut()),
            None => now.get_mut().clone_from(scan),
        }
    }

    fn keep(&mut self, now: Time, pose: Pose2) {
        // The clock was set back.
        if self.poses.back().is_some_and(|(last, _)| *last >= now) {
            self.poses.clear();
        }
        if self.poses.is_full() {
            self.poses.pop_front();
        }
        // Cannot fail: there is room.
        let _ = self.poses.push_back((now, pose));
    }

    /// Present pose in the frame of the scanner at a time. `None` if that is before all that is remembered.
    fn motion_since(&self, stamp: Time) -> Option<Pose2> {
        let (_, last) = self.poses.back()?;
        let later = self.poses.iter().position(|(time, _)| *time >= stamp)?;
        let (time, pose) = self.poses.iter().nth(later)?;
        if *time == stamp {
            return Some(last.relative_to(pose));
        }
        let (earlier, from) = self.poses.iter().nth(later.checked_sub(1)?)?;
        let part = stamp.since(*earlier).as_secs_f32() / time.since(*earlier).as_secs_f32();
        let way = pose.relative_to(from);
        let then = from.compose(&Pose2::new(part * way.x, part * way.y, part * way.theta));
        Some(last.relative_to(&then))
    }

    fn moved(&mut self, scan: &Scan, motion: &Pose2, now: &mut Scan) {
        now.clone_from(scan);
        now.ranges.fill(f32::NAN);
        let step = scan.angle_increment;
        let place = |angle: f32| {
            let middle = scan.angle_min + 0.5 * step * scan.ranges.len() as f32;
            (middle + normalize_angle(&(angle - middle)) - scan.angle_min) / step
        };
        // What is far away is in the same direction from everywhere.
        for beam in (0..scan.ranges.len()).filter(|beam| scan.sight(*beam) == f32::INFINITY) {
            set(now, place(scan.angle(beam) - motion.theta), f32::INFINITY);
        }
        let frame = motion.transform();
        let mut last: Option<(usize, f32, f32)> = None;
        for (beam, point) in self.directions.points(scan) {
            let point: Point2 = frame.to_inner(point);
            let (at, range) = (place(point.angle()), point.norm());
            set(now, at, range);
            let before = last.replace((beam, at, range)).filter(|(other, ..)| other + 1 == beam);
            if let Some((_, other, near)) = before {
                fill(now, [other, at], [near, range]);
            }
        }
    }
}

/// Sets the range of the beam nearest to a place among the beams, unless something nearer is there.
fn set(scan: &mut Scan, place: f32, range: f32) {
    let beam = libm::roundf(place);
    if beam >= 0.0
        && let Some(old) = scan.ranges.get_mut(beam as usize)
    {
        // `min` ignores NaN.
        *old = old.min(range);
    }
}

/// Sets the beams between two neighbouring points, if they are of one surface.
fn fill(scan: &mut Scan, [from, to]: [f32; 2], [a, b]: [f32; 2]) {
    if !(from < to && (a - b).abs() <= GAP + STEEP * a.min(b)) {
        return;
    }
    for beam in libm::ceilf(from.max(0.0)) as usize..=libm::floorf(to.max(0.0)) as usize {
        set(scan, beam as f32, a + (b - a) * (beam as f32 - from) / (to - from));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct as _;
    use apex_sim::{Laser, Random, World};

    const LASER: Laser = Laser { noise: 0.0, dropout: 0.0, ..Laser::S300 };

    fn room() -> World {
        let mut world = World::default();
        world.block(&Pose2::default(), 8.0, 5.0);
        world.block(&Pose2::new(1.5, 1.0, 0.3), 0.4, 0.3);
        world.disc(Point2::new(1.2, -1.0), 0.06);
        world
    }

    fn scan_at(pose: &Pose2, stamp: Time) -> Scan {
        let mut scan = Scan { stamp, ..Scan::default() };
        LASER.measure(&room(), pose, &mut Random::new(1), &mut scan);
        scan
    }

    fn fire(node: &mut CatchUp, ms: i64, scan: Option<&Scan>, pose: &Pose2) -> Option<Scan> {
        let mut now = Out::new();
        node.process(&Ctx::new(Time::from_millis(ms)), scan, Some(pose), &mut now);
        now.get().cloned()
    }

    /// Share of the beams whose ranges are alike.
    fn alike(a: &Scan, b: &Scan) -> f32 {
        let pairs = a.ranges.iter().zip(b.ranges.iter());
        pairs.filter(|(a, b)| (*a - *b).abs() < 0.02).count() as f32 / a.ranges.len() as f32
    }

    #[test]
    fn a_late_scan_becomes_the_present_one() {
        let poses = [Pose2::new(-0.5, 0.1, 0.2), Pose2::new(-0.44, 0.12, 0.3)];
        let mut node = CatchUp::construct(());
        let late = scan_at(&poses[0], Time::from_millis(80));
        assert!(fire(&mut node, 80, None, &poses[0]).is_none());
        let now = fire(&mut node, 160, Some(&late), &poses[1]).expect("a scan");
        let true_one = scan_at(&poses[1], Time::from_millis(160));
        assert!(alike(&late, &true_one) < 0.4, "{}", alike(&late, &true_one));
        // What was out of view is not seen: 6° of 270°, and beside edges.
        assert!(alike(&now, &true_one) > 0.93, "{}", alike(&now, &true_one));
        assert_eq!((now.stamp, now.ranges.len()), (late.stamp, late.ranges.len()));
    }

    #[test]
    fn a_stamp_lies_between_two_poses() {
        let pose = |ms: i64| Pose2::new(0.0005 * ms as f32, 0.0, 0.0);
        let mut node = CatchUp::construct(());
        for ms in [0, 80, 160, 240] {
            fire(&mut node, ms, None, &pose(ms));
        }
        let motion = node.motion_since(Time::from_millis(100)).expect("it is remembered");
        assert!((motion.x - 0.07).abs() < 1e-5, "{motion:?}");
    }

    #[test]
    fn a_scan_in_time_or_without_motion_passes_unchanged() {
        let pose = Pose2::new(-0.5, 0.1, 0.2);
        let mut node = CatchUp::construct(());
        for (ms, stamp) in [(0, 0), (80, 80), (160, 80)] {
            let scan = scan_at(&pose, Time::from_millis(stamp));
            assert_eq!(fire(&mut node, ms, Some(&scan), &pose), Some(scan));
        }
    }

    #[test]
    fn a_scan_of_before_all_poses_passes_unchanged() {
        let mut node = CatchUp::construct(());
        let scan = scan_at(&Pose2::default(), Time::ZERO);
        fire(&mut node, 80, None, &Pose2::default());
        assert_eq!(fire(&mut node, 160, Some(&scan), &Pose2::new(1.0, 0.0, 0.0)), Some(scan));
    }
}

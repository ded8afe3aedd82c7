use super::{BeamDirections, Pose2, PoseHistory, Scan, wrap_angle};
use apex_rt::{Ctx, Out, Time, node};

/// Number of remembered poses: those of more than a second, at up to 15 in a second.
const POSES: usize = 16;
/// Greatest difference between the ranges of two neighbouring beams that end on one surface, as a share of the range,
/// and in m.
const STEEP: f32 = 0.1;
const GAP: f32 = 0.08;

/// Turns a scan that arrives late, or whose beams measure one after the other, into the one that the scanner would
/// measure now all at once, if nothing but the scanner moves.
///
/// `pose` is the pose of the scanner in a fixed frame such as that of odometry, with each firing. The motion since the
/// time of each beam (`stamp` and `time_increment` of the scan) is taken out of the scan: its points are put into the
/// present frame. Between two neighbouring points of one surface there is surface; where no point is, nothing was
/// measured. The stamp stays, as it is the age of what is seen. A scan without motion, or whose stamp is before all
/// that is remembered, which is the last 16 poses, has the same ranges as before.
///
/// Cost: O(n) for n beams, with the sine and the cosine of an angle for each, if the scanner has moved.
#[node]
#[derive(Debug, Clone, Default)]
pub struct CatchUp {
    poses: PoseHistory<POSES>,
    directions: BeamDirections,
}

#[node]
impl CatchUp {
    fn process(&mut self, ctx: &Ctx, scan: Option<&Scan>, pose: Option<&Pose2>, now: &mut Out<Scan>) {
        if let Some(pose) = pose {
            self.poses.keep(ctx.now(), pose);
        }
        let Some(scan) = scan else { return };
        let now = now.get_mut();
        now.clone_from(scan);
        now.time_increment = 0.0;
        let ends = [0, scan.ranges.len().saturating_sub(1)].map(|beam| motion_since(&self.poses, scan.time(beam)));
        if ends.into_iter().flatten().any(|motion| motion != Pose2::default()) {
            self.moved(scan, now);
        }
    }

    fn moved(&mut self, scan: &Scan, now: &mut Scan) {
        now.ranges.fill(f32::NAN);
        let step = scan.angle_increment;
        let place = |angle: f32| {
            let middle = scan.angle_min + 0.5 * step * scan.ranges.len() as f32;
            (middle + wrap_angle(angle - middle) - scan.angle_min) / step
        };
        let motion = |beam| motion_since(&self.poses, scan.time(beam)).unwrap_or_default();
        // What is far away is in the same direction from everywhere.
        for beam in (0..scan.ranges.len()).filter(|beam| scan.sight(*beam) == f32::INFINITY) {
            set(now, place(scan.angle(beam) - motion(beam).theta), f32::INFINITY);
        }
        let mut last: Option<(usize, f32, f32)> = None;
        for (beam, point) in self.directions.points(scan) {
            let point = motion(beam).to_inner(point);
            let (at, range) = (place(point.angle()), point.norm());
            set(now, at, range);
            let before = last.replace((beam, at, range)).filter(|(other, ..)| other + 1 == beam);
            if let Some((_, other, near)) = before {
                fill(now, [other, at], [near, range]);
            }
        }
    }
}

/// Present pose in the frame of the scanner at a time. `None` if that is before all that is remembered.
fn motion_since(poses: &PoseHistory<POSES>, time: Time) -> Option<Pose2> {
    let (newest, now) = poses.newest()?;
    // A clock that is ahead.
    let then = poses.at(time.min(*newest))?;
    Some(now.relative_to(&then))
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

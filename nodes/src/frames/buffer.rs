use super::{FrameName, Pose3, Transform, Transforms};
use apex_rt::Time;
use core::fmt;
use heapless::Vec;

/// Times at which a transform holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It holds at all times: that of a sensor on its robot.
    Fixed,
    /// It holds at its stamp, and between two stamps what is between them.
    Moving,
}

/// Reason for which a transform is not taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TransformError {
    /// A name is empty, or a frame is its own parent.
    Unnamed(FrameName),
    /// The pose is not finite.
    NotFinite(FrameName),
    /// The frame `child` is in two others.
    TwoParents {
        /// Frame.
        child: FrameName,
        /// Its parent so far.
        known: FrameName,
        /// Its parent in this transform.
        new: FrameName,
    },
    /// The frame `parent` is in the frame `child` already, directly or through others.
    Cycle {
        /// Parent in this transform.
        parent: FrameName,
        /// Child in this transform.
        child: FrameName,
    },
    /// A transform comes both as a fixed and as a moving one.
    FixedAndMoving(FrameName),
    /// The buffer has room for this number of frames.
    TooManyFrames(FrameName, usize),
    /// The buffer has room for this number of frames that move.
    TooManyMoving(FrameName, usize),
}

impl fmt::Display for TransformError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unnamed(parent) if parent.is_empty() => {
                f.write_str("a transform has a frame without a name: its sender has to name parent and child")
            }
            Self::Unnamed(name) => {
                write!(f, "the frame `{name}` is its own parent: its sender has to name two different frames")
            }
            Self::NotFinite(child) => {
                write!(f, "the position of the frame `{child}` is not finite: its sender has to leave it out")
            }
            Self::TwoParents { child, known, new } => write!(
                f,
                "the frame `{child}` has two parents, `{known}` and `{new}`: frames form a tree, so one of two senders \
                 must name another child, or send the pose of `{new}` in `{child}`"
            ),
            Self::Cycle { parent, child } => write!(
                f,
                "`{parent} -> {child}` closes a cycle, because `{parent}` is below `{child}` already: frames form a \
                 tree, so one of the senders has parent and child exchanged"
            ),
            Self::FixedAndMoving(child) => write!(
                f,
                "the frame `{child}` comes both as fixed (`/tf_static`) and as moving (`/tf`): stop one of the senders"
            ),
            Self::TooManyFrames(name, room) => {
                write!(
                    f,
                    "the frame `{name}` is one more than the {room} for which there is room: send only those needed"
                )
            }
            Self::TooManyMoving(name, room) => write!(
                f,
                "the frame `{name}` is one more than the {room} that may move: send what does not move as fixed, and \
                 only what is needed"
            ),
        }
    }
}

impl core::error::Error for TransformError {}

/// Reason for which there is no transform between two frames at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Gap {
    /// One of the frames has not been heard of, or nothing connects the two yet.
    Unconnected,
    /// The time is before the oldest transform that is kept.
    Before,
    /// The time is after the newest transform.
    After,
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unconnected => "no transforms connect the two frames: a name is wrong, or its sender is silent",
            Self::Before => "the time is before the oldest transform that is kept: the token is too old",
            Self::After => "the time is after the newest transform: wait for it with `TransformQueue`",
        })
    }
}

/// Transforms between the frames of a tree, of the last moments.
///
/// It has room for `FRAMES` frames, of which `MOVING` may move in their parent; of each of them the newest `SAMPLES`
/// transforms are kept. Between two of them positions change with constant velocity and rotations on the shortest way
/// with constant angular velocity. Nothing is said about times outside of them.
#[derive(Debug, Clone)]
pub struct TransformBuffer<const FRAMES: usize, const MOVING: usize, const SAMPLES: usize> {
    frames: Vec<Frame, FRAMES>,
    moving: Vec<Vec<Sample, SAMPLES>, MOVING>,
}

#[derive(Debug, Clone)]
struct Frame {
    name: FrameName,
    link: Option<Link>,
}

/// Way from a frame to its parent.
#[derive(Debug, Clone, Copy)]
struct Link {
    parent: usize,
    pose: LinkPose,
}

#[derive(Debug, Clone, Copy)]
enum LinkPose {
    Fixed(Pose3),
    /// Number of its samples.
    Moving(usize),
}

/// Pose at a time; samples are in the order of their times.
#[derive(Debug, Clone, Copy)]
struct Sample {
    stamp: Time,
    pose: Pose3,
}

impl<const FRAMES: usize, const MOVING: usize, const SAMPLES: usize> Default
    for TransformBuffer<FRAMES, MOVING, SAMPLES>
{
    fn default() -> Self {
        Self { frames: Vec::new(), moving: Vec::new() }
    }
}

impl<const FRAMES: usize, const MOVING: usize, const SAMPLES: usize> TransformBuffer<FRAMES, MOVING, SAMPLES> {
    /// Takes a transform. A fixed one takes the place of the last fixed one between its frames, a moving one that of
    /// one with its stamp. A moving one that is older than all that are kept is left out if there is no room.
    ///
    /// # Errors
    /// It contradicts the others, or there is no room for a frame. Then the buffer is as before.
    pub fn insert(&mut self, transform: &Transform, kind: Kind) -> Result<(), TransformError> {
        let Transform { stamp, parent, child, pose } = transform;
        if parent == child || parent.is_empty() || child.is_empty() {
            let shown = if child.is_empty() { child } else { parent };
            return Err(TransformError::Unnamed(shown.clone()));
        }
        if !pose.is_finite() {
            return Err(TransformError::NotFinite(child.clone()));
        }
        let link = self.link(parent, child, kind)?;
        match link.pose {
            LinkPose::Moving(number) => self.moving[number].keep(Sample { stamp: *stamp, pose: *pose }),
            LinkPose::Fixed(_) => {
                let frame = self.index(child).map(|index| &mut self.frames[index]);
                if let Some(frame) = frame {
                    frame.link = Some(Link { pose: LinkPose::Fixed(*pose), ..link });
                }
            }
        }
        Ok(())
    }

    /// Takes all transforms of a token, but for those that contradict others.
    ///
    /// # Errors
    /// The first one that is not taken: the reason.
    pub fn insert_all(&mut self, all: &Transforms, kind: Kind) -> Result<(), TransformError> {
        let mut result = Ok(());
        for transform in &all.transforms {
            result = result.and(self.insert(transform, kind));
        }
        result
    }

    /// Pose of the frame `from` in the frame `to` at a time.
    ///
    /// # Errors
    /// It is not known: the reason.
    pub fn look_up(&self, from: &str, to: &str, at: Time) -> Result<Pose3, Gap> {
        let (from, to) = self.index(from).zip(self.index(to)).ok_or(Gap::Unconnected)?;
        let common = self.common(from, to).ok_or(Gap::Unconnected)?;
        let (up, down) = (self.pose_in(from, common, at)?, self.pose_in(to, common, at)?);
        Ok(down.inverse().compose(&up))
    }

    /// Newest time at which all that is between two frames is known. `Time::MAX` if nothing between them moves.
    ///
    /// # Errors
    /// Nothing connects them.
    pub fn newest(&self, from: &str, to: &str) -> Result<Time, Gap> {
        let (from, to) = self.index(from).zip(self.index(to)).ok_or(Gap::Unconnected)?;
        let common = self.common(from, to).ok_or(Gap::Unconnected)?;
        let newest = |frame: usize| {
            let links = self.above(frame).take_while(|frame| *frame != common);
            let moving = links.filter_map(|frame| match self.frames[frame].link?.pose {
                LinkPose::Fixed(_) => None,
                LinkPose::Moving(number) => self.moving[number].last().map(|sample| sample.stamp),
            });
            moving.min().unwrap_or(Time::MAX)
        };
        Ok(newest(from).min(newest(to)))
    }

    /// Link between two frames of this kind, which is made if there is none.
    fn link(&mut self, parent: &FrameName, child: &FrameName, kind: Kind) -> Result<Link, TransformError> {
        let (above, below) = (self.index(parent), self.index(child));
        if let Some(link) = below.and_then(|below| self.frames[below].link) {
            return self.same(link, parent, child, kind);
        }
        if let Some((above, below)) = above.zip(below)
            && self.above(above).any(|frame| frame == below)
        {
            return Err(TransformError::Cycle { parent: parent.clone(), child: child.clone() });
        }
        let new = usize::from(above.is_none()) + usize::from(below.is_none());
        if self.frames.len() + new > FRAMES {
            return Err(TransformError::TooManyFrames(child.clone(), FRAMES));
        }
        let pose = match kind {
            Kind::Fixed => LinkPose::Fixed(Pose3::default()),
            Kind::Moving => {
                let full = TransformError::TooManyMoving(child.clone(), MOVING);
                self.moving.push(Vec::new()).map_err(|_| full)?;
                LinkPose::Moving(self.moving.len() - 1)
            }
        };
        let above = above.unwrap_or_else(|| self.add(parent));
        let below = below.unwrap_or_else(|| self.add(child));
        let link = Link { parent: above, pose };
        self.frames[below].link = Some(link);
        Ok(link)
    }

    /// The link that a frame has, if it is to the same parent and of the same kind.
    fn same(&self, link: Link, parent: &FrameName, child: &FrameName, kind: Kind) -> Result<Link, TransformError> {
        let known = &self.frames[link.parent].name;
        if known != parent {
            let (child, known, new) = (child.clone(), known.clone(), parent.clone());
            return Err(TransformError::TwoParents { child, known, new });
        }
        match (link.pose, kind) {
            (LinkPose::Fixed(_), Kind::Fixed) | (LinkPose::Moving(_), Kind::Moving) => Ok(link),
            _ => Err(TransformError::FixedAndMoving(child.clone())),
        }
    }

    /// Adds a frame, for which there is room.
    fn add(&mut self, name: &FrameName) -> usize {
        // There is room: it was counted.
        let _ = self.frames.push(Frame { name: name.clone(), link: None });
        self.frames.len() - 1
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.frames.iter().position(|frame| frame.name.as_str() == name)
    }

    /// A frame and those above it.
    fn above(&self, frame: usize) -> impl Iterator<Item = usize> + '_ {
        core::iter::successors(Some(frame), |frame| self.frames[*frame].link.map(|link| link.parent))
    }

    /// First frame above both.
    fn common(&self, a: usize, b: usize) -> Option<usize> {
        self.above(a).find(|frame| self.above(b).any(|other| other == *frame))
    }

    /// Pose of a frame in one above it.
    fn pose_in(&self, frame: usize, ancestor: usize, at: Time) -> Result<Pose3, Gap> {
        let mut pose = Pose3::default();
        for frame in self.above(frame).take_while(|frame| *frame != ancestor) {
            let Some(link) = self.frames[frame].link else { return Err(Gap::Unconnected) };
            let outer = match link.pose {
                LinkPose::Fixed(pose) => pose,
                LinkPose::Moving(number) => pose_at(&self.moving[number], at)?,
            };
            pose = outer.compose(&pose);
        }
        Ok(pose)
    }
}

/// Keeping the newest samples in the order of their stamps.
trait Keep {
    fn keep(&mut self, sample: Sample);
}

impl<const SAMPLES: usize> Keep for Vec<Sample, SAMPLES> {
    fn keep(&mut self, sample: Sample) {
        let mut place = self.partition_point(|other| other.stamp < sample.stamp);
        if let Some(same) = self.get_mut(place).filter(|other| other.stamp == sample.stamp) {
            *same = sample;
            return;
        }
        if self.is_full() {
            if place == 0 {
                return;
            }
            self.remove(0);
            place -= 1;
        }
        // There is room, unless `SAMPLES` is 0.
        let _ = self.insert(place, sample);
    }
}

/// Pose between the samples about a time.
fn pose_at(samples: &[Sample], at: Time) -> Result<Pose3, Gap> {
    let place = samples.partition_point(|sample| sample.stamp < at);
    let after = samples.get(place).ok_or(Gap::After)?;
    if after.stamp == at {
        return Ok(after.pose);
    }
    let before = place.checked_sub(1).and_then(|place| samples.get(place)).ok_or(Gap::Before)?;
    let part = at.since(before.stamp).as_secs_f64() / after.stamp.since(before.stamp).as_secs_f64();
    Ok(before.pose.towards(&after.pose, part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Rotation, frame_name};
    use apex_optim::Random;
    use std::{
        format,
        string::{String, ToString as _},
        vec::Vec as List,
    };

    fn transform(parent: &str, child: &str, millis: i64, pose: Pose3) -> Transform {
        let name = |name| frame_name(name).expect("a short name");
        Transform { stamp: Time::from_millis(millis), parent: name(parent), child: name(child), pose }
    }

    fn at(x: f64) -> Pose3 {
        Pose3::new([x, 0.0, 0.0], Rotation::NONE)
    }

    type Small = TransformBuffer<4, 2, 3>;

    impl Small {
        fn takes(&mut self, parent: &str, child: &str, millis: i64, x: f64, kind: Kind) -> Result<(), String> {
            self.insert(&transform(parent, child, millis, at(x)), kind).map_err(|error| error.to_string())
        }

        fn x(&self, from: &str, to: &str, millis: i64) -> Result<f64, Gap> {
            self.look_up(from, to, Time::from_millis(millis)).map(|pose| pose.x)
        }
    }

    #[test]
    fn poses_are_known_between_their_times_and_nowhere_else() {
        let mut buffer = Small::default();
        for (millis, x) in [(10, 1.0), (30, 3.0), (20, 5.0)] {
            assert_eq!(buffer.takes("odom", "base", millis, x, Kind::Moving), Ok(()));
        }
        assert_eq!(buffer.x("base", "odom", 9), Err(Gap::Before));
        assert_eq!([10, 15, 20, 25, 30].map(|at| buffer.x("base", "odom", at)), [1.0, 3.0, 5.0, 4.0, 3.0].map(Ok));
        assert_eq!(buffer.x("base", "odom", 31), Err(Gap::After));
        assert_eq!(buffer.x("base", "map", 20), Err(Gap::Unconnected));
        // The same time again, one too many, and one that is too old.
        for (millis, x) in [(20, 7.0), (40, 4.0), (5, 9.0)] {
            assert_eq!(buffer.takes("odom", "base", millis, x, Kind::Moving), Ok(()));
        }
        assert_eq!([10, 20, 40].map(|at| buffer.x("base", "odom", at)), [Err(Gap::Before), Ok(7.0), Ok(4.0)]);
        assert_eq!(buffer.takes("base", "laser", 0, 0.5, Kind::Fixed), Ok(()));
        assert_eq!(buffer.takes("base", "laser", 0, 0.25, Kind::Fixed), Ok(()));
        assert_eq!((buffer.x("laser", "odom", 20), buffer.x("odom", "laser", 20)), (Ok(7.25), Ok(-7.25)));
        assert_eq!((buffer.x("laser", "base", -1), buffer.x("odom", "odom", 999)), (Ok(0.25), Ok(0.0)));
        assert_eq!(buffer.newest("laser", "odom"), Ok(Time::from_millis(40)));
        assert_eq!(
            (buffer.newest("laser", "base"), buffer.newest("laser", "x")),
            (Ok(Time::MAX), Err(Gap::Unconnected))
        );
    }

    #[test]
    fn what_is_not_a_tree_is_refused_in_words() {
        let mut buffer = Small::default();
        let mut refused = |parent: &str, child: &str, kind| buffer.takes(parent, child, 0, 1.0, kind);
        assert_eq!(refused("map", "odom", Kind::Moving), Ok(()));
        assert_eq!(refused("odom", "base", Kind::Moving), Ok(()));
        for (parent, child, kind, text) in [
            ("base", "map", Kind::Fixed, "`base -> map` closes a cycle, because `base` is below `map` already"),
            ("base", "odom", Kind::Moving, "the frame `odom` has two parents, `map` and `base`"),
            ("map", "odom", Kind::Fixed, "the frame `odom` comes both as fixed (`/tf_static`) and as moving (`/tf`)"),
            ("base", "base", Kind::Fixed, "the frame `base` is its own parent"),
            ("", "base", Kind::Fixed, "a transform has a frame without a name"),
            ("base", "wheel", Kind::Moving, "the frame `wheel` is one more than the 2 that may move"),
        ] {
            let error = refused(parent, child, kind).expect_err(text);
            assert!(error.starts_with(text), "{error}");
        }
        assert_eq!(refused("base", "laser", Kind::Fixed), Ok(()), "there is still room for it");
        let full = refused("base", "camera", Kind::Fixed).expect_err("too many");
        assert!(full.starts_with("the frame `camera` is one more than the 4 for which there is room"), "{full}");
        let error = buffer.takes("map", "odom", 1, f64::NAN, Kind::Moving).expect_err("not a number");
        assert!(error.starts_with("the position of the frame `odom` is not finite"), "{error}");
        assert_eq!(buffer.x("base", "map", 0), Ok(2.0), "all is as before");
    }

    /// Matrix of a pose: its first three rows.
    type Matrix = [[f64; 4]; 3];

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        let last = [0.0, 0.0, 0.0, 1.0];
        let entry = |row: usize, column: usize| {
            (0..3).map(|k| a[row][k] * b[k][column]).sum::<f64>() + a[row][3] * last[column]
        };
        core::array::from_fn(|row| core::array::from_fn(|column| entry(row, column)))
    }

    fn inverse(a: &Matrix) -> Matrix {
        core::array::from_fn(|row| {
            core::array::from_fn(|column| match column {
                3 => -(0..3).map(|k| a[k][row] * a[k][3]).sum::<f64>(),
                _ => a[column][row],
            })
        })
    }

    /// Roll, pitch, yaw and position as a matrix, by the textbook and not by quaternions.
    fn matrix([roll, pitch, yaw]: [f64; 3], [x, y, z]: [f64; 3]) -> Matrix {
        let ((a, b), (c, d), (e, f)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        let rx = [[1.0, 0.0, 0.0, 0.0], [0.0, b, -a, 0.0], [0.0, a, b, 0.0]];
        let ry = [[d, 0.0, c, 0.0], [0.0, 1.0, 0.0, 0.0], [-c, 0.0, d, 0.0]];
        let rz = [[f, -e, 0.0, x], [e, f, 0.0, y], [0.0, 0.0, 1.0, z]];
        product(&product(&rz, &ry), &rx)
    }

    #[test]
    fn random_trees_are_as_matrices() {
        let mut random = Random::new(43);
        for _ in 0..200 {
            let mut buffer = TransformBuffer::<24, 12, 4>::default();
            let count = 2 + random.below(22) as usize;
            // Each frame but the first is in one before it; half of them turn about the vertical axis and travel.
            let mut poses: List<[Matrix; 2]> = List::from([[matrix([0.0; 3], [0.0; 3]); 2]]);
            let mut links = List::new();
            for child in 1..count {
                let parent = random.below(child as u64) as usize;
                let mut number = || 2.0 * random.unit() - 1.0;
                let (angles, place) =
                    ([3.0 * number(), 1.5 * number(), 3.0 * number()], [0; 3].map(|_| 5.0 * number()));
                let (turn, shift) = (3.0 * number(), [0; 3].map(|_| number()));
                let moves = child % 2 == 0;
                links.push((parent, child, angles, place, moves.then_some((turn, shift))));
                // At half of the time between two samples.
                let half = if moves { (0.5 * turn, shift.map(|c| 0.5 * c)) } else { (0.0, [0.0; 3]) };
                let turned = |part: f64| {
                    let shifted = core::array::from_fn(|i| place[i] + 2.0 * part * half.1[i]);
                    let [roll, pitch, yaw] = angles;
                    matrix([roll, pitch, yaw + 2.0 * part * half.0], shifted)
                };
                poses.push([0.0, 0.5].map(|part| product(&poses[parent][(2.0 * part) as usize], &turned(part))));
            }
            // They come in any order.
            for i in (1..links.len()).rev() {
                links.swap(i, random.below(i as u64 + 1) as usize);
            }
            for (parent, child, [roll, pitch, yaw], place, moves) in &links {
                let (parent, child) = (format!("f{parent}"), format!("f{child}"));
                let send = |buffer: &mut TransformBuffer<24, 12, 4>, millis, pose, kind| {
                    buffer.insert(&transform(&parent, &child, millis, pose), kind).expect("a tree");
                };
                let pose = |turn: f64, place| Pose3::new(place, Rotation::from_rpy(*roll, *pitch, yaw + turn));
                match moves {
                    None => send(&mut buffer, 7, pose(0.0, *place), Kind::Fixed),
                    Some((turn, shift)) => {
                        let end = core::array::from_fn(|i| place[i] + shift[i]);
                        send(&mut buffer, 2000, pose(*turn, end), Kind::Moving);
                        send(&mut buffer, 1000, pose(0.0, *place), Kind::Moving);
                    }
                }
            }
            for (time, millis) in [(0, 1000), (1, 1500)] {
                let (from, to) = (random.below(count as u64) as usize, random.below(count as u64) as usize);
                let found = buffer.look_up(&format!("f{from}"), &format!("f{to}"), Time::from_millis(millis));
                let found = found.expect("connected");
                let expected = product(&inverse(&poses[to][time]), &poses[from][time]);
                for (i, row) in expected.iter().enumerate() {
                    let entries = [found.rotation.matrix()[i].as_slice(), &[found.position()[i]]].concat();
                    assert!(entries.iter().zip(row).all(|(a, b)| (a - b).abs() < 1e-11), "{entries:?} {row:?}");
                }
            }
        }
    }
}

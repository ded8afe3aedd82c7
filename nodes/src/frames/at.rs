use super::{Buffer, Gap, Kind, Pose3, TransformError, Transforms};
use crate::{persons::Detections, scan::Scan};
use apex_rt::{Ctx, Event, Time, node};
use core::marker::PhantomData;

/// Token of something that was measured at a time.
pub trait Stamped {
    /// Time of the measurement.
    fn stamp(&self) -> Time;
}

/// Implements [`Stamped`] for types with a field `stamp`.
macro_rules! stamped {
    ($($(#[$attribute:meta])? $ty:ty),* $(,)?) => {
        $(
            $(#[$attribute])?
            impl Stamped for $ty {
                fn stamp(&self) -> Time {
                    self.stamp
                }
            }
        )*
    };
}

stamped!(
    Scan,
    Detections,
    #[cfg(feature = "std")]
    crate::cloud::PointCloud,
    #[cfg(feature = "image")]
    crate::image::GrayImage,
    #[cfg(feature = "image")]
    crate::image::ColorImage,
);

impl Stamped for Time {
    fn stamp(&self) -> Time {
        *self
    }
}

/// Sends the pose of the frame `from` in the frame `to` at the time at which the token at `at` was measured: a scan, a
/// point cloud, an image, or a time.
///
/// Transforms come in at the slots: those that change (`/tf`) at `moving`, those that do not (`/tf_static`) at `fixed`.
/// They are kept for [`MAX_SAMPLES`](super::MAX_SAMPLES) stamps of each of at most [`MAX_MOVING`](super::MAX_MOVING)
/// frames that move, and between two stamps the pose is between the two. Outside of them nothing is known: the output
/// is ⊥, and `missing` has the reason. A transform that contradicts others is an error, and the others are taken.
#[node]
#[derive(Debug, Clone)]
pub struct TransformAt<T> {
    /// Frame of which the pose is.
    #[param]
    from: &'static str,
    /// Frame in which the pose is.
    #[param]
    to: &'static str,
    buffer: Buffer,
    tokens: PhantomData<fn(T)>,
}

#[node]
impl<T: Stamped> TransformAt<T> {
    fn process(&mut self, at: &T, missing: Event<Gap>) -> Option<Pose3> {
        let pose = self.buffer.look_up(self.from, self.to, at.stamp());
        pose.map_err(|gap| missing.emit(gap)).ok()
    }

    /// Takes transforms that hold at their stamps.
    #[slot]
    fn moving(&mut self, transforms: &Transforms) -> Result<(), TransformError> {
        self.buffer.insert_all(transforms, Kind::Moving)
    }

    /// Takes transforms that hold at all times.
    #[slot]
    fn fixed(&mut self, transforms: &Transforms) -> Result<(), TransformError> {
        self.buffer.insert_all(transforms, Kind::Fixed)
    }
}

/// Sends in each firing the pose of the frame `from` in the frame `to` at the newest time at which all transforms
/// between them are known; ⊥ if they are older than `max_age`, or not known.
///
/// The slots are those of [`TransformAt`].
#[node]
#[computed]
#[derive(Debug, Clone)]
pub struct LatestTransform {
    /// Frame of which the pose is.
    #[param]
    from: &'static str,
    /// Frame in which the pose is.
    #[param]
    to: &'static str,
    /// Age up to which a pose is sent.
    #[param(unit = "s", default = 0.5, range = 0.0..=600.0)]
    max_age: f32,
    buffer: Buffer,
}

#[node]
impl LatestTransform {
    fn process(&mut self, ctx: &Ctx) -> Option<Pose3> {
        let newest = self.buffer.newest(self.from, self.to).ok()?;
        let is_young = ctx.now().since(newest).as_secs_f32() <= self.max_age;
        is_young.then(|| self.buffer.look_up(self.from, self.to, newest).ok())?
    }

    /// Takes transforms that hold at their stamps.
    #[slot]
    fn moving(&mut self, transforms: &Transforms) -> Result<(), TransformError> {
        self.buffer.insert_all(transforms, Kind::Moving)
    }

    /// Takes transforms that hold at all times.
    #[slot]
    fn fixed(&mut self, transforms: &Transforms) -> Result<(), TransformError> {
        self.buffer.insert_all(transforms, Kind::Fixed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Rotation, Transform, frame_name};
    use apex_rt::{Construct, event};

    /// One transform along x.
    pub(crate) fn along(parent: &str, child: &str, millis: i64, x: f64) -> Transforms {
        let [parent, child] = [parent, child].map(|name| frame_name(name).expect("a short name"));
        let pose = Pose3::new([x, 0.0, 0.0], Rotation::NONE);
        let transform = Transform { stamp: Time::from_millis(millis), parent, child, pose };
        Transforms { transforms: heapless::Vec::from_iter([transform]) }
    }

    #[test]
    fn a_scan_finds_the_transform_at_its_time() {
        let mut node = TransformAt::construct(("laser", "odom"));
        let fire = |node: &mut TransformAt<Scan>, millis| {
            let mut gap = None;
            let scan = Scan { stamp: Time::from_millis(millis), ..Scan::default() };
            let pose = node.process(&scan, event(&mut gap));
            (pose.map(|pose| pose.x), gap)
        };
        assert_eq!(fire(&mut node, 0), (None, Some(Gap::Unconnected)));
        node.fixed(&along("base", "laser", 0, 0.5)).expect("a tree");
        node.moving(&along("odom", "base", 0, 1.0)).expect("a tree");
        node.moving(&along("odom", "base", 100, 2.0)).expect("a tree");
        assert_eq!([0, 50, 100].map(|at| fire(&mut node, at).0), [1.5, 2.0, 2.5].map(Some));
        assert_eq!([-1, 101].map(|at| fire(&mut node, at)), [(None, Some(Gap::Before)), (None, Some(Gap::After))]);
        assert!(matches!(node.fixed(&along("x", "laser", 0, 0.0)), Err(TransformError::TwoParents { .. })));
    }

    #[test]
    fn all_of_a_token_are_taken_but_the_wrong_one() {
        let mut node: TransformAt<Time> = TransformAt::construct(("laser", "odom"));
        let mut all = along("odom", "odom", 0, 0.0);
        all.transforms.extend(along("odom", "laser", 0, 2.0).transforms);
        assert!(matches!(node.fixed(&all), Err(TransformError::Unnamed(_))));
        let mut gap = None;
        assert_eq!(node.process(&Time::ZERO, event(&mut gap)).map(|pose| pose.x), Some(2.0));
    }

    #[test]
    fn the_newest_pose_is_sent_while_it_is_young() {
        let mut node = LatestTransform::construct(("laser", "odom", 0.1));
        let fire =
            |node: &mut LatestTransform, millis| node.process(&Ctx::new(Time::from_millis(millis))).map(|pose| pose.x);
        node.fixed(&along("base", "laser", 0, 0.5)).expect("a tree");
        assert_eq!(fire(&mut node, 10), None);
        node.moving(&along("odom", "base", 0, 1.0)).expect("a tree");
        node.moving(&along("odom", "base", 20, 2.0)).expect("a tree");
        assert_eq!([30, 120, 121].map(|now| fire(&mut node, now)), [Some(2.5), Some(2.5), None]);
        let mut node = LatestTransform::construct(("laser", "base", 0.1));
        node.fixed(&along("base", "laser", 0, 0.5)).expect("a tree");
        assert_eq!(fire(&mut node, 99_000), Some(0.5), "it holds at all times");
    }
}

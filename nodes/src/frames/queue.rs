use super::{Buffer, Gap, Kind, Pose3, Stamped, TransformError, Transforms};
use apex_rt::{Ctx, Event, Out, Time, node};

/// Maximum number of tokens that wait in a [`TransformQueue`].
pub const MAX_WAITING: usize = 8;

/// Keeps tokens until the transform at their time is known: often a scan comes before the transform with its stamp.
///
/// In a firing it sends the oldest token that was put in, as `item`, with the pose of the frame `from` in the frame
/// `to` at its time. A token for which there is no transform after `wait`, or can be none, is left out, and so is the
/// oldest one if more than [`MAX_WAITING`] wait: `lost` has its time. Tokens stay in their order. Give the node a short
/// period: `every 10ms`.
///
/// The slots for transforms are those of [`TransformAt`](super::TransformAt).
#[node]
#[computed]
#[derive(Debug, Clone)]
pub struct TransformQueue<T> {
    /// Frame of which the pose is.
    #[param]
    from: &'static str,
    /// Frame in which the pose is.
    #[param]
    to: &'static str,
    /// Age up to which a token waits.
    #[param(unit = "s", default = 0.5, range = 0.0..=60.0)]
    wait: f32,
    buffer: Buffer,
    waiting: Waiting<T>,
}

/// Ring of tokens, whose storage is used again.
#[derive(Debug, Clone)]
struct Waiting<T> {
    tokens: [Option<T>; MAX_WAITING],
    first: usize,
    count: usize,
}

impl<T> Default for Waiting<T> {
    fn default() -> Self {
        Self { tokens: [const { None }; MAX_WAITING], first: 0, count: 0 }
    }
}

impl<T: Clone> Waiting<T> {
    fn oldest(&self) -> Option<&T> {
        self.tokens[self.first].as_ref().filter(|_| self.count > 0)
    }

    fn drop_oldest(&mut self) {
        self.first = (self.first + 1) % MAX_WAITING;
        self.count -= 1;
    }

    /// Adds a token; there is room.
    fn add(&mut self, token: &T) {
        let place = &mut self.tokens[(self.first + self.count) % MAX_WAITING];
        match place {
            Some(place) => place.clone_from(token),
            None => *place = Some(token.clone()),
        }
        self.count += 1;
    }
}

#[node]
impl<T: Clone + Default + Stamped> TransformQueue<T> {
    fn process(&mut self, ctx: &Ctx, item: &mut Out<T>, pose: &mut Out<Pose3>, #[failure] lost: Event<Time>) {
        let Some(oldest) = self.waiting.oldest() else { return };
        let stamp = oldest.stamp();
        match self.buffer.look_up(self.from, self.to, stamp) {
            Ok(known) => {
                item.get_mut().clone_from(oldest);
                pose.set(known);
            }
            Err(Gap::After | Gap::Unconnected) if ctx.now().since(stamp).as_secs_f32() <= self.wait => return,
            Err(_) => lost.emit(stamp),
        }
        self.waiting.drop_oldest();
    }

    /// Takes a token that waits for its transform.
    #[slot]
    fn put(&mut self, token: &T, #[failure] lost: Event<Time>) {
        if let Some(oldest) = self.waiting.oldest().filter(|_| self.waiting.count == MAX_WAITING) {
            lost.emit(oldest.stamp());
            self.waiting.drop_oldest();
        }
        self.waiting.add(token);
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
    use heapless::Vec;

    fn along(millis: i64, x: f64) -> Transforms {
        let [parent, child] = ["odom", "base"].map(|name| frame_name(name).expect("a short name"));
        let pose = Pose3::new([x, 0.0, 0.0], Rotation::NONE);
        let transform = Transform { stamp: Time::from_millis(millis), parent, child, pose };
        Transforms { transforms: Vec::from_iter([transform]) }
    }

    type Node = TransformQueue<Time>;

    /// Time of the token that is sent, with its pose; and that of a lost one.
    fn fire(node: &mut Node, now: i64) -> (Option<(i64, f64)>, Option<i64>) {
        let (mut item, mut pose, mut lost) = (Out::new(), Out::new(), None);
        node.process(&Ctx::new(Time::from_millis(now)), &mut item, &mut pose, event(&mut lost));
        let millis = |time: Time| time.since(Time::ZERO).as_millis() as i64;
        let sent = item.get().zip(pose.get()).map(|(item, pose)| (millis(*item), pose.x));
        (sent, lost.map(millis))
    }

    fn put(node: &mut Node, millis: i64) -> bool {
        let mut lost = None;
        node.put(&Time::from_millis(millis), event(&mut lost));
        lost.is_some()
    }

    #[test]
    fn tokens_wait_for_their_transforms_and_stay_in_order() {
        let mut node = Node::construct(("base", "odom", 0.1));
        assert_eq!(fire(&mut node, 0), (None, None));
        node.moving(&along(2, 1.2)).expect("a tree");
        assert!(!put(&mut node, 11) && !put(&mut node, 20));
        assert_eq!(fire(&mut node, 25), (None, None));
        node.moving(&along(20, 3.0)).expect("a tree");
        assert_eq!(fire(&mut node, 30), (Some((11, 2.1)), None));
        assert_eq!(fire(&mut node, 30), (Some((20, 3.0)), None));
        assert_eq!(fire(&mut node, 30), (None, None));
        // Too old for any transform; and one whose transform does not come.
        put(&mut node, 1);
        put(&mut node, 40);
        assert_eq!(fire(&mut node, 41), (None, Some(1)));
        assert_eq!((fire(&mut node, 140), fire(&mut node, 141)), ((None, None), (None, Some(40))));
    }

    #[test]
    fn the_oldest_makes_room() {
        let mut node = Node::construct(("base", "odom", 0.1));
        for i in 0..20 {
            assert_eq!(put(&mut node, i), i >= MAX_WAITING as i64, "{i}");
        }
        node.moving(&along(0, 0.0)).expect("a tree");
        node.moving(&along(20, 20.0)).expect("a tree");
        let sent: Vec<_, 20> = (0..9).filter_map(|_| fire(&mut node, 30).0.map(|(time, _)| time)).collect();
        assert_eq!(sent, (12..20).collect::<Vec<_, 20>>());
    }
}

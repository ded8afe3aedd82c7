use apex_rt::{Event, node};
use core::marker::PhantomData;

/// Forwards every `n`-th value, and sends ⊥ for the `n − 1` values before it (thesis 3.6.2).
#[node]
#[derive(Debug, Clone)]
pub struct Throttle<T> {
    /// Number of values per forwarded value.
    #[param(default = 2, range = 1..=1_000_000)]
    n: u32,
    seen: u32,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T: Clone> Throttle<T> {
    fn process(&mut self, value: &T) -> Option<T> {
        self.seen += 1;
        let due = self.seen >= self.n;
        if due {
            self.seen = 0;
        }
        due.then(|| value.clone())
    }

    /// Restarts the count: the next value is the first of `n`.
    #[slot]
    fn reset(&mut self) {
        self.seen = 0;
    }
}

/// Number of values received, including the present one. Saturates at the maximum of `u64`.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Count<T> {
    count: u64,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Count<T> {
    fn process(&mut self, _value: &T) -> u64 {
        self.count = self.count.saturating_add(1);
        self.count
    }

    /// Resets the count to zero.
    #[slot]
    fn reset(&mut self) {
        self.count = 0;
    }
}

/// Forwards a value if it differs from the previous one; ⊥ otherwise. The first value always passes.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Changed<T> {
    last: Option<T>,
}

#[node]
impl<T: Clone + PartialEq> Changed<T> {
    fn process(&mut self, value: &T) -> Option<T> {
        if self.last.as_ref() == Some(value) {
            return None;
        }
        self.last = Some(value.clone());
        self.last.clone()
    }
}

/// Turns the edges of a boolean into events: an emitter (thesis 3.6.3). The state before the first value is `false`.
#[node]
#[derive(Debug, Clone, Default)]
pub struct Edge {
    last: bool,
}

#[node]
impl Edge {
    fn process(&mut self, value: &bool, rose: Event<()>, fell: Event<()>) {
        match (self.last, *value) {
            (false, true) => rose.emit(()),
            (true, false) => fell.emit(()),
            _ => {}
        }
        self.last = *value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn throttle_forwards_every_nth() {
        let mut node = Throttle::<i32>::construct((3,));
        let sent: [Option<i32>; 7] = core::array::from_fn(|i| node.process(&(i as i32)));
        assert_eq!(sent, [None, None, Some(2), None, None, Some(5), None]);
        node.reset();
        assert_eq!([node.process(&7), node.process(&8), node.process(&9)], [None, None, Some(9)]);
    }

    #[test]
    fn throttle_of_one_forwards_everything() {
        let mut node = Throttle::<i32>::construct((1,));
        assert_eq!((node.process(&1), node.process(&2)), (Some(1), Some(2)));
    }

    #[test]
    fn count_starts_at_one_and_resets() {
        let mut node = Count::default();
        assert_eq!((node.process(&'a'), node.process(&'b')), (1, 2));
        node.reset();
        assert_eq!(node.process(&'c'), 1);
    }

    #[test]
    fn changed_drops_repetitions() {
        let mut node = Changed::default();
        let sent = [1, 1, 2, 2, 1].map(|x| node.process(&x));
        assert_eq!(sent, [Some(1), None, Some(2), None, Some(1)]);
    }

    #[test]
    fn edge_tells_rising_from_falling() {
        let mut node = Edge::default();
        let events = [false, true, true, false].map(|value| {
            let (mut rose, mut fell) = (None, None);
            node.process(&value, apex_rt::event(&mut rose), apex_rt::event(&mut fell));
            (rose.is_some(), fell.is_some())
        });
        assert_eq!(events, [(false, false), (true, false), (false, false), (false, true)]);
    }
}

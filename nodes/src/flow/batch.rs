use apex_rt::{Out, node};
use heapless::{Deque, Vec};

/// Maximum number of tokens in a [`Delay`] or [`Collect`].
pub const MAX_BATCH: usize = 64;

/// Delays a stream by `n` values. The first `n` outputs are ⊥.
#[node]
#[derive(Debug, Clone)]
pub struct Delay<T> {
    /// Length of the delay, in values.
    #[param(default = 1, range = 1..=64)]
    n: usize,
    waiting: Deque<T, MAX_BATCH>,
}

#[node]
impl<T: Clone> Delay<T> {
    fn process(&mut self, value: &T) -> Option<T> {
        // Taken out first, so that there is always room for the new value. A loop, because `n` may have become smaller.
        let mut sent = None;
        while self.waiting.len() >= self.n.clamp(1, MAX_BATCH) {
            sent = self.waiting.pop_front();
        }
        let full = self.waiting.push_back(value.clone());
        debug_assert!(full.is_ok(), "there is room for a value after one was taken out");
        sent
    }

    /// Discards all delayed values.
    #[slot]
    fn reset(&mut self) {
        self.waiting.clear();
    }
}

/// Gathers `n` values and sends them as one list, in order of arrival; ⊥ in between.
#[node]
#[derive(Debug, Clone)]
pub struct Collect<T> {
    /// Length of the list.
    #[param(default = 8, range = 1..=64)]
    n: usize,
    gathered: Vec<T, MAX_BATCH>,
}

#[node]
impl<T: Clone> Collect<T> {
    fn process(&mut self, value: &T, list: &mut Out<Vec<T, MAX_BATCH>>) {
        let full = self.gathered.push(value.clone());
        debug_assert!(full.is_ok(), "the list is emptied before it is full");
        if self.gathered.len() >= self.n.clamp(1, MAX_BATCH) {
            core::mem::swap(list.get_mut(), &mut self.gathered);
            self.gathered.clear();
        }
    }

    /// Starts a new list.
    #[slot]
    fn reset(&mut self) {
        self.gathered.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn delay_shifts_the_stream() {
        let mut node = Delay::construct((2,));
        let sent = [1, 2, 3, 4].map(|x| node.process(&x));
        assert_eq!(sent, [None, None, Some(1), Some(2)]);
        node.reset();
        assert_eq!(node.process(&5), None);
    }

    #[test]
    fn the_longest_delay_fits() {
        let mut node = Delay::construct((MAX_BATCH,));
        for i in 0..MAX_BATCH {
            assert_eq!(node.process(&i), None);
        }
        assert_eq!(node.process(&MAX_BATCH), Some(0));
    }

    #[test]
    fn collect_sends_full_lists_only() {
        let mut node = Collect::construct((3,));
        let mut out = Out::new();
        let mut lists: std::vec::Vec<std::vec::Vec<i32>> = std::vec::Vec::new();
        for x in 0..7 {
            out.clear();
            node.process(&x, &mut out);
            lists.extend(out.get().map(|list| list.to_vec()));
        }
        assert_eq!(lists, [[0, 1, 2], [3, 4, 5]]);
        node.reset();
        assert!(node.gathered.is_empty());
    }
}

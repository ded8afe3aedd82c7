//! Buffers from events to synchronous flow (thesis 3.6.3). A connection from an event to an input does the same;
//! buffers serve flow with a rate of its own.

use apex_rt::node;

/// Sends the same value in every firing.
#[node]
#[computed]
pub fn constant<T: Clone>(#[param] value: T) -> T {
    value
}

/// Sends the last received value in every firing; ⊥ before the first one (thesis 3.6.3, *latching*).
#[node]
#[computed]
#[derive(Debug, Clone, Default)]
pub struct Latch<T> {
    value: Option<T>,
}

#[node]
impl<T: Clone> Latch<T> {
    fn process(&mut self) -> Option<T> {
        self.value.clone()
    }

    /// Replaces the stored value.
    #[slot]
    fn set(&mut self, value: &T) {
        self.value = Some(value.clone());
    }

    /// Discards the stored value: the output is ⊥ until the next one.
    #[slot]
    fn reset(&mut self) {
        self.value = None;
    }
}

/// Sends every received value at most once: the last one since the previous firing, or ⊥ (thesis 3.6.3).
#[node]
#[computed]
#[derive(Debug, Clone, Default)]
pub struct Latest<T> {
    value: Option<T>,
}

#[node]
impl<T: Clone> Latest<T> {
    fn process(&mut self) -> Option<T> {
        self.value.take()
    }

    /// Replaces the value to send.
    #[slot]
    fn set(&mut self, value: &T) {
        self.value = Some(value.clone());
    }
}

/// Fills the gaps of a stream: sends the last value again in place of ⊥.
#[node]
#[computed]
#[derive(Debug, Clone, Default)]
pub struct Hold<T> {
    value: Option<T>,
}

#[node]
impl<T: Clone> Hold<T> {
    fn process(&mut self, value: Option<&T>) -> Option<T> {
        if let Some(value) = value {
            self.value = Some(value.clone());
        }
        self.value.clone()
    }

    /// Discards the last value.
    #[slot]
    fn reset(&mut self) {
        self.value = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latch_repeats() {
        let mut node = Latch::default();
        assert_eq!(node.process(), None);
        node.set(&4);
        assert_eq!((node.process(), node.process()), (Some(4), Some(4)));
        node.reset();
        assert_eq!(node.process(), None);
    }

    #[test]
    fn latest_sends_once() {
        let mut node = Latest::default();
        node.set(&4);
        node.set(&5);
        assert_eq!((node.process(), node.process()), (Some(5), None));
    }

    #[test]
    fn hold_fills_gaps() {
        let mut node = Hold::default();
        let sent = [None, Some(&1), None, Some(&2), None].map(|x| node.process(x));
        assert_eq!(sent, [None, Some(1), Some(1), Some(2), Some(2)]);
        node.reset();
        assert_eq!(node.process(None), None);
    }
}

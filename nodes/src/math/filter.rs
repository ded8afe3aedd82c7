use apex_rt::{Ctx, Time, node};
use heapless::Deque;
use num_traits::Float;

/// Maximum window of a [`MovingAverage`].
pub const MAX_WINDOW: usize = 64;

/// Mean of the last `window` values, or of all values while there are fewer.
#[node]
#[derive(Debug, Clone)]
pub struct MovingAverage<T> {
    /// Number of averaged values.
    #[param(default = 8, range = 1..=64)]
    window: usize,
    values: Deque<T, MAX_WINDOW>,
}

#[node]
impl<T: Float> MovingAverage<T> {
    fn process(&mut self, x: &T) -> T {
        while self.values.len() >= self.window.clamp(1, MAX_WINDOW) {
            self.values.pop_front();
        }
        let full = self.values.push_back(*x);
        debug_assert!(full.is_ok(), "there is room for a value after one was taken out");
        // Summed again each time: a running sum would drift, and keep a NaN forever.
        let (sum, count) = self.values.iter().fold((T::zero(), T::zero()), |(s, n), x| (s + *x, n + T::one()));
        sum / count
    }

    /// Discards all values.
    #[slot]
    fn reset(&mut self) {
        self.values.clear();
    }
}

/// Exponential smoothing: `y ← y + weight · (x − y)`. The first output is the first value.
#[node]
#[derive(Debug, Clone)]
pub struct LowPass {
    /// Weight of the new value: 1 does not smooth; values near 0 smooth strongly.
    #[param(range = 0.0..=1.0)]
    weight: f64,
    state: Option<f64>,
}

#[node]
impl LowPass {
    fn process(&mut self, x: &f64) -> f64 {
        let y = self.state.map_or(*x, |y| y + self.weight * (*x - y));
        self.state = Some(y);
        y
    }

    /// Restarts the filter at the next value.
    #[slot]
    fn reset(&mut self) {
        self.state = None;
    }
}

/// Limits the rate of change of a value, for example of a velocity to a limited acceleration.
#[node]
#[derive(Debug, Clone)]
pub struct RateLimit {
    /// Maximum change per second, in units of the value.
    #[param(range = 0.0..)]
    rate: f64,
    last: Option<(Time, f64)>,
}

#[node]
impl RateLimit {
    fn process(&mut self, ctx: &Ctx, x: &f64) -> f64 {
        let y = self.last.map_or(*x, |(then, y)| {
            let step = self.rate * ctx.now().since(then).as_secs_f64();
            // Not `f64::clamp`, which panics if the step is NaN.
            (*x - y).min(step).max(-step) + y
        });
        self.last = Some((ctx.now(), y));
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn average_of_a_sliding_window() {
        let mut node = MovingAverage::construct((2,));
        assert_eq!([1.0, 3.0, 5.0].map(|x| node.process(&x)), [1.0, 2.0, 4.0]);
        node.reset();
        assert_eq!(node.process(&7.0), 7.0);
    }

    #[test]
    fn average_recovers_from_nan() {
        let mut node = MovingAverage::construct((2,));
        assert!(node.process(&f64::NAN).is_nan());
        assert!(node.process(&1.0).is_nan());
        assert_eq!(node.process(&3.0), 2.0);
    }

    #[test]
    fn low_pass_approaches_a_step() {
        let mut node = LowPass::construct((0.5,));
        assert_eq!([0.0, 4.0, 4.0].map(|x| node.process(&x)), [0.0, 2.0, 3.0]);
        node.reset();
        assert_eq!(node.process(&9.0), 9.0);
    }

    #[test]
    fn rate_limit_is_per_second() {
        let mut node = RateLimit::construct((2.0,));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        assert_eq!(node.process(&at(0), &0.0), 0.0);
        assert_eq!(node.process(&at(500), &10.0), 1.0);
        assert_eq!(node.process(&at(1000), &-10.0), 0.0);
        assert_eq!(node.process(&at(9000), &3.0), 3.0);
    }
}

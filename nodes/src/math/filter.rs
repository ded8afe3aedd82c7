use apex_rt::{Ctx, Time, node};
use heapless::Deque;
use num_traits::Float;

/// Maximum window of a [`MovingAverage`].
pub const MAX_WINDOW: usize = 64;

/// Mean of the last `window` values, or of all values while there are fewer. It is a number again when the last value
/// that is none, NaN or infinite, has left the window.
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

/// Exponential smoothing: `y ← y + weight · (x − y)`. The first output is the first value. An output that is not
/// finite, because a value is NaN or infinite, is not remembered: the next one is computed from the last finite one.
#[node]
#[derive(Debug, Clone)]
pub struct LowPass<T> {
    /// Weight of the new value: 1 does not smooth; values near 0 smooth strongly.
    #[param(range = 0.0..=1.0)]
    weight: f64,
    state: Option<T>,
}

#[node]
impl<T: Float> LowPass<T> {
    fn process(&mut self, x: &T) -> T {
        let weight: T = number(self.weight);
        let y = self.state.map_or(*x, |y| y + weight * (*x - y));
        if y.is_finite() {
            self.state = Some(y);
        }
        y
    }

    /// Restarts the filter at the next value.
    #[slot]
    fn reset(&mut self) {
        self.state = None;
    }
}

/// Limits the rate of change of a value, for example of a velocity to a limited acceleration. The output begins at
/// `initial`, also if the first value is another one, and is continuous: a pause does not allow a jump.
///
/// NaN passes as NaN and changes nothing else.
#[node]
#[derive(Debug, Clone)]
pub struct RateLimit<T> {
    /// Maximum change per second, in units of the value.
    #[param(range = 0.0..)]
    rate: f64,
    /// First output, in units of the value.
    #[param(default = 0.0)]
    initial: f64,
    /// Longest time between two values that counts. A value that comes later changes the output by no more than one
    /// that comes after this time.
    #[param(unit = "s", default = 0.1, range = 0.0..=3600.0)]
    max_pause: f64,
    last: Option<(Time, T)>,
}

#[node]
impl<T: Float> RateLimit<T> {
    fn process(&mut self, ctx: &Ctx, x: &T) -> T {
        if x.is_nan() {
            return *x;
        }
        let (then, y) = self.last.unwrap_or((ctx.now(), number(self.initial)));
        let step: T = number(self.rate * ctx.now().since(then).as_secs_f64().min(self.max_pause));
        // Not `clamp`, which panics if the step is NaN.
        let y = (*x - y).min(step).max(-step) + y;
        self.last = Some((ctx.now(), y));
        y
    }

    /// Restarts at `initial`.
    #[slot]
    fn reset(&mut self) {
        self.last = None;
    }
}

/// A parameter as a number of the type of the values.
pub(super) fn number<T: Float>(value: f64) -> T {
    T::from(value).unwrap_or_else(T::nan)
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
    fn low_pass_forgets_what_is_not_finite() {
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut node = LowPass::construct((0.5,));
            assert!(!node.process(&odd).is_finite());
            assert_eq!(node.process(&2.0), 2.0);
            assert!(!node.process(&odd).is_finite());
            assert_eq!(node.process(&4.0), 3.0);
        }
    }

    #[test]
    fn rate_limit_is_per_second() {
        let mut node = RateLimit::construct((2.0, 0.0, 1.0));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        assert_eq!(node.process(&at(0), &0.0), 0.0);
        assert_eq!(node.process(&at(500), &10.0), 1.0);
        assert_eq!(node.process(&at(1000), &-10.0), 0.0);
        assert_eq!(node.process(&at(2000), &1.5), 1.5);
    }

    #[test]
    fn filters_take_single_precision_too() {
        let mut low = LowPass::<f32>::construct((0.5,));
        assert_eq!([0.0, 4.0].map(|x| low.process(&x)), [0.0, 2.0_f32]);
        let mut rate = RateLimit::<f32>::construct((2.0, 0.0, 1.0));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        assert_eq!([(0, 1.0), (250, 1.0)].map(|(ms, x)| rate.process(&at(ms), &x)), [0.0, 0.5_f32]);
    }

    #[test]
    fn the_rate_is_limited_at_the_start_and_after_a_pause_too() {
        let mut node = RateLimit::construct((1.0, 0.0, 0.5));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        assert_eq!([0, 100].map(|ms| node.process(&at(ms), &1.0)), [0.0, 0.1]);
        assert_eq!(node.process(&at(10_000), &1.0), 0.6);
        node.reset();
        assert_eq!(node.process(&at(10_100), &1.0), 0.0);
        let mut node = RateLimit::construct((1.0, 3.0, 0.5));
        assert_eq!([0, 500].map(|ms| node.process(&at(ms), &1.0)), [3.0, 2.5]);
    }

    #[test]
    fn the_rate_is_limited_after_nan_and_towards_infinity() {
        let mut node = RateLimit::construct((1.0, 0.0, 0.5));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        assert!(node.process(&at(0), &f64::NAN).is_nan());
        assert_eq!(node.process(&at(100), &0.0), 0.0);
        for ms in 2..100 {
            assert!(node.process(&at(100 * ms), &f64::NAN).is_nan());
        }
        assert_eq!(node.process(&at(10_000), &9.0), 0.5);
        assert_eq!(node.process(&at(10_500), &f64::INFINITY), 1.0);
        assert_eq!(node.process(&at(11_000), &f64::NEG_INFINITY), 0.5);
    }
}

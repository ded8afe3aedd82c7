use apex_rt::node;
use num_traits::Float;

/// `true` if the value is at least `level`; `false` for NaN.
#[node]
pub fn above<T: Float>(x: &T, #[param] level: T) -> bool {
    *x >= level
}

/// `true` if the value is less than `level`; `false` for NaN.
#[node]
pub fn below<T: Float>(x: &T, #[param] level: T) -> bool {
    *x < level
}

/// `true` if the value is between the bounds, both included; `false` for NaN.
#[node]
pub fn within<T: Float>(x: &T, #[param] lower: T, #[param] upper: T) -> bool {
    *x >= lower && *x <= upper
}

/// Logical negation.
#[node]
pub fn not(a: &bool) -> bool {
    !*a
}

/// Threshold with hysteresis: `true` from `high` on, `false` again below `low`. Starts as `false`. NaN does not change
/// it.
#[node]
#[derive(Debug, Clone)]
pub struct Hysteresis<T> {
    /// Lower threshold, below which the result becomes `false`.
    #[param]
    low: T,
    /// Upper threshold, from which on the result becomes `true`.
    #[param]
    high: T,
    state: bool,
}

#[node]
impl<T: Float> Hysteresis<T> {
    fn process(&mut self, x: &T) -> bool {
        if *x >= self.high {
            self.state = true;
        } else if *x < self.low {
            self.state = false;
        }
        self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn thresholds_and_logic() {
        assert_eq!([0.4, 0.5, f64::NAN].map(|x| above(&x, 0.5)), [false, true, false]);
        assert_eq!([0.4, 0.5, f64::NAN].map(|x| below(&x, 0.5)), [true, false, false]);
        assert_eq!([0.0, 1.0, 1.1].map(|x| within(&x, 0.0, 1.0)), [true, true, false]);
        assert!(not(&false) && !not(&true));
    }

    #[test]
    fn hysteresis_keeps_its_state_in_between() {
        let mut node = Hysteresis::construct((1.0, 2.0));
        let states = [1.5, 2.0, 1.5, 0.9, 1.5].map(|x| node.process(&x));
        assert_eq!(states, [false, true, true, false, false]);
        assert_eq!([f64::NAN, 3.0, f64::NAN].map(|x| node.process(&x)), [false, true, true]);
    }
}

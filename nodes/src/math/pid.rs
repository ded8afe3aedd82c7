use super::filter::number;
use apex_rt::{Ctx, Time, node};
use num_traits::Float;

/// Control law of a PID controller: a proportional, an integral and a derivative part, and a limited output.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidLaw<T> {
    /// Proportional gain: output per error.
    pub proportional: T,
    /// Integral gain: output per error and second.
    pub integral: T,
    /// Derivative gain: output per change of the error per second.
    pub derivative: T,
    /// Limit of the output on both sides, at least 0.
    pub limit: T,
    sum: T,
    last: Option<T>,
}

impl<T: Float> PidLaw<T> {
    /// Creates a controller with these gains.
    pub fn new(proportional: T, integral: T, derivative: T, limit: T) -> Self {
        Self { proportional, integral, derivative, limit, sum: T::zero(), last: None }
    }

    /// Output for an error, `dt` s after the previous one. An error that is not finite gives 0 and does not change the
    /// state.
    pub fn step(&mut self, error: T, dt: T) -> T {
        let zero = T::zero();
        if !error.is_finite() {
            return zero;
        }
        let slope = match self.last.replace(error) {
            Some(last) if dt > zero => (error - last) / dt,
            _ => zero,
        };
        let output = self.proportional * error + self.integral * (self.sum + error * dt) + self.derivative * slope;
        let limited = output.max(-self.limit).min(self.limit);
        // Anti-windup: the part cut off by the limit is not summed up, as it would have to be undone later.
        if limited == output || (output > zero) != (error > zero) {
            self.sum = self.sum + error * dt;
        }
        limited
    }

    /// Resets the integral and the previous error.
    pub fn reset(&mut self) {
        self.sum = T::zero();
        self.last = None;
    }
}

/// PID controller: the output that makes an error smaller, from the error itself, its integral and its slope. The
/// integral is not summed up while the output is at its limit. It begins at 0 when the node becomes active.
///
/// An error that is not finite gives 0 and changes nothing else.
#[node]
#[derive(Debug, Clone)]
pub struct PID<T> {
    /// Output per error.
    #[param]
    proportional: f64,
    /// Output per error and second.
    #[param(default = 0.0)]
    integral: f64,
    /// Output per change of the error per second.
    #[param(default = 0.0)]
    derivative: f64,
    /// Limit of the output on both sides.
    #[param(range = 0.0..)]
    limit: f64,
    /// Longest time between two errors that counts in the integral.
    #[param(unit = "s", default = 0.1, range = 0.0..=3600.0)]
    max_pause: f64,
    law: Option<PidLaw<T>>,
    last: Option<Time>,
}

#[node]
impl<T: Float> PID<T> {
    fn process(&mut self, ctx: &Ctx, error: &T) -> T {
        let [proportional, integral, derivative, limit] =
            [self.proportional, self.integral, self.derivative, self.limit].map(number);
        let law = self.law.get_or_insert_with(|| PidLaw::new(proportional, integral, derivative, limit));
        // Parameters may have changed.
        *law = PidLaw { proportional, integral, derivative, limit, ..*law };
        let then = self.last.replace(ctx.now()).unwrap_or(ctx.now());
        law.step(*error, number(ctx.now().since(then).as_secs_f64().min(self.max_pause)))
    }

    /// Forgets the integral and the previous error.
    #[slot]
    fn reset(&mut self) {
        self.begin();
    }

    #[on_activate]
    fn begin(&mut self) {
        self.law = None;
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn the_node_knows_the_time_between_its_errors() {
        let at = |ms| Ctx::new(Time::from_millis(ms));
        let mut node = PID::<f32>::construct((1.0, 2.0, 0.0, 9.0, 1.0));
        assert_eq!([0, 500, 1000].map(|ms| node.process(&at(ms), &1.0)), [1.0, 2.0, 3.0]);
        // A pause counts as one second.
        assert_eq!(node.process(&at(60_000), &1.0), 5.0);
        node.reset();
        assert_eq!(node.process(&at(61_000), &1.0), 1.0);
        assert_eq!(node.process(&at(61_500), &100.0), 9.0);
        assert_eq!(node.process(&at(62_000), &f32::NAN), 0.0);
        let mut slope = PID::<f64>::construct((0.0, 0.0, 2.0, 9.0, 1.0));
        assert_eq!([(0, 1.0), (500, 2.0)].map(|(ms, error)| slope.process(&at(ms), &error)), [0.0, 4.0]);
    }

    #[test]
    fn each_part_does_its_own() {
        assert_eq!(PidLaw::new(2.0, 0.0, 0.0, 10.0).step(1.5, 0.1), 3.0);
        let mut integral = PidLaw::new(0.0, 2.0, 0.0, 10.0);
        assert_eq!([integral.step(1.0, 0.5), integral.step(1.0, 0.5)], [1.0, 2.0]);
        integral.reset();
        assert_eq!(integral.step(1.0, 0.5), 1.0);
        let mut derivative = PidLaw::new(0.0, 0.0, 2.0, 10.0);
        assert_eq!([derivative.step(1.0, 0.5), derivative.step(2.0, 0.5), derivative.step(5.0, 0.0)], [0.0, 4.0, 0.0]);
    }

    #[test]
    fn a_limited_output_does_not_wind_up() {
        let mut pid = PidLaw::new(1.0, 1.0, 0.0, 1.0);
        for _ in 0..1000 {
            assert_eq!(pid.step(5.0, 0.1), 1.0);
        }
        assert!(pid.step(-0.5, 0.1) < 0.0);
        assert_eq!(pid.step(f32::NAN, 0.1), 0.0);
        assert!(pid.step(-0.5, 0.1) < 0.0);
    }

    #[test]
    fn a_constant_load_is_overcome() {
        // A value that falls by 0.3 per second by itself has to reach 1.
        let (mut pid, mut value) = (PidLaw::new(2.0, 1.0, 0.0, 5.0), 0.0);
        for _ in 0..3000 {
            value += 0.01 * (pid.step(1.0 - value, 0.01) - 0.3);
        }
        assert!((value - 1.0_f32).abs() < 1e-3, "{value}");
    }
}

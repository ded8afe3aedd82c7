/// PID controller: a proportional, an integral and a derivative part, and a limited output.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pid {
    /// Proportional gain: output per error.
    pub proportional: f32,
    /// Integral gain: output per error and second.
    pub integral: f32,
    /// Derivative gain: output per change of the error per second.
    pub derivative: f32,
    /// Limit of the output on both sides, at least 0.
    pub limit: f32,
    sum: f32,
    last: Option<f32>,
}

impl Pid {
    /// Creates a controller with these gains.
    pub const fn new(proportional: f32, integral: f32, derivative: f32, limit: f32) -> Self {
        Self { proportional, integral, derivative, limit, sum: 0.0, last: None }
    }

    /// Output for an error, `dt` s after the previous one. An error that is not finite gives 0 and does not change the
    /// state.
    pub fn step(&mut self, error: f32, dt: f32) -> f32 {
        if !error.is_finite() {
            return 0.0;
        }
        let slope = match self.last.replace(error) {
            Some(last) if dt > 0.0 => (error - last) / dt,
            _ => 0.0,
        };
        let output = self.proportional * error + self.integral * (self.sum + error * dt) + self.derivative * slope;
        let limited = output.max(-self.limit).min(self.limit);
        // Anti-windup: the part cut off by the limit is not summed up, as it would have to be undone later.
        if limited == output || (output > 0.0) != (error > 0.0) {
            self.sum += error * dt;
        }
        limited
    }

    /// Resets the integral and the previous error.
    pub const fn reset(&mut self) {
        self.sum = 0.0;
        self.last = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_does_its_own() {
        assert_eq!(Pid::new(2.0, 0.0, 0.0, 10.0).step(1.5, 0.1), 3.0);
        let mut integral = Pid::new(0.0, 2.0, 0.0, 10.0);
        assert_eq!([integral.step(1.0, 0.5), integral.step(1.0, 0.5)], [1.0, 2.0]);
        integral.reset();
        assert_eq!(integral.step(1.0, 0.5), 1.0);
        let mut derivative = Pid::new(0.0, 0.0, 2.0, 10.0);
        assert_eq!([derivative.step(1.0, 0.5), derivative.step(2.0, 0.5), derivative.step(5.0, 0.0)], [0.0, 4.0, 0.0]);
    }

    #[test]
    fn a_limited_output_does_not_wind_up() {
        let mut pid = Pid::new(1.0, 1.0, 0.0, 1.0);
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
        let (mut pid, mut value) = (Pid::new(2.0, 1.0, 0.0, 5.0), 0.0);
        for _ in 0..3000 {
            value += 0.01 * (pid.step(1.0 - value, 0.01) - 0.3);
        }
        assert!((value - 1.0_f32).abs() < 1e-3, "{value}");
    }
}

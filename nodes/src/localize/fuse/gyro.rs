use super::past::seconds;
use apex_rt::Time;

/// Time for which a rate holds if no other one comes, in s.
const HOLDS: f64 = 0.2;

/// Turn that a gyroscope measured since it was last taken.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Gyro {
    /// Time and value of the last rate.
    last: Option<(Time, f64)>,
    /// Time up to which it is summed.
    until: Option<Time>,
    turned: Turned,
}

/// Sum of rates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Turned {
    /// Angle, in rad, with the bias.
    pub angle: f64,
    /// Time in which there was a rate, in s.
    pub covered: f64,
}

impl Gyro {
    /// Adds a rate, in rad/s. A time that is not after the last one is ignored.
    pub fn put(&mut self, now: Time, rate: f64) {
        if self.last.is_some_and(|(then, _)| now <= then) {
            return;
        }
        self.sum(now, Some(rate));
        self.last = Some((now, rate));
    }

    /// Turn up to `now`, after that of the last call.
    pub fn take(&mut self, now: Time) -> Turned {
        self.sum(now, None);
        core::mem::take(&mut self.turned)
    }

    /// Sums up to `now`: in the mean with the next rate, if there is one.
    fn sum(&mut self, now: Time, next: Option<f64>) {
        let (from, last) = (self.until, self.last);
        self.until = Some(from.map_or(now, |from| from.max(now)));
        let (Some(from), Some((then, rate))) = (from, last) else { return };
        let step = seconds(from, now);
        if step <= 0.0 || seconds(then, now) > HOLDS {
            return;
        }
        self.turned.angle += step * next.map_or(rate, |next| 0.5 * (rate + next));
        self.turned.covered += step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_summed_until_they_are_missing() {
        let (mut gyro, ms) = (Gyro::default(), Time::from_millis);
        gyro.put(ms(0), 1.0);
        gyro.put(ms(100), 2.0);
        assert_eq!(gyro.take(ms(150)), Turned { angle: 0.15 + 0.1, covered: 0.1 + 0.05 });
        gyro.put(ms(90), 7.0);
        assert_eq!(gyro.take(ms(150)), Turned::default(), "nothing new");
        assert_eq!(gyro.take(ms(10_000)).covered, 0.0, "it is silent");
        gyro.put(ms(20_000), 1.0);
        let turned = gyro.take(ms(20_100));
        assert!((turned.angle - 0.1).abs() < 1e-12 && (turned.covered - 0.1).abs() < 1e-12, "{turned:?}");
    }
}

use crate::scan::{Point2, Pose2};
use apex_rt::Time;
use heapless::Deque;

/// Number of poses that are kept, and time between them, in s: at least 2.5 s of them.
const KEPT: usize = 128;
const APART: f64 = 0.02;
/// Time by which a measurement may be ahead of the last pose, in s.
const AHEAD: f64 = 0.1;

/// Time between two times, in s, negative if the second one is the earlier one.
pub(super) fn seconds(from: Time, to: Time) -> f64 {
    1e-9 * to.as_nanos().saturating_sub(from.as_nanos()) as f64
}

/// Angle in [−π, π].
pub(super) fn wrapped(angle: f64) -> f64 {
    let (sin, cos) = libm::sincos(angle);
    libm::atan2(sin, cos)
}

/// Pose in the plane: x and y in m, and the heading in rad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Place {
    pub x: f64,
    pub y: f64,
    pub theta: f64,
}

impl Place {
    pub fn to_outer(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.theta);
        [self.x + x * cos - y * sin, self.y + x * sin + y * cos]
    }

    pub fn to_inner(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ((sin, cos), x, y) = (libm::sincos(self.theta), x - self.x, y - self.y);
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// Place on the way to `other`: this one at 0, the other one at 1.
    fn towards(self, other: Self, part: f64) -> Self {
        Self {
            x: self.x + part * (other.x - self.x),
            y: self.y + part * (other.y - self.y),
            theta: self.theta + part * wrapped(other.theta - self.theta),
        }
    }
}

impl From<Place> for Pose2 {
    fn from(place: Place) -> Self {
        Self::new(place.x as f32, place.y as f32, wrapped(place.theta) as f32)
    }
}

pub(super) fn vector(point: Point2) -> [f64; 2] {
    [f64::from(point.x), f64::from(point.y)]
}

/// Places of the last seconds.
#[derive(Debug, Clone, Default)]
pub(super) struct Past {
    places: Deque<(Time, Place), KEPT>,
}

impl Past {
    /// Adds a place, which has to be later than the others.
    pub fn put(&mut self, now: Time, place: Place) {
        // The newest one is replaced if it is not far enough from the one before.
        let mut last = self.places.iter().rev().map(|(time, _)| *time);
        if let (Some(newest), Some(before)) = (last.next(), last.next())
            && seconds(before, newest) < APART
        {
            self.places.pop_back();
        }
        if self.places.is_full() {
            self.places.pop_front();
        }
        let full = self.places.push_back((now, place));
        debug_assert!(full.is_ok(), "there is room after one was taken out");
    }

    /// Place at a time; `None` before all of them, and later than the last one.
    pub fn at(&self, time: Time) -> Option<Place> {
        let (last, newest) = self.places.back()?;
        if time >= *last {
            return (seconds(*last, time) <= AHEAD).then_some(*newest);
        }
        let (mut after, mut there) = (*last, *newest);
        for (before, here) in self.places.iter().rev().skip(1) {
            if *before <= time {
                let part = seconds(*before, time) / seconds(*before, after);
                return Some(here.towards(there, part));
            }
            (after, there) = (*before, *here);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_of_the_past_are_between_those_that_are_kept() {
        let mut past = Past::default();
        assert_eq!(past.at(Time::ZERO), None);
        for i in 0..1000 {
            past.put(Time::from_millis(10 * i), Place { x: 0.01 * i as f64, y: 0.0, theta: 0.001 * i as f64 });
        }
        let at = |ms| past.at(Time::from_millis(ms));
        for ms in [9990, 9985, 8003, 7600] {
            let place = at(ms).expect("it is kept");
            assert!((place.x - 1e-3 * ms as f64).abs() < 1e-9 && (place.theta - 1e-4 * ms as f64).abs() < 1e-9, "{ms}");
        }
        assert_eq!((at(5000), at(10_200)), (None, None));
        assert_eq!(at(10_050), at(9990), "shortly after the last one");
    }
}

use super::{Detections, Hypotheses, Model, Persons, Sensor};
use apex_rt::{Ctx, Out, Time, node};
use core::fmt;
use heapless::Vec;

/// Maximum number of measurements that wait for older ones.
const MAX_WAITING: usize = 8;

/// Error of detections whose stamp cannot be used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum UntimelyDetections {
    /// The detections are older than others that were used already, by this time in s.
    Late(f32),
    /// The detections are from the future, by this time in s.
    Early(f32),
}

impl fmt::Display for UntimelyDetections {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Late(by) => {
                write!(f, "the detections are {by:.3} s older than the last used ones: a longer `delay` waits for them")
            }
            Self::Early(by) => write!(f, "the detections are {by:.3} s ahead of the clock: their stamp is wrong"),
        }
    }
}

impl core::error::Error for UntimelyDetections {}

/// Detections that wait, and the sensor they are from.
#[derive(Debug, Clone)]
struct Waiting {
    from_legs: bool,
    detections: Detections,
}

/// Tracks persons by many hypotheses (thesis 6.8.2; Arras et al. 2008): a buffer with asynchronous inputs.
///
/// Detections of cameras are trusted more than those of legs in laser scans. Both are in the same fixed frame, and are
/// used in the order of their stamps when the node fires. Its output are the persons at the time of the firing; a
/// person appears with the second or third detection. Persons that are not detected are predicted, until they are
/// probably gone. The limits are [`MAX_PERSONS`](super::MAX_PERSONS), [`MAX_HYPOTHESES`](super::MAX_HYPOTHESES) and
/// [`MAX_DETECTIONS`](super::MAX_DETECTIONS).
///
/// Detections that are older than used ones, or from the future by more than `delay` and 1 s, are an error and change
/// nothing.
#[node]
#[computed]
#[derive(Debug, Clone)]
pub struct PersonTracker {
    /// Standard deviation of the positions that cameras detect, along each axis.
    #[param(unit = "m", default = 0.1, range = 0.001..=2.0)]
    camera_deviation: f32,
    /// Probability that a camera detects a person in view.
    #[param(default = 0.78, range = 0.01..=0.99)]
    camera_rate: f32,
    /// False detections of cameras per square metre and measurement.
    #[param(default = 0.005, range = 0.000001..=10.0)]
    camera_clutter: f32,
    /// Standard deviation of the positions of persons detected by their legs, along each axis.
    #[param(unit = "m", default = 0.25, range = 0.001..=2.0)]
    legs_deviation: f32,
    /// Probability that the legs of a person in view are detected.
    #[param(default = 0.6, range = 0.01..=0.99)]
    legs_rate: f32,
    /// False detections of legs per square metre and measurement.
    #[param(default = 0.02, range = 0.000001..=10.0)]
    legs_clutter: f32,
    /// Noise of accelerations: the standard deviation of the change of velocity within 1 s.
    #[param(unit = "m/s", default = 0.2, range = 0.01..=20.0)]
    acceleration: f32,
    /// Standard deviation of the velocity of persons, along each axis.
    #[param(unit = "m/s", default = 1.2, range = 0.0..=20.0)]
    speed: f32,
    /// New persons per square metre and measurement.
    #[param(default = 0.003, range = 0.000001..=10.0)]
    births: f32,
    /// Mean time until a person leaves.
    #[param(unit = "s", default = 10.0, range = 0.1..=100000.0)]
    stay: f32,
    /// Time after the last detection at which a person is forgotten.
    #[param(unit = "s", default = 3.0, range = 0.0..=600.0)]
    forget: f32,
    /// Maximum Mahalanobis distance of a detection from its person.
    #[param(default = 4.0, range = 0.1..=20.0)]
    gate: f32,
    /// Maximum difference of the logarithmic score from the best hypothesis about a person.
    #[param(default = 8.0, range = 0.0..=1000.0)]
    margin: f32,
    /// Number of hypotheses about one person.
    #[param(default = 8, range = 1..=16)]
    branches: usize,
    /// Number of measurements after which an assignment is final.
    #[param(default = 1, range = 1..=8)]
    depth: usize,
    /// Logarithmic score from which a person is reported.
    #[param(default = 2.0, range = -10.0..=100.0)]
    confirm: f32,
    /// Probability of being there down to which a person is reported.
    #[param(default = 0.5, range = 0.0..=1.0)]
    presence: f32,
    /// Time for which detections wait for older ones of another sensor.
    #[param(unit = "s", default = 0.0, range = 0.0..=10.0)]
    delay: f32,
    waiting: Vec<Waiting, MAX_WAITING>,
    hypotheses: Hypotheses,
    /// `true` after the first measurement.
    begun: bool,
}

#[node]
impl PersonTracker {
    fn process(&mut self, ctx: &Ctx, persons: &mut Out<Persons>) {
        while self.waiting.first().is_some_and(|w| age(ctx.now(), w.detections.stamp) >= self.delay) {
            self.use_oldest();
        }
        self.hypotheses.persons(ctx.now(), &self.model(), self.confirm, self.presence, persons.get_mut());
    }

    /// Takes persons detected by a camera.
    #[slot]
    fn camera(&mut self, detections: &Detections, ctx: &Ctx) -> Result<(), UntimelyDetections> {
        self.take(ctx.now(), detections, false)
    }

    /// Takes persons detected by their legs in a laser scan.
    #[slot]
    fn legs(&mut self, detections: &Detections, ctx: &Ctx) -> Result<(), UntimelyDetections> {
        self.take(ctx.now(), detections, true)
    }

    /// Forgets all persons, for example after a jump of the fixed frame.
    #[slot]
    fn reset(&mut self) {
        self.waiting.clear();
        self.hypotheses.clear();
    }

    fn take(&mut self, now: Time, detections: &Detections, from_legs: bool) -> Result<(), UntimelyDetections> {
        let stamp = detections.stamp;
        let early = stamp.since(now).as_secs_f32();
        if early > self.delay + 1.0 {
            return Err(UntimelyDetections::Early(early));
        }
        if self.waiting.is_full() {
            self.use_oldest();
        }
        if self.begun && stamp < self.hypotheses.stamp() {
            return Err(UntimelyDetections::Late(self.hypotheses.stamp().since(stamp).as_secs_f32()));
        }
        let at = self.waiting.partition_point(|other| other.detections.stamp <= stamp);
        // Cannot fail: one place is free.
        let _ = self.waiting.insert(at, Waiting { from_legs, detections: detections.clone() });
        Ok(())
    }

    fn use_oldest(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        let Waiting { from_legs, detections } = self.waiting.remove(0);
        // The two update functions of the thesis: the same filter with the errors of either sensor.
        let sensor = if from_legs { self.legs_sensor() } else { self.camera_sensor() };
        let model = self.model();
        self.hypotheses.update(&detections, &sensor, &model);
        self.begun = true;
    }

    const fn camera_sensor(&self) -> Sensor {
        Sensor { deviation: self.camera_deviation, rate: self.camera_rate, clutter: self.camera_clutter }
    }

    const fn legs_sensor(&self) -> Sensor {
        Sensor { deviation: self.legs_deviation, rate: self.legs_rate, clutter: self.legs_clutter }
    }

    const fn model(&self) -> Model {
        Model {
            acceleration: self.acceleration,
            speed: self.speed,
            births: self.births,
            stay: self.stay,
            forget: self.forget,
            gate: self.gate,
            margin: self.margin,
            branches: self.branches,
            depth: self.depth,
        }
    }
}

/// Age of a measurement in s; negative for one in the future.
fn age(now: Time, stamp: Time) -> f32 {
    now.since(stamp).as_secs_f32() - stamp.since(now).as_secs_f32()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{persons::View, scan::Point2};

    fn tracker(delay: f32) -> PersonTracker {
        PersonTracker {
            camera_deviation: 0.1,
            camera_rate: 0.78,
            camera_clutter: 0.005,
            legs_deviation: 0.25,
            legs_rate: 0.6,
            legs_clutter: 0.02,
            acceleration: 0.5,
            speed: 1.0,
            births: 0.001,
            stay: 10.0,
            forget: 3.0,
            gate: 3.5,
            margin: 8.0,
            branches: 8,
            depth: 5,
            confirm: 4.0,
            presence: 0.4,
            delay,
            waiting: Vec::new(),
            hypotheses: Hypotheses::default(),
            begun: false,
        }
    }

    fn at(ms: i64, x: f32) -> Detections {
        let positions = [Point2::new(x, 0.0)].into_iter().collect();
        Detections { stamp: Time::from_millis(ms), view: View::default(), positions }
    }

    fn ctx(ms: i64) -> Ctx {
        Ctx::new(Time::from_millis(ms))
    }

    fn persons(node: &mut PersonTracker, ms: i64) -> Persons {
        let mut out = Out::new();
        node.process(&ctx(ms), &mut out);
        out.get().cloned().expect("always a list")
    }

    #[test]
    fn both_sensors_update_one_person() {
        let mut node = tracker(0.0);
        for i in 0..10 {
            node.camera(&at(200 * i, 0.2 * i as f32), &ctx(200 * i)).expect("in time");
            node.legs(&at(200 * i + 100, 0.2 * i as f32 + 0.1), &ctx(200 * i + 100)).expect("in time");
            persons(&mut node, 200 * i + 100);
        }
        let seen = persons(&mut node, 2000);
        assert_eq!(seen.len(), 1, "{seen:?}");
        assert!((seen[0].position.x - 2.0).abs() < 0.1 && (seen[0].velocity.x - 1.0).abs() < 0.2, "{seen:?}");
        assert!(persons(&mut node, 6000).is_empty());
        node.reset();
        assert!(persons(&mut node, 2000).is_empty());
    }

    #[test]
    fn legs_move_a_person_less() {
        let moved = |from_legs: bool| {
            let mut node = tracker(0.0);
            for i in 0..10 {
                node.camera(&at(100 * i, 0.0), &ctx(100 * i)).expect("in time");
            }
            let last = at(1000, 0.3);
            let taken = if from_legs { node.legs(&last, &ctx(1000)) } else { node.camera(&last, &ctx(1000)) };
            taken.expect("in time");
            persons(&mut node, 1000)[0].position.x
        };
        assert!(moved(true) > 0.0 && moved(true) < 0.7 * moved(false), "{} {}", moved(true), moved(false));
    }

    #[test]
    fn late_ones_wait_or_are_an_error() {
        let mut node = tracker(0.3);
        node.camera(&at(400, 0.4), &ctx(400)).expect("in time");
        persons(&mut node, 450);
        assert_eq!(node.legs(&at(300, 0.3), &ctx(450)), Ok(()));
        persons(&mut node, 800);
        assert_eq!(node.legs(&at(200, 0.2), &ctx(800)), Err(UntimelyDetections::Late(0.2)));
        assert!(matches!(node.legs(&at(9000, 0.2), &ctx(800)), Err(UntimelyDetections::Early(_))));
        for i in 0..20 {
            node.camera(&at(800 + i, 0.2), &ctx(800)).expect("the oldest makes room");
        }
        let text = std::format!("{}", UntimelyDetections::Late(0.2));
        assert!(text.contains("0.200 s older"), "{text}");
    }
}

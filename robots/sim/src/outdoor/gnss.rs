use super::{Surface, Terrain, ThingShape};
use crate::Random;
use apex_nodes::{
    localize::{GeoFix, TangentPlane},
    scan::Point2,
};
use apex_rt::Time;
use libm::{expf, sqrtf};
use std::time::Duration;

/// Reach of the crown of a tree that disturbs a receiver, in m, and its least height.
const SHADE: f32 = 3.0;
const CROWN: f32 = 2.0;
/// Probability that a disturbance begins with a fix near a tree, and that it is an outage.
const DISTURBED: f32 = 0.03;
const SILENT: f32 = 0.4;
/// Shortest and longest disturbance, in s.
const LASTS: [f32; 2] = [0.5, 4.0];

/// Errors of a receiver of satellite navigation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GnssErrors {
    /// Standard deviation along each axis from one fix to the next, in m.
    pub noise: f32,
    /// Standard deviation of the slow error of satellites and atmosphere (first-order Gauss–Markov process), in m.
    pub wander: f32,
    /// Its correlation time, in s.
    pub wander_time: f32,
    /// Standard deviation of a position by reflected signals, in m.
    pub multipath: f32,
    /// Time between fixes.
    pub period: Duration,
    /// Time until a fix arrives.
    pub latency: Duration,
}

impl GnssErrors {
    /// Receiver with one frequency and SBAS: half of its positions are within 2 m (NEO-M8N, data sheet).
    pub const NEO_M8: Self = Self {
        noise: 0.5,
        wander: 1.6,
        wander_time: 200.0,
        multipath: 8.0,
        period: Duration::from_millis(200),
        latency: Duration::from_millis(120),
    };
}

/// Cause of a disturbance.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Disturbance {
    Outage,
    /// Signals are reflected: the position is off by this.
    Multipath(Point2),
}

/// Receiver of satellite navigation on a base. Crowns of trees nearby take the signals away for moments, or reflect
/// them, so that the position jumps by metres.
#[derive(Debug, Clone)]
pub struct Gnss {
    errors: GnssErrors,
    /// Plane of the world, whose x axis points to the east.
    plane: TangentPlane,
    slow: Point2,
    disturbed: Option<(Time, Disturbance)>,
    due: Time,
    random: Random,
}

impl Gnss {
    /// Creates a receiver in a world with this plane.
    pub fn new(errors: GnssErrors, plane: TangentPlane, mut random: Random) -> Self {
        let slow = error(&mut random, errors.wander);
        Self { errors, plane, slow, disturbed: None, due: Time::ZERO, random }
    }

    /// Measures the position of the antenna, once in a period: `None` between.
    pub fn measure(&mut self, terrain: &Terrain, antenna: Point2, now: Time) -> Option<GeoFix> {
        if now < self.due {
            return None;
        }
        self.due = now + self.errors.period;
        self.wander();
        let measured = antenna + self.slow + error(&mut self.random, self.errors.noise);
        match self.disturbance(terrain, antenna, now) {
            None => Some(self.fix(measured, now)),
            Some(Disturbance::Multipath(offset)) => Some(self.fix(measured + offset, now)),
            Some(Disturbance::Outage) => Some(GeoFix { stamp: now, ..GeoFix::default() }),
        }
    }

    fn fix(&self, measured: Point2, stamp: Time) -> GeoFix {
        let GnssErrors { noise, wander, .. } = self.errors;
        let [latitude, longitude] =
            self.plane.geodetic([f64::from(measured.x), f64::from(measured.y)]).map(f64::to_degrees);
        let variance = f64::from(noise * noise + wander * wander);
        GeoFix { stamp, has_position: true, latitude, longitude, altitude: 0.0, variance }
    }

    fn wander(&mut self) {
        let GnssErrors { wander, wander_time, period, .. } = self.errors;
        let remembered = expf(-period.as_secs_f32() / wander_time.max(1e-3));
        let change = wander * sqrtf(1.0 - remembered * remembered);
        self.slow = self.slow.scaled(remembered) + error(&mut self.random, change);
    }

    fn disturbance(&mut self, terrain: &Terrain, antenna: Point2, now: Time) -> Option<Disturbance> {
        if let Some((until, disturbance)) = self.disturbed {
            if now < until {
                return Some(disturbance);
            }
            self.disturbed = None;
        }
        if !is_shaded(terrain, antenna) || !self.random.chance(DISTURBED) {
            return None;
        }
        let lasts = Duration::from_secs_f32(self.random.uniform(LASTS[0], LASTS[1]));
        let disturbance = if self.random.chance(SILENT) {
            Disturbance::Outage
        } else {
            Disturbance::Multipath(error(&mut self.random, self.errors.multipath))
        };
        self.disturbed = Some((now + lasts, disturbance));
        Some(disturbance)
    }
}

/// Random error with a standard deviation along each axis, in m.
fn error(random: &mut Random, deviation: f32) -> Point2 {
    Point2::new(random.normal(deviation), random.normal(deviation))
}

/// Returns `true` near the crown of a tree.
fn is_shaded(terrain: &Terrain, place: Point2) -> bool {
    terrain.near(place, 2.0 * SHADE).any(|thing| {
        let is_crown = thing.surface == Surface::Leaves
            && matches!(thing.shape, ThingShape::Ball { middle, .. } if middle > CROWN);
        is_crown && (thing.at - place).norm() < SHADE + thing.radius()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of 2000 fixes at the origin, in m; `None` for a fix without a position.
    fn fixes(terrain: &Terrain, seed: u64) -> Vec<Option<Point2>> {
        let plane = TangentPlane::new(0.85, 0.16);
        let mut gnss = Gnss::new(GnssErrors::NEO_M8, plane, Random::new(seed));
        (0..2000)
            .map(|i| {
                let now = Time::from_millis(200 * i);
                let fix = gnss.measure(terrain, Point2::default(), now).expect("it is due");
                assert_eq!(gnss.measure(terrain, Point2::default(), now), None, "once in a period");
                let [x, y] = plane.position(fix.latitude.to_radians(), fix.longitude.to_radians());
                fix.has_position.then_some(Point2::new(x as f32, y as f32))
            })
            .collect()
    }

    #[test]
    fn half_of_the_positions_are_within_two_metres() {
        let terrain = Terrain::flat(20.0);
        let all: Vec<f32> = (0..100).flat_map(|seed| fixes(&terrain, seed)).flatten().map(Point2::norm).collect();
        let within = all.iter().filter(|error| **error < 2.0).count() as f32 / all.len() as f32;
        assert!(all.len() == 200_000 && (0.45..0.55).contains(&within), "{within}");
    }

    #[test]
    fn trees_disturb_it() {
        let mut terrain = Terrain::flat(20.0);
        terrain.add(Point2::new(2.0, 0.0), ThingShape::Ball { radius: 1.5, middle: 5.0 }, Surface::Leaves);
        let fixes = fixes(&terrain, 5);
        let jumps = fixes.windows(2).filter(|pair| match pair {
            [Some(a), Some(b)] => (*a - *b).norm() > 5.0,
            _ => false,
        });
        let (missing, jumps) = (fixes.iter().filter(|fix| fix.is_none()).count(), jumps.count());
        assert!(missing > 50 && jumps > 10, "{missing} {jumps}");
    }
}

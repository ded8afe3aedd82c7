use super::Person;
use crate::scan::Point2;
use apex_rt::Time;
use libm::{fmaxf, sqrtf};

/// Most evidence of a camera for a person.
pub(super) const SURE: f32 = 6.0;
/// Speed from which on something moves, in m/s.
const MOVES: f32 = 0.6;
/// Standard deviation of the velocity of something that is new, along each axis, in m/s.
const SPEED: f32 = 1.5;
/// Highest speed of a person who was lost, in m/s.
const RUNS: f32 = 3.0;
/// Age up to which a track may be a target that has appeared again, in s.
pub(super) const NEW: f32 = 2.5;

/// Something that is tracked by a Kalman filter of constant velocity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub id: u32,
    pub position: Point2,
    pub velocity: Point2,
    /// Covariance of position and velocity, the same along both axes: position, both, velocity.
    pub spread: [f32; 3],
    pub born: Time,
    /// Time of the last detection.
    pub seen: Time,
    pub hits: u32,
    /// Evidence of the camera for a person.
    pub evidence: f32,
    /// `true` if a detection of the present measurement belongs to it.
    pub is_taken: bool,
}

impl Track {
    /// New track, whose position has this variance.
    pub const fn new(id: u32, position: Point2, variance: f32, now: Time) -> Self {
        Self {
            id,
            position,
            velocity: Point2::new(0.0, 0.0),
            spread: [variance, 0.0, SPEED * SPEED],
            born: now,
            seen: now,
            hits: 1,
            evidence: 0.0,
            is_taken: true,
        }
    }

    /// Returns `true` if it was seen often enough to know that it moves.
    pub fn moves(&self) -> bool {
        self.hits >= 4 && self.velocity.norm() > MOVES
    }

    /// Returns `true` for a person, as far as it is known: what the camera has taken for one, or what moves.
    pub fn is_someone(&self) -> bool {
        self.evidence >= 1.0 || self.moves()
    }

    /// Stops it at a place, where it is not seen.
    pub fn stop_at(&mut self, place: Point2) {
        (self.position, self.velocity) = (place, Point2::default());
    }

    pub fn predict(&mut self, dt: f32, noise: f32) {
        self.position = self.position + self.velocity.scaled(dt);
        let [p, c, v] = self.spread;
        let square = dt * dt;
        self.spread = [
            p + 2.0 * dt * c + square * (v + 0.25 * square * noise),
            c + dt * (v + 0.5 * square * noise),
            v + square * noise,
        ];
    }

    /// Corrects the state by two parts of a difference, at right angles, with their variances.
    pub fn correct(&mut self, parts: [Point2; 2], variances: [f32; 2]) {
        let [p, c, v] = self.spread;
        for (part, variance) in parts.into_iter().zip(variances) {
            let whole = p + variance;
            self.position = self.position + part.scaled(p / whole);
            self.velocity = self.velocity + part.scaled(c / whole);
        }
        // The covariance is that of the worse direction.
        let whole = p + fmaxf(variances[0], variances[1]);
        self.spread = [p - p * p / whole, c - p * c / whole, v - c * c / whole];
    }

    /// Returns `true` if someone can be this lost person: not one who was seen beside the person, nor one who is too
    /// far away.
    pub fn may_be(&self, other: &Self, now: Time) -> bool {
        let since = |time: Time| now.since(time).as_secs_f32();
        let reach = 1.0 + RUNS * since(self.seen);
        since(other.born) < since(self.seen) + NEW && (other.position - self.position).norm() <= reach
    }

    pub fn person(&self) -> Person {
        Person {
            id: self.id,
            position: self.position,
            velocity: self.velocity,
            deviation: sqrtf(self.spread[0]),
            presence: (self.evidence / SURE).clamp(0.0, 1.0),
        }
    }
}

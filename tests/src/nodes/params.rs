use apex_rt::prelude::*;
use std::time::Duration;

/// Records the gain in each firing.
#[node]
pub struct Gain {
    /// A gain.
    #[param(default = 1, range = 0..=10)]
    gain: i64,
    /// Gains of the firings.
    pub seen: Vec<i64>,
}

#[node]
impl Gain {
    fn process(&mut self) {
        self.seen.push(self.gain);
    }
}

/// `x` times `gain`, which is at most 10.
#[node]
pub fn scaled(x: &i64, #[param(default = 1, range = 0..=10)] gain: i64) -> i64 {
    x * gain
}

/// `x` plus `by`.
#[node]
pub fn offset(x: &i64, #[param(default = 0)] by: i64) -> i64 {
    x + by
}

/// Limits values to `limit`, in m.
#[node]
pub fn limited(x: &f64, #[param(unit = "m", default = 1.0, range = 0.0..=2.0)] limit: f64) -> f64 {
    x.min(limit)
}

/// A node that has only parameters.
#[node]
pub struct Settings {
    /// A length.
    #[param(unit = "m", default = 0.5, range = 0.0..=100.0)]
    pub length: f64,
    /// An angle.
    #[param(unit = "rad", default = 0.0)]
    pub angle: f32,
    /// A speed.
    #[param(unit = "m/s", default = 1.0)]
    pub speed: f64,
    /// A time.
    #[param(default = 1.5)]
    pub pause: Duration,
    /// A text.
    #[param(default = "none")]
    pub name: &'static str,
    /// A switch.
    #[param(default = false)]
    pub on: bool,
    /// A number.
    #[param(default = 3)]
    pub count: i64,
}

#[node]
impl Settings {
    fn process(&mut self) {}
}

/// Sends the numbers of a matrix row by row.
#[node]
pub struct Matrix {
    /// The rows.
    #[param]
    rows: [[i64; 3]; 2],
    at: usize,
}

#[node]
impl Matrix {
    fn process(&mut self) -> Option<i64> {
        self.at += 1;
        self.rows.iter().flatten().nth(self.at - 1).copied()
    }
}

//! Arithmetic, comparison, angles, filters of one signal, and pseudo-random numbers.
//!
//! Floating point throughout, `f32` or `f64` as the connections decide: no value of an input can make a node panic,
//! and NaN goes through as IEEE 754 has it.

mod angle;
mod arithmetic;
mod compare;
mod filter;
mod random;

pub use angle::{angle_difference, atan2, cos, degrees, hypot, normalize_angle, radians, sin};
pub use arithmetic::{abs, add, clamp, div, lerp, max, min, mul, neg, scale, sqrt, sub};
pub use compare::{Hysteresis, above, and, below, not, or, within};
pub use filter::{LowPass, MAX_WINDOW, MovingAverage, RateLimit};
pub use random::Random;

//! Arithmetic, comparison, conversion, angles, filters and controllers of one signal, and pseudo-random numbers.
//!
//! Most numbers are floating-point: `f32` or `f64`, as determined by the connections. No input value makes a node
//! panic; NaN propagates according to IEEE 754. A filter is well again after it: the test `filters` tries all of them.

mod angle;
mod arithmetic;
mod compare;
mod convert;
mod filter;
mod pid;
#[cfg(feature = "std")]
pub(crate) mod sets;
mod several;

pub use angle::{angle_difference, atan2, cos, degrees, hypot, normalize_angle, radians, sin};
pub use apex_optim::Random;
pub use arithmetic::{abs, add, clamp, div, lerp, mul, neg, scale, sqrt, sub};
pub use compare::{Hysteresis, above, below, not, within};
pub use convert::{to_f32, to_f64, to_i32, to_i64, to_u32, to_u64};
pub use filter::{LowPass, MAX_WINDOW, MovingAverage, RateLimit};
pub use pid::{PID, PidLaw};
pub use several::{all, any, max, mean, median, min, sum, vote};

use apex_rt::prelude::*;

/// The mean of two values that came one after the other.
#[node]
pub fn mean_of_two(x: &[f64; 2]) -> f64 {
    (x[0] + x[1]) / 2.0
}

/// A value and its double, one after the other.
#[node]
pub fn and_double(x: &f64) -> [f64; 2] {
    [*x, 2.0 * x]
}

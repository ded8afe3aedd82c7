use apex_rt::node;
use num_traits::{Float, FloatConst};

/// Sine of an angle in rad.
#[node]
pub fn sin<T: Float>(#[unit("rad")] angle: &T) -> T {
    angle.sin()
}

/// Cosine of an angle in rad.
#[node]
pub fn cos<T: Float>(#[unit("rad")] angle: &T) -> T {
    angle.cos()
}

/// Direction of the vector (`x`, `y`) in (−π, π] rad.
#[node]
#[unit("rad")]
pub fn atan2<T: Float>(y: &T, x: &T) -> T {
    y.atan2(*x)
}

/// Length of the vector (`x`, `y`).
#[node]
pub fn hypot<T: Float>(x: &T, y: &T) -> T {
    x.hypot(*y)
}

/// Angle normalized to [−π, π) rad.
#[node]
#[unit("rad")]
pub fn normalize_angle<T: Float + FloatConst>(#[unit("rad")] angle: &T) -> T {
    let turn = T::TAU();
    // The remainder keeps the sign of the angle; the second step makes negative ones positive.
    let positive = ((*angle + T::PI()) % turn + turn) % turn;
    positive - T::PI()
}

/// Smallest rotation from `from` to `to`, in [−π, π) rad.
#[node]
#[unit("rad")]
pub fn angle_difference<T: Float + FloatConst>(#[unit("rad")] from: &T, #[unit("rad")] to: &T) -> T {
    normalize_angle(&(*to - *from))
}

/// Angle in degrees, from rad.
#[node]
#[unit("deg")]
pub fn degrees<T: Float>(#[unit("rad")] angle: &T) -> T {
    angle.to_degrees()
}

/// Angle in rad, from degrees.
#[node]
#[unit("rad")]
pub fn radians<T: Float>(#[unit("deg")] angle: &T) -> T {
    angle.to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, PI};

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn trigonometry() {
        assert!(close(sin(&FRAC_PI_2), 1.0) && close(cos(&PI), -1.0));
        assert!(close(atan2(&1.0, &0.0), FRAC_PI_2) && close(hypot(&3.0, &4.0), 5.0));
        assert!(close(degrees(&PI), 180.0) && close(radians(&90.0), FRAC_PI_2));
    }

    #[test]
    fn angles_come_back_into_one_turn() {
        for turns in -3..=3 {
            let angle = 0.3 + f64::from(turns) * 2.0 * PI;
            assert!(close(normalize_angle(&angle), 0.3), "{angle}");
        }
        assert!(close(normalize_angle(&PI), -PI));
        assert!(normalize_angle(&f64::INFINITY).is_nan());
    }

    #[test]
    fn difference_takes_the_short_way() {
        assert!(close(angle_difference(&3.0, &-3.0), 2.0 * PI - 6.0));
        assert!(close(angle_difference(&-3.0, &3.0), 6.0 - 2.0 * PI));
    }
}

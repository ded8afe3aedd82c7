use apex_rt::node;
use num_traits::Float;

/// Sum: `a + b`.
#[node]
pub fn add<T: Float>(a: &T, b: &T) -> T {
    *a + *b
}

/// Difference: `a − b`.
#[node]
pub fn sub<T: Float>(a: &T, b: &T) -> T {
    *a - *b
}

/// Product: `a · b`.
#[node]
pub fn mul<T: Float>(a: &T, b: &T) -> T {
    *a * *b
}

/// Quotient: `a / b`. A division by zero gives ±∞ or NaN.
#[node]
pub fn div<T: Float>(a: &T, b: &T) -> T {
    *a / *b
}

/// Negated value: `−x`.
#[node]
pub fn neg<T: Float>(x: &T) -> T {
    -*x
}

/// Absolute value.
#[node]
pub fn abs<T: Float>(x: &T) -> T {
    x.abs()
}

/// Square root; NaN for negative values.
#[node]
pub fn sqrt<T: Float>(x: &T) -> T {
    x.sqrt()
}

/// Value limited to the range from `lower` to `upper`. If `lower` exceeds `upper`, the result is at most `upper`.
#[node]
pub fn clamp<T: Float>(x: &T, #[param] lower: T, #[param] upper: T) -> T {
    if *x > upper {
        upper
    } else if *x < lower {
        lower.min(upper)
    } else {
        *x
    }
}

/// Linear function: `factor · x + offset`.
#[node]
pub fn scale<T: Float>(x: &T, #[param] factor: T, #[param(default = T::zero())] offset: T) -> T {
    *x * factor + offset
}

/// Linear interpolation: `a` at `t = 0`, `b` at `t = 1`. Extrapolates outside this range.
#[node]
pub fn lerp<T: Float>(a: &T, b: &T, t: &T) -> T {
    *a + (*b - *a) * *t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn basic_operations() {
        assert_eq!((add(&1.0, &2.0), sub(&1.0, &2.0), mul(&3.0, &2.0), div(&3.0, &2.0)), (3.0, -1.0, 6.0, 1.5));
        assert_eq!((neg(&1.0), abs(&-2.0), sqrt(&9.0)), (-1.0, 2.0, 3.0));
        assert_eq!(add(&1.0_f32, &2.0_f32), 3.0_f32);
    }

    #[test]
    fn division_by_zero_is_infinite() {
        assert_eq!(div(&1.0, &0.0), f64::INFINITY);
        assert!(div(&0.0_f64, &0.0).is_nan());
    }

    #[test]
    fn clamp_accepts_any_bounds() {
        assert_eq!([-1.0, 0.5, 2.0].map(|x| clamp(&x, 0.0, 1.0)), [0.0, 0.5, 1.0]);
        assert_eq!([-1.0, 0.5, 2.0].map(|x| clamp(&x, 1.0, 0.0)), [0.0, 0.0, 0.0]);
        assert!(clamp(&f64::NAN, 0.0, 1.0).is_nan());
    }

    #[test]
    fn scale_and_lerp() {
        assert_eq!(scale(&2.0, 3.0, 1.0), 7.0);
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(|t| lerp(&1.0, &3.0, &t)), [1.0, 2.0, 3.0, 5.0]);
    }
}

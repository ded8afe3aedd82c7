//! Conversions of numbers.

use apex_rt::node;
use num_traits::{NumCast, ToPrimitive};

/// Converts a number to single precision. A number that is too large becomes infinite.
#[node]
pub fn to_f32<T: ToPrimitive>(x: &T) -> f32 {
    x.to_f32().unwrap_or(f32::NAN)
}

/// Converts a number to double precision.
#[node]
pub fn to_f64<T: ToPrimitive>(x: &T) -> f64 {
    x.to_f64().unwrap_or(f64::NAN)
}

/// Converts a number to the nearest whole one, away from zero if there are two. ⊥ if it is NaN or out of range.
#[node]
pub fn to_i32<T: ToPrimitive>(x: &T) -> Option<i32> {
    nearest(x)
}

/// Converts a number to the nearest whole one, away from zero if there are two. ⊥ if it is NaN or out of range.
#[node]
pub fn to_i64<T: ToPrimitive>(x: &T) -> Option<i64> {
    nearest(x)
}

/// Converts a number to the nearest whole one, away from zero if there are two. ⊥ if it is NaN or out of range.
#[node]
pub fn to_u32<T: ToPrimitive>(x: &T) -> Option<u32> {
    nearest(x)
}

/// Converts a number to the nearest whole one, away from zero if there are two. ⊥ if it is NaN or out of range.
#[node]
pub fn to_u64<T: ToPrimitive>(x: &T) -> Option<u64> {
    nearest(x)
}

/// The nearest whole number. What is whole already is not rounded as a float, which would lose its last digits.
fn nearest<T: ToPrimitive, N: NumCast + ToPrimitive>(x: &T) -> Option<N> {
    let float = x.to_f64()?;
    match x.to_i128() {
        Some(whole) if whole as f64 == float => N::from(whole),
        _ => N::from(libm::round(float)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_become_the_nearest_whole_number() {
        assert_eq!(
            [0.4, 0.5, -0.5, 2.6, -0.4].map(|x: f64| to_i32(&x)),
            [Some(0), Some(1), Some(-1), Some(3), Some(0)]
        );
        assert_eq!(
            [-0.4, -0.6, 4_294_967_295.4, 4_294_967_295.5].map(|x: f64| to_u32(&x)),
            [Some(0), None, Some(u32::MAX), None]
        );
        assert_eq!([f32::NAN, f32::INFINITY, -1e30].map(|x| to_i64(&x)), [None; 3]);
    }

    #[test]
    fn whole_numbers_keep_all_digits() {
        assert_eq!((to_u64(&u64::MAX), to_i64(&i64::MIN)), (Some(u64::MAX), Some(i64::MIN)));
        assert_eq!((to_i64(&u64::MAX), to_u32(&-1_i8), to_i32(&7_u8)), (None, None, Some(7)));
        assert_eq!(to_i64(&((1_i64 << 53) + 1)), Some((1 << 53) + 1));
        assert_eq!((to_f64(&3_u32), to_f32(&0.1_f64), to_f32(&1e300_f64)), (3.0, 0.1, f32::INFINITY));
    }
}

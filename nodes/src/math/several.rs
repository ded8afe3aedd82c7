//! Nodes with any number of inputs: `[a, b, c] -> sum() -> y`.

use apex_rt::node;
use num_traits::Float;

/// Sum of all values.
#[node]
pub fn sum<T: Float, const N: usize>(values: [&T; N]) -> T {
    values.into_iter().fold(T::zero(), |sum, value| sum + *value)
}

/// Arithmetic mean of all values.
#[node]
pub fn mean<T: Float, const N: usize>(values: [&T; N]) -> T {
    let add = |(sum, count): (T, T), value: &T| (sum + *value, count + T::one());
    let (sum, count) = values.into_iter().fold((T::zero(), T::zero()), add);
    sum / count
}

/// Smallest value, without regard to NaN.
#[node]
pub fn min<T: Float, const N: usize>(values: [&T; N]) -> T {
    values.into_iter().fold(T::nan(), |least, value| least.min(*value))
}

/// Largest value, without regard to NaN.
#[node]
pub fn max<T: Float, const N: usize>(values: [&T; N]) -> T {
    values.into_iter().fold(T::nan(), |most, value| most.max(*value))
}

/// Median of all values, without regard to NaN: one wrong sensor of three does not change it much. The mean of the two
/// middle values if their number is even; NaN if there is none.
#[node]
pub fn median<T: Float, const N: usize>(values: [&T; N]) -> T {
    let mut sorted = values.map(|value| *value);
    sorted.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap_or_else(|| a.is_nan().cmp(&b.is_nan())));
    let count = sorted.iter().take_while(|value| !value.is_nan()).count();
    if count == 0 {
        return T::nan();
    }
    let (low, high) = (sorted[(count - 1) / 2], sorted[count / 2]);
    let two = T::one() + T::one();
    // Not by the difference: that of two infinite values is not a number.
    if low == high { low } else { low / two + high / two }
}

/// Logical and: `true` if all inputs are `true`.
#[node]
pub fn all<const N: usize>(values: [&bool; N]) -> bool {
    values.into_iter().all(|value| *value)
}

/// Logical or: `true` if at least one input is `true`.
#[node]
pub fn any<const N: usize>(values: [&bool; N]) -> bool {
    values.into_iter().any(|value| *value)
}

/// Vote: `true` if more inputs are `true` than `false`. Inputs with ⊥ abstain; ⊥ if there is a tie or no vote at all.
#[node]
pub fn vote<const N: usize>(values: [Option<&bool>; N]) -> Option<bool> {
    let votes = |of: bool| values.iter().filter(|value| **value == Some(&of)).count();
    let (yes, no) = (votes(true), votes(false));
    (yes != no).then_some(yes > no)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAN: f64 = f64::NAN;

    #[test]
    fn numbers() {
        assert_eq!((sum([&1.0, &2.0, &4.0]), mean([&1.0, &2.0, &6.0])), (7.0, 3.0));
        assert_eq!((min([&2.0, &NAN, &1.0]), max([&NAN, &2.0, &1.0])), (1.0, 2.0));
        assert!(min([&NAN]).is_nan() && max([&NAN, &NAN]).is_nan());
    }

    #[test]
    fn the_median_ignores_outliers_and_nan() {
        assert_eq!([median([&1.0, &100.0, &2.0]), median([&4.0, &1.0]), median([&7.0])], [2.0, 2.5, 7.0]);
        assert_eq!(median([&NAN, &3.0, &-NAN, &1.0]), 2.0);
        assert!(median([&NAN, &NAN]).is_nan());
        let far = f64::INFINITY;
        assert_eq!([median([&far, &far, &2.0]), median([&far, &2.0]), median([&-far, &2.0])], [far, far, -far]);
        assert_eq!((median([&f64::MAX, &f64::MAX]), median([&-f64::MAX, &f64::MAX])), (f64::MAX, 0.0));
    }

    #[test]
    fn truth_values() {
        assert!(all([&true, &true]) && !all([&true, &false]) && any([&false, &true]) && !any([&false]));
        assert_eq!(vote([Some(&true), None, Some(&true), Some(&false)]), Some(true));
        assert_eq!(vote([Some(&false), None, None]), Some(false));
        assert_eq!([vote([Some(&false), Some(&true)]), vote([None, None])], [None, None]);
    }
}

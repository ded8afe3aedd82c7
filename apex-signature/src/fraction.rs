//! Exact constants: fractions of whole numbers, times a power of π.

use std::{cmp::Ordering, f64::consts::PI};

/// A fraction, times a power of π: `15cm` is 3/20, and `90deg` is π/2. It is always in lowest terms, so that equal
/// numbers are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fraction {
    numerator: i128,
    /// A positive number.
    denominator: i128,
    /// Power of π; 0 for zero.
    pi: i8,
}

/// Number of digits behind the point, and most zeros that an exponent adds: more have no place in 127 bits.
const MAX_DIGITS: u32 = 38;

impl Fraction {
    /// One.
    pub const ONE: Self = Self::constant(1, 1, 0);

    /// A fraction in lowest terms, times a power of π.
    pub const fn constant(numerator: i128, denominator: i128, pi: i8) -> Self {
        Self { numerator, denominator, pi }
    }

    /// A whole number.
    pub const fn whole(number: i128) -> Self {
        Self::constant(number, 1, 0)
    }

    /// A number as it is written, such as `0.5` or `1e-3`. Returns `None` for too many digits.
    pub fn parse(text: &str) -> Option<Self> {
        let (number, exponent) = match text.split_once(['e', 'E']) {
            Some((number, exponent)) => (number, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, part) = number.split_once('.').unwrap_or((number, ""));
        let digits: i128 = format!("{whole}{part}").parse().ok()?;
        let exponent = exponent.checked_sub(i32::try_from(part.len()).ok()?)?;
        let power = Some(exponent.unsigned_abs()).filter(|power| *power <= MAX_DIGITS)?;
        let power = 10_i128.checked_pow(power)?;
        match exponent < 0 {
            true => Self::new(digits, power, 0),
            false => Some(Self::whole(digits.checked_mul(power)?)),
        }
    }

    /// A number as it is printed.
    pub fn of(value: f64) -> Option<Self> {
        Self::parse(&value.to_string())
    }

    fn new(numerator: i128, denominator: i128, pi: i8) -> Option<Self> {
        let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs());
        let divisor =
            i128::try_from(divisor).ok().filter(|divisor| *divisor != 0)?.checked_mul(denominator.signum())?;
        let (numerator, denominator) = (numerator.checked_div(divisor)?, denominator.checked_div(divisor)?);
        Some(Self { numerator, denominator, pi: if numerator == 0 { 0 } else { pi } })
    }

    /// The number, if it is whole.
    pub fn integer(self) -> Option<i128> {
        (self.denominator == 1 && self.pi == 0).then_some(self.numerator)
    }

    /// The nearest number with a point, but for numbers with more than 53 bits.
    pub fn value(self) -> f64 {
        let (numerator, denominator) = (self.numerator as f64, self.denominator as f64);
        match self.pi {
            0 => numerator / denominator,
            power => numerator * PI.powi(i32::from(power)) / denominator,
        }
    }

    /// The negative number.
    pub fn checked_neg(self) -> Option<Self> {
        Some(Self { numerator: self.numerator.checked_neg()?, ..self })
    }

    /// The sum. Returns `None` if it is not such a number, or too long.
    pub fn checked_add(self, other: Self) -> Option<Self> {
        let (a, b, denominator, pi) = self.over_one_denominator(other)?;
        Self::new(a.checked_add(b)?, denominator, pi)
    }

    /// The difference.
    pub fn checked_sub(self, other: Self) -> Option<Self> {
        self.checked_add(other.checked_neg()?)
    }

    /// The product.
    pub fn checked_mul(self, other: Self) -> Option<Self> {
        // In lowest terms each numerator shares factors only with the other denominator.
        let (a, d) = lowest(self.numerator, other.denominator);
        let (b, c) = lowest(other.numerator, self.denominator);
        Self::new(a.checked_mul(b)?, c.checked_mul(d)?, self.pi.checked_add(other.pi)?)
    }

    /// The quotient. Returns `None` for a division by zero, too.
    pub fn checked_div(self, other: Self) -> Option<Self> {
        let inverse = Self::new(other.denominator, other.numerator, other.pi.checked_neg()?)?;
        self.checked_mul(inverse)
    }

    /// The remainder of a division whose quotient is whole, with the sign of the dividend.
    pub fn checked_rem(self, other: Self) -> Option<Self> {
        let (a, b, denominator, pi) = self.over_one_denominator(other)?;
        Self::new(a.checked_rem(b)?, denominator, pi)
    }

    /// A power.
    pub fn checked_pow(self, power: i8) -> Option<Self> {
        let factor = if power < 0 { Self::ONE.checked_div(self)? } else { self };
        (0..power.unsigned_abs()).try_fold(Self::ONE, |all, _| all.checked_mul(factor))
    }

    /// The order of two numbers. Returns `None` if it takes too many digits, or the digits of π.
    pub fn checked_cmp(self, other: Self) -> Option<Ordering> {
        let (a, b, ..) = self.over_one_denominator(other)?;
        Some(a.cmp(&b))
    }

    /// Both numerators over a common denominator, and the power of π.
    fn over_one_denominator(self, other: Self) -> Option<(i128, i128, i128, i8)> {
        let pi = match (self.numerator, other.numerator) {
            (0, _) => other.pi,
            (_, 0) => self.pi,
            _ if self.pi == other.pi => self.pi,
            _ => return None,
        };
        let (c, d) = lowest(self.denominator, other.denominator);
        let (a, b) = (self.numerator.checked_mul(d)?, other.numerator.checked_mul(c)?);
        Some((a, b, self.denominator.checked_mul(d)?, pi))
    }
}

/// Both numbers, divided by their greatest common divisor.
fn lowest(a: i128, b: i128) -> (i128, i128) {
    match i128::try_from(gcd(a.unsigned_abs(), b.unsigned_abs())) {
        Ok(divisor) if divisor > 1 => (a / divisor, b / divisor),
        _ => (a, b),
    }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(text: &str) -> Fraction {
        Fraction::parse(text).expect(text)
    }

    #[test]
    fn numbers_are_exactly_what_is_written() {
        assert_eq!(number("1e3").integer(), Some(1000));
        assert_eq!(number("2.50e1").integer(), Some(25));
        assert_eq!(number("0.1").checked_add(number("0.2")), Some(number("0.3")));
        assert_eq!(number("0.1").value(), 0.1);
        assert_eq!(number("0.0"), Fraction::whole(0));
        assert_eq!(Fraction::of(0.05), Some(number("5e-2")));
        for text in ["", ".", "1e", "1e99", "x", "0.1.2", "99999999999999999999999999999999999999999"] {
            assert_eq!(Fraction::parse(text), None, "{text}");
        }
    }

    #[test]
    fn quotients_are_exact() {
        let third = number("1").checked_div(number("3")).unwrap();
        assert_eq!(third.checked_mul(number("3")), Some(Fraction::ONE));
        assert_eq!(third.integer(), None);
        assert_eq!(number("7").checked_rem(number("-2")), Some(number("1")));
        assert_eq!(number("-7.5").checked_rem(number("2")), Some(number("-1.5")));
        assert_eq!(number("1").checked_div(number("0")), None);
        assert_eq!(number("1").checked_rem(number("0")), None);
        assert_eq!(third.checked_cmp(number("0.333")), Some(Ordering::Greater));
        assert_eq!(number("-2").checked_pow(-3), Some(Fraction::constant(-1, 8, 0)));
    }

    #[test]
    fn angles_are_multiples_of_pi() {
        let degree = Fraction::constant(1, 180, 1);
        let angle = |text: &str| number(text).checked_mul(degree).unwrap();
        assert_eq!(angle("180").value(), PI);
        assert_eq!(angle("60").value(), PI / 3.0);
        assert_eq!(angle("0").checked_add(number("1")), Some(Fraction::ONE));
        assert_eq!(angle("90").checked_add(number("1")), None);
        assert_eq!(angle("90").checked_div(angle("45")).and_then(Fraction::integer), Some(2));
    }

    #[test]
    fn what_is_too_long_is_no_fraction() {
        let most = Fraction::whole(i128::MAX);
        assert_eq!(most.checked_add(Fraction::ONE), None);
        assert_eq!(most.checked_mul(most), None);
        let least = Fraction::whole(i128::MIN);
        for other in [most, least, Fraction::ONE, Fraction::whole(-1), Fraction::whole(0)] {
            let _ = (least.checked_div(other), other.checked_div(least), least.checked_rem(other));
            let _ = (least.checked_cmp(other), least.checked_neg(), other.checked_sub(least));
        }
    }
}

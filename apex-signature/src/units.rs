//! Physical dimensions, so that a length is never used as a time.

use crate::fraction::Fraction;
use std::{fmt, time::Duration};

/// Exponents of metre, second, kilogram, ampere, kelvin and radian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Dimension([i8; 6]);

const BASE: [&str; 6] = ["m", "s", "kg", "A", "K", "rad"];
/// Largest exponent; a larger one is considered a mistake.
const MAX_EXPONENT: i8 = 9;

impl Dimension {
    /// A plain number.
    pub const NONE: Self = Self([0; 6]);
    /// A time.
    pub const TIME: Self = Self([0, 1, 0, 0, 0, 0]);
    /// Something per time.
    pub const FREQUENCY: Self = Self([0, -1, 0, 0, 0, 0]);

    /// Returns `true` for a plain number.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// `self · other^sign`; `None` if an exponent exceeds its limit.
    pub fn combine(self, other: Self, sign: i8) -> Option<Self> {
        let mut sum = self.0;
        for (a, b) in sum.iter_mut().zip(other.0) {
            *a = a.checked_add(b.checked_mul(sign)?).filter(|e| e.abs() <= MAX_EXPONENT)?;
        }
        Some(Self(sum))
    }

    /// Common name of quantities with this dimension.
    pub fn noun(self) -> &'static str {
        match self.0 {
            [0, 0, 0, 0, 0, 0] => "a plain number",
            [1, 0, 0, 0, 0, 0] => "a length",
            [2, 0, 0, 0, 0, 0] => "an area",
            [0, 1, 0, 0, 0, 0] => "a time",
            [0, -1, 0, 0, 0, 0] => "a frequency",
            [0, 0, 1, 0, 0, 0] => "a mass",
            [0, 0, 0, 0, 0, 1] => "an angle",
            [1, -1, 0, 0, 0, 0] => "a speed",
            [1, -2, 0, 0, 0, 0] => "an acceleration",
            [0, -1, 0, 0, 0, 1] => "an angular speed",
            _ => "another quantity",
        }
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut first = true;
        for positive in [true, false] {
            for (unit, exponent) in BASE.iter().zip(self.0).filter(|(_, e)| *e != 0 && (*e > 0) == positive) {
                let sign = if positive && first {
                    ""
                } else if positive {
                    "*"
                } else if first {
                    "1/"
                } else {
                    "/"
                };
                write!(f, "{sign}{unit}")?;
                if exponent.abs() > 1 {
                    write!(f, "^{}", exponent.abs())?;
                }
                first = false;
            }
        }
        if first { f.write_str("1") } else { Ok(()) }
    }
}

/// A unit: its dimension and its size in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Dimension of the quantities that it measures.
    pub dimension: Dimension,
    /// Size in SI units.
    pub factor: Fraction,
}

impl Unit {
    /// Size in SI units.
    pub fn size(self) -> f64 {
        self.factor.value()
    }
}

/// Smallest limit of a recording, in bytes.
pub const LEAST_RECORDING: u64 = 16_000_000;
/// Smallest age of a recording.
pub const YOUNGEST_RECORDING: Duration = Duration::from_secs(8);

/// Returns a number of bytes, given in `B`, `kB`, `MB`, `GB` or `TB`.
pub fn bytes(digits: &str, unit: &str) -> Option<u64> {
    let factor = match unit {
        "B" => 1.0,
        "kB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        "TB" => 1e12,
        _ => return None,
    };
    let bytes = digits.parse::<f64>().ok()? * factor;
    (0.0..1e18).contains(&bytes).then_some(bytes as u64)
}

/// Returns a time, given in a unit of time.
pub fn time(digits: &str, unit: &str) -> Option<Duration> {
    let unit = parse(unit).ok().filter(|unit| unit.dimension == Dimension::TIME)?;
    Duration::try_from_secs_f64(digits.parse::<f64>().ok()? * unit.size()).ok()
}

/// All units with a name: exponents as in [`Dimension`], and size in SI units.
const UNITS: [(&str, [i8; 6], Fraction); 32] = [
    ("m", [1, 0, 0, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("km", [1, 0, 0, 0, 0, 0], Fraction::constant(1000, 1, 0)),
    ("cm", [1, 0, 0, 0, 0, 0], Fraction::constant(1, 100, 0)),
    ("mm", [1, 0, 0, 0, 0, 0], Fraction::constant(1, 1000, 0)),
    ("um", [1, 0, 0, 0, 0, 0], Fraction::constant(1, 1_000_000, 0)),
    ("s", [0, 1, 0, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("ms", [0, 1, 0, 0, 0, 0], Fraction::constant(1, 1000, 0)),
    ("us", [0, 1, 0, 0, 0, 0], Fraction::constant(1, 1_000_000, 0)),
    ("ns", [0, 1, 0, 0, 0, 0], Fraction::constant(1, 1_000_000_000, 0)),
    ("min", [0, 1, 0, 0, 0, 0], Fraction::constant(60, 1, 0)),
    ("h", [0, 1, 0, 0, 0, 0], Fraction::constant(3600, 1, 0)),
    ("Hz", [0, -1, 0, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("kHz", [0, -1, 0, 0, 0, 0], Fraction::constant(1000, 1, 0)),
    ("MHz", [0, -1, 0, 0, 0, 0], Fraction::constant(1_000_000, 1, 0)),
    ("kg", [0, 0, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("g", [0, 0, 1, 0, 0, 0], Fraction::constant(1, 1000, 0)),
    ("t", [0, 0, 1, 0, 0, 0], Fraction::constant(1000, 1, 0)),
    ("rad", [0, 0, 0, 0, 0, 1], Fraction::constant(1, 1, 0)),
    ("mrad", [0, 0, 0, 0, 0, 1], Fraction::constant(1, 1000, 0)),
    ("deg", [0, 0, 0, 0, 0, 1], Fraction::constant(1, 180, 1)),
    ("rev", [0, 0, 0, 0, 0, 1], Fraction::constant(2, 1, 1)),
    ("A", [0, 0, 0, 1, 0, 0], Fraction::constant(1, 1, 0)),
    ("mA", [0, 0, 0, 1, 0, 0], Fraction::constant(1, 1000, 0)),
    ("K", [0, 0, 0, 0, 1, 0], Fraction::constant(1, 1, 0)),
    ("N", [1, -2, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("Nm", [2, -2, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("J", [2, -2, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("W", [2, -3, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("V", [2, -3, 1, -1, 0, 0], Fraction::constant(1, 1, 0)),
    ("mV", [2, -3, 1, -1, 0, 0], Fraction::constant(1, 1000, 0)),
    ("Pa", [-1, -2, 1, 0, 0, 0], Fraction::constant(1, 1, 0)),
    ("%", [0, 0, 0, 0, 0, 0], Fraction::constant(1, 100, 0)),
];

/// Units that are common elsewhere, and what to write instead.
pub const ELSEWHERE: [(&str, &str); 15] = [
    ("l", "a litre is `1000cm^3`"),
    ("ml", "a millilitre is `1cm^3`"),
    ("bar", "a bar is `100000Pa`"),
    ("mbar", "a millibar is `100Pa`"),
    ("rpm", "a turn a minute is `1rev/min`"),
    ("degC", "a temperature is in `K`: 0 °C is `273.15K`"),
    ("C", "a temperature is in `K`: 0 °C is `273.15K`; a charge is in `A*s`"),
    ("Ah", "an ampere hour is `1A*h`"),
    ("mAh", "a milliampere hour is `1mA*h`"),
    ("Wh", "a watt hour is `1W*h`"),
    ("lx", "light has no unit here: use a plain number, and name its unit in the documentation"),
    ("lm", "light has no unit here: use a plain number, and name its unit in the documentation"),
    ("dB", "a ratio is a plain number, or in `%`"),
    ("ppm", "a ratio is a plain number, or in `%`"),
    ("px", "pixels are counted: use a plain number"),
];

/// The names of all units.
pub fn names() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|(name, ..)| *name)
}

/// Reads a unit such as `m/s^2`.
///
/// # Errors
/// Returns the part that is not known.
pub fn parse(text: &str) -> Result<Unit, &str> {
    let mut unit = Unit { dimension: Dimension::NONE, factor: Fraction::ONE };
    let mut sign = 1;
    for part in text.split_inclusive(['/', '*']) {
        let term = part.trim_end_matches(['/', '*']);
        let (name, power) = match term.split_once('^') {
            Some((name, power)) => (name, power.parse::<i8>().map_err(|_| term)?),
            None => (term, 1),
        };
        if name != "1" {
            let (_, exponents, size) = UNITS.iter().find(|(n, ..)| *n == name).ok_or(term)?;
            let power = power.checked_mul(sign).filter(|p| p.abs() <= MAX_EXPONENT).ok_or(term)?;
            unit.dimension = unit.dimension.combine(Dimension(*exponents), power).ok_or(term)?;
            let size = size.checked_pow(power).ok_or(term)?;
            unit.factor = unit.factor.checked_mul(size).ok_or(term)?;
        }
        sign = if part.ends_with('/') { -1 } else { 1 };
    }
    Ok(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compound_units() {
        assert_eq!(parse("m/s^2").unwrap().dimension.to_string(), "m/s^2");
        assert_eq!(parse("km/h").unwrap().factor, Fraction::constant(5, 18, 0));
        assert_eq!(parse("rev/min").unwrap().size(), std::f64::consts::PI / 30.0);
        assert_eq!(parse("1/s").unwrap(), parse("Hz").unwrap());
        assert_eq!(parse("m/x"), Err("x"));
        assert_eq!(parse("m^99"), Err("m^99"));
        assert_eq!(parse("N").unwrap().dimension, parse("kg*m/s^2").unwrap().dimension);
    }
}

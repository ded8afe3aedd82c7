use crate::Random;
use core::fmt;
use serde::{Deserialize, Serialize};

/// Distribution of the values of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Scale {
    /// Equal differences are equally likely.
    #[default]
    Linear,
    /// Equal ratios are equally likely. The bounds must be positive.
    Logarithmic,
}

/// Range of one parameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    low: f64,
    high: f64,
    scale: Scale,
    integer: bool,
}

/// Error of a range that cannot be searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BadAxis {
    low: f64,
    high: f64,
    reason: &'static str,
}

impl fmt::Display for BadAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot search {}..={}: {}", self.low, self.high, self.reason)
    }
}

impl core::error::Error for BadAxis {}

impl Axis {
    /// Creates an axis from `low` to `high`, both included, in the unit of the parameter. Fails if a bound is not
    /// finite, `low` exceeds `high`, a bound of a logarithmic axis is not positive, or a bound of an integer axis is
    /// not an integer.
    pub fn new(low: f64, high: f64, scale: Scale, integer: bool) -> Result<Self, BadAxis> {
        let fail = |reason| Err(BadAxis { low, high, reason });
        if !(high - low).is_finite() {
            return fail("the bounds must be finite");
        }
        if low > high {
            return fail("the first bound must not exceed the second one");
        }
        if scale == Scale::Logarithmic && low <= 0.0 {
            return fail("a logarithmic scale needs positive bounds");
        }
        if integer && (low.fract() != 0.0 || high.fract() != 0.0) {
            return fail("the bounds of an integer must be integers");
        }
        Ok(Self { low, high, scale, integer })
    }

    /// Lower bound.
    pub fn low(&self) -> f64 {
        self.low
    }

    /// Upper bound.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Distribution of the values.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Returns `true` if all values are integers.
    pub fn is_integer(&self) -> bool {
        self.integer
    }

    /// Bounds on a scale on which equal differences are equally likely. An integer has an interval of its own.
    fn stretch(&self) -> (f64, f64) {
        let half = if self.integer { 0.5 } else { 0.0 };
        match self.scale {
            Scale::Linear => (self.low - half, self.high + half),
            Scale::Logarithmic => (libm::log(self.low - half), libm::log(self.high + half)),
        }
    }

    /// Value at a position between 0 and 1.
    pub fn value(&self, position: f64) -> f64 {
        if position <= 0.0 || position >= 1.0 {
            // Exactly, without rounding.
            return if position <= 0.0 { self.low } else { self.high };
        }
        let (low, high) = self.stretch();
        let at = low + position * (high - low);
        let value = if self.scale == Scale::Logarithmic { libm::exp(at) } else { at };
        let value = if self.integer { libm::round(value) } else { value };
        value.clamp(self.low, self.high)
    }

    /// Position of a value, from 0 to 1. Values out of range have the position of the nearest bound.
    pub fn position(&self, value: f64) -> f64 {
        let (low, high) = self.stretch();
        let value = value.clamp(self.low, self.high);
        let at = if self.scale == Scale::Logarithmic { libm::log(value) } else { value };
        if high > low { ((at - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
    }

    /// Distance of two integers on the axis, as a share of the axis; 0 if the values are not integers.
    pub(super) fn step(&self) -> f64 {
        if self.integer { 1.0 / (self.high - self.low + 1.0) } else { 0.0 }
    }
}

/// Search space: the product of the ranges of all parameters. Searches work in the unit cube.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Space {
    axes: Vec<Axis>,
}

impl Space {
    /// Creates the product of these axes.
    pub fn new(axes: Vec<Axis>) -> Self {
        Self { axes }
    }

    /// Axes, one for each parameter.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of parameters.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }

    /// Values at a point of the unit cube.
    pub fn values(&self, point: &[f64]) -> Vec<f64> {
        self.axes.iter().zip(point).map(|(axis, p)| axis.value(*p)).collect()
    }

    /// Point of the unit cube with these values. Missing values are at the middle of their axis.
    pub fn point(&self, values: &[f64]) -> Vec<f64> {
        let values = values.iter().map(Some).chain(core::iter::repeat(None));
        self.axes.iter().zip(values).map(|(axis, v)| v.map_or(0.5, |v| axis.position(*v))).collect()
    }

    /// Points of the unit cube, evenly distributed along each axis: a Latin hypercube (McKay, Beckman, Conover 1979).
    pub(super) fn sample(&self, count: usize, random: &mut Random) -> Vec<Vec<f64>> {
        let mut points = vec![Vec::with_capacity(self.dimensions()); count];
        let mut cells: Vec<usize> = (0..count).collect();
        for _ in 0..self.dimensions() {
            for i in (1..count).rev() {
                cells.swap(i, below(random, i + 1));
            }
            for (point, cell) in points.iter_mut().zip(&cells) {
                point.push((*cell as f64 + random.unit()) / count as f64);
            }
        }
        points
    }
}

/// Random number below `count`, which must not be 0.
pub(super) fn below(random: &mut Random, count: usize) -> usize {
    ((random.unit() * count as f64) as usize).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(low: f64, high: f64, scale: Scale, integer: bool) -> Axis {
        Axis::new(low, high, scale, integer).expect("a range")
    }

    #[test]
    fn values_and_positions_are_inverse() {
        for (low, high, scale) in [(-3.0, 7.0, Scale::Linear), (1e-3, 1e3, Scale::Logarithmic)] {
            let real = axis(low, high, scale, false);
            assert_eq!((real.value(0.0), real.value(1.0)), (low, high));
            for position in [0.0, 0.2, 0.5, 1.0] {
                assert!((real.position(real.value(position)) - position).abs() < 1e-12);
            }
        }
        assert!((axis(0.01, 100.0, Scale::Logarithmic, false).value(0.5) - 1.0).abs() < 1e-12);
        let fixed = axis(2.0, 2.0, Scale::Linear, false);
        assert_eq!((fixed.value(0.7), fixed.position(2.0)), (2.0, 0.5));
    }

    #[test]
    fn integers_are_equally_likely() {
        let dice = axis(1.0, 6.0, Scale::Linear, true);
        let mut counts = [0; 7];
        (0..6000).for_each(|i| counts[dice.value((f64::from(i) + 0.5) / 6000.0) as usize] += 1);
        assert_eq!(counts, [0, 1000, 1000, 1000, 1000, 1000, 1000]);
        let log = axis(1.0, 1000.0, Scale::Logarithmic, true);
        for value in [1.0, 2.0, 37.0, 1000.0] {
            assert_eq!(log.value(log.position(value)), value);
        }
    }

    #[test]
    fn bad_ranges_are_refused() {
        for (low, high, scale, integer) in [
            (1.0, 0.0, Scale::Linear, false),
            (f64::NAN, 1.0, Scale::Linear, false),
            (0.0, f64::INFINITY, Scale::Linear, false),
            (0.0, 1.0, Scale::Logarithmic, false),
            (0.5, 2.0, Scale::Linear, true),
        ] {
            let error = Axis::new(low, high, scale, integer).expect_err("no range").to_string();
            assert!(error.starts_with("cannot search"), "{error}");
        }
    }

    #[test]
    fn a_sample_has_one_point_in_each_row_and_column() {
        let space = Space::new(vec![axis(0.0, 1.0, Scale::Linear, false); 3]);
        let points = space.sample(20, &mut Random::new(5));
        for dimension in 0..3 {
            let mut rows: Vec<usize> = points.iter().map(|p| (20.0 * p[dimension]) as usize).collect();
            rows.sort_unstable();
            assert_eq!(rows, (0..20).collect::<Vec<_>>());
        }
    }
}

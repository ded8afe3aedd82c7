//! Curves of splines as chords.

use std::ops::ControlFlow;

/// Maximum degree; CAD programs write 3 and at most 25.
const MAX_DEGREE: usize = 25;
/// Maximum number of times that a part of the curve is halved.
const MAX_HALVES: u32 = 8;

/// Rational B-spline in the plane.
pub(super) struct Spline<'a> {
    degree: usize,
    knots: &'a [f64],
    /// Control points with their weights: weight · x, weight · y, weight.
    control: Vec<[f64; 3]>,
}

/// Point of the curve at a parameter.
type At = (f64, [f64; 2]);

impl<'a> Spline<'a> {
    /// Creates a spline. Returns `None` if the numbers of knots, points and weights do not fit together, knots
    /// decrease, or a weight is not positive.
    pub fn new(degree: usize, knots: &'a [f64], points: &[[f64; 2]], weights: &[f64]) -> Option<Self> {
        let fits = (1..=MAX_DEGREE).contains(&degree)
            && points.len() > degree
            && knots.len() == points.len() + degree + 1
            && (weights.is_empty() || weights.len() == points.len());
        // Not true for NaN.
        let ascend = knots.windows(2).all(|pair| pair[0] <= pair[1]) && weights.iter().all(|weight| *weight > 0.0);
        let weights = weights.iter().copied().chain(std::iter::repeat(1.0));
        let control = points.iter().zip(weights).map(|([x, y], w)| [x * w, y * w, w]).collect();
        (fits && ascend).then_some(Self { degree, knots, control })
    }

    /// Gives the points of the curve to `add`, from one end to the other. The chords between them deviate by at most
    /// about `tolerance`. Ends if `add` breaks.
    pub fn chords<E>(&self, tolerance: f64, mut add: impl FnMut([f64; 2]) -> Result<(), E>) -> Result<(), E> {
        let ends = self.degree..self.control.len();
        add(self.point(self.degree, self.knots[self.degree]))?;
        for span in ends.filter(|span| self.knots[*span] < self.knots[span + 1]) {
            let [from, to] = [self.knots[span], self.knots[span + 1]].map(|at| (at, self.point(span, at)));
            let middle = self.middle(span, from, to);
            for (from, to) in [(from, middle), (middle, to)] {
                if let ControlFlow::Break(error) = self.halve(span, [from, to], tolerance, MAX_HALVES, &mut add) {
                    return Err(error);
                }
            }
        }
        Ok(())
    }

    /// Gives the points between two ends, and the second end.
    fn halve<E>(
        &self,
        span: usize,
        [from, to]: [At; 2],
        tolerance: f64,
        halves: u32,
        add: &mut impl FnMut([f64; 2]) -> Result<(), E>,
    ) -> ControlFlow<E> {
        let middle = self.middle(span, from, to);
        if halves == 0 || distance(middle.1, from.1, to.1) <= tolerance {
            return add(to.1).map_or_else(ControlFlow::Break, ControlFlow::Continue);
        }
        self.halve(span, [from, middle], tolerance, halves - 1, add)?;
        self.halve(span, [middle, to], tolerance, halves - 1, add)
    }

    fn middle(&self, span: usize, (from, _): At, (to, _): At) -> At {
        let at = 0.5 * (from + to);
        (at, self.point(span, at))
    }

    /// Point at a parameter between the knots `span` and `span + 1`, by the algorithm of de Boor.
    fn point(&self, span: usize, at: f64) -> [f64; 2] {
        let degree = self.degree;
        let mut points = self.control[span - degree..=span].to_vec();
        for round in 1..=degree {
            for j in (round..=degree).rev() {
                let (low, high) = (self.knots[j + span - degree], self.knots[j + 1 + span - round]);
                let share = if high > low { (at - low) / (high - low) } else { 0.0 };
                points[j] = std::array::from_fn(|i| (1.0 - share) * points[j - 1][i] + share * points[j][i]);
            }
        }
        let [x, y, weight] = points[degree];
        [x / weight, y / weight]
    }
}

/// Distance of a point from the chord between two points.
fn distance(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (ux, uy) = (b[0] - a[0], b[1] - a[1]);
    let (px, py) = (point[0] - a[0], point[1] - a[1]);
    let length = ux.hypot(uy);
    if length > 0.0 { (ux * py - uy * px).abs() / length } else { px.hypot(py) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(spline: &Spline<'_>) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        let add = |point| {
            points.push(point);
            Ok::<_, ()>(())
        };
        spline.chords(1e-3, add).expect("no end");
        points
    }

    #[test]
    fn a_rational_spline_is_a_circle() {
        let (w, knots) = (0.5_f64.sqrt(), [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0]);
        let square = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
        let square = square.map(|(x, y)| [f64::from(x), f64::from(y)]);
        let weights = [1.0, w, 1.0, w, 1.0, w, 1.0, w, 1.0];
        let circle = points(&Spline::new(2, &knots, &square, &weights).expect("a spline"));
        assert!(circle.iter().all(|[x, y]| (x.hypot(*y) - 1.0).abs() < 1e-12));
        let length: f64 = circle.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1])).sum();
        assert!((length - std::f64::consts::TAU).abs() < 0.01 && circle.len() < 200, "{length} {}", circle.len());
    }

    #[test]
    fn a_curve_with_a_turning_point_is_not_a_line() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let curve =
            points(&Spline::new(3, &knots, &[[0.0, 0.0], [1.0, 3.0], [2.0, -3.0], [3.0, 0.0]], &[]).expect("a spline"));
        let highest = curve.iter().map(|p| p[1]).fold(0.0, f64::max);
        assert!((highest - 0.866).abs() < 0.01 && curve.last() == Some(&[3.0, 0.0]), "{highest}");
    }

    #[test]
    fn numbers_that_do_not_fit_are_no_spline() {
        let (knots, points) = ([0.0, 0.0, 1.0, 1.0], [[0.0, 0.0], [1.0, 0.0]]);
        assert!(Spline::new(1, &knots, &points, &[]).is_some());
        assert!(Spline::new(0, &knots, &points, &[]).is_none());
        assert!(Spline::new(2, &knots, &points, &[]).is_none());
        assert!(Spline::new(usize::MAX, &knots, &points, &[]).is_none());
        assert!(Spline::new(1, &knots[1..], &points, &[]).is_none());
        assert!(Spline::new(1, &[0.0, f64::NAN, 1.0, 1.0], &points, &[]).is_none());
        assert!(Spline::new(1, &[0.0, 2.0, 1.0, 1.0], &points, &[]).is_none());
        assert!(Spline::new(1, &knots, &points, &[1.0]).is_none());
        assert!(Spline::new(1, &knots, &points, &[1.0, 0.0]).is_none());
    }
}

//! Lines as drawn: a common part of several lines is drawn once, with one of them.

use super::placed::{Placed, Point};
use crate::model::{Frame, Line};

/// The drawn part of a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stroke {
    /// Number of the line in its frame.
    pub line: usize,
    /// Points of the drawn part. Fewer than two if the whole line is drawn with other lines.
    pub points: Vec<Point>,
    /// `true` if it branches off another line with the same start.
    pub parts: bool,
    /// `true` if it merges into another line with the same end.
    pub joins: bool,
}

/// Strokes of all lines of a frame, `=>` first: other lines branch off these and merge into them.
pub fn strokes(frame: &Frame, placed: &Placed) -> Vec<Stroke> {
    let mut order: Vec<usize> = (0..frame.lines.len()).collect();
    let key = |line: &Line| (!line.active, line.from, line.flow);
    order.sort_by_key(|i| key(&frame.lines[*i]));
    let mut strokes: Vec<Stroke> = vec![];
    for (rank, &index) in order.iter().enumerate() {
        let (line, route) = (&frame.lines[index], &placed.routes[index]);
        let backwards = reversed(route);
        let before = || order[..rank].iter().map(|other| (&frame.lines[*other], &placed.routes[*other]));
        let begin = before().filter(|(other, _)| other.from == line.from).map(|(_, other)| common(route, other)).max();
        let end = before()
            .filter(|(other, _)| other.to == line.to)
            .map(|(_, other)| common(&backwards, &reversed(other)))
            .max();
        let (begin, end) = (begin.unwrap_or(0), end.unwrap_or(0));
        let rest = reversed(&without(&backwards, end));
        let points = if begin + end < length(route) { without(&rest, begin) } else { vec![] };
        strokes.push(Stroke { line: index, points, parts: begin > 0, joins: end > 0 });
    }
    strokes
}

fn reversed(points: &[Point]) -> Vec<Point> {
    points.iter().rev().copied().collect()
}

/// Length and direction of a piece.
fn piece(from: Point, to: Point) -> (i64, Point) {
    let (x, y) = (to.0 - from.0, to.1 - from.1);
    (x.abs() + y.abs(), (x.signum(), y.signum()))
}

fn length(points: &[Point]) -> i64 {
    points.windows(2).map(|ends| piece(ends[0], ends[1]).0).sum()
}

/// Length of the common part of two lines from their starts.
fn common(a: &[Point], b: &[Point]) -> i64 {
    if a.first() != b.first() {
        return 0;
    }
    let mut sum = 0;
    for (a, b) in a.windows(2).zip(b.windows(2)) {
        let ((long, way), (other, other_way)) = (piece(a[0], a[1]), piece(b[0], b[1]));
        if way != other_way {
            break;
        }
        sum += long.min(other);
        if long != other {
            break;
        }
    }
    sum
}

/// Removes the first `cut` pixels of a line.
fn without(points: &[Point], cut: i64) -> Vec<Point> {
    let mut left = cut;
    for (at, ends) in points.windows(2).enumerate() {
        let (long, (x, y)) = piece(ends[0], ends[1]);
        if left < long {
            let begin = (ends[0].0 + x * left, ends[0].1 + y * left);
            return [begin].into_iter().chain(points[at + 1..].iter().copied()).collect();
        }
        left -= long;
    }
    vec![]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_one_until_they_part() {
        let line = [(0, 0), (10, 0), (10, 20)];
        assert_eq!(common(&line, &[(0, 0), (10, 0), (10, 5), (30, 5)]), 15);
        assert_eq!(common(&line, &[(0, 0), (30, 0)]), 10);
        assert_eq!(common(&line, &[(0, 0), (0, 9)]), 0);
        assert_eq!(common(&line, &[(1, 0), (10, 0)]), 0);
        assert_eq!(common(&line, &line), 30);
        assert_eq!(without(&line, 15), [(10, 5), (10, 20)]);
        assert_eq!(without(&line, 10), [(10, 0), (10, 20)]);
        assert_eq!(without(&line, 0), line);
        assert_eq!(without(&line, 30), []);
    }
}

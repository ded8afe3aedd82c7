use crate::{
    map::{LineSegment, cross},
    scan::Point2,
};

/// Distances below this are treated as 0, in m: segments that touch do not hide each other.
const TOUCH: f32 = 1e-4;

/// Square cell of the look-up table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Square {
    pub corners: [Point2; 4],
}

/// Shadow polygon of a segment: all points that are hidden behind it from every point of a cell (thesis figure 6.18).
///
/// It lies beyond the segment, between the sides of the convex hull of the cell and both ends of the segment, which
/// are extended to infinite lines.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shadow {
    lines: [HalfPlane; 3],
}

/// Points `p` with `normal · p ≥ offset`.
#[derive(Debug, Clone, Copy)]
struct HalfPlane {
    normal: Point2,
    offset: f32,
}

/// Region that is seen from a cell in the directions of a sector.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wedge {
    sides: [HalfPlane; 3],
}

impl Square {
    pub fn new(corner: Point2, side: f32) -> Self {
        let at = |x: f32, y: f32| corner + Point2::new(x, y).scaled(side);
        Self { corners: [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)] }
    }

    /// Distance from the middle of the square to a segment, minus the half diagonal: a lower bound of the distance.
    pub fn distance(&self, segment: &LineSegment) -> f32 {
        let [low, _, high, _] = self.corners;
        let middle = (low + high).scaled(0.5);
        let (along, from) = (segment.b - segment.a, middle - segment.a);
        let share = (from.dot(along) / along.norm_squared()).clamp(0.0, 1.0);
        (from - along.scaled(share)).norm() - (high - middle).norm()
    }
}

impl HalfPlane {
    /// Half-plane to the left of the line from `from` in the direction of the unit vector `direction`.
    const fn left_of(from: Point2, direction: Point2) -> Self {
        let normal = direction.perpendicular();
        Self { normal, offset: normal.dot(from) }
    }

    const fn depth(&self, point: Point2) -> f32 {
        self.normal.dot(point) - self.offset
    }
}

impl Shadow {
    /// Shadow of `segment` for a cell. Returns `None` if the line through the segment meets the cell: then no point is
    /// hidden from the whole cell.
    pub fn new(square: &Square, segment: &LineSegment) -> Option<Self> {
        let middle = square.corners[0] + (square.corners[2] - square.corners[0]).scaled(0.5);
        // Seen from the cell, the segment extends from `right` to `left`.
        let (right, left) = if cross(segment.a - middle, segment.b - middle) > 0.0 {
            (segment.a, segment.b)
        } else {
            (segment.b, segment.a)
        };
        let unit = |v: Point2| v.scaled(1.0 / v.norm());
        // The cell is to the left of the line from `right` to `left`, and its shadow to the right.
        let front = HalfPlane::left_of(right, unit(left - right));
        if square.corners.iter().any(|corner| front.depth(*corner) < TOUCH) {
            return None;
        }
        let behind = HalfPlane::left_of(left, unit(right - left));
        let mut first = square.corners[0];
        let mut last = first;
        for &corner in &square.corners[1..] {
            if cross(right - first, corner - first) < 0.0 {
                first = corner;
            }
            if cross(left - last, corner - last) > 0.0 {
                last = corner;
            }
        }
        let lines =
            [behind, HalfPlane::left_of(first, unit(right - first)), HalfPlane::left_of(left, unit(last - left))];
        Some(Self { lines })
    }

    /// Returns `true` if a segment is completely inside.
    pub fn hides(&self, segment: &LineSegment) -> bool {
        self.lines.iter().all(|line| line.depth(segment.a) > TOUCH && line.depth(segment.b) > TOUCH)
    }
}

impl Wedge {
    /// Region that is seen from `square` in directions between `from` and `to` rad, which differ by less than a half
    /// turn.
    pub fn new(square: &Square, from: f32, to: f32) -> Self {
        // Wider by a hair, so that no beam between two sectors is lost by rounding.
        let sides = [
            HalfPlane::left_of(Point2::default(), Point2::polar(1.0, from - 1e-3)),
            HalfPlane::left_of(Point2::default(), Point2::polar(-1.0, to + 1e-3)),
            HalfPlane::left_of(Point2::default(), Point2::polar(-1.0, 0.5 * (from + to)).perpendicular()),
        ];
        let around = |side: HalfPlane| {
            let depths = square.corners.map(|corner| side.depth(corner));
            HalfPlane { offset: depths.into_iter().fold(f32::MAX, f32::min) - 1e-3, ..side }
        };
        Self { sides: sides.map(around) }
    }

    /// Part of a segment in the region, or `None` if it is outside.
    pub fn clip(&self, segment: &LineSegment) -> Option<LineSegment> {
        let (mut first, mut last) = (0.0_f32, 1.0_f32);
        for side in &self.sides {
            match (side.depth(segment.a), side.depth(segment.b)) {
                (a, b) if a < 0.0 && b < 0.0 => return None,
                (a, b) if a < 0.0 => first = first.max(a / (a - b)),
                (a, b) if b < 0.0 => last = last.min(a / (a - b)),
                _ => {}
            }
        }
        let along = segment.b - segment.a;
        (first <= last).then(|| LineSegment { a: segment.a + along.scaled(first), b: segment.a + along.scaled(last) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(ax: f32, ay: f32, bx: f32, by: f32) -> LineSegment {
        LineSegment { a: Point2::new(ax, ay), b: Point2::new(bx, by) }
    }

    #[test]
    fn a_wall_hides_what_is_behind_it_from_the_whole_cell() {
        let square = Square::new(Point2::new(0.0, 0.0), 1.0);
        for wide in [wall(3.0, -1.0, 3.0, 2.0), wall(3.0, 2.0, 3.0, -1.0)] {
            let shadow = Shadow::new(&square, &wide).expect("a shadow");
            assert!(shadow.hides(&wall(5.0, 0.0, 6.0, 1.0)));
            assert!(!shadow.hides(&wall(5.0, 0.0, 5.0, 4.0)), "it sticks out");
            assert!(!shadow.hides(&wall(2.0, 0.0, 2.0, 1.0)), "it is in front");
            assert!(!shadow.hides(&wall(3.0, 0.0, 3.0, 1.0)), "it is the same wall");
        }
        // The shadow of a wall that is narrower than the cell is a triangle.
        let narrow = Shadow::new(&square, &wall(3.0, 0.4, 3.0, 0.6)).expect("a shadow");
        assert!(narrow.hides(&wall(3.1, 0.45, 3.1, 0.55)) && !narrow.hides(&wall(9.0, 0.45, 9.0, 0.55)));
    }

    #[test]
    fn a_wall_in_line_with_the_cell_hides_nothing() {
        let square = Square::new(Point2::new(0.0, 0.0), 1.0);
        for seen in [wall(2.0, 0.5, 4.0, 0.5), wall(-1.0, 0.5, 2.0, 0.6), wall(2.0, 1.0, 4.0, 1.0)] {
            assert!(Shadow::new(&square, &seen).is_none(), "{seen:?}");
        }
    }

    #[test]
    fn a_wedge_cuts_segments() {
        let square = Square::new(Point2::new(0.0, 0.0), 1.0);
        let wedge = Wedge::new(&square, 0.0, 0.5);
        let part = wedge.clip(&wall(5.0, -9.0, 5.0, 9.0)).expect("it is seen");
        assert!(part.a.y < 0.0 && part.a.y > -0.05 && part.b.y > 3.5 && part.b.y < 4.0, "{part:?}");
        assert!(
            wedge.clip(&wall(-5.0, -9.0, -5.0, 9.0)).is_none() && wedge.clip(&wall(2.0, -1.0, 4.0, -1.0)).is_none()
        );
    }
}

use super::{Cell, Grid, Occupancy};
use crate::scan::Point2;
use core::fmt;

/// Maximum number of segments of a [`VectorMap`].
pub const MAX_SEGMENTS: usize = 200_000;
/// Maximum magnitude of a coordinate, in m. Beyond it, single precision is coarser than a centimetre.
const FARTHEST: f32 = 1e5;

/// Straight line between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineSegment {
    /// First end, in m.
    pub a: Point2,
    /// Second end, in m.
    pub b: Point2,
}

/// Map of line segments: walls seen from above, for example from the plan of an architect (thesis 6.9).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VectorMap {
    segments: Vec<LineSegment>,
}

/// Error of segments that cannot be added to a [`VectorMap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapError {
    /// More than [`MAX_SEGMENTS`] segments.
    TooMany,
    /// A coordinate that is NaN or more than 100 km from the origin.
    TooFar,
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany => {
                write!(f, "the plan has more than {MAX_SEGMENTS} line segments: select the layers of the walls")
            }
            Self::TooFar => f.write_str(
                "a coordinate is not a number or more than 100 km from the origin: move the plan to the origin, or \
                 scale it",
            ),
        }
    }
}

impl core::error::Error for MapError {}

impl VectorMap {
    /// Adds a segment. One that is shorter than 1 mm is skipped.
    ///
    /// # Errors
    /// If the map is full, or if a coordinate is out of range.
    pub fn add(&mut self, a: Point2, b: Point2) -> Result<(), MapError> {
        // Not true for NaN.
        if ![a.x, a.y, b.x, b.y].iter().all(|value| value.abs() <= FARTHEST) {
            return Err(MapError::TooFar);
        }
        if (b - a).norm() < 1e-3 {
            return Ok(());
        }
        if self.segments.len() == MAX_SEGMENTS {
            return Err(MapError::TooMany);
        }
        self.segments.push(LineSegment { a, b });
        Ok(())
    }

    /// All segments, in the order of addition.
    pub fn segments(&self) -> &[LineSegment] {
        &self.segments
    }

    /// Smallest and largest coordinates, or `None` for a map without segments.
    pub fn bounds(&self) -> Option<(Point2, Point2)> {
        let mut points = self.segments.iter().flat_map(|s| [s.a, s.b]);
        let first = points.next()?;
        Some(points.fold((first, first), |(low, high), p| {
            (Point2::new(low.x.min(p.x), low.y.min(p.y)), Point2::new(high.x.max(p.x), high.y.max(p.y)))
        }))
    }

    /// Outlines of the occupied cells of a grid map, each side as long as possible.
    ///
    /// # Errors
    /// If there are too many sides.
    pub fn outline(grid: &Grid<Occupancy>) -> Result<Self, MapError> {
        let raster = *grid.raster();
        let is_occupied = |x: usize, y: usize| grid.get(Cell::new(x, y)) == Some(&Occupancy::Occupied);
        let at = |x: usize, y: usize| raster.corner + Point2::new(x as f32, y as f32).scaled(raster.resolution);
        let mut map = Self::default();
        for y in 1..raster.height {
            runs(
                raster.width,
                |x| is_occupied(x, y - 1) != is_occupied(x, y),
                |from, to| map.add(at(from, y), at(to, y)),
            )?;
        }
        for x in 1..raster.width {
            runs(
                raster.height,
                |y| is_occupied(x - 1, y) != is_occupied(x, y),
                |from, to| map.add(at(x, from), at(x, to)),
            )?;
        }
        Ok(map)
    }
}

impl LineSegment {
    /// Distance from `origin` along the unit vector `direction` to this segment, or `None` if it is not hit.
    #[inline]
    pub fn hit(&self, origin: Point2, direction: Point2) -> Option<f32> {
        Some(nearest_hit([self], origin, direction)).filter(|range| range.is_finite())
    }

    /// Distance from `origin` along `direction` to the line through this segment, and the place where it is hit: 0 at
    /// the first end, 1 at the second one. Neither is finite if they are parallel.
    #[inline]
    fn crossing(&self, origin: Point2, direction: Point2) -> (f32, f32) {
        let (along, from) = (self.b - self.a, self.a - origin);
        let scale = 1.0 / cross(direction, along);
        (cross(from, along) * scale, cross(from, direction) * scale)
    }
}

/// Distance from `origin` along the unit vector `direction` to the nearest segment; infinite if none is hit.
///
/// Compares the bits of floating-point numbers, which have the order of the numbers if these are not negative;
/// negative ones and NaN come after infinity. So there are few instructions for a segment, and no branch that is hard
/// to predict.
#[inline]
pub(crate) fn nearest_hit<'a>(
    segments: impl IntoIterator<Item = &'a LineSegment>,
    origin: Point2,
    direction: Point2,
) -> f32 {
    // −0 + 0 is 0.
    let bits = |value: f32| (value + 0.0).to_bits();
    let mut nearest = f32::INFINITY.to_bits();
    for segment in segments {
        let (distance, place) = segment.crossing(origin, direction);
        nearest = nearest.min(if bits(place) <= bits(1.0) { bits(distance) } else { u32::MAX });
    }
    f32::from_bits(nearest)
}

/// z component of the cross product: positive if `b` points to the left of `a`.
#[inline]
pub(crate) const fn cross(a: Point2, b: Point2) -> f32 {
    a.x * b.y - a.y * b.x
}

/// Calls `found` for each longest run of places below `count` for which `holds` is true, with its first place and the
/// one after its last.
fn runs(
    count: usize,
    holds: impl Fn(usize) -> bool,
    mut found: impl FnMut(usize, usize) -> Result<(), MapError>,
) -> Result<(), MapError> {
    let mut begin = None;
    for place in 0..=count {
        match (begin, place < count && holds(place)) {
            (None, true) => begin = Some(place),
            (Some(from), false) => {
                found(from, place)?;
                begin = None;
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;

    #[test]
    fn what_is_no_place_is_refused() {
        let mut map = VectorMap::default();
        let origin = Point2::default();
        for x in [f32::NAN, f32::INFINITY, 2e5] {
            assert_eq!(map.add(origin, Point2::new(x, 0.0)), Err(MapError::TooFar));
        }
        assert_eq!((map.add(origin, origin), map.bounds()), (Ok(()), None), "a point is no wall");
        for _ in 0..MAX_SEGMENTS {
            map.add(origin, Point2::new(1.0, 2.0)).expect("room");
        }
        assert_eq!(map.add(origin, Point2::new(1.0, 0.0)), Err(MapError::TooMany));
        assert_eq!(map.bounds(), Some((origin, Point2::new(1.0, 2.0))));
    }

    #[test]
    fn a_segment_is_hit_from_both_sides_and_not_beside() {
        let wall = LineSegment { a: Point2::new(2.0, -1.0), b: Point2::new(2.0, 1.0) };
        let x = Point2::new(1.0, 0.0);
        assert_eq!(wall.hit(Point2::default(), x), Some(2.0));
        assert_eq!(wall.hit(Point2::new(5.0, 0.5), x.scaled(-1.0)), Some(3.0));
        for origin in [Point2::new(3.0, 0.0), Point2::new(0.0, 1.5), Point2::new(0.0, f32::NAN)] {
            assert_eq!(wall.hit(origin, x), None);
        }
        assert_eq!(wall.hit(Point2::default(), Point2::new(0.0, 1.0)), None, "parallel");
    }

    #[test]
    fn occupied_cells_have_outlines() {
        let raster = Raster { corner: Point2::new(1.0, 0.0), resolution: 0.5, width: 6, height: 5 };
        let mut grid = Grid::new(raster, Occupancy::Free).expect("a small grid");
        for x in 2..4 {
            *grid.get_mut(Cell::new(x, 2)).expect("inside") = Occupancy::Occupied;
        }
        let map = VectorMap::outline(&grid).expect("four sides");
        assert_eq!(map.segments().len(), 4);
        assert_eq!(map.bounds(), Some((Point2::new(2.0, 1.0), Point2::new(3.0, 1.5))));
    }
}

use super::{Columns, Label};
use core::f32::consts::TAU;

/// Distance to each side at which the ground is looked up, in m, and again at twice this distance.
const BESIDE: f32 = 0.6;
/// Difference of the distances of two points of a ring up to which they are on the same ground, in m.
const LEVEL: f32 = 0.15;
/// Number of points of a ring on each side of one that are likely to be on the same thing.
const SAME: usize = 2;

/// Labelled points of a full turn of a scanner with rings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn<'a> {
    pub columns: &'a Columns,
    /// Distances of the points from the axis of the scanner, in m.
    pub distances: &'a [f32],
    pub labels: &'a [Label],
}

impl Turn<'_> {
    /// Returns `true` for a point that is higher than the ground to both sides, by more than `rise` m, and by `bend`
    /// for each metre from a point of the ground there.
    pub fn stands_out(&self, i: usize, rise: f32, bend: f32) -> bool {
        let height = self.columns.height;
        let count = self.labels.len() / height;
        let (column, row) = (i / height, i % height);
        let (distance, z) = (self.distances[i], self.columns.z[i]);
        // A cast of a number that is not finite saturates.
        let off = ((BESIDE * count as f32 / (TAU * distance)) as usize).saturating_add(1).min(count / 8);
        let is_over = |other: usize| {
            let other = if other < count { other } else { other - count };
            let same = other * height + row;
            if self.labels[same] == Label::Floor && self.distances[same] - distance < LEVEL {
                return false;
            }
            let ground = self.ground_at(other, row, distance);
            ground.is_some_and(|(ground, gap)| z - ground > rise + bend * gap)
        };
        (is_over(column + off) || is_over(column + 2 * off))
            && (is_over(column + count - off) || is_over(column + count - 2 * off))
    }

    /// Height of the ground of a column at a distance, and the distance from there to the nearest point of that ground.
    /// Where the ground is not seen beyond that distance, it is not above the lowest ray that goes on. The search
    /// begins with the ring `row`.
    fn ground_at(&self, column: usize, row: usize, distance: f32) -> Option<(f32, f32)> {
        let height = self.columns.height;
        let first = column * height;
        let at = |row: usize| [self.distances[first + row], self.columns.z[first + row]];
        let is_ground = |row: &usize| self.labels[first + row] == Label::Floor;
        let Some(mut far) = (0..=row).rev().filter(is_ground).find(|row| at(*row)[0] >= distance) else {
            // False for NaN.
            let [end, z] = (0..height).rev().map(at).find(|[end, _]| *end > distance)?;
            let origin = self.columns.origin[2];
            return Some((origin + (z - origin) * distance / end, 0.0));
        };
        // The robot stands on the ground.
        let mut near = [0.0; 2];
        for lower in (far + 1..height).filter(is_ground) {
            if at(lower)[0] < distance {
                near = at(lower);
                break;
            }
            far = lower;
        }
        let ([r0, z0], [r1, z1]) = (near, at(far));
        let part = (distance - r0) / (r1 - r0).max(1e-3);
        Some((z0 + part * (z1 - z0), (distance - r0).min(r1 - distance)))
    }
}

/// Number of marked points among a point and those beside it in its ring.
pub(super) fn marks_around(marks: &[bool], i: usize, height: usize) -> usize {
    let count = marks.len() / height;
    let (column, row) = (i / height + SAME * count, i % height);
    (column - SAME..=column + SAME).filter(|column| marks[column % count * height + row]).count()
}

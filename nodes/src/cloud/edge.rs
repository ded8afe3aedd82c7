use super::{Columns, Label, Labels};
use apex_rt::{Out, node};

/// Splits the volume before the robot into an unknown one up to the height `overhang` and the overhanging one above,
/// and removes flying pixels from the latter (thesis 6.5.1, steps 3 and 4): points that are far from all eight
/// neighbours.
///
/// Unknown points above `overhang` become `Overhanging` or `Artefact`. The output is ⊥ if points and labels differ in
/// size.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct EdgeFilter {
    /// Height above which a point is neither floor nor a small object, z_0.
    #[param(unit = "m", default = 0.12, range = 0.0..=10.0)]
    overhang: f32,
    /// Maximum distance of a point from its nearest neighbour, δ_edge.
    #[param(unit = "m", default = 0.07, range = 0.0..=10.0)]
    edge: f32,
}

#[node]
impl EdgeFilter {
    fn process(&mut self, points: &Columns, labels: &Labels, filtered: &mut Out<Labels>) {
        if !points.fits(labels) {
            return;
        }
        let out = filtered.get_mut();
        out.clone_from(labels);
        let limit = self.edge * self.edge;
        for (i, (label, z)) in out.labels.iter_mut().zip(&points.z).enumerate() {
            if *label == Label::Unknown && *z > self.overhang {
                // The input labels are asked, so that the result does not depend on the order of the points.
                let near = |j: usize| labels.labels[j].is_valid() && points.distance_squared(i, j) <= limit;
                *label = if neighbours(i, points.height, points.len()).any(near) {
                    Label::Overhanging
                } else {
                    Label::Artefact
                };
            }
        }
    }
}

/// The eight neighbours of point `i`, as far as the image has them: those in its column first.
fn neighbours(i: usize, height: usize, count: usize) -> impl Iterator<Item = usize> {
    let row = i % height;
    let rows = (usize::from(row > 0), usize::from(row + 1 < height));
    let around = move |j: usize| (j - rows.0..=j + rows.1).filter(move |k| *k != i);
    let right = (i + height < count).then_some(i + height);
    [Some(i), i.checked_sub(height), right].into_iter().flatten().flat_map(around)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::columns::tests::columns;
    use apex_rt::Construct;

    #[test]
    fn flying_pixels_are_removed_from_what_hangs_over() {
        use Label::{Artefact, Missing, Overhanging, Unknown};
        let at = |x: f32, z: f32| [x, 0.0, z, 1.0];
        // A box at 1 m, a wall at 2 m, and a flying pixel between them: one high up, one near the floor.
        let points = [at(2.0, 0.4), at(1.5, 0.3), at(1.0, 0.2), at(2.0, 0.4), at(2.0, 0.35), at(1.0, 0.2)];
        let (points, labels) = columns(3, &points);
        let mut out = Out::new();
        EdgeFilter::construct((0.12, 0.07)).process(&points, &labels, &mut out);
        let high = [Overhanging, Artefact, Overhanging, Overhanging, Overhanging, Overhanging];
        assert_eq!(out.get().expect("labels").labels, high);
        EdgeFilter::construct((0.32, 0.07)).process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("labels").labels[..2], [Overhanging, Unknown]);
        // One column, and one row.
        for (height, expected) in [(2, Artefact), (1, Artefact)] {
            let (points, labels) = columns(height, &[at(2.0, 0.4), at(1.5, 0.3)]);
            EdgeFilter::construct((0.12, 0.07)).process(&points, &labels, &mut out);
            assert_eq!(out.get().expect("labels").labels, [expected; 2]);
        }
        let (points, labels) = columns(2, &[[f32::NAN; 4]; 2]);
        EdgeFilter::construct((0.12, 0.07)).process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("labels").labels, [Missing; 2]);
    }
}

use super::{Columns, Label, Labels, grow::Grow};
use apex_rt::{Out, node};

/// Removes points nearer than the camera can measure: wrapping errors of surfaces just beyond its range (thesis 6.5.1,
/// step 1). Their direct neighbours are removed recursively while they are near.
///
/// Labels are `Missing`, `Artefact` or `Unknown`.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct NearFilter {
    /// Minimum range of the camera, d_min.
    #[param(unit = "m", default = 0.15, range = 0.0..=10.0)]
    min_range: f32,
    /// Maximum distance between neighbours of the recursion, δ_edge.
    #[param(unit = "m", default = 0.07, range = 0.0..=10.0)]
    edge: f32,
    grow: Grow,
}

#[node]
impl NearFilter {
    fn process(&mut self, points: &Columns, labels: &mut Out<Labels>) {
        let out = labels.get_mut();
        out.height = points.height;
        out.labels.clear();
        let label = |((x, y), z): ((&f32, &f32), &f32)| {
            if (x + y + z).is_finite() { Label::Unknown } else { Label::Missing }
        };
        out.labels.extend(points.x.iter().zip(&points.y).zip(&points.z).map(label));
        let (least, origin) = (self.min_range * self.min_range, points.origin);
        self.grow.run(points, out, self.edge, Label::Unknown, |i| {
            let d = [points.x[i] - origin[0], points.y[i] - origin[1], points.z[i] - origin[2]];
            d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < least
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::columns::tests::columns;
    use apex_rt::Construct;

    fn labels(height: usize, points: &[[f32; 4]]) -> Vec<Label> {
        let mut out = Out::new();
        NearFilter::construct((0.15, 0.07)).process(&columns(height, points).0, &mut out);
        out.get().expect("labels").labels.clone()
    }

    #[test]
    fn what_hangs_together_with_a_point_that_is_too_near_is_removed() {
        use Label::{Artefact, Missing, Unknown};
        let at = |x: f32| [x, 0.0, 0.0, 1.0];
        // Two columns: 0.1, 0.16 and 0.22 hang together, across the columns too; 0.4 does not.
        let points = [at(0.1), at(0.16), at(0.4), [f32::NAN; 4], at(0.22), at(0.25)];
        assert_eq!(labels(3, &points), [Artefact, Artefact, Unknown, Missing, Artefact, Artefact]);
        assert_eq!(labels(0, &[]), []);
        assert_eq!(labels(2, &[[f32::NAN; 4]; 4]), [Missing; 4]);
    }
}

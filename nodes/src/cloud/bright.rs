use super::{Columns, Label, Labels, grow::Grow};
use apex_rt::{Out, node};

/// Removes wrapping errors of retro-reflectors (thesis 6.5.1, step 5): points of the overhanging volume that reflect
/// at maximum intensity, and recursively their direct neighbours in this volume while they are near.
///
/// The output is ⊥ if points and labels differ in size.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct BrightFilter {
    /// Maximum intensity of an obstacle, δ_I: slightly less than the maximum of the sensor, in its unit.
    #[param(default = 1021.0, range = 0.0..=1e9)]
    max_intensity: f32,
    /// Maximum distance between neighbours of the recursion, δ_edge.
    #[param(unit = "m", default = 0.07, range = 0.0..=10.0)]
    edge: f32,
    grow: Grow,
}

#[node]
impl BrightFilter {
    fn process(&mut self, points: &Columns, labels: &Labels, filtered: &mut Out<Labels>) {
        if !points.fits(labels) {
            return;
        }
        let out = filtered.get_mut();
        out.clone_from(labels);
        let limit = self.max_intensity;
        self.grow.run(points, out, self.edge, Label::Overhanging, |i| points.intensity[i] > limit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::columns::tests::columns;
    use apex_rt::Construct;

    #[test]
    fn only_what_hangs_over_is_removed() {
        use Label::{Artefact, Overhanging, Unknown};
        let at = |x: f32, intensity: f32| [x, 0.0, 0.5, intensity];
        let (points, mut labels) =
            columns(5, &[at(1.0, 1024.0), at(1.05, 9.0), at(1.2, 9.0), at(2.0, 1024.0), at(2.0, 9.0)]);
        labels.labels[..3].fill(Overhanging);
        let mut out = Out::new();
        let mut node = BrightFilter::construct((1021.0, 0.07));
        node.process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("labels").labels, [Artefact, Artefact, Overhanging, Unknown, Unknown]);
        out.clear();
        node.process(&points, &Labels::default(), &mut out);
        assert!(out.get().is_none());
    }
}

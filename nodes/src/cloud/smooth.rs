use super::{Columns, Labels};
use apex_rt::{Out, node};

/// Low-pass filter of the heights (thesis 6.5.1, step 2): mixes each height with the median of itself and its
/// neighbours above and below in the column.
///
/// The thesis does not name its filter. A median leaves the edges of objects where they are; a part of the original
/// height keeps objects of a single row. A point with a neighbour that is missing or an artefact keeps its height. The
/// output is ⊥ if points and labels differ in size.
#[node]
#[keeps_frame]
#[derive(Debug, Clone)]
pub struct SmoothHeights {
    /// Share of the median.
    #[param(default = 0.5, range = 0.0..=1.0)]
    strength: f32,
}

#[node]
impl SmoothHeights {
    fn process(&mut self, points: &Columns, labels: &Labels, smoothed: &mut Out<Columns>) {
        if !points.fits(labels) {
            return;
        }
        let out = smoothed.get_mut();
        out.clone_from(points);
        let height = points.height.max(1);
        let columns = points.z.chunks_exact(height).zip(labels.labels.chunks_exact(height));
        for (smooth, (heights, labels)) in out.z.chunks_exact_mut(height).zip(columns) {
            let inner = smooth.iter_mut().skip(1);
            for ((z, around), labels) in inner.zip(heights.windows(3)).zip(labels.windows(3)) {
                if labels[0].is_valid() && labels[1].is_valid() && labels[2].is_valid() {
                    let (low, high) = (around[0].min(around[2]), around[0].max(around[2]));
                    // Not `clamp`, which panics on NaN.
                    *z += self.strength * (around[1].max(low).min(high) - around[1]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Label, columns::tests::columns};
    use apex_rt::Construct;

    #[test]
    fn a_step_stays_and_a_spike_shrinks() {
        let at = |z: f32| [1.0, 0.0, z, 1.0];
        let (points, mut labels) = columns(6, &[0.0, 0.0, 1.0, 1.0, 0.0, 0.0].map(at));
        let mut out = Out::new();
        let mut node = SmoothHeights::construct((0.5,));
        node.process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("points").z, points.z);
        let (points, _) = columns(6, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0].map(at));
        node.process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("points").z, [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]);
        labels.labels[3] = Label::Artefact;
        node.process(&points, &labels, &mut out);
        assert_eq!(out.get().expect("points").z[2], 1.0);
        for height in [0, 1, 2] {
            let (points, labels) = columns(height, &vec![at(1.0); 2 * height]);
            node.process(&points, &labels, &mut out);
            assert_eq!(out.get().expect("points").z, points.z);
        }
    }
}

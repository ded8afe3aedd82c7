use super::{Columns, Label, Labels};

/// Recursive removal of artefacts (thesis 6.5.1, steps 1 and 5). Keeps its list of points to visit.
#[derive(Debug, Clone, Default)]
pub(super) struct Grow {
    open: Vec<usize>,
}

impl Grow {
    /// Labels each point `i` with `seed(i)` as an artefact, and recursively those of the four direct neighbours that
    /// are labelled `kind` and nearer than `edge` m to it.
    pub fn run(&mut self, points: &Columns, labels: &mut Labels, edge: f32, kind: Label, seed: impl Fn(usize) -> bool) {
        for i in 0..points.len() {
            if labels.labels[i] == kind && seed(i) {
                labels.labels[i] = Label::Artefact;
                self.open.push(i);
            }
        }
        while let Some(i) = self.open.pop() {
            for j in direct_neighbours(i, points.height, points.len()) {
                if labels.labels[j] == kind && points.distance_squared(i, j) < edge * edge {
                    labels.labels[j] = Label::Artefact;
                    self.open.push(j);
                }
            }
        }
    }
}

/// Points above, below, to the left and to the right of point `i`, as far as the image has them.
fn direct_neighbours(i: usize, height: usize, count: usize) -> impl Iterator<Item = usize> {
    let row = i % height;
    let above = (row > 0).then(|| i - 1);
    let below = (row + 1 < height).then(|| i + 1);
    let right = (i + height < count).then_some(i + height);
    [above, below, i.checked_sub(height), right].into_iter().flatten()
}

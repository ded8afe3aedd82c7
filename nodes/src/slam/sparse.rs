use nalgebra::{Matrix3, Vector3};

/// Sparse symmetric positive definite matrix of 3×3 blocks, and its Cholesky factor.
///
/// Variables are eliminated in the order of minimum degree, which also determines the structure of the factor.
#[derive(Debug, Clone, Default)]
pub(super) struct BlockMatrix {
    /// Elimination step of each variable.
    step: Vec<usize>,
    /// Start of the column of each step in `rows` and `lower`, with one more entry at the end.
    starts: Vec<usize>,
    /// Rows (as steps) of the blocks below the diagonal, ascending in each column.
    rows: Vec<usize>,
    lower: Vec<Matrix3<f64>>,
    diagonal: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// Creates a zero matrix with storage for the blocks of these pairs of variables, and for the fill-in of the
    /// factor.
    pub fn new(variables: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        let mut neighbours = vec![Vec::new(); variables];
        for (a, b) in pairs.filter(|(a, b)| a != b) {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        for list in &mut neighbours {
            list.sort_unstable();
            list.dedup();
        }
        let order = eliminate(&mut neighbours);
        let mut step = vec![0; variables];
        order.iter().enumerate().for_each(|(at, &variable)| step[variable] = at);
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for variable in order {
            let first = rows.len();
            rows.extend(neighbours[variable].iter().map(|&other| step[other]));
            rows[first..].sort_unstable();
            starts.push(rows.len());
        }
        let (lower, diagonal) = (vec![Matrix3::zeros(); rows.len()], vec![Matrix3::zeros(); variables]);
        Self { step, starts, rows, lower, diagonal }
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        self.lower.fill(Matrix3::zeros());
        self.diagonal.fill(Matrix3::zeros());
    }

    /// Adds to a block of the diagonal.
    pub fn add_diagonal(&mut self, variable: usize, block: &Matrix3<f64>) {
        self.diagonal[self.step[variable]] += block;
    }

    /// Adds to the block in the row of one variable and the column of another, and to its mirror image.
    ///
    /// Only pairs that were passed to [`new`](Self::new) have storage.
    pub fn add(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        let (row, column) = (self.step[row], self.step[column]);
        if row > column {
            let at = self.place(row, column);
            self.lower[at] += block;
        } else {
            let at = self.place(column, row);
            self.lower[at] += block.transpose();
        }
    }

    /// Adds `least` to each entry of the diagonal of the matrix.
    pub fn damp(&mut self, least: f64) {
        for block in &mut self.diagonal {
            *block += Matrix3::identity() * least;
        }
    }

    /// Replaces the matrix A by its factor L with L Lᵀ = A. Returns `None` if A is not positive definite.
    pub fn factorize(&mut self) -> Option<()> {
        for k in 0..self.diagonal.len() {
            let factor = self.diagonal[k].cholesky()?.l();
            self.diagonal[k] = factor;
            let column = self.starts[k]..self.starts[k + 1];
            for block in &mut self.lower[column.clone()] {
                // L_ik = A_ik L_kk⁻ᵀ, by rows.
                *block = factor.solve_lower_triangular(&block.transpose())?.transpose();
            }
            for at in column.clone() {
                self.subtract_from_column(self.rows[at], at, column.end);
            }
        }
        Some(())
    }

    /// Subtracts L_ik L_jkᵀ from column j, for all rows i at `from..end` of column k, the first of which is j.
    fn subtract_from_column(&mut self, j: usize, from: usize, end: usize) {
        let transposed = self.lower[from].transpose();
        self.diagonal[j] -= self.lower[from] * transposed;
        let mut target = self.starts[j];
        for at in from + 1..end {
            // The rows of both columns ascend, and all rows of this column exist in the other.
            while self.rows[target] != self.rows[at] {
                target += 1;
            }
            let product = self.lower[at] * transposed;
            self.lower[target] -= product;
        }
    }

    /// Solves A x = b with the factor, in place; `b` is in the order of the variables.
    pub fn solve(&self, b: &mut [Vector3<f64>]) {
        let mut x = vec![Vector3::zeros(); b.len()];
        self.step.iter().zip(b.iter()).for_each(|(&step, value)| x[step] = *value);
        for k in 0..x.len() {
            x[k] = self.diagonal[k].solve_lower_triangular(&x[k]).unwrap_or_default();
            for at in self.starts[k]..self.starts[k + 1] {
                let product = self.lower[at] * x[k];
                x[self.rows[at]] -= product;
            }
        }
        for k in (0..x.len()).rev() {
            for at in self.starts[k]..self.starts[k + 1] {
                let product = self.lower[at].tr_mul(&x[self.rows[at]]);
                x[k] -= product;
            }
            x[k] = self.diagonal[k].tr_solve_lower_triangular(&x[k]).unwrap_or_default();
        }
        self.step.iter().zip(b).for_each(|(&step, value)| *value = x[step]);
    }

    fn place(&self, row: usize, column: usize) -> usize {
        let range = self.starts[column]..self.starts[column + 1];
        range.start + self.rows[range].partition_point(|&r| r < row)
    }
}

/// Minimum-degree elimination: removes the variables from the graph of a matrix, always one with the fewest neighbours,
/// which then become neighbours of each other. Returns the order. Afterwards, `neighbours` contains the neighbours of
/// each variable at its removal.
fn eliminate(neighbours: &mut [Vec<usize>]) -> Vec<usize> {
    let mut left: std::collections::BTreeSet<(usize, usize)> =
        neighbours.iter().enumerate().map(|(variable, list)| (list.len(), variable)).collect();
    let mut order = Vec::with_capacity(neighbours.len());
    while let Some((_, variable)) = left.pop_first() {
        order.push(variable);
        let front = std::mem::take(&mut neighbours[variable]);
        for &other in &front {
            left.remove(&(neighbours[other].len(), other));
            let merged = merge(&neighbours[other], &front);
            neighbours[other] = merged.filter(|&v| v != variable && v != other).collect();
            left.insert((neighbours[other].len(), other));
        }
        neighbours[variable] = front;
    }
    order
}

/// Union of two ascending lists.
fn merge<'a>(a: &'a [usize], b: &'a [usize]) -> impl Iterator<Item = usize> + 'a {
    let (mut a, mut b) = (a.iter().copied().peekable(), b.iter().copied().peekable());
    std::iter::from_fn(move || match (a.peek(), b.peek()) {
        (Some(x), Some(y)) if x == y => {
            b.next();
            a.next()
        }
        (Some(x), Some(y)) if x > y => b.next(),
        (None, _) => b.next(),
        _ => a.next(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of eight variables with one chord.
    const PAIRS: [(usize, usize); 9] = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 0), (1, 5)];

    fn block(a: usize, b: usize) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| ((a * 31 + b * 17 + i * 7 + j * 3) as f64).sin())
    }

    fn matrix(diagonal: f64) -> BlockMatrix {
        let mut matrix = BlockMatrix::new(8, PAIRS.into_iter());
        PAIRS.iter().for_each(|&(a, b)| matrix.add(a, b, &block(a, b)));
        (0..8).for_each(|v| matrix.add_diagonal(v, &(Matrix3::identity() * diagonal)));
        matrix
    }

    #[test]
    fn what_is_solved_is_the_matrix_that_was_filled() {
        let mut matrix = matrix(12.0);
        matrix.factorize().expect("the diagonal dominates");
        let x: Vec<_> = (0..8).map(|v| Vector3::new(v as f64, 1.0, -2.0 * v as f64)).collect();
        let mut b: Vec<_> = x.iter().map(|x| x * 12.0).collect();
        for (row, column) in PAIRS {
            b[row] += block(row, column) * x[column];
            b[column] += block(row, column).transpose() * x[row];
        }
        matrix.solve(&mut b);
        assert!(x.iter().zip(&b).all(|(x, b)| (x - b).norm() < 1e-9));
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        assert_eq!(matrix(0.1).factorize(), None);
        assert_eq!(matrix(f64::NAN).factorize(), None);
    }

    #[test]
    fn a_chain_needs_no_more_blocks_than_it_has() {
        let chain = BlockMatrix::new(100, (1..100).map(|v| (v - 1, v)));
        assert_eq!(chain.rows.len(), 99);
    }
}

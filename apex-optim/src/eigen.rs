/// Eigenvalues, and eigenvectors by column, of a symmetric `n` × `n` matrix, by Jacobi's method (Golub and Van Loan,
/// Matrix Computations, 8.5). Uses only operations that IEEE 754 determines to the bit.
pub(super) fn eigen(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix.to_vec();
    let mut v = vec![0.0; n * n];
    (0..n).for_each(|i| v[i * n + i] = 1.0);
    let total: f64 = a.iter().map(|x| x * x).sum();
    for _ in 0..50 {
        let outside: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i * n + j].powi(2)).sum();
        if outside.is_nan() || outside <= 1e-32 * total {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, &mut v, n, p, q);
            }
        }
    }
    ((0..n).map(|i| a[i * n + i]).collect(), v)
}

/// Rotates the axes `p` and `q` so that the element between them vanishes.
fn rotate(a: &mut [f64], v: &mut [f64], n: usize, p: usize, q: usize) {
    let between = a[p * n + q];
    if between == 0.0 {
        return;
    }
    let ratio = (a[q * n + q] - a[p * n + p]) / (2.0 * between);
    let tangent = ratio.signum() / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
    let cos = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sin = tangent * cos;
    let turn = |m: &mut [f64], i: usize, j: usize| (m[i], m[j]) = (cos * m[i] - sin * m[j], sin * m[i] + cos * m[j]);
    (0..n).for_each(|k| turn(a, k * n + p, k * n + q));
    (0..n).for_each(|k| turn(a, p * n + k, q * n + k));
    (0..n).for_each(|k| turn(v, k * n + p, k * n + q));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    #[test]
    fn a_matrix_is_the_product_of_its_parts() {
        let (n, mut random) = (7, Random::new(3));
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..=i {
                a[i * n + j] = random.standard_normal();
                a[j * n + i] = a[i * n + j];
            }
        }
        let (values, v) = eigen(&a, n);
        for i in 0..n {
            for j in 0..n {
                let product: f64 = (0..n).map(|k| v[i * n + k] * values[k] * v[j * n + k]).sum();
                let unit: f64 = (0..n).map(|k| v[i * n + k] * v[j * n + k]).sum();
                assert!((product - a[i * n + j]).abs() < 1e-12);
                assert!((unit - f64::from(u8::from(i == j))).abs() < 1e-12);
            }
        }
    }
}

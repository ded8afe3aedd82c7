/// Runs `body` for all `items` and returns the results in order, without `None`. `make` creates the local state of
/// `body` for each thread. Without the feature `parallel` the items run in sequence, with the same results.
#[cfg(feature = "parallel")]
pub fn par_map<T: Sync, L, R: Send>(
    items: &[T],
    make: impl Fn() -> L + Send + Sync,
    body: impl Fn(&mut L, &T) -> Option<R> + Send + Sync,
) -> impl Iterator<Item = R> {
    use rayon::prelude::*;
    let results: alloc::vec::Vec<Option<R>> = items.par_iter().map_init(make, body).collect();
    results.into_iter().flatten()
}

/// Runs `body` for all `items` and returns the results in order, without `None`. `make` creates the local state of
/// `body`.
#[cfg(not(feature = "parallel"))]
#[inline]
pub fn par_map<T: Sync, L, R: Send>(
    items: &[T],
    make: impl Fn() -> L + Send + Sync,
    body: impl Fn(&mut L, &T) -> Option<R> + Send + Sync,
) -> impl Iterator<Item = R> {
    let mut local = make();
    items.iter().filter_map(move |item| body(&mut local, item))
}

//! Access to the tokens of multi-rate connections.

/// The `N` tokens of firing `firing`, from a buffer in which every token is present.
#[inline(always)]
pub fn chunk<T, const N: usize>(buffer: &[T], firing: usize) -> &[T; N] {
    &buffer.as_chunks::<N>().0[firing]
}

/// The `N` tokens of firing `firing`, from a buffer in which a token may be ⊥; `None` if one of them is.
#[inline(always)]
pub fn gather<T: Clone, const N: usize>(buffer: &[Option<T>], firing: usize) -> Option<[T; N]> {
    let tokens = &buffer[firing * N..][..N];
    if tokens.iter().any(Option::is_none) {
        return None;
    }
    let mut present = tokens.iter().flatten();
    // Never `None`: all `N` tokens are present.
    let mut next = || present.next().cloned();
    let first: [Option<T>; N] = core::array::from_fn(|_| next());
    collect(first)
}

fn collect<T, const N: usize>(tokens: [Option<T>; N]) -> Option<[T; N]> {
    let mut tokens = tokens;
    if tokens.iter().any(Option::is_none) {
        return None;
    }
    Some(core::array::from_fn(|i| match tokens[i].take() {
        Some(token) => token,
        None => unreachable!("checked above"),
    }))
}

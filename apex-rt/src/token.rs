//! Functions on tokens that generated code calls.

use crate::{Explains, Observer, ParamField};
use core::fmt::Debug;

/// Returns copies of the `N` tokens of firing `firing` at a port that takes `N` at once; `None` if one of them is ⊥.
#[inline(always)]
pub fn gather<T, const N: usize>(tokens: &[Option<T>], firing: usize, copy: impl Fn(&T) -> T) -> Option<[T; N]> {
    let mut gathered: [Option<T>; N] = [const { None }; N];
    for (to, from) in gathered.iter_mut().zip(&tokens[firing * N..]) {
        *to = Some(copy(from.as_ref()?));
    }
    // Never `None` here: every place was filled above.
    gathered.iter().all(Option::is_some).then(|| gathered.map(|token| token.unwrap_or_else(|| unreachable!())))
}

/// Puts the `N` tokens that firing `firing` sent at once into their places.
#[inline(always)]
pub fn spread<T, const N: usize>(places: &mut [Option<T>], firing: usize, tokens: [T; N]) {
    for (place, token) in places[firing * N..].iter_mut().zip(tokens) {
        *place = Some(token);
    }
}

/// Stores a copy of a token. The storage of the previous one is reused.
#[inline(always)]
pub fn store<T: Clone>(place: &mut Option<T>, token: Option<&T>) {
    match (place, token) {
        (Some(old), Some(new)) => old.clone_from(new),
        (place, new) => *place = new.cloned(),
    }
}

/// Sets a parameter of a node, unless the value is out of its range.
#[inline]
pub fn set_param<const I: usize, N, O>(
    node: &mut N,
    value: &N::Value,
    index: usize,
    name: &'static str,
    observer: &mut O,
) where
    N: ParamField<I, Value: Clone + Debug>,
    O: Observer,
{
    if N::accepts(value) {
        node.field().clone_from(value);
    } else {
        observer.refused(index, name, value);
    }
}

/// Returns the value of a function node's parameter that arrives as a token; `None` if it is out of its range.
#[inline]
pub fn checked_param<const I: usize, N, O>(
    value: &N::Value,
    index: usize,
    name: &'static str,
    observer: &mut O,
) -> Option<N::Value>
where
    N: crate::Param<I, Value: Clone + Debug>,
    O: Observer,
{
    if N::accepts(value) {
        return Some(value.clone());
    }
    observer.refused(index, name, value);
    None
}

/// Returns the token that a node which may fail sends. An error is reported, and becomes ⊥.
#[inline(always)]
pub fn sent<T, E: Explains, O: Observer>(result: Result<T, E>, index: usize, observer: &mut O) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            observer.failed(index, &error);
            None
        }
    }
}

/// Delay by `N` iterations: a token that is put in comes out `N` iterations later.
#[derive(Debug, Clone)]
pub struct Delay<T, const N: usize> {
    tokens: [Option<T>; N],
    at: usize,
}

impl<T, const N: usize> Delay<T, N> {
    /// Returns a delay that sends the tokens of `initial` first.
    pub const fn new(initial: [Option<T>; N]) -> Self {
        Self { tokens: initial, at: 0 }
    }

    /// Takes the oldest token out.
    #[inline(always)]
    pub fn take(&mut self) -> Option<T> {
        self.tokens[self.at].take()
    }

    /// Takes out the token that is `ahead` iterations younger than the oldest.
    #[inline(always)]
    pub fn take_at(&mut self, ahead: usize) -> Option<T> {
        self.tokens[(self.at + ahead) % N].take()
    }

    /// Returns `true` if the delay holds a token.
    pub fn holds_any(&self) -> bool {
        self.tokens.iter().any(Option::is_some)
    }

    /// Takes all tokens out.
    pub fn clear(&mut self) {
        self.tokens.iter_mut().for_each(|token| *token = None);
    }

    /// Puts the token of this iteration in.
    #[inline(always)]
    pub fn put(&mut self, token: Option<T>) {
        self.tokens[self.at] = token;
        self.at = (self.at + 1) % N;
    }
}

//! Tokens as text, for generated code: of any type, whether it has `Debug` or not.

use std::{borrow::ToOwned as _, fmt::Debug, format, string::String};

/// Wrapper that shows a token as text, even if its type has no `Debug`.
pub struct Shown<'a, T>(pub &'a T);

/// Text of tokens with `Debug`.
pub trait ByDebug {
    /// Returns the token as text.
    fn shown(&self) -> String;
}

impl<T: Debug> ByDebug for Shown<'_, T> {
    fn shown(&self) -> String {
        format!("{:?}", self.0)
    }
}

/// Text of all other tokens.
pub trait ByType {
    /// Returns the token as text.
    fn shown(&self) -> String;
}

impl<T> ByType for &Shown<'_, T> {
    fn shown(&self) -> String {
        "a token".to_owned()
    }
}

//! The types of a node's ports and parameters, as associated types: `#[node]` writes these implementations,
//! and generated code names the type of a token through them, so that it never has to spell a user's type.

use crate::params::Declared;

/// Input number `I` of a node.
pub trait Input<const I: usize> {
    /// The type of one token.
    type Token: ?Sized;
}

/// Output number `I` of a node. The returned value comes after all `&mut Out<T>`.
pub trait Output<const I: usize> {
    /// The type of one token.
    type Token;
}

/// Slot number `I` of a node.
pub trait Slot<const I: usize> {
    /// The type of one token.
    type Token: ?Sized;
}

/// Event number `I` of a node.
pub trait Trigger<const I: usize> {
    /// The type of one token.
    type Token;
}

/// Field number `I` of a `#[derive(Outputs)]` struct.
pub trait Field<const I: usize> {
    /// The type of one token.
    type Token;
}

/// Parameter number `I` of a node.
pub trait Param<const I: usize> {
    /// The type of the value.
    type Value;

    /// Returns `true` if `value` is in the declared range.
    fn accepts(value: &Self::Value) -> bool;
}

/// A parameter that the node stores in a field, so that it can change at run time.
pub trait ParamField<const I: usize>: Param<I> {
    /// Returns the field.
    fn field(&mut self) -> &mut Self::Value;
}

/// The parameters of a node.
pub trait Params {
    /// Their units and ranges, in the order of their declaration.
    const DECLARED: &'static [Declared];
}

/// A node that a graph can construct from the values of its parameters, in the order of their declaration.
pub trait Construct<Params> {
    /// Returns the node. All its other state has its default.
    fn construct(params: Params) -> Self;
}

/// Constructs a node from the tuple of its parameters.
#[doc(hidden)]
pub fn construct<N: Construct<Params>, Params>(params: Params) -> N {
    N::construct(params)
}

/// State with an initial value: every type with a `Default`.
///
/// The lifetime only defers the check. A bound `for<'a> State: Fresh<'a>` is checked where a node is constructed, not
/// where its type is declared, so that a node that is passed to the program needs no default.
pub trait Fresh<'a>: Sized {
    /// Returns the initial value.
    fn fresh() -> Self;
}

impl<T: Default> Fresh<'_> for T {
    #[inline]
    fn fresh() -> Self {
        T::default()
    }
}

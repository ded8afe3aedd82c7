//! The types of a node's ports and parameters, as associated types: `#[node]` writes these implementations,
//! and generated code names the type of a token through them, so that it never has to spell a user's type.

/// Input number `I` of a node takes tokens of this type.
pub trait Input<const I: usize> {
    /// The type of one token.
    type Token: ?Sized;
}

/// Output number `I` of a node sends tokens of this type. The returned value comes after all `&mut Out<T>`.
pub trait Output<const I: usize> {
    /// The type of one token.
    type Token;
}

/// Slot number `I` of a node takes tokens of this type.
pub trait Slot<const I: usize> {
    /// The type of one token.
    type Token: ?Sized;
}

/// Event number `I` of a node carries tokens of this type.
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

    /// Whether `value` lies in the declared range.
    fn accepts(value: &Self::Value) -> bool;
}

/// A parameter that the node keeps in a field, so that it can change at run time.
pub trait ParamField<const I: usize>: Param<I> {
    /// The field.
    fn field(&mut self) -> &mut Self::Value;
}

/// A node that a graph can make from the values of its parameters, in the order of their declaration.
pub trait Construct<Params> {
    /// The node with all its other state at its default.
    fn construct(params: Params) -> Self;
}

/// A node from its parameters, which are a tuple in their order.
#[doc(hidden)]
pub fn construct<N: Construct<Params>, Params>(params: Params) -> N {
    N::construct(params)
}

/// State that has a value to start with: everything with a `Default`.
///
/// The lifetime has no meaning of its own. A bound `for<'a> State: Fresh<'a>` is checked where a node is made, not
/// where its type is declared, so that a node that is only handed in needs no default.
pub trait Fresh<'a>: Sized {
    /// The value to start with.
    fn fresh() -> Self;
}

impl<T: Default> Fresh<'_> for T {
    #[inline]
    fn fresh() -> Self {
        T::default()
    }
}

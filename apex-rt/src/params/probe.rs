//! Access to parameters of any type, for generated code. It calls `visit` on a [`Probe`], which is [`Known::visit`] if
//! the type is a [`ParamValue`], and [`Opaque::visit`] otherwise, because rustc tries a value before a reference to it.

use super::{Access, IntoParam as _, ParamInfo, ParamRange, ParamRef, ParamValue, ParamVisitor, Rejection};
use crate::{Param, ParamField};

/// Parameter number `I` of a node, with the range that it has in its program.
pub struct Probe<'a, N, const I: usize>(&'a mut N, ParamRange);

impl<'a, N, const I: usize> Probe<'a, N, I> {
    /// Returns the probe of a parameter of `node`.
    pub fn new(node: &'a mut N) -> Self {
        Self(node, ParamRange::new(None, None, true))
    }
}

impl<N, const I: usize> Access for Probe<'_, N, I>
where
    N: ParamField<I>,
    <N as Param<I>>::Value: ParamValue,
{
    fn get(&mut self) -> ParamRef<'_> {
        self.0.field().give()
    }

    fn check(&self, value: ParamRef<'_>) -> Result<(), Rejection> {
        accepted(value, N::accepts, &self.1).map(drop)
    }

    fn set(&mut self, value: ParamRef<'_>) -> Result<(), Rejection> {
        *self.0.field() = accepted(value, N::accepts, &self.1)?;
        Ok(())
    }
}

/// Returns the value for a parameter that accepts it.
///
/// It depends on the type of the value alone, so that it is compiled once for all parameters of that type.
fn accepted<V: ParamValue>(given: ParamRef<'_>, accepts: fn(&V) -> bool, range: &ParamRange) -> Result<V, Rejection> {
    let value = V::take(given)?;
    if accepts(&value) && holds(range, &given) { Ok(value) } else { Err(Rejection::Range) }
}

/// Returns `true` if a number is in a range, or all numbers of a list are. Other values are in every range.
fn holds(range: &ParamRange, given: &ParamRef<'_>) -> bool {
    match *given {
        ParamRef::Integer(value) => range.has(value as f64),
        ParamRef::Float(value) => range.has(value),
        ParamRef::Single(value) => {
            let [min, max] = [range.min, range.max].map(|bound| bound.map(|bound| f64::from(bound as f32)));
            ParamRange { min, max, ..*range }.has(value.into())
        }
        ParamRef::List(list) => (0..list.count()).all(|index| holds(range, &list.element(index))),
        ParamRef::Bool(_) | ParamRef::Text(_) | ParamRef::Other(_) => true,
    }
}

/// A parameter whose type is a [`ParamValue`].
pub trait Known {
    /// Passes the parameter to `visitor`, with access.
    fn visit(self, info: &'static ParamInfo, visitor: &mut dyn ParamVisitor);
}

impl<N, const I: usize> Known for Probe<'_, N, I>
where
    N: ParamField<I>,
    <N as Param<I>>::Value: ParamValue,
{
    fn visit(mut self, info: &'static ParamInfo, visitor: &mut dyn ParamVisitor) {
        self.1 = info.range;
        visitor.param(info, Some(&mut self));
    }
}

/// A parameter of any other type.
pub trait Opaque {
    /// Passes the parameter to `visitor`, without access.
    fn visit(self, info: &'static ParamInfo, visitor: &mut dyn ParamVisitor);
}

impl<N, const I: usize> Opaque for &Probe<'_, N, I> {
    fn visit(self, info: &'static ParamInfo, visitor: &mut dyn ParamVisitor) {
        visitor.param(info, None);
    }
}

/// Visits parameters of a node: those with these numbers. The first has the row `$first` of the table.
#[doc(hidden)]
#[macro_export]
macro_rules! visit_params {
    ($visitor:ident, $table:expr, $first:literal, $node:expr, $($param:literal)*) => {
        $($crate::params::Probe::<_, $param>::new(&mut $node).visit(&$table[$first + $param], $visitor);)*
    };
}

//! Parameters of a running program: a table of all of them, and access to each by name.
//!
//! The table has the parameters of struct nodes, with the name of the node: `fast.planner.speed`. Function nodes have
//! no state: their parameters are part of the code.

mod any;
mod error;
#[cfg(feature = "params")]
mod file;
#[cfg(feature = "std")]
mod given;
mod info;
#[cfg(feature = "params")]
mod keep;
mod probe;
#[cfg(feature = "studio")]
mod room;
#[cfg(feature = "params")]
mod run;
#[cfg(feature = "params")]
mod text;
mod value;

pub(crate) use any::AnyParams;
pub use error::{ParamError, Rejection};
#[cfg(feature = "params")]
pub use file::{load_file, save_file};
#[cfg(feature = "std")]
pub(crate) use given::{Given, MAX_VALUE};
#[doc(hidden)]
pub use info::Declared;
pub use info::{ParamInfo, ParamRange};
#[doc(hidden)]
pub use probe::{Known, Opaque, Probe};
#[cfg(feature = "studio")]
pub(crate) use room::room;
#[cfg(feature = "params")]
#[doc(hidden)]
pub use run::run_with_files;
#[cfg(feature = "params")]
pub(crate) use text::parsed;
#[cfg(feature = "params")]
pub use text::{LoadError, Problem, load, not_saved, save, set_text};
pub use value::{GivenList, IntoParam, ParamRef, ParamValue};

/// Access to the value of one parameter.
///
/// ```
/// use apex_rt::{
///     params::{Access, IntoParam, ParamInfo, ParamVisitor},
///     prelude::*,
/// };
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// /// Sets all parameters to zero that may be zero.
/// struct ToZero;
///
/// impl ParamVisitor for ToZero {
///     fn param(&mut self, _info: &'static ParamInfo, access: Option<&mut dyn Access>) {
///         if let Some(access) = access.filter(|access| access.check(0u8.give()).is_ok()) {
///             assert_eq!(access.set(0u8.give()), Ok(()));
///         }
///     }
/// }
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// smooth.visit_params(&mut ToZero);
/// assert_eq!(smooth.param("filter.weight"), Ok(0.0));
/// # }
/// ```
pub trait Access {
    /// Returns the value.
    fn get(&mut self) -> ParamRef<'_>;

    /// Checks if `value` can be set.
    ///
    /// # Errors
    /// The value is of another type, or out of range.
    fn check(&self, value: ParamRef<'_>) -> Result<(), Rejection>;

    /// Sets the value.
    ///
    /// # Errors
    /// The errors of [`Access::check`]; the parameter then keeps its value.
    fn set(&mut self, value: ParamRef<'_>) -> Result<(), Rejection>;
}

/// Visitor of the parameters of a program.
///
/// ```
/// use apex_rt::{
///     params::{Access, ParamInfo, ParamVisitor},
///     prelude::*,
/// };
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// /// Lists parameters with their values.
/// #[derive(Default)]
/// struct Values(Vec<String>);
///
/// impl ParamVisitor for Values {
///     fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
///         self.0.extend(access.map(|access| format!("{} = {}", info.name, access.get())));
///     }
/// }
///
/// # fn main() {
/// let mut values = Values::default();
/// Smooth::new().visit_params(&mut values);
/// assert_eq!(values.0, ["filter.weight = 0.5"]);
/// # }
/// ```
pub trait ParamVisitor {
    /// Visits one parameter. `access` is `None` if its type is not a [`ParamValue`].
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>);
}

/// The parameters of a compiled graph, or of one of its thread groups.
///
/// ```
/// use apex_macros::graph;
/// use apex_rt::prelude::*;
///
/// graph! {
///     use apex_nodes::math::LowPass;
///
///     graph Smooth {
///         in  x: f64;
///         out y: f64;
///
///         node filter = LowPass(weight = 0.5);
///         x -> filter -> y;
///     }
/// }
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// assert_eq!(smooth.param("filter.weight"), Ok(0.5));
/// assert_eq!(smooth.set_param("filter.weight", 0.25), Ok(()));
/// let error = smooth.set_param("filter.weight", 2.0).expect_err("the largest weight is 1");
/// assert_eq!(error.to_string(), "the value of `filter.weight` is out of range: its range is 0..=1");
/// # }
/// ```
pub trait Parameters {
    /// All parameters of all struct nodes of the graph, in the order of the source file.
    const PARAMS: &'static [ParamInfo] = &[];

    /// Passes the parameters to `visitor`, in the order of [`Parameters::PARAMS`]; of a thread group, those of its
    /// nodes.
    fn visit_params(&mut self, visitor: &mut dyn ParamVisitor) {
        let _ = visitor;
    }

    /// Returns the value of the parameter `name`.
    ///
    /// # Errors
    /// A parameter that does not exist or is of another type.
    fn param<T: ParamValue>(&mut self, name: &str) -> Result<T, ParamError> {
        let mut program = self;
        at(&mut program, name, &mut |access| T::take(access.get()))
    }

    /// Sets the parameter `name` to `value` from the next firing on. The value is in SI units; a time is a
    /// [`Duration`](core::time::Duration) or a number of seconds.
    ///
    /// # Errors
    /// A parameter that does not exist or is of another type, or a value out of its range. Tokens at the port of the
    /// parameter are checked in the same way. The parameter keeps its value.
    fn set_param(&mut self, name: &str, value: impl IntoParam) -> Result<(), ParamError> {
        let mut program = self;
        at(&mut program, name, &mut |access| access.set(value.give()))
    }
}

impl<P: Parameters + ?Sized> Parameters for &mut P {
    const PARAMS: &'static [ParamInfo] = P::PARAMS;

    fn visit_params(&mut self, visitor: &mut dyn ParamVisitor) {
        (**self).visit_params(visitor);
    }
}

/// Returns the parameter `name` of `params`.
///
/// # Errors
/// There is none of this name.
pub(crate) fn find(params: &'static [ParamInfo], name: &str) -> Result<&'static ParamInfo, ParamError> {
    let unknown = || ParamError::Unknown { nearest: error::nearest(name, params.iter().map(|p| p.name)) };
    params.iter().find(|param| param.name == name).ok_or_else(unknown)
}

/// Sets the parameter `name` as [`Parameters::set_param`] does.
#[cfg(feature = "record")]
pub(crate) fn set(program: &mut dyn AnyParams, name: &str, value: &Given) -> Result<(), ParamError> {
    at(program, name, &mut |access| access.set(value.give()))
}

/// Operation on a parameter.
type Act<'a, T> = &'a mut dyn FnMut(&mut dyn Access) -> Result<T, Rejection>;

/// Visitor that applies `act` to the parameter `name`.
struct At<'a, T> {
    name: &'a str,
    act: Act<'a, T>,
    result: Option<Result<T, ParamError>>,
}

impl<T> ParamVisitor for At<'_, T> {
    fn param(&mut self, param: &'static ParamInfo, access: Option<&mut dyn Access>) {
        if param.name == self.name {
            let result = access.map_or(Err(Rejection::Opaque), |access| (self.act)(access));
            self.result = Some(result.map_err(|refusal| ParamError::Refused { param, refusal }));
        }
    }
}

fn at<T>(program: &mut dyn AnyParams, name: &str, act: Act<'_, T>) -> Result<T, ParamError> {
    let param = find(program.list(), name)?;
    let mut at = At { name, act, result: None };
    program.visit(&mut at);
    at.result.unwrap_or(Err(ParamError::Refused { param, refusal: Rejection::Opaque }))
}

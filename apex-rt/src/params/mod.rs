//! Parameters of a running program: a table of all, and access to each by its name.
//!
//! Those of struct nodes are there, by the name of the node and their own: `fast.planner.speed`. Function nodes keep
//! nothing; their parameters are part of the code.

mod error;
#[cfg(feature = "params")]
mod file;
#[cfg(feature = "params")]
mod keep;
mod probe;
#[cfg(feature = "params")]
mod run;
#[cfg(feature = "params")]
mod text;
mod value;

pub use error::{ParamError, Rejection};
#[cfg(feature = "params")]
pub use file::{load_file, save_file};
#[doc(hidden)]
pub use probe::{Known, Opaque, Probe};
#[cfg(feature = "params")]
pub use run::run_with_files;
#[cfg(feature = "params")]
pub use text::{LoadError, Problem, load, not_saved, save, set_text};
pub use value::{GivenList, IntoParam, ParamRef, ParamValue};

use core::fmt;

/// A parameter of a program.
#[derive(Debug, PartialEq)]
pub struct ParamInfo {
    /// Its name after that of its node: `fast.planner.speed`.
    pub name: &'static str,
    /// Its type, as its declaration spells it.
    pub ty: &'static str,
    /// The unit of its numbers, which is one of SI.
    pub unit: Option<&'static str>,
    /// The values that it may have, as far as they are known.
    pub range: ParamRange,
}

/// The range of a parameter, as far as the compiler knows it: bounds that are no plain numbers are missing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamRange {
    /// The smallest value.
    pub min: Option<f64>,
    /// The largest value.
    pub max: Option<f64>,
    /// Whether the largest value itself belongs to the range.
    pub inclusive: bool,
}

impl ParamInfo {
    /// One row of the table.
    pub const fn new(name: &'static str, ty: &'static str, unit: Option<&'static str>, range: ParamRange) -> Self {
        Self { name, ty, unit, range }
    }
}

impl ParamRange {
    /// From its bounds.
    pub const fn new(min: Option<f64>, max: Option<f64>, inclusive: bool) -> Self {
        Self { min, max, inclusive }
    }

    /// Whether there is anything to say about it.
    pub const fn is_known(&self) -> bool {
        self.min.is_some() || self.max.is_some()
    }
}

impl fmt::Display for ParamRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(min) = self.min {
            write!(f, "{min}")?;
        }
        f.write_str(if self.inclusive && self.max.is_some() { "..=" } else { ".." })?;
        self.max.map_or(Ok(()), |max| write!(f, "{max}"))
    }
}

/// Access to the value of one parameter.
pub trait Access {
    /// The value that it has.
    fn get(&mut self) -> ParamRef<'_>;

    /// Whether `value` could be set.
    ///
    /// # Errors
    /// Says why not: another type, or out of its range.
    fn check(&self, value: ParamRef<'_>) -> Result<(), Rejection>;

    /// Sets it.
    ///
    /// # Errors
    /// Those of [`Access::check`]; then it keeps the value that it has.
    fn set(&mut self, value: ParamRef<'_>) -> Result<(), Rejection>;
}

/// Sees the parameters of a program one after the other.
pub trait ParamVisitor {
    /// One parameter; `None` if its type is no [`ParamValue`].
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>);
}

/// The parameters of a compiled graph.
pub trait Parameters {
    /// All parameters of all struct nodes, in the order of the text.
    const PARAMS: &'static [ParamInfo];

    /// Shows all parameters to `visitor`, in the order of [`Parameters::PARAMS`].
    fn visit_params<V: ParamVisitor>(&mut self, visitor: &mut V);

    /// The value of the parameter `name`.
    ///
    /// # Errors
    /// There is no such parameter, or it is of another type.
    fn param<T: ParamValue>(&mut self, name: &str) -> Result<T, ParamError> {
        at::<Self, T>(self, name, &mut |access| T::take(access.get()))
    }

    /// Sets the parameter `name` to `value` (in SI, a [`Duration`](core::time::Duration) or a number of seconds
    /// for a time), from the next firing on.
    ///
    /// # Errors
    /// There is no such parameter, it is of another type, or the value is out of its range; this is the check that
    /// tokens at the port of the parameter pass, too. The parameter keeps the value that it has.
    fn set_param(&mut self, name: &str, value: impl IntoParam) -> Result<(), ParamError> {
        at::<Self, ()>(self, name, &mut |access| access.set(value.give()))
    }
}

/// What `act` does with a parameter.
type Act<'a, T> = &'a mut dyn FnMut(&mut dyn Access) -> Result<T, Rejection>;

/// Looks for the parameter `name`.
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

fn at<P: Parameters + ?Sized, T>(program: &mut P, name: &str, act: Act<'_, T>) -> Result<T, ParamError> {
    let mut at = At { name, act, result: None };
    program.visit_params(&mut at);
    at.result
        .unwrap_or_else(|| Err(ParamError::Unknown { nearest: error::nearest(name, P::PARAMS.iter().map(|p| p.name)) }))
}

//! Values that are passed on from the parameters of a graph to those of its nodes, and what is known of them.

use super::{condition::names_in, declared::range, scope::Scope};
use crate::{
    catalog::{Limits, ParamSig, Signature},
    report::Diagnostic,
    source::Span,
    syntax::tree::{Arg, Expr, ExprKind, ParamItem},
};
use std::collections::{BTreeMap, BTreeSet};

/// Origin of a parameter's value that is passed on.
#[derive(Debug, Clone)]
pub struct Origin {
    /// The value as written.
    given: Span,
    /// The parameter of the graph that passes the value on.
    declared: Span,
    /// Ranges of that parameter, and of those from which it has its value.
    ranges: Vec<Limits>,
}

/// Origins of the values of a graph's parameters.
pub type Origins = BTreeMap<String, Origin>;

/// Origins of the values of `params`: arguments in `args`, which may name parameters of the graph around, or defaults.
/// `inside` has the values.
pub fn origins(params: &[ParamItem], args: &[Arg], around: &Origins, inside: &Scope<'_>) -> Origins {
    let of_param = |param: &ParamItem| {
        let arg = argument(args, &param.name.text);
        let value = arg.or(param.default.as_ref())?;
        let handed = arg.and_then(only_param).and_then(|name| around.get(name));
        let given = handed.map_or(value.span, |origin| origin.given);
        // A mistake in it has been reported.
        let own = range(param, inside).ok().flatten();
        let ranges = own.into_iter().chain(handed.into_iter().flat_map(|origin| origin.ranges.clone())).collect();
        Some((param.name.text.clone(), Origin { given, declared: param.name.span, ranges }))
    };
    params.iter().filter_map(of_param).collect()
}

/// Ranges of the graph's parameters that a node gets as they are, for each of its parameters.
pub fn passed_on(signature: &Signature, args: &[Arg], origins: &Origins) -> Vec<Vec<Limits>> {
    let origin = |param: &ParamSig| origins.get(only_param(argument(args, &param.name)?)?);
    let ranges = |param| origin(param).into_iter().flat_map(|origin| origin.ranges.clone()).collect();
    signature.params.iter().map(ranges).collect()
}

/// The argument with this name.
fn argument<'a>(args: &'a [Arg], name: &str) -> Option<&'a Expr> {
    args.iter().find(|arg| arg.name.as_ref().is_some_and(|given| given.text == name)).map(|arg| &arg.value)
}

/// The name of the parameter, if an expression consists of nothing else.
fn only_param(expr: &Expr) -> Option<&str> {
    match &expr.kind {
        ExprKind::Path(path) => match path.segments.as_slice() {
            [name] => Some(&name.text),
            _ => None,
        },
        _ => None,
    }
}

/// Adds the origins of the parameters in `expr` to an error about its value. A single parameter that is out of range is
/// reported where its value was given; all other errors are reported where the value is used.
pub fn handed_down(mut error: Box<Diagnostic>, expr: &Expr, origins: &Origins) -> Box<Diagnostic> {
    if let Some(origin) = only_param(expr).and_then(|name| origins.get(name))
        && error.code == "out-of-range"
        && error.primary.span == expr.span
    {
        error.primary.span = origin.given;
        return Box::new(error.also(origin.declared, "this parameter").also(expr.span, "is passed on here"));
    }
    let names: BTreeSet<&str> = names_in(expr).into_iter().map(|name| name.text.as_str()).collect();
    let given = names.into_iter().filter_map(|name| Some((name, origins.get(name)?)));
    given.fold(error, |error, (name, origin)| Box::new(error.also(origin.given, format!("`{name}` is given here"))))
}

//! New values of arguments that are plain numbers, written as their author would.

use apex_dsl::{
    report::{Diagnostics, Fix},
    source::{Sources, Span},
    syntax::{
        parse,
        tree::{Arg, Expr, ExprKind, File, Instance, NodeBody},
    },
    units,
};

/// An argument of a node in a source file.
#[derive(Debug, Clone, Copy)]
pub struct ArgumentPlace<'a> {
    /// Name of the node, without the graphs around it.
    pub node: &'a str,
    /// Line of its declaration, from 1.
    pub line: usize,
    /// Name of the parameter.
    pub param: &'a str,
    /// SI unit of the parameter.
    pub unit: Option<&'a str>,
}

/// Returns the change of `text` after which an argument has this `value`, in SI. An argument that is not there yet is
/// added.
///
/// # Errors
/// The node is not declared there, or its argument is not a plain number, `true` or `false`.
pub fn set_argument(text: &str, place: ArgumentPlace<'_>, value: &str) -> Result<Fix, String> {
    let mut sources = Sources::default();
    let id = sources.add("text.afg", text);
    let file = parse(id, text, &mut Diagnostics::default());
    let is_there = |span| sources.line_column(id, span).0 == place.line;
    let instance = instance(&file, place.node, is_there).ok_or_else(|| {
        format!("`{}` is not declared in line {} as `node {} = …`", place.node, place.line, place.node)
    })?;
    let param = place.param;
    let named = |arg: &&Arg| arg.name.as_ref().is_some_and(|name| name.text == param);
    let (span, replacement) = match instance.args.iter().find(named) {
        Some(arg) => {
            let replacement = replaced(&arg.value, value)
                .ok_or_else(|| format!("`{param}` is not a plain number in the text: change it there"))?;
            (arg.value.span, replacement)
        }
        None => {
            let added = format!("{param} = {value}{}", place.unit.unwrap_or_default());
            match instance.args.last() {
                Some(last) => (Span { start: last.value.span.end, ..last.value.span }, format!(", {added}")),
                None => {
                    let rest = &text[instance.path.span.end as usize..instance.span.end as usize];
                    let open = rest.find('(').ok_or_else(|| format!("`{}` has no arguments", place.node))? as u32;
                    let at = instance.path.span.end + open + 1;
                    (Span { start: at, end: at, ..instance.span }, added)
                }
            }
        }
    };
    let title = format!("set `{param}` to {replacement}");
    Ok(Fix { title, span, replacement, certain: true })
}

fn instance<'a>(file: &'a File, node: &str, is_there: impl Fn(u32) -> bool) -> Option<&'a Instance> {
    let mut nodes = file.graphs.iter().flat_map(|graph| &graph.nodes);
    nodes.find(|item| item.name.text == node && is_there(item.name.span.start)).and_then(|item| match &item.body {
        NodeBody::Instance(instance) => Some(instance),
        NodeBody::HandedIn(..) => None,
    })
}

/// The value in the unit of the expression that it replaces.
fn replaced(old: &Expr, value: &str) -> Option<String> {
    match &old.kind {
        ExprKind::Bool(_) if matches!(value, "true" | "false") => Some(value.to_owned()),
        ExprKind::Unary("-", inner) => replaced(inner, value),
        ExprKind::Number(_, None) if value.parse::<f64>().is_ok() => Some(value.to_owned()),
        ExprKind::Number(_, Some(name)) => {
            let unit = units::parse(name).ok()?;
            let value = apex_dsl::graph::Number::plain(value.parse().ok()?).in_unit(unit).value;
            Some(format!("{value}{name}"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fix::applied;

    const TEXT: &str = "graph G {\n    in a: f32;\n    node n = Gate(gap = 15cm, on = true, k = K) every 10ms;\n    node m = Gate();\n    a -> n;\n}\n";

    fn set(node: &str, line: usize, param: &str, unit: Option<&str>, value: &str) -> Result<String, String> {
        let fix = set_argument(TEXT, ArgumentPlace { node, line, param, unit }, value)?;
        Ok(applied(TEXT, &fix).lines().nth(line - 1).unwrap_or_default().trim().to_owned())
    }

    #[test]
    fn numbers_keep_their_units() {
        let line = |param: &str, value: &str| set("n", 3, param, Some("m"), value).unwrap();
        assert_eq!(line("gap", "0.2"), "node n = Gate(gap = 20cm, on = true, k = K) every 10ms;");
        assert_eq!(line("gap", "-0.1234"), "node n = Gate(gap = -12.34cm, on = true, k = K) every 10ms;");
        assert_eq!(
            set("n", 3, "on", None, "false").unwrap(),
            "node n = Gate(gap = 15cm, on = false, k = K) every 10ms;"
        );
    }

    #[test]
    fn arguments_are_added() {
        assert_eq!(
            set("n", 3, "far", Some("m"), "2.5").unwrap(),
            "node n = Gate(gap = 15cm, on = true, k = K, far = 2.5m) every 10ms;"
        );
        assert_eq!(set("m", 4, "count", None, "3").unwrap(), "node m = Gate(count = 3);");
    }

    #[test]
    fn other_expressions_and_places_are_refused() {
        assert!(set("n", 3, "k", None, "1").unwrap_err().contains("not a plain number"));
        assert!(set("n", 4, "gap", None, "1").unwrap_err().contains("not declared in line 4"));
        assert!(set("n", 3, "on", None, "1").is_err());
    }
}

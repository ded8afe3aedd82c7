//! Tuned values in the text.

use crate::{
    project::{self, Checked, Checker},
    replace,
};
use apex_dsl::{
    resolve::{Constructor, GraphId, SourceSet},
    script::{Script, Study, Varied},
    source::Span,
    syntax::tree::{Ident, Instance, NodeBody, ParamItem},
};
use std::{collections::BTreeMap, path::Path};

/// A change of the text: the place, and what is there before and behind the value.
struct Change {
    span: Span,
    before: String,
    behind: &'static str,
}

/// Checks if the result can be written into the text.
pub fn look(checked: &Checked, script: &Script, study: &Study) -> Result<(), String> {
    study.vary.iter().try_for_each(|varied| place(checked, script, varied).map(|_| ()))
}

/// Writes the values, as TOML, into the text, unless it would have errors then.
pub fn write(checked: &Checked, script: &Script, study: &Study, numbers: &[String], file: &Path) -> Result<(), String> {
    let mut changes: BTreeMap<(u32, u32), (Vec<String>, &str)> = BTreeMap::new();
    for (varied, number) in study.vary.iter().zip(numbers) {
        let Change { span, before, behind } = place(checked, script, varied)?;
        let (values, _) = changes.entry((span.start, span.end)).or_insert((vec![], behind));
        values.push(before + &quantity(number, varied.unit.as_deref()));
    }
    let mut checker = Checker::new(file)?;
    let mut text = checker.read(file)?.to_string();
    // From the end, so that places before it stay where they are.
    for ((start, end), (values, behind)) in changes.into_iter().rev() {
        text.replace_range(start as usize..end as usize, &format!("{}{behind}", values.join(", ")));
    }
    let (sources, diagnostics, _) = checker.check(file, text.clone().into());
    if diagnostics.has_errors() {
        project::print_diagnostics(&diagnostics, &sources);
        return Err(format!(
            "`{}` is not changed: it would have errors with the values; use `--params`",
            file.display()
        ));
    }
    replace::replace(file, &text).map_err(|e| format!("cannot write `{}`: {e}", file.display()))
}

/// Number with its unit, as in a text. Units of which only the reciprocal can be written become divisions.
fn quantity(number: &str, unit: Option<&str>) -> String {
    match (unit, unit.and_then(|unit| unit.strip_prefix("1/"))) {
        (None, _) => number.to_owned(),
        (_, Some("s")) => format!("{number}Hz"),
        (_, Some(below)) => below.split('/').fold(number.to_owned(), |text, unit| format!("{text} / 1{unit}")),
        (Some(unit), None) => format!("{number}{unit}"),
    }
}

/// Place of the value in the text.
fn place(checked: &Checked, script: &Script, varied: &Varied) -> Result<Change, String> {
    let (texts, cannot) = (&checked.texts, |why: &str| {
        Err(format!("`{}` cannot be written into the text: {why}; use `--params`", varied.name))
    });
    let tree = &texts.files[0].1;
    let item = tree.tests.iter().find(|test| test.name.text == script.name);
    let graph = item.and_then(|item| texts.made(&item.graph, &checked.catalog).ok());
    let Some(Constructor::Graph(mut id)) = graph else { return cannot("its graph is unknown") };
    let names: Vec<&str> = varied.name.split('.').collect();
    let Some((last, outer)) = names.split_last() else { return cannot("it has no name") };
    let mut instance: Option<&Instance> = None;
    for name in outer {
        if let Some(instance) = instance {
            match texts.made(&instance.path, &checked.catalog) {
                Ok(Constructor::Graph(inside)) => id = inside,
                _ => return cannot("its node is not in the text"),
            }
        }
        instance = node(texts, id, name);
        if instance.is_none() {
            return cannot("its node has no name in the text");
        }
    }
    if id.file != 0 {
        return cannot("it is in another file");
    }
    match instance {
        Some(instance) => Ok(in_arguments(checked, instance, last)),
        None => match texts.graph(id).params.iter().find(|param| param.name.text == *last) {
            Some(ParamItem { default: Some(default), .. }) => {
                Ok(Change { span: default.span, before: String::new(), behind: "" })
            }
            _ => cannot("the parameter of the graph has no default"),
        },
    }
}

fn node<'a>(texts: &'a SourceSet, id: GraphId, name: &str) -> Option<&'a Instance> {
    let item = texts.graph(id).nodes.iter().find(|node| node.name.text == name)?;
    if let NodeBody::Instance(instance) = &item.body { Some(instance) } else { None }
}

/// The value of an argument, or the place of a new one before the others.
fn in_arguments(checked: &Checked, instance: &Instance, name: &str) -> Change {
    let is_it = |given: &Option<Ident>| given.as_ref().is_some_and(|given| given.text == name);
    if let Some(arg) = instance.args.iter().find(|arg| is_it(&arg.name)) {
        return Change { span: arg.value.span, before: String::new(), behind: "" };
    }
    let before = format!("{name} = ");
    match instance.args.first() {
        Some(first) => {
            let start = first.name.as_ref().map_or(first.value.span, |name| name.span);
            Change { span: Span { end: start.start, ..start }, before, behind: ", " }
        }
        None => {
            let made_of = instance.types.last().map_or(instance.path.span, |ty| ty.span);
            let rest = Span { start: made_of.end, ..instance.span };
            let open = checked.sources.text(rest).find('(').map_or(rest.start, |at| rest.start + at as u32 + 1);
            Change { span: Span { start: open, end: open, ..rest }, before, behind: "" }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::quantity;

    #[test]
    fn quantities_can_be_read_again() {
        let units = [None, Some("m"), Some("m/s^2"), Some("1/s"), Some("1/s^2"), Some("1/m/s")];
        let written = units.map(|unit| quantity("-2.5", unit));
        assert_eq!(written, ["-2.5", "-2.5m", "-2.5m/s^2", "-2.5Hz", "-2.5 / 1s^2", "-2.5 / 1m / 1s"]);
    }
}

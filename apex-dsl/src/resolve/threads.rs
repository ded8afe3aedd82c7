//! `thread` statements.

use super::{builder::Builder, scope::Evaluated, suggest::suggest, value::evaluate};
use crate::{
    graph::{MAIN_GROUP, Scope, ThreadSettings, Value},
    report::{Diagnostic, nearest},
    source::Span,
    syntax::tree::{Expr, ExprKind, GraphItem, Ident, ThreadItem},
};
use std::{collections::BTreeMap, time::Duration};

/// Names of all settings.
const SETTINGS: [&str; 5] = ["cores", "priority", "policy", "rights", "hang"];

impl Builder<'_> {
    /// The settings of the threads of a program.
    pub fn threads(&mut self, values: &BTreeMap<String, Value>, item: &GraphItem) -> Vec<ThreadSettings> {
        let mut found: Vec<ThreadSettings> = vec![];
        for thread in &item.threads {
            if !item.robot {
                let message = "threads can only be configured in a `robot`";
                let error = Diagnostic::error("threads", thread.name.span, message);
                self.diagnostics.push(error.note(format!("write `robot {}` instead of `graph`", item.name.text)));
            }
            self.check_group(thread, item, found.iter().any(|t| t.group == thread.name.text));
            let mut settings = ThreadSettings { group: thread.name.text.clone(), ..ThreadSettings::default() };
            for (name, value) in &thread.settings {
                if let Err(error) = self.set(values, &mut settings, name, value) {
                    self.diagnostics.push(*error);
                }
            }
            found.push(settings);
        }
        self.check_groups(item);
        found
    }

    /// Warns about a group with a single node and without a `thread` statement that may be a misspelt one.
    fn check_groups(&mut self, item: &GraphItem) {
        let described = || item.threads.iter().map(|thread| thread.name.text.as_str());
        let groups = item.groups();
        for group in &groups {
            let name = group.text.as_str();
            let is_single = groups.iter().filter(|other| other.text == name).count() == 1;
            if !is_single || name == MAIN_GROUP || described().any(|thread| thread == name) {
                continue;
            }
            // Similar names of numbered groups are intended.
            let letters = |name: &str| name.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
            let near = nearest(name, described()).filter(|near| letters(near) != letters(name));
            if let Some(near) = near.filter(|near| groups.iter().any(|other| other.text == *near)) {
                let message = format!("thread `{name}` has no settings, but there are settings for `{near}`");
                let warning = Diagnostic::warning("threads", group.span, message);
                self.diagnostics.push(suggest(warning, group, [near].into_iter()));
            }
        }
    }

    /// Reports a thread that is described twice, or on which no node runs.
    fn check_group(&mut self, thread: &ThreadItem, item: &GraphItem, again: bool) {
        let name = &thread.name;
        if again {
            let message = format!("thread `{}` is configured twice", name.text);
            self.diagnostics.push(Diagnostic::error("duplicate-name", name.span, message).note("merge both into one"));
        }
        let of_nodes = self.nodes.iter().filter_map(|n| n.modifiers.group.as_deref());
        let of_scopes = self.scopes.iter().filter_map(|s: &Scope| s.group.as_deref());
        let groups: Vec<&str> = [MAIN_GROUP].into_iter().chain(of_nodes).chain(of_scopes).collect();
        if !groups.contains(&name.text.as_str()) {
            let error = Diagnostic::error("threads", name.span, format!("no node runs on thread `{}`", name.text));
            let error = error.note("`on` after an instance selects its thread; all other nodes run on `main`");
            let error = misspelt_group(name, item).unwrap_or_else(|| suggest(error, name, groups.into_iter()));
            self.diagnostics.push(error);
        }
    }

    fn set(
        &mut self,
        values: &BTreeMap<String, Value>,
        settings: &mut ThreadSettings,
        name: &Ident,
        value: &Expr,
    ) -> Evaluated<()> {
        let scope = self.names(values);
        match name.text.as_str() {
            "cores" => match evaluate(value, &scope)? {
                Value::List(cores) if !cores.is_empty() => {
                    let cores: Option<Vec<usize>> = cores.iter().map(|core| whole(core, 0..=1023)).collect();
                    settings.cores =
                        cores.ok_or_else(|| wrong(value.span, "a core must be a whole number from 0 to 1023"))?;
                }
                _ => return Err(wrong(value.span, "`cores` must be a list of numbers: `cores = [0, 1]`")),
            },
            "priority" => {
                let priority = whole(&evaluate(value, &scope)?, 1..=99).and_then(|p| u8::try_from(p).ok());
                let message = "`priority` must be a whole number from 1 (lowest) to 99";
                settings.priority = Some(priority.ok_or_else(|| wrong(value.span, message))?);
            }
            "policy" => settings.round_robin = word(value, ["fifo", "rr"])? == 1,
            "rights" => settings.strict = word(value, ["warn", "strict"])? == 1,
            "hang" => match evaluate(value, &scope)? {
                Value::Duration(time) if time > Duration::ZERO => settings.hang = Some(time),
                Value::Number(n) if n.dimension == crate::units::Dimension::TIME && n.value > 0.0 => {
                    settings.hang = Duration::try_from_secs_f64(n.value).ok();
                }
                _ => {
                    return Err(wrong(
                        value.span,
                        "`hang` must be a time, after which a node counts as hanging: `hang = 500ms`",
                    ));
                }
            },
            _ => {
                let message = format!("a thread has no setting `{}`", name.text);
                let error = Diagnostic::error("threads", name.span, message)
                    .note(format!("the settings are {}", SETTINGS.join(", ")));
                return Err(Box::new(suggest(error, name, SETTINGS.into_iter())));
            }
        }
        Ok(())
    }
}

/// An error about the only `on` with a name similar to `described`, if it has no `thread` statement of its own:
/// presumably that name is misspelt. If several nodes use it, the description is misspelt instead.
fn misspelt_group(described: &Ident, item: &GraphItem) -> Option<Diagnostic> {
    let is_known = |group: &Ident| item.threads.iter().any(|thread| thread.name.text == group.text);
    let groups: Vec<&Ident> = item.groups().into_iter().filter(|group| !is_known(group)).collect();
    let near = nearest(&described.text, groups.iter().map(|group| group.text.as_str()))?;
    let mut uses = groups.into_iter().filter(|group| group.text == near);
    let (only, None) = (uses.next()?, uses.next()) else { return None };
    let message = format!("thread `{near}` has no settings, but there are settings for `{}`", described.text);
    let error = Diagnostic::error("threads", only.span, message).also(described.span, "no node runs on this thread");
    Some(suggest(error, only, [described.text.as_str()].into_iter()))
}

fn wrong(span: Span, message: &str) -> Box<Diagnostic> {
    Box::new(Diagnostic::error("wrong-value", span, message))
}

fn whole(value: &Value, range: std::ops::RangeInclusive<usize>) -> Option<usize> {
    let Value::Number(number) = value else { return None };
    usize::try_from(number.integer()?).ok().filter(|n| range.contains(n))
}

/// Index of a value among two words.
fn word(value: &Expr, words: [&str; 2]) -> Evaluated<usize> {
    let text = match &value.kind {
        ExprKind::Path(path) => path.text(),
        _ => String::new(),
    };
    let message = format!("expected `{}` or `{}`", words[0], words[1]);
    words.iter().position(|word| *word == text).ok_or_else(|| wrong(value.span, &message))
}

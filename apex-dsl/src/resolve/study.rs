//! Studies: what a `tune` item has besides the script of a test.

use super::{
    args,
    condition::names_in,
    declared,
    names::{Constructor, GraphId, SourceSet},
    scope::{Evaluated, Scope},
    suggest::suggest,
    value::{evaluate, limits},
    wanted::Wanted,
    writer::Writer,
};
use crate::{
    catalog::{Catalog, Limits, ParamSig, Signature, Type},
    graph::{NodeKind, Value},
    report::Diagnostic,
    script::{Goal, Study, Varied},
    source::Span,
    syntax::tree::{
        Endpoint, Expr, ExprKind, GoalItem, GraphItem, Ident, Instance, ModifierKind, NodeBody, PortRef, RangeExpr,
        StudyItem, TestItem,
    },
    units::{self, Unit},
};

/// Share of the seeds that must reach the value of a goal, if the text gives none.
const SHARE: f64 = 0.9;
/// Maximum number of seeds.
const MOST_SEEDS: f64 = 1e6;

/// A parameter that a study can vary: of a node, or of a graph.
struct Parameter {
    /// Names of the parameters of nodes that have its value.
    targets: Vec<String>,
    ty: Type,
    unit: Option<String>,
    range: Option<Limits>,
    declared: String,
}

/// Resolves the study of `item`, which runs graph `id` of `texts`.
pub fn study(
    writer: &mut Writer<'_>,
    texts: &SourceSet,
    catalog: &Catalog,
    item: &TestItem,
    id: GraphId,
) -> Option<Study> {
    let study = item.study.as_ref()?;
    let resolver = Resolver { texts, catalog, id };
    let needs = [
        (study.vary.is_empty(), "vary", "nothing would be searched: write `vary node.parameter;`"),
        (study.goals.is_empty(), "minimise", "no value would be better than another: write `minimise port;`"),
    ];
    for (_, word, note) in needs.into_iter().filter(|(is_missing, ..)| *is_missing) {
        let error = Diagnostic::error("wrong-study", item.name.span, format!("a `tune` needs a `{word}`"));
        writer.diagnostics.push(error.note(note));
    }
    let vary = study.vary.iter().filter_map(|(of, range)| resolver.varied(writer, of, range.as_ref())).collect();
    twice(writer, study.vary.iter().map(|(of, _)| of));
    twice(writer, study.goals.iter().map(|goal| &goal.of));
    let goals = study.goals.iter().filter_map(|goal| goal_of(writer, goal)).collect();
    let required = study.required.iter().filter_map(|name| resolver.required(writer, name)).collect();
    let mut found = Study { vary, goals, required, ..Study::default() };
    found.seeds = study.seeds.as_ref().map_or(Some(1), |seeds| count(writer, seeds))?;
    found.held_out = if study.seeds.is_some() { found.seeds } else { 0 };
    resolver.held_out(writer, study, item, &mut found)?;
    found.seed_params = resolver.seed_params(writer);
    let seeds = study.seeds.as_ref().or(study.held_out.iter().find(|held| !is_text(held)));
    if let (Some(at), true) = (seeds, found.seed_params.is_empty()) {
        let message = format!("`{}` has no parameter `seed`: all runs would be the same", item.graph.text());
        let note = "a run sets the whole number `seed` of every struct node; remove this statement, or add a node with random numbers";
        writer.diagnostics.push(Diagnostic::error("wrong-study", at.span, message).note(note));
    }
    Some(found)
}

fn is_text(expr: &Expr) -> bool {
    matches!(expr.kind, ExprKind::Text(_))
}

/// Reports names that are given twice.
fn twice<'a>(writer: &mut Writer<'_>, all: impl Iterator<Item = &'a PortRef>) {
    let mut before: Vec<&PortRef> = vec![];
    for of in all {
        if let Some(first) = before.iter().find(|first| first.text() == of.text()) {
            let error = Diagnostic::error("wrong-study", of.span, format!("`{}` is given twice", of.text()));
            writer.diagnostics.push(error.also(first.span, "first given here").note("remove one of the two"));
        }
        before.push(of);
    }
}

/// A number of seeds.
fn count(writer: &mut Writer<'_>, expr: &Expr) -> Option<u64> {
    match writer.value(expr)? {
        Value::Number(n) if n.integer().is_some() && n.value >= 1.0 && n.value <= MOST_SEEDS => Some(n.value as u64),
        _ => {
            let error = Diagnostic::error("wrong-study", expr.span, "the number of seeds must be a whole number");
            writer.diagnostics.push(error.note(format!("from 1 to {MOST_SEEDS}, for example `seeds 32`")));
            None
        }
    }
}

fn goal_of(writer: &mut Writer<'_>, goal: &GoalItem) -> Option<Goal> {
    let of = writer.observed(&goal.of)?;
    let ty = of.ty.clone();
    let number = ty.without_unit();
    let is_number = matches!(number.name(), "f32" | "f64" | "Duration") || limits(number.name()).is_some();
    if !is_number {
        let message = format!("the goal `{}` is not a number, but a `{ty}`", goal.of.text());
        let note = "a goal is a port with numbers or times: compute one from it with a node";
        writer.diagnostics.push(Diagnostic::error("wrong-goal", goal.of.span, message).note(note));
        return None;
    }
    let share = match &goal.share {
        None => SHARE,
        Some(expr) => match writer.value(expr)? {
            Value::Number(n) if n.dimension.is_none() && n.value > 0.0 && n.value <= 1.0 => n.value,
            _ => {
                let error = Diagnostic::error("wrong-goal", expr.span, "expected a share of the seeds");
                let note = "it is above 0% and at most 100%: `at 90%` is the value that nine of ten seeds reach";
                writer.diagnostics.push(error.note(note));
                return None;
            }
        },
    };
    let unit = match &ty {
        Type::Measured(_, unit) => Some(unit.clone()),
        _ => (number.name() == "Duration").then(|| "s".to_owned()),
    };
    Some(Goal { name: goal.of.text(), of, unit, maximise: goal.maximise, share })
}

/// Names of a text that a study refers to.
struct Resolver<'a> {
    texts: &'a SourceSet,
    catalog: &'a Catalog,
    /// The tuned graph.
    id: GraphId,
}

impl Resolver<'_> {
    /// The signatures and values of all nodes of the program, with their names.
    fn nodes<'w>(&'w self, writer: &'w Writer<'_>) -> impl Iterator<Item = (String, &'w Signature)> {
        writer.graph.nodes.iter_enumerated().filter_map(|(id, node)| match &node.kind {
            NodeKind::Library(library) => Some((writer.graph.path(id), &self.catalog.signatures[library.signature])),
            _ => None,
        })
    }

    /// The parameters named `seed` of the program.
    fn seed_params(&self, writer: &Writer<'_>) -> Vec<String> {
        let is_seed = |p: &ParamSig| p.name == "seed" && limits(p.ty.name()).is_some();
        let nodes = self.nodes(writer).filter(|(_, s)| !s.is_function && s.params.iter().any(is_seed));
        nodes.map(|(name, _)| format!("{name}.seed")).collect()
    }

    fn required(&self, writer: &mut Writer<'_>, name: &Ident) -> Option<String> {
        let tests = &self.texts.files[0].1.tests;
        let known = || tests.iter().filter(|test| test.study.is_none()).map(|test| test.name.text.as_str());
        if !known().any(|test| test == name.text) {
            let error = Diagnostic::error("unknown-name", name.span, format!("there is no test `{}`", name.text));
            let error = error.note("`require` names tests of this text, or what must not happen: `require never port`");
            writer.diagnostics.push(suggest(error, name, known()));
            return None;
        }
        Some(name.text.clone())
    }

    fn held_out(&self, writer: &mut Writer<'_>, study: &StudyItem, item: &TestItem, found: &mut Study) -> Option<()> {
        for expr in &study.held_out {
            let ExprKind::Text(file) = &expr.kind else {
                found.held_out = count(writer, expr)?;
                continue;
            };
            use crate::syntax::tree::TestStep::FeedRecorded;
            if !item.steps.iter().any(|step| matches!(step, FeedRecorded(..))) {
                let message = format!("the recording `{file}` would not be used: the study feeds none");
                let note =
                    "feed the recording on which is tuned: `feed port = recording(\"run.mcap\", \"node.port\");`";
                writer.diagnostics.push(Diagnostic::error("wrong-study", expr.span, message).note(note));
            }
            found.recordings.push(file.clone());
        }
        Some(())
    }

    fn varied(&self, writer: &mut Writer<'_>, of: &PortRef, range: Option<&RangeExpr>) -> Option<Varied> {
        let parameter = self.parameter(writer, of)?;
        let bounds = self.bounds(writer.scope, of, &parameter, range);
        let (low, high) = bounds.map_err(|error| writer.diagnostics.push(*error)).ok()?;
        let integer = limits(parameter.ty.name()).is_some();
        let (single, is_time) = (parameter.ty.name() == "f32", parameter.ty.name() == "Duration");
        let parsed = parameter.unit.as_deref().and_then(|unit| units::parse(unit).ok());
        let declared = parameter.unit.clone().zip(parsed.map(Unit::size)).filter(|(_, size)| *size != 1.0);
        let unit = parsed.map(|unit| unit.dimension).filter(|d| !d.is_none()).map(|d| d.to_string());
        let unit = if is_time { Some("s".to_owned()) } else { unit };
        Some(Varied {
            name: of.text(),
            targets: parameter.targets,
            unit,
            declared,
            low,
            high,
            integer,
            single,
            span: of.span,
        })
    }

    /// The parameter with this name: of the graph, of a nested graph, or of a node.
    fn parameter(&self, writer: &mut Writer<'_>, of: &PortRef) -> Option<Parameter> {
        let (last, outer) = of.parts.split_last()?;
        let found = match self.graph_around(outer) {
            Some(id) => self.of_graph(writer, id, outer, last),
            None => self.of_node(writer, of),
        };
        let found = match found {
            None => Err(Box::new(self.unknown(writer, of))),
            Some(found) => found.and_then(|p| if is_numeric(&p.ty) { Ok(p) } else { Err(not_numeric(of, &p.ty)) }),
        };
        found.map_err(|error| writer.diagnostics.push(*error)).ok()
    }

    /// The graph that the nested graphs with these names lead to.
    fn graph_around(&self, names: &[Ident]) -> Option<GraphId> {
        names.iter().try_fold(self.id, |id, name| {
            let node = self.texts.graph(id).nodes.iter().find(|node| node.name.text == name.text)?;
            let NodeBody::Instance(instance) = &node.body else { return None };
            match self.texts.made(&instance.path, self.catalog) {
                Ok(Constructor::Graph(id)) => Some(id),
                _ => None,
            }
        })
    }

    fn of_node(&self, writer: &Writer<'_>, of: &PortRef) -> Option<Evaluated<Parameter>> {
        let path = of.text();
        let (node, name) = path.rsplit_once('.')?;
        let (_, signature) = self.nodes(writer).find(|(path, _)| path == node)?;
        let param = signature.params.iter().find(|param| param.name == name)?;
        if signature.is_function {
            let message = format!("`{path}` cannot be varied: `{}` is a function node", signature.name);
            let error = Diagnostic::error("cannot-vary", of.span, message);
            let note = "the parameters of a function node are part of the code: write it as a struct node";
            return Some(Err(Box::new(error.note(note).note(args::wanted(signature, param).declared))));
        }
        Some(Ok(Parameter {
            targets: vec![path],
            ty: param.ty.clone(),
            unit: param.unit.clone(),
            range: param.range,
            declared: args::wanted(signature, param).declared,
        }))
    }

    fn of_graph(
        &self,
        writer: &Writer<'_>,
        id: GraphId,
        outer: &[Ident],
        name: &Ident,
    ) -> Option<Evaluated<Parameter>> {
        let param = self.texts.graph(id).params.iter().find(|param| param.name.text == name.text)?;
        let ty = self.catalog.type_in_text(&self.texts.ty(&param.ty), &[]);
        let wanted = match declared::wanted(param, &ty, writer.scope) {
            Ok(wanted) => wanted,
            Err(error) => return Some(Err(error)),
        };
        let mut users = Users { resolver: self, targets: vec![], fixed: None };
        let prefix: String = outer.iter().map(|part| format!("{}.", part.text)).collect();
        users.graph(id, &prefix, &name.text);
        let known: Vec<String> = self.nodes(writer).map(|(path, _)| path).collect();
        users.targets.retain(|target| target.rsplit_once('.').is_some_and(|(node, _)| known.iter().any(|k| k == node)));
        let error = |message: String| Diagnostic::error("cannot-vary", name.span, message);
        let note = "vary the parameters of the nodes instead, or pass this one on unchanged to struct nodes with names";
        if let Some(fixed) = users.fixed {
            let message = format!("`{}` cannot be varied: part of the program is computed from it", name.text);
            return Some(Err(Box::new(error(message).also(fixed, "here it is part of the code").note(note))));
        }
        if users.targets.is_empty() {
            let message = format!("`{}` cannot be varied: no node has its value", name.text);
            return Some(Err(Box::new(error(message).also(param.name.span, "declared here").note(note))));
        }
        let (unit, range, declared) = (wanted.unit.map(str::to_owned), wanted.range, wanted.declared);
        Some(Ok(Parameter { targets: users.targets, ty, unit, range, declared }))
    }

    fn unknown(&self, writer: &Writer<'_>, of: &PortRef) -> Diagnostic {
        let of_graph = self.texts.graph(self.id).params.iter().map(|param| param.name.text.clone());
        let nodes = self.nodes(writer).filter(|(_, signature)| !signature.is_function);
        let of_nodes = nodes.flat_map(|(path, signature)| {
            signature.params.iter().map(|param| format!("{path}.{}", param.name)).collect::<Vec<_>>()
        });
        let known: Vec<String> = of_graph.chain(of_nodes).collect();
        let word = Ident { text: of.text(), span: of.span };
        let message = format!("`{}` has no parameter `{}`", self.texts.graph(self.id).name.text, word.text);
        let error = Diagnostic::error("unknown-argument", of.span, message);
        let error = match known.is_empty() {
            true => error.note("it has none at all: give a node a parameter"),
            false => error.note("`vary` names a parameter of the graph, or of a node in it: `node.parameter`"),
        };
        suggest(error, &word, known.iter().map(String::as_str))
    }

    /// The smallest and largest value that is searched, in SI.
    fn bounds(
        &self,
        scope: &Scope<'_>,
        of: &PortRef,
        parameter: &Parameter,
        range: Option<&RangeExpr>,
    ) -> Evaluated<(f64, f64)> {
        let last = of.parts.last().map_or("", |part| part.text.as_str());
        let (low, high, inclusive) = match range {
            None => parameter.range.unwrap_or((None, None, true)),
            Some(range) => {
                let declared = parameter.range.map(|(low, high, inside)| (low, high, inside || !range.inclusive));
                let (unit, declared_at) = (parameter.unit.as_deref(), parameter.declared.clone());
                let wanted = Wanted { name: last, ty: &parameter.ty, unit, range: declared, declared: declared_at };
                let bound = |expr: &Expr| -> Evaluated<Option<f64>> {
                    Ok(seconds_or_number(&wanted.fit(evaluate(expr, scope)?, expr)?))
                };
                (bound(&range.low)?, bound(&range.high)?, range.inclusive)
            }
        };
        let span = range.map_or(of.span, |range| range.low.span.to(range.high.span));
        let error = |message: String| Diagnostic::error("cannot-vary", span, message);
        let (Some(low), Some(high)) = (low, high) else {
            let error = error(format!("`{}` has no range in which it can be searched", of.text()));
            let note = format!("write its bounds: `vary {} in low..=high`", of.text());
            return Err(Box::new(error.note(note).note(parameter.declared.clone())));
        };
        let high = if inclusive { high } else { below(high, parameter.ty.name()) };
        if low < high {
            return Ok((low, high));
        }
        let what = if low == high { "has a single value" } else { "is empty" };
        Err(Box::new(
            error(format!("the range of `{}` {what}", of.text())).note("the first bound must be the smaller one"),
        ))
    }
}

/// The largest value of a type below `high`.
fn below(high: f64, ty: &str) -> f64 {
    match ty {
        "f32" => f64::from((high as f32).next_down()),
        "Duration" => high - 1e-9,
        "f64" => high.next_down(),
        _ => high - 1.0,
    }
}

fn seconds_or_number(value: &Value) -> Option<f64> {
    match value {
        Value::Number(n) => Some(n.value),
        Value::Duration(time) => Some(time.as_secs_f64()),
        _ => None,
    }
}

fn is_numeric(ty: &Type) -> bool {
    matches!(ty.name(), "f32" | "f64" | "Duration")
        || limits(ty.name()).is_some_and(|(_, high)| high <= u64::MAX.into())
}

fn not_numeric(of: &PortRef, ty: &Type) -> Box<Diagnostic> {
    let message = format!("`{}` cannot be varied: it is a `{ty}`", of.text());
    let error = Diagnostic::error("cannot-vary", of.span, message);
    Box::new(error.note("only numbers and times have a range that can be searched"))
}

/// Search for the nodes that have the value of a parameter of a graph.
struct Users<'a> {
    resolver: &'a Resolver<'a>,
    /// Full names of their parameters.
    targets: Vec<String>,
    /// A place where the value is used in another way.
    fixed: Option<Span>,
}

impl Users<'_> {
    fn graph(&mut self, id: GraphId, prefix: &str, param: &str) {
        let item = self.resolver.texts.graph(id);
        for node in &item.nodes {
            if let NodeBody::Instance(instance) = &node.body {
                self.instance(instance, Some(&format!("{prefix}{}", node.name.text)), param);
            }
        }
        for instance in in_place(item) {
            self.instance(instance, None, param);
        }
        let others = item.params.iter().filter(|other| other.name.text != param).filter_map(|p| p.default.as_ref());
        let given = item.ends().into_iter().filter_map(|end| match end {
            Endpoint::Port(_, given) => given.as_deref(),
            _ => None,
        });
        let fixed = others
            .chain(given)
            .chain(item.threads.iter().flat_map(|thread| thread.settings.iter().map(|(_, value)| value)));
        fixed.filter(|expr| names(expr, param)).for_each(|expr| self.fixed = Some(expr.span));
    }

    fn instance(&mut self, instance: &Instance, name: Option<&str>, param: &str) {
        let repeats = instance.modifiers.iter().any(|m| matches!(m.kind, ModifierKind::Each { .. }));
        for modifier in &instance.modifiers {
            if time_of(&modifier.kind).is_some_and(|expr| names(expr, param)) {
                self.fixed = Some(modifier.span);
            }
        }
        for arg in instance.args.iter().filter(|arg| names(&arg.value, param)) {
            let is_passed = matches!(&arg.value.kind, ExprKind::Path(path) if path.segments.len() == 1);
            let made = self.resolver.texts.made(&instance.path, self.resolver.catalog);
            match (made, name, &arg.name) {
                (Ok(Constructor::Graph(inside)), Some(name), Some(arg)) if is_passed && !repeats => {
                    self.graph(inside, &format!("{name}."), &arg.text);
                }
                (Ok(Constructor::Node(node)), Some(name), Some(arg))
                    if is_passed && !repeats && !self.resolver.catalog.signatures[node].is_function =>
                {
                    self.targets.push(format!("{name}.{}", arg.text));
                }
                _ => self.fixed = Some(arg.value.span),
            }
        }
    }
}

fn names(expr: &Expr, param: &str) -> bool {
    names_in(expr).iter().any(|name| name.text == param)
}

/// The instances of a graph that have no name.
fn in_place(item: &GraphItem) -> impl Iterator<Item = &Instance> {
    let named = |instance: &&Instance| {
        item.nodes.iter().any(|node| matches!(&node.body, NodeBody::Instance(own) if std::ptr::eq(own, *instance)))
    };
    item.instances().into_iter().filter(move |instance| !named(instance))
}

fn time_of(kind: &ModifierKind) -> Option<&Expr> {
    match kind {
        ModifierKind::Every(expr)
        | ModifierKind::After(expr)
        | ModifierKind::Timeout(expr)
        | ModifierKind::Deadline(expr) => Some(expr),
        ModifierKind::Delay(expr) => expr.as_ref(),
        _ => None,
    }
}

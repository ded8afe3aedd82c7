//! The `record` statement of a program: the ports that it names, as ports of the flat graph.

use super::suggest::suggest;
use crate::{
    graph::{Graph, NodeKind, PortId, Record, WireEnd},
    report::{Diagnostic, Diagnostics},
    syntax::tree::{Arg, Expr, ExprKind, GraphItem, Ident, PortRef, RecordItem},
    units,
};
use std::time::Duration;

/// Names of all options.
const OPTIONS: [&str; 3] = ["limit", "age", "compress"];

/// Resolves the `record` statement of `item`, whose program is `graph`.
pub fn record(graph: &Graph, item: &GraphItem, diagnostics: &mut Diagnostics) -> Option<Record> {
    let [first, others @ ..] = item.records.as_slice() else { return None };
    for other in others {
        let error = Diagnostic::error("wrong-record", other.span, "a program can be recorded to only one file");
        diagnostics.push(
            error
                .also(first.span, "the first `record` statement")
                .note("write the ports of both into one `record` statement"),
        );
    }
    if first.file.is_empty() {
        let error = Diagnostic::error("wrong-record", first.span, "the file of the recording has no name");
        diagnostics.push(error.note("write it as `record \"run.mcap\" { … }`"));
    }
    let found: Vec<Option<Vec<PortId>>> = first.ports.iter().map(|port| port_of(graph, port, diagnostics)).collect();
    report_twice(first, diagnostics);
    let (file, span) = (first.file.clone(), first.span);
    let mut record = Record { file, limit: None, age: None, compress: false, ports: vec![], span };
    for (number, option) in first.options.iter().enumerate() {
        if let Err(error) = set(&mut record, option, &first.options[..number]) {
            diagnostics.push(*error);
        }
    }
    let ports: Vec<Vec<PortId>> = found.into_iter().collect::<Option<_>>()?;
    Some(Record { ports: ports.concat(), ..record })
}

/// Sets an option, which must not be among those `before`.
fn set(record: &mut Record, option: &Arg, before: &[Arg]) -> Result<(), Box<Diagnostic>> {
    let wrong = |message: &str| Box::new(Diagnostic::error("wrong-value", option.value.span, message));
    let Some(name) = &option.name else {
        let error = Diagnostic::error("unnamed-argument", option.value.span, "an option of a recording has a name");
        return Err(Box::new(error.note("write it as `limit = 1GB`, `age = 10min` or `compress = true`")));
    };
    if before.iter().any(|other| other.name.as_ref().is_some_and(|other| other.text == name.text)) {
        let message = format!("`{}` is given twice", name.text);
        return Err(Box::new(
            Diagnostic::error("duplicate-argument", name.span, message).note("remove one of the two"),
        ));
    }
    match name.text.as_str() {
        "limit" => {
            let message = "`limit` must be a size of at least 16MB, in `MB`, `GB` or `TB`: `limit = 1GB`";
            let size = size(&option.value).filter(|size| *size >= units::LEAST_RECORDING);
            record.limit = Some(size.ok_or_else(|| wrong(message))?);
        }
        "age" => {
            let message = "`age` must be a time of at least 8s, as a number with a unit: `age = 10min`";
            let age = time(&option.value).filter(|age| *age >= units::YOUNGEST_RECORDING);
            record.age = Some(age.ok_or_else(|| wrong(message))?);
        }
        "compress" => match option.value.kind {
            ExprKind::Bool(compress) => record.compress = compress,
            _ => return Err(wrong("`compress` must be `true` or `false`")),
        },
        _ => {
            let message = format!("a recording has no option `{}`", name.text);
            let error = Diagnostic::error("unknown-argument", name.span, message);
            let error = error.note(format!("the options are {}", OPTIONS.join(", ")));
            return Err(Box::new(suggest(error, name, OPTIONS.into_iter())));
        }
    }
    Ok(())
}

/// A size in bytes.
fn size(value: &Expr) -> Option<u64> {
    let ExprKind::Number(digits, Some(unit)) = &value.kind else { return None };
    units::bytes(&digits.replace('_', ""), unit)
}

/// A time.
fn time(value: &Expr) -> Option<Duration> {
    let ExprKind::Number(digits, Some(unit)) = &value.kind else { return None };
    units::time(&digits.replace('_', ""), unit)
}

fn report_twice(record: &RecordItem, diagnostics: &mut Diagnostics) {
    for (i, port) in record.ports.iter().enumerate() {
        if let Some(before) = record.ports[..i].iter().find(|before| before.text() == port.text()) {
            let message = format!("`{}` is named twice", port.text());
            let error = Diagnostic::error("wrong-record", port.span, message);
            diagnostics.push(error.also(before.span, "first named here").note("remove one of the two"));
        }
    }
}

/// The ports that a name stands for: a port of a node, or all ports that send to the port of a nested graph.
fn port_of(graph: &Graph, port: &PortRef, diagnostics: &mut Diagnostics) -> Option<Vec<PortId>> {
    let path = port.text();
    let ends = match sending_port(graph, &path) {
        Some(end) => vec![end],
        None => ends_of_pin(graph, &path),
    };
    if ends.is_empty() {
        diagnostics.push(unknown(graph, port));
        return None;
    }
    let is_connected = |end: &&PortId| graph.connections.iter().any(|c| c.from == **end);
    if ends.iter().any(|end| !is_connected(&end)) {
        let message = format!("`{path}` cannot be recorded: nothing is connected to it");
        let error = Diagnostic::error("wrong-record", port.span, message);
        diagnostics.push(error.note("connect it to a node that takes its tokens, or remove it here"));
        return None;
    }
    Some(ends)
}

fn unknown(graph: &Graph, port: &PortRef) -> Diagnostic {
    let path = port.text();
    let ends = sending_ports(graph).map(|end| graph.end_name(end));
    let pins = (0..graph.pins.len()).filter(|pin| graph.pins[*pin].kind.sends()).map(|pin| pin_name(graph, pin));
    let known: Vec<String> = ends.chain(pins).collect();
    let word = Ident { text: path.clone(), span: port.span };
    let error =
        Diagnostic::error("unknown-port", port.span, format!("the program has no port `{path}` that sends tokens"));
    suggest(error, &word, known.iter().map(String::as_str))
}

fn sending_ports(graph: &Graph) -> impl Iterator<Item = PortId> + '_ {
    let nodes = graph.nodes.ids().filter(|node| !matches!(graph.nodes[*node].kind, NodeKind::Start));
    let ends = nodes.flat_map(|node| (0..graph.nodes[node].ports.len()).map(move |port| PortId { node, port }));
    ends.filter(|end| graph.port(*end).kind.sends())
}

/// The port that `path` names: `node.port`, an input of the graph, or `node` if only one of its ports sends.
pub fn sending_port(graph: &Graph, path: &str) -> Option<PortId> {
    let exact = |end: &PortId| format!("{}.{}", graph.path(end.node), graph.port(*end).name) == path;
    let of_node: Vec<PortId> = sending_ports(graph)
        .filter(|end| graph.path(end.node) == path && graph.port(*end).parameter.is_none())
        .collect();
    sending_ports(graph).find(exact).or(if let [only] = of_node.as_slice() { Some(*only) } else { None })
}

fn pin_name(graph: &Graph, pin: usize) -> String {
    format!("{}.{}", graph.scope_path(graph.pins[pin].scope), graph.pins[pin].name)
}

/// The ports of nodes whose tokens leave a nested graph through its port `path`.
fn ends_of_pin(graph: &Graph, path: &str) -> Vec<PortId> {
    let is_meant = |pin: &usize| graph.pins[*pin].kind.sends() && pin_name(graph, *pin) == path;
    let mut open: Vec<usize> = (0..graph.pins.len()).filter(is_meant).collect();
    let (mut seen, mut ends) = (open.clone(), vec![]);
    while let Some(pin) = open.pop() {
        for wire in graph.wires.iter().filter(|wire| wire.to == WireEnd::Pin(pin)) {
            match wire.from {
                WireEnd::Port(end) => ends.push(end),
                WireEnd::Pin(inner) if !seen.contains(&inner) => {
                    seen.push(inner);
                    open.push(inner);
                }
                WireEnd::Pin(_) => {}
            }
        }
    }
    ends.sort_unstable();
    ends.dedup();
    ends
}

//! Random tests of the graphs of a source file.

use super::{case::Item, interface::Interface, kinds::Kind, maker::Maker};

/// Names of tests that are difficult for code generation.
const NAMES: &[&str] = &[
    "Self", "self", "crate", "match", "test", "tests", "Robot", "Arm", "arm", "passes", "std", "core", "apex_rt",
    "super", "made", "type", "_", "main", "a", "A", "ArmState", "program", "alloc", "Some", "u8", "String", "Vec",
    "Time", "graph", "node",
];

/// Adds tests.
pub fn add(maker: &mut Maker) {
    let mut used = vec![];
    for _ in 0..1 + maker.dice.below(2) {
        let graph = maker.dice.of(&maker.graphs.clone()).clone();
        let named = maker.strikes(Kind::Tests, 3).then(|| graph.node.name.clone());
        let list = if maker.strikes(Kind::Tests, 2) { NAMES } else { &["it_works", "it_stops", "it_waits"] };
        let name = match named {
            Some(name) => name,
            None if maker.strikes(Kind::Tests, 4) => "it_works".to_owned(),
            None => maker.free(list, &mut used),
        };
        let body = steps(maker, &graph);
        let args = arguments(maker, &graph);
        maker.items.push(Item { head: format!("test {name}: {}{args}", graph.node.name), body: Some(body) });
    }
}

fn arguments(maker: &mut Maker, graph: &Interface) -> String {
    let mut args = vec![];
    for (name, param) in &graph.node.params {
        if let Some(value) = maker.value(param) {
            args.push(format!("{name} = {value}"));
        }
    }
    if args.is_empty() { String::new() } else { format!("({})", args.join(", ")) }
}

fn steps(maker: &mut Maker, graph: &Interface) -> Vec<String> {
    let mut body = vec![];
    if maker.dice.one_in(10)
        && let Some((name, node)) = graph.named.first()
        && let Some(ty) = node.inputs.first().map(|p| p.ty)
    {
        let other = if maker.dice.one_in(2) { node.clone() } else { maker.node(ty) };
        body.push(format!("replace {name} = {}();", other.name));
    }
    for port in graph.node.inputs.iter().chain(&graph.node.slots) {
        let value = maker.token(port.ty);
        if let Some(value) = value.filter(|_| !maker.dice.one_in(4)) {
            let value = if maker.dice.one_in(4) { format!("[{value}, {value}] every 10ms") } else { value };
            body.push(format!("feed {} = {value};", port.name));
        } else if maker.strikes(Kind::Tests, 2) {
            body.push(format!("feed {};", port.name));
        }
    }
    let seen = seen(maker, graph);
    for name in seen {
        let line = match maker.dice.below(4) {
            0 => format!("never {name};"),
            1 => format!("expect {name} within 10ms;"),
            2 => format!("expect {name} by 2s;"),
            _ => format!("expect {name};"),
        };
        body.push(line);
    }
    if let Some(active) = graph.active.last().and_then(|a| a.split('.').next()) {
        body.push(format!("expect active({active});"));
    }
    body.push("wait 1s;".to_owned());
    body
}

/// Ports of the graph and of its nodes, alone or compared with a value.
fn seen(maker: &mut Maker, graph: &Interface) -> Vec<String> {
    let mut all = vec![];
    for port in graph.node.outputs.iter().chain(&graph.node.events) {
        all.push((port.name.clone(), port.ty));
    }
    for (name, node) in &graph.named {
        let ports = node.outputs.iter().chain(&node.events);
        all.extend(ports.map(|p| (format!("{name}.{}", p.name), p.ty)));
    }
    let count = 1 + maker.dice.below(3);
    let mut seen = vec![];
    for _ in 0..count.min(all.len()) {
        let (name, ty) = maker.dice.of(&all).clone();
        let compared = maker.token(ty).filter(|v| !v.contains("crate") && maker.dice.one_in(2));
        match compared {
            Some(value) => seen.push(format!("{name} {} {value}", maker.dice.of(&["==", "!=", "<", ">="]))),
            None => seen.push(name),
        }
    }
    seen
}

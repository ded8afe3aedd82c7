//! Writes a graph file as a source file, which is then formatted.

use super::{
    graph::{Connection, Graph, Node, Param},
    known::{self, MESSAGE, NOTE},
    names,
    ports::{Kind, Port, PortId},
};
use std::{collections::BTreeSet, fmt::Write as _};

/// The source file; `module` is the module of the type of messages.
pub fn write(top: &Graph, module: &str) -> String {
    let mut text = "//! Imported from a graph of CS::APEX.\n".to_owned();
    let (mut library, mut has_ports) = (BTreeSet::new(), false);
    visit(top, &mut |graph| {
        has_ports |= !graph.ports.is_empty();
        library.extend(graph.nodes.iter().filter_map(|node| known::find(&node.ty)).map(|known| known.ours));
        if graph.connections.iter().any(Connection::needs_signal) {
            library.insert(("flow", "Signal"));
        }
    });
    for (module, name) in library {
        let _ = writeln!(text, "use apex_nodes::{module}::{name};");
    }
    if has_ports {
        text += "// The file does not contain the types of the ports of graphs: add them here.\n";
        let _ = writeln!(text, "use {module}::{MESSAGE};");
    }
    visit(top, &mut |graph| write_graph(graph, &mut text));
    text
}

/// Calls `each` with a graph and all graphs nested in it.
pub fn visit<'a>(graph: &'a Graph, each: &mut impl FnMut(&'a Graph)) {
    each(graph);
    graph.nodes.iter().filter_map(|node| node.graph.as_ref()).for_each(|graph| visit(graph, each));
}

// Writing into a string cannot fail.
fn write_graph(graph: &Graph, text: &mut String) {
    let _ = writeln!(text, "\ngraph {} {{", graph.name);
    for (kind, k) in &graph.ports {
        let word = kind.word();
        let _ = writeln!(text, "{word} {word}_{k}: {MESSAGE};");
    }
    text.push('\n');
    for (node, connected) in graph.nodes.iter().zip(graph.connected()) {
        write_node(node, &connected, text);
    }
    text.push('\n');
    graph.connections.iter().for_each(|connection| write_connection(graph, connection, text));
    text.push_str("}\n");
}

fn write_connection(graph: &Graph, connection: &Connection, text: &mut String) {
    let Connection { from, to, active } = connection;
    // What the language has no port for stays in the text for whoever knows better.
    for whole in [from, to].into_iter().filter_map(PortId::without_counterpart) {
        let _ = write!(text, "// `{whole}` of CS::APEX itself has no counterpart here: ");
    }
    let arrow = if *active { "=>" } else { "->" };
    let signal = if connection.needs_signal() { format!("Signal() {arrow} ") } else { String::new() };
    let _ = writeln!(text, "{} {arrow} {signal}{};", end(graph, from), end(graph, to));
}

fn write_node(node: &Node, connected: &BTreeSet<&Port>, text: &mut String) {
    if node.ty == NOTE {
        for (_, param) in &node.params {
            let Param::Text(note) = param else { continue };
            note.lines().for_each(|line| text.push_str(&format!("// {}\n", plain(line))));
        }
        return;
    }
    if !node.enabled {
        text.push_str("// It was disabled.\n");
    }
    let group = node.group.as_ref().map_or(String::new(), |group| format!(" on {group}"));
    let (ty, arguments) = match (&node.graph, known::find(&node.ty)) {
        (Some(graph), _) => (graph.name.clone(), String::new()),
        (None, Some(known)) => (known.ours.1.to_owned(), String::new()),
        (None, None) => {
            let ports: Vec<String> = connected.iter().map(|port| port_name(node, port)).collect();
            let ports =
                if ports.is_empty() { "no ports used".to_owned() } else { format!("uses {}", ports.join(", ")) };
            text.push_str(&format!("// `{}` is not in the library; {ports}.\n", plain(&node.ty)));
            (names::camel(&node.ty), arguments(node))
        }
    };
    let _ = writeln!(text, "node {} = {ty}({arguments}){group};", node.name);
}

/// Removes characters that cannot be in a comment.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

fn arguments(node: &Node) -> String {
    let arguments: Vec<String> = node.params.iter().map(|(name, param)| format!("{name} = {}", value(param))).collect();
    arguments.join(", ")
}

/// A value in the syntax of both the language and Rust.
pub fn value(param: &Param) -> String {
    match param {
        Param::Int(value) => value.to_string(),
        Param::Float(value) => format!("{value:?}"),
        Param::Bool(value) => value.to_string(),
        Param::Text(value) => format!("{value:?}"),
        Param::List(values) => format!("[{}]", values.iter().map(self::value).collect::<Vec<_>>().join(", ")),
        Param::None => String::new(),
    }
}

fn end(graph: &Graph, end: &PortId) -> String {
    match end {
        PortId::Own(kind, k) => format!("{}_{k}", kind.word()),
        PortId::Whole(whole) => whole.ours.unwrap_or(whole.theirs).to_owned(),
        PortId::Plugin(_, theirs) => theirs.clone(),
        PortId::Node(index, port) => {
            let node = &graph.nodes[*index];
            format!("{}.{}", node.name, port_name(node, port))
        }
    }
}

/// Name of a port of a node.
pub fn port_name(node: &Node, port: &Port) -> String {
    if let Some(name) = port.common() {
        return name.to_owned();
    }
    if let (Some(_), Some((kind, k))) = (&node.graph, port.of_graph()) {
        return format!("{}_{k}", kind.word());
    }
    let name = match port {
        Port::Number(kind, k) => format!("{}_{k}", kind.word()),
        // This is the port of the parameter itself, if the parameter has a value.
        Port::Param(Kind::In, param) if node.param_names.contains(&names::snake(param)) => names::snake(param),
        Port::Param(kind, param) => format!("{}_{}", kind.word(), names::snake(param)),
    };
    let known = known::find(&node.ty).and_then(|known| known.ports.iter().find(|(theirs, _)| *theirs == name));
    known.map_or(name, |(_, ours)| (*ours).to_owned())
}

//! Statements that a source file gets at the end: claims, records, and what a robot is tuned for.

use super::{case::Item, interface::Interface, maker::Maker};

/// Adds some of them. A node without the feature that a statement needs makes it a mistake, which is to be found.
pub fn add(maker: &mut Maker) {
    for add in [claims, record, set_back, skip, tune, recording, in_state, field] {
        if maker.dice.one_in(6) {
            let graph = maker.dice.of(&maker.graphs.clone()).clone();
            add(maker, &graph);
        }
    }
}

/// Adds a statement to a graph.
fn state(maker: &mut Maker, graph: &Interface, statement: String) {
    let begins = |item: &&mut Item| {
        let head = item.head.trim_start_matches("pub ");
        let name = head.split_once(' ').and_then(|(_, rest)| rest.split(['(', ' ', '<']).next());
        matches!(head.split(' ').next(), Some("graph" | "robot")) && name == Some(&graph.node.name)
    };
    let body = maker.items.iter_mut().find(begins).and_then(|item| item.body.as_mut());
    body.into_iter().for_each(|body| body.push(statement.clone()));
}

/// The nodes of a graph that can be active.
fn active(graph: &Interface) -> Vec<&str> {
    graph.active.iter().filter_map(|port| port.split('.').next()).collect()
}

fn claims(maker: &mut Maker, graph: &Interface) {
    let active = active(graph);
    let claim = match (maker.dice.below(3), &active[..]) {
        (0, [first, .., last]) => format!("claim reaches({first}, {last});"),
        (1, [_, ..]) => "claim conserved;".to_owned(),
        _ => "claim live;".to_owned(),
    };
    state(maker, graph, claim);
}

fn record(maker: &mut Maker, graph: &Interface) {
    let ports = graph.named.iter().flat_map(|(name, node)| {
        let ports = node.outputs.iter().chain(&node.events);
        ports.map(move |port| format!("{name}.{};", port.name))
    });
    let ports: Vec<String> = ports.take(1 + maker.dice.below(2)).collect();
    if !ports.is_empty() {
        state(maker, graph, format!("record \"made.mcap\" {{ {} }}", ports.join(" ")));
    }
}

fn set_back(maker: &mut Maker, graph: &Interface) {
    state(maker, graph, "set_back -> exit;".to_owned());
}

/// A source of the graph leaves out what it has missed.
fn skip(maker: &mut Maker, _: &Interface) {
    let lines = maker.items.iter_mut().filter_map(|item| item.body.as_mut()).flatten();
    let mut sources = lines.filter(|line| line.starts_with("node ") && line.contains(" every 3ms"));
    if let Some(line) = sources.next() {
        *line = line.replacen(" every 3ms", " every 3ms skip", 1);
    }
}

fn tune(maker: &mut Maker, graph: &Interface) {
    let (Some((param, _)), Some(goal)) = (graph.node.params.first(), graph.node.outputs.first()) else { return };
    let goal = match maker.dice.below(3) {
        0 => format!("minimise {};", goal.name),
        1 => format!("maximise {};", goal.name),
        _ => format!("minimise {} at 50%;", goal.name),
    };
    let mut body = vec![format!("vary {param} in 1..=2;"), "wait 1s;".to_owned(), goal];
    body.push(format!("require never {};", graph.node.outputs[0].name));
    body.extend(["seeds 2;", "holdout 3;"].map(str::to_owned));
    maker.items.push(Item { head: format!("tune Best: {}", graph.node.name), body: Some(body) });
}

fn recording(maker: &mut Maker, graph: &Interface) {
    let Some(port) = graph.node.inputs.first() else { return };
    let body = vec![format!("feed {} = recording(\"none.mcap\", \"x\");", port.name), "wait 1s;".to_owned()];
    maker.items.push(Item { head: format!("test it_replays: {}", graph.node.name), body: Some(body) });
}

/// Adds a statement to the first test of a graph.
fn observe(maker: &mut Maker, graph: &Interface, statement: String) {
    let of_graph = format!(": {}", graph.node.name);
    let test = maker.items.iter_mut().find(|item| item.head.starts_with("test ") && item.head.ends_with(&of_graph));
    test.and_then(|item| item.body.as_mut()).into_iter().for_each(|body| body.push(statement.clone()));
}

/// A state machine is in its first state, or in another one.
fn in_state(maker: &mut Maker, graph: &Interface) {
    for (name, node) in &graph.named {
        let machine = maker.items.iter().find(|item| item.head == format!("fsm {}", node.name));
        let lines = machine.and_then(|item| item.body.as_ref()).into_iter().flatten();
        let states: Vec<&str> = lines.filter_map(|line| line.strip_prefix("state ")?.split(' ').next()).collect();
        if !states.is_empty() {
            let state = maker.dice.of(&states);
            return observe(maker, graph, format!("expect active({name}.{state});"));
        }
    }
}

/// A field of a token is compared.
fn field(maker: &mut Maker, graph: &Interface) {
    let ports = graph.node.outputs.iter().chain(&graph.node.events);
    let Some((port, name)) = ports.clone().find_map(|port| match port.ty.name {
        "Pose" => Some((port, "x")),
        "Pair<i64>" => Some((port, "b")),
        _ => None,
    }) else {
        return;
    };
    let operator = maker.word(&["==", "!=", "<", ">="]);
    observe(maker, graph, format!("expect {}.{name} {operator} 3;", port.name));
}

//! Every item is drawn, and drawn once.

use crate::{Drawer, root};
use apex_diagram::{
    Anchor, Flow, Frame, Item, News, READABLE, Shape, Side, diagram, folded, folded_states, mark_new, states,
};
use apex_dsl::graph::{Graph, NodeKind, Subject, WireEnd};

const KINDS: &str = "
use apex_nodes::flow::{ActivityGate, Relay, Wait};
use apex_tests::nodes::{Count, Snk, Take, Tee, mul};

/// Everything that can be connected.
graph Kinds {
    in    x: i64;
    out   y: i64;
    slot  go;
    event over;

    /// Has a doc of its own.
    node s     = Count(end = 4) every 20ms;
    node inner = Inner(k = 7);
    node t     = Take();
    node k     = Snk();
    node wait  = Relay();
    node rest  = Wait() timeout 2s;
    start       => wait.enable;
    go          -> wait.put;
    wait.signal => rest.activate;
    rest.timeout => over;
    rest.timeout => wait.enable;
    x -> inner.a;
    inner.b -> y;
    s -> k;
    s -> t.s;
    inner.e -> mul(k = 2) -> Snk();
}

/// A graph inside.
graph Inner(k: i64 = 3) {
    in    a: i64;
    out   b: i64;
    event e: i64;
    node m   = mul(k = k);
    node tee = Tee();
    a -> m -> tee;
    tee.out -> b;
    tee.e -> e;
}
";

fn named<'a>(frame: &'a Frame, name: &str) -> (usize, &'a Item) {
    let mut found = frame.items.iter().enumerate().filter(|(_, item)| item.name == name);
    let item = found.next().unwrap_or_else(|| panic!("there is no `{name}`"));
    assert!(found.next().is_none(), "`{name}` is drawn twice");
    item
}

/// Lines by the names at their ends.
fn lines(item: &Item) -> Vec<String> {
    let frame = item.inside.as_ref().expect("it has an inside");
    let name = |end: Anchor| match end {
        Anchor::Own(port) => item.ports[port].name.clone(),
        Anchor::Of(at, port) => {
            let inner = &frame.items[at];
            format!("{}.{}", inner.name, inner.ports[port].name)
        }
    };
    let line = |l: &apex_diagram::Line| {
        let arrow = if l.active { "=>" } else { "->" };
        format!("{} {arrow} {} {:?}", name(l.from), name(l.to), l.flow)
    };
    let mut all: Vec<String> = frame.lines.iter().map(line).collect();
    all.sort();
    all
}

#[test]
fn nested_graphs_can_be_closed() {
    let item = Drawer::new().one(KINDS);
    let (open, closed) = (item.inside.clone().expect("an inside"), item.clone().closed(1));
    let (_, inner) = named(&open, "inner");
    let inside = closed.inside.as_ref().expect("it is open itself");
    let (_, box_of_inner) = named(inside, "inner");
    assert!(inner.inside.is_some() && box_of_inner.inside.is_none());
    assert_eq!((&box_of_inner.ports, &box_of_inner.words), (&inner.ports, &inner.words));
    assert_eq!(lines(&closed), lines(&item), "all lines of the open one are there");
    assert_eq!(item.clone().closed(2), item);
    assert_eq!(item.closed(0).inside, None);
}

#[test]
fn nodes_and_connections_of_all_kinds() {
    let item = Drawer::new().one(KINDS);
    assert_eq!(item.docs.trim(), "Everything that can be connected.");
    let sides: Vec<(&str, Side)> = item.ports.iter().map(|p| (p.name.as_str(), p.side)).collect();
    assert_eq!(sides, [("x", Side::Left), ("y", Side::Right), ("go", Side::Top), ("over", Side::Bottom)]);
    let expected = [
        "go -> wait.put Asynchronous",
        "inner.b -> y Synchronous",
        "inner.e -> mul_1.x Hybrid",
        "mul_1. -> snk_2.x Synchronous",
        "rest.timeout => over Asynchronous",
        "rest.timeout => wait.enable Asynchronous",
        "s. -> k.x Synchronous",
        "s. -> t.s Hybrid",
        "start. => wait.enable Asynchronous",
        "wait.signal => rest.activate Asynchronous",
        "x -> inner.a Synchronous",
    ];
    assert_eq!(lines(&item), expected);
    let frame = item.inside.as_ref().unwrap();
    assert_eq!(frame.items.len(), 9);
    assert_eq!(named(frame, "s").1.words, ["Count", "end = 4", "every 20 ms"]);
    assert_eq!(named(frame, "s").1.docs.trim(), "Has a doc of its own.");
    assert_eq!(named(frame, "rest").1.words, ["Wait", "timeout 2 s"]);
    assert_eq!(named(frame, "start").1.shape, Shape::Start);
    assert_eq!((named(frame, "rest").1.active, named(frame, "k").1.active), (true, false));
    let inner = named(frame, "inner").1;
    assert_eq!(inner.words, ["Inner", "k = 7"]);
    assert_eq!(inner.docs.trim(), "A graph inside.");
    let expected =
        ["a -> m.x Synchronous", "m. -> tee.x Synchronous", "tee. -> b Synchronous", "tee.e -> e Asynchronous"];
    assert_eq!(lines(inner), expected);
}

#[test]
fn values_that_are_the_default_are_not_shown() {
    let text = "use apex_nodes::scan::JumpDistance;\nuse apex_nodes::scan::Scan;\ngraph A { in s: Scan; node j = JumpDistance(gap = VALUE); s -> j; }";
    let words = |value: &str| {
        let item = Drawer::new().one(&text.replace("VALUE", value));
        named(item.inside.as_ref().unwrap(), "j").1.words.clone()
    };
    assert_eq!(words("15cm"), ["JumpDistance"]);
    assert_eq!(words("30cm"), ["JumpDistance", "gap = 0.3 m"]);
}

#[test]
fn activity_alone_is_a_state_diagram() {
    let seen = states(&Drawer::new().one(KINDS)).expect("there is activity in it");
    let frame = seen.inside.as_ref().unwrap();
    let names: Vec<&str> = frame.items.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["wait", "rest", "start"], "neither data flow nor what it goes through");
    assert_eq!(seen.ports.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["over"]);
    let labels: Vec<&str> = frame.lines.iter().map(|l| l.label.as_str()).collect();
    assert_eq!(labels, ["", "signal", "timeout", "timeout"]);
    let silent = Drawer::new().one("use apex_tests::nodes::{Count, Snk}; graph A { node s = Count(); s -> Snk(); }");
    assert_eq!(states(&silent), None);
}

#[test]
fn a_machine_shows_its_states() {
    let text = "
fsm Door {
    slot  push;
    slot  lock: i64;
    event bell;
    state closed { on push => open -> bell; on lock -> bell; }
    state open { on push => closed; on lock if lock > 3 => closed; }
}
graph House { slot push; node door = Door(); push -> door.push; }
";
    let item = Drawer::new().one(text);
    let (_, door) = named(item.inside.as_ref().unwrap(), "door");
    assert!(door.inside.is_none(), "the graph shows it as a box");
    let seen = states(&item).expect("a machine has states");
    let (_, door) = named(seen.inside.as_ref().unwrap(), "door");
    let frame = door.inside.as_ref().expect("its states are drawn");
    let names: Vec<&str> = frame.items.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["closed", "open", "start"]);
    assert_eq!(frame.items[0].words, ["lock / bell"]);
    let labels: Vec<&str> = frame.lines.iter().map(|l| l.label.as_str()).collect();
    assert_eq!(labels, ["", "push / bell", "push", "lock [lock > 3]"]);
}

#[test]
fn what_every_program_has_is_told_apart_from_the_start() {
    let text = "
use apex_nodes::flow::{ActivityGate, Relay, tick};
robot Runner {
    thread main { hang = 200ms }
    thread vision { hang = 2s }
    node clock = tick() every 50ms;
    node watch = Relay() on vision;
    node gate  = ActivityGate<()>();
    clock -> watch.put;
    clock -> gate.value;
    start => gate.activate;
    hung  -> abort;
}
";
    let item = Drawer::new().one(text);
    let frame = item.inside.as_ref().unwrap();
    let shapes = ["start", "hung", "abort"].map(|name| named(frame, name).1.shape);
    assert_eq!(shapes, [Shape::Start, Shape::Event, Shape::End]);
    assert!(lines(&item).contains(&"hung. -> abort. Asynchronous".to_owned()), "{:?}", lines(&item));
}

/// A graph with `count` instances of a graph of three nodes, one of which is a graph of two nodes.
fn large(count: usize) -> String {
    let parts: String = (0..count).map(|i| format!("    node p{i} = Middle();\n    s -> p{i}.x;\n")).collect();
    format!(
        "use apex_tests::nodes::{{Count, Snk, mul}};
graph Large {{
    node s = Count();
{parts}}}
graph Middle {{ in x: i64; node m = mul(k = 2); node inner = Inner(); x -> m -> inner.x; }}
graph Inner {{ in x: i64; node m = mul(k = 3); x -> m -> Snk(); }}
"
    )
}

#[test]
fn large_pictures_are_folded() {
    let mut drawer = Drawer::new();
    let mut item = |count| drawer.one(&large(count));
    let small = item(3);
    assert_eq!(folded(small.clone()), (small, Default::default()));
    for (count, depth) in [(6, 1), (12, 0), (40, 0)] {
        let (item, folding) = folded(item(count));
        assert_eq!((folding.depth, folding.chains), (Some(depth), 0), "{count}");
        assert_eq!(item.count() <= READABLE, count < 40);
    }
    assert_eq!(folded_states(&item(40)), None);
}

#[test]
fn long_chains_become_one_box() {
    let chain: Vec<String> = (0..30).map(|i| format!("n{i}")).collect();
    let nodes: String = chain.iter().map(|name| format!("    node {name} = mul(k = 2);\n")).collect();
    let text = format!(
        "use apex_tests::nodes::{{Count, Snk, mul}};\ngraph Long {{\n    node s = Count();\n{nodes}    s -> {};\n    s -> Snk();\n    n29 -> Snk();\n}}\n",
        chain.join(" -> ")
    );
    let item = Drawer::new().one(&text);
    let (small, folding) = folded(item.clone());
    assert_eq!((folding.depth, folding.chains, small.count()), (None, 1, 4));
    let frame = small.inside.as_ref().unwrap();
    let (_, chain) = named(frame, "n0 … snk_2");
    assert_eq!(chain.words.len(), 31, "{:?}", chain.words);
    assert_eq!(chain.words[7], "n7: mul");
    assert_eq!(frame.lines.len(), 2);
    assert_eq!(lines(&small), ["s. -> n0 … snk_2.x Synchronous", "s. -> snk_1.x Synchronous"]);
}

/// Numbers of nodes and connections that a picture must have.
fn expected(graph: &Graph) -> (usize, usize) {
    use NodeKind::{Boundary, Interrupt, Relay};
    let drawn = |n: &&apex_dsl::graph::Node| !matches!(n.kind, Boundary(_) | Relay | Interrupt(_));
    let nodes = graph.nodes.iter().filter(drawn).count() + graph.scopes.len() - 1;
    // A connection with the `cancel` of a nested graph ends at its frame.
    let is_inside = |end: WireEnd| {
        let WireEnd::Port(end) = end else { return false };
        matches!(graph.nodes[end.node].kind, Interrupt(Subject::Scope(_)))
    };
    let lines = graph.wires.iter().filter(|wire| !is_inside(wire.from) && !is_inside(wire.to)).count();
    (nodes, lines + graph.nodes.iter().filter(|n| n.starts_active).count())
}

/// Numbers of items and lines of a frame, without start dots and the contents of `each`.
fn drawn(frame: &Frame) -> (usize, usize) {
    let dots = frame.items.iter().filter(|i| i.shape == Shape::Start).count();
    let mut count = (frame.items.len() - dots, frame.lines.len());
    for inner in frame.items.iter().filter(|i| !i.each).filter_map(|i| i.inside.as_ref()) {
        let (items, lines) = drawn(inner);
        count = (count.0 + items, count.1 + lines);
    }
    count
}

#[test]
fn each_node_and_each_connection_is_drawn_once() {
    let mut drawer = Drawer::new();
    let mut hybrid = 0;
    for seed in 0..40 {
        let text = apex_tests::oracle::generate(seed, true).text("Random");
        for graph in drawer.graphs(&root().join("tests"), &text).unwrap_or_default() {
            let item = diagram(&graph, &drawer.1, &drawer.0);
            let frame = item.inside.as_ref().unwrap();
            let starts = graph.nodes.iter().filter(|n| matches!(n.kind, NodeKind::Start)).count();
            let (nodes, connections) = expected(&graph);
            assert_eq!(drawn(frame), (nodes - starts, connections), "{text}");
            hybrid += frame.lines.iter().filter(|l| l.flow == Flow::Hybrid).count();
        }
    }
    assert!(hybrid > 10, "the random graphs have hybrid connections");
}

#[test]
fn a_source_that_a_slower_one_holds_back_has_its_real_period() {
    let item = Drawer::new().one(
        "
use apex_nodes::math::add;
use apex_tests::nodes::{Count, Snk, mul};

graph Joined {
    node fast = Count(end = 9) every 10ms skip;
    node slow = Count(end = 9) every 100ms;
    node free = Count(end = 9) every 10ms;
    node sum  = add();
    fast -> sum.a;
    slow -> sum.b;
    sum  -> Snk();
    free -> Snk();
}
",
    );
    let frame = item.inside.as_ref().expect("it has an inside");
    let words = |name: &str| named(frame, name).1.words[2..].to_vec();
    assert_eq!(words("fast"), ["every 10 ms skip", "really every 100 ms"]);
    assert_eq!([words("slow"), words("free")], [["every 100 ms"], ["every 10 ms"]]);
}

/// Full names of what is new.
fn new_items(item: &Item) -> Vec<String> {
    let names = item.items().flat_map(|inner| {
        let below = new_items(inner).into_iter().map(|name| format!("{}.{name}", inner.name));
        inner.new.then(|| inner.name.clone()).into_iter().chain(below).collect::<Vec<_>>()
    });
    names.collect()
}

#[test]
fn what_others_lack_is_new() {
    let mut drawer = Drawer::new();
    let mut all = |text: &str| -> Vec<Item> {
        let graphs = drawer.graphs(&root().join("tests"), text).unwrap_or_else(|errors| panic!("{errors}"));
        graphs.iter().map(|graph| diagram(graph, &drawer.1, &drawer.0)).collect()
    };
    let old = all(KINDS);
    // The same text has nothing new, whatever the parameters.
    let mut same = all(&KINDS.replace("k = 7", "k = 8")).remove(0);
    let news = mark_new(&mut same, &old);
    assert!(new_items(&same).is_empty() && news.new == 0 && news.all > 6, "{news:?}");
    // A node of another type, and the graph around it.
    let text = KINDS.replace("use apex_tests::nodes::{", "use apex_tests::nodes::{CountUp, ");
    let mut changed = all(&text.replace(
        "graph Inner(k: i64 = 3) {",
        "graph Inner(k: i64 = 3) {\n    node more = CountUp() every 20ms;\n    more -> Snk();",
    ))
    .remove(0);
    assert_eq!(mark_new(&mut changed, &old), News { new: 1, all: news.all + 2 });
    assert_eq!(new_items(&changed), ["inner", "inner.more"]);
    // Beside nothing everything is new.
    let News { new, all } = mark_new(&mut same, &[]);
    assert_eq!(new, all);
}

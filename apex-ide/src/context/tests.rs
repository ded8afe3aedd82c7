//! Contexts at the ends of incomplete source files.

use super::*;

/// The context at the end of a text.
fn at_end(text: &str) -> Context {
    context(text, text.len()).0
}

fn path(words: &str) -> Vec<String> {
    words.split("::").map(str::to_owned).collect()
}

#[test]
fn items_and_imports() {
    assert_eq!(at_end(""), Context::Item);
    assert_eq!(at_end("gra"), Context::Item);
    assert_eq!(at_end("use "), Context::Import(vec![]));
    assert_eq!(at_end("use a::b::"), Context::Import(path("a::b")));
    assert_eq!(at_end("use a::{b::{c, D"), Context::Import(path("a::b")));
    assert_eq!(at_end("use a::{b::{c}, "), Context::Import(path("a")));
    assert_eq!(at_end("graph A { x -> y; }\nuse a::"), Context::Import(path("a")));
    assert_eq!(at_end("test t: "), Context::Tested);
    assert_eq!(at_end("tune t: "), Context::Tested);
}

#[test]
fn statements_of_a_graph() {
    let in_graph = |text: &str| at_end(&format!("use a::{{b, c}};\n/// x\ngraph A(x: u8) {{ in a: u8; {text}"));
    let name = |parts: &[&str]| Some(PortId::Reference(parts.iter().map(|p| (*p).to_owned()).collect()));
    assert_eq!(in_graph(""), Context::Statement);
    assert_eq!(in_graph("sc"), Context::Statement);
    assert_eq!(in_graph("in x: Sc"), Context::Type);
    assert_eq!(in_graph("node n = "), Context::Constructor(false));
    assert_eq!(in_graph("node n: "), Context::Constructor(true));
    assert_eq!(in_graph("node n = a::b::"), Context::Path(path("a::b")));
    assert_eq!(in_graph("x.y -> "), Context::Name(Named::Takes, name(&["x", "y"])));
    assert_eq!(in_graph("x -> [y, z"), Context::Name(Named::Takes, name(&["x"])));
    assert_eq!(in_graph("[x, y] => "), Context::Name(Named::Takes, name(&["x"])));
    assert_eq!(
        in_graph("x -> a::B(c = 1) -> y."),
        Context::Port(PortId::Reference(vec!["y".into()]), Named::Takes, Some(PortId::InPlace(path("a::B"))))
    );
    assert_eq!(in_graph("x."), Context::Port(PortId::Reference(vec!["x".into()]), Named::Sends, None));
    assert_eq!(in_graph("claim "), Context::Claim);
    assert_eq!(in_graph("claim exclusive(a, "), Context::Name(Named::Node, None));
    assert_eq!(in_graph("record "), Context::Nothing);
    assert_eq!(in_graph("record \"a.mcap\" { x.y; "), Context::Name(Named::Node, None));
    let of = PortId::Reference(vec!["x".into()]);
    assert_eq!(in_graph("record \"a.mcap\" { x."), Context::Port(of, Named::Tested, None));
}

#[test]
fn arguments_and_modifiers() {
    let in_graph = |text: &str| at_end(&format!("graph A {{ {text}"));
    assert_eq!(in_graph("x -> B("), Context::Argument(path("B"), vec![]));
    assert_eq!(in_graph("node n = a::B(c = [1, 2], d"), Context::Argument(path("a::B"), path("c")));
    assert_eq!(in_graph("node n = B(c = -(1 + "), Context::Value(path("B"), "c".into()));
    assert_eq!(in_graph("node n = B(c = [[15c"), Context::Unit(Quantity::Argument(path("B"), "c".into())));
    assert_eq!(in_graph("node n = B() ev"), Context::Modifier);
    assert_eq!(in_graph("node n = B() every 20m"), Context::Unit(Quantity::Time));
    assert_eq!(in_graph("node n = B() every 20ms "), Context::Modifier);
    assert_eq!(in_graph("node n = a::B() each("), Context::List(path("a::B")));
    assert_eq!(at_end("graph A(x: f32["), Context::Unit(Quantity::Any));
    assert_eq!(at_end("graph A(x: f32[m], y: "), Context::Type);
}

#[test]
fn statements_of_a_study() {
    let in_tune = |text: &str| at_end(&format!("tune t: A {{ wait 1s; {text}"));
    assert_eq!(in_tune(""), Context::Tune);
    assert_eq!(in_tune("vary "), Context::Varied(vec![]));
    assert_eq!(in_tune("vary a.b."), Context::Varied(vec!["a".into(), "b".into()]));
    assert_eq!(in_tune("vary a.b "), Context::Words(&["in"]));
    assert_eq!(in_tune("vary a.b in "), Context::Expression);
    assert_eq!(in_tune("minimise "), Context::Name(Named::Tested, None));
    assert_eq!(in_tune("maximise y "), Context::Words(&["at"]));
    assert_eq!(in_tune("require "), Context::Required);
    assert_eq!(in_tune("require never "), Context::Name(Named::Tested, None));
    assert_eq!(in_tune("seeds "), Context::Nothing);
    assert_eq!(in_tune("feed "), Context::Name(Named::Fed, None));
}

#[test]
fn machines_and_tests() {
    let in_state = |text: &str| at_end(&format!("fsm M {{ slot s; state a {{ {text}"));
    assert_eq!(at_end("fsm M { "), Context::Machine(false));
    assert_eq!(in_state(""), Context::Machine(true));
    assert_eq!(in_state("on "), Context::MachineSlot);
    assert_eq!(in_state("on s if s > 1 => "), Context::State);
    assert_eq!(in_state("on s => b -> "), Context::MachineEvent);
    let in_test = |text: &str| at_end(&format!("test t: A(x = 1) {{ wait 1s; {text}"));
    assert_eq!(in_test(""), Context::Test);
    assert_eq!(in_test("feed "), Context::Name(Named::Fed, None));
    assert_eq!(in_test("expect "), Context::Name(Named::Tested, None));
    assert_eq!(in_test("expect active("), Context::Name(Named::Node, None));
    assert_eq!(in_test("expect x within 1"), Context::Unit(Quantity::Time));
    assert_eq!(in_test("replace a = "), Context::Constructor(false));
}

#[test]
fn no_place_is_too_much() {
    assert_eq!(at_end("// gra"), Context::Nothing);
    assert_eq!(at_end(&"(".repeat(100_000)), Context::Nothing);
    assert_eq!(at_end(&"a::".repeat(100_000)), Context::Path(vec!["a".to_owned(); 100_000]));
}

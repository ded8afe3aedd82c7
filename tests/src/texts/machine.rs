//! Random state machines.

use super::{
    case::Item,
    interface::{Node, Port, port},
    kinds::Kind,
    maker::Maker,
    names,
    types::Type,
};

/// Names of states that are difficult for code generation.
const STATES: &[&str] = &[
    "Self", "self", "state", "token", "match", "super", "crate", "a_b", "aB", "AB", "ab", "type", "new", "Idle",
    "idle", "idle_", "None", "Some", "_", "__", "x1", "x_1", "entry", "on", "fn", "events", "Clone", "r", "A", "a",
    "event",
];
const PLAIN_STATES: &[&str] = &["waiting", "driving", "docked", "failed", "searching", "first_try", "second_try"];
/// Names of slots and events that are difficult for code generation.
const PORTS: &[&str] = &[
    "state",
    "new",
    "begin",
    "start",
    "construct",
    "self",
    "Self",
    "match",
    "token",
    "default",
    "clone",
    "fmt",
    "type",
    "event_x",
    "_",
    "super",
    "crate",
    "into",
    "enter",
    "entry",
    "exit",
    "async",
    "process",
    "try",
    "event_done",
    "x",
    "y",
    "enable",
    "failed",
    "timeout",
];

/// Adds a state machine to the source file.
pub fn add(maker: &mut Maker) {
    let mut used: Vec<String> = maker.machines.iter().map(|m| m.name.clone()).collect();
    let list = if maker.strikes(Kind::GraphNames, 1) { names::GRAPHS } else { &["Courier", "Turns", "Door"] };
    let name = maker.free(list, &mut used);
    let mut used = vec![];
    let slots: Vec<Port> = (0..1 + maker.dice.below(2)).map(|_| a_port(maker, &mut used)).collect();
    let events: Vec<Port> = (0..1 + maker.dice.below(2)).map(|_| a_port(maker, &mut used)).collect();
    let mut body = vec![];
    for (word, ports) in [("slot", &slots), ("event", &events)] {
        for port in ports {
            let ty = maker.written(port.ty);
            body.push(format!("{word} {}: {ty};", port.name));
        }
    }
    let states: Vec<String> = {
        let mut used = vec![];
        let list = if maker.strikes(Kind::Machines, 4) { STATES } else { PLAIN_STATES };
        (0..2 + maker.dice.below(3)).map(|_| maker.free(list, &mut used)).collect()
    };
    let nested = maker.dice.one_in(3);
    let mut lines: Vec<String> = states.iter().map(|s| state(maker, s, &states, &slots, &events)).collect();
    if nested && lines.len() > 2 {
        let inner = lines.remove(1);
        lines[0] = lines[0].trim_end_matches('}').to_owned() + &inner + " }";
    }
    body.extend(lines);
    maker.items.push(Item { head: format!("fsm {name}"), body: Some(body) });
    maker.machines.push(Node { name, generic: None, inputs: vec![], outputs: vec![], slots, events, params: vec![] });
}

fn a_port(maker: &mut Maker, used: &mut Vec<String>) -> Port {
    let list = if maker.strikes(Kind::Machines, 4) { PORTS } else { names::PLAIN_PORTS };
    let name = maker.free(list, used);
    let ty = maker.ty();
    maker.rust(ty.item);
    port(&name, ty)
}

fn state(maker: &mut Maker, name: &str, states: &[String], slots: &[Port], events: &[Port]) -> String {
    let mut text = format!("state {name} {{ ");
    if maker.dice.one_in(3)
        && let [_, event, ..] = events
    {
        let hook = *maker.dice.of(&["entry", "exit"]);
        if let Some(value) = maker.token(event.ty) {
            text.push_str(&format!("{hook} -> {}({value}); ", event.name));
        }
    }
    for slot in slots {
        let guard = if maker.dice.one_in(2) { guard(maker, slot) } else { String::new() };
        let target = if maker.dice.one_in(5) {
            String::new()
        } else {
            let returns = if maker.dice.one_in(12) { *maker.dice.of(&["resume ", "repeat "]) } else { "" };
            format!(" => {returns}{}", maker.dice.of(states))
        };
        let sent = sent(maker, slot, events);
        if !target.is_empty() || !sent.is_empty() {
            text.push_str(&format!("on {}{guard}{target}{sent}; ", slot.name));
        }
    }
    if maker.dice.one_in(3) {
        let time = maker.dice.of(&["1ms", "5s", "2.5ms", "1h"]);
        let target = if maker.dice.one_in(4) { String::new() } else { format!(" => {}", maker.dice.of(states)) };
        let sent = match events {
            [event, ..] if target.is_empty() || maker.dice.one_in(2) => {
                maker.token(event.ty).map_or(String::new(), |value| format!(" -> {}({value})", event.name))
            }
            _ => String::new(),
        };
        if !target.is_empty() || !sent.is_empty() {
            text.push_str(&format!("after {time}{target}{sent}; "));
        }
    }
    text + "}"
}

fn guard(maker: &mut Maker, slot: &Port) -> String {
    let name = &slot.name;
    if maker.strikes(Kind::Machines, 2) || maker.strikes(Kind::Values, 2) {
        let odd = [
            "{} > 300",
            "{} % 0 == 1",
            "{} == 1.5",
            "{} / 0 > 1",
            "{} == \"s\"",
            "!{}",
            "{}",
            "nope > 1",
            "{} == [1]",
            "{} > 1m",
            "{} < -1",
            "{} + 1 > 255",
            "{} == crate::MISSING",
            "-{} > 1",
            "{} && true",
            "{} == {}",
            "{} * 1e40 > 1",
            "true",
            "1 < 2",
            "1",
            "{} == 1 == true",
            "{} - 300 < 0",
            "{} % 2 == 0",
            "{} > 0xffff",
            "{} == 2 * 200",
            "{} % (1 - 1) == 0",
            "{} < 1e400",
        ];
        return format!(" if {}", maker.dice.of(&odd).replace("{}", name));
    }
    let number = matches!(slot.ty.name, "i64" | "u8" | "u32" | "f64" | "Meters" | "usize" | "i128");
    match (number, slot.ty.name) {
        (true, _) => {
            format!(" if {name} {} {}", maker.dice.of(&["<", ">", "==", ">="]), maker.dice.of(&["1", "7", "2 * 3"]))
        }
        (_, "bool") => format!(" if {name} == true"),
        (_, "String") => format!(" if {name} == \"a\""),
        _ => String::new(),
    }
}

fn sent(maker: &mut Maker, slot: &Port, events: &[Port]) -> String {
    if maker.dice.one_in(3) {
        return String::new();
    }
    // Events of entry and exit are not used here: a transition triggers an event at most once.
    let event = events[0].clone();
    match same(event.ty, slot.ty) && maker.dice.one_in(2) || maker.strikes(Kind::Machines, 6) {
        true => format!(" -> {}", event.name),
        false => match maker.token(event.ty) {
            Some(value) if number(slot.ty) && number(event.ty) && maker.dice.one_in(3) => {
                format!(" -> {}({} + {value})", event.name, slot.name)
            }
            Some(value) => format!(" -> {}({value})", event.name),
            None => String::new(),
        },
    }
}

fn same(a: &Type, b: &Type) -> bool {
    a == b
}

fn number(ty: &Type) -> bool {
    matches!(ty.name, "i64" | "u8" | "u32" | "f64")
}

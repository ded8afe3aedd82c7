//! Random graphs around a random state machine.

use crate::Dice;
use std::fmt::Write as _;

/// Slots of the machine.
const SLOTS: [&str; 3] = ["s", "t", "r"];
/// Events: of `entry`, of `exit`, and of transitions, the last one without a value. One transition must not trigger an
/// event twice.
const EVENTS: [&str; 4] = ["e", "f", "g", "u"];

/// A state with those inside it.
struct State {
    name: String,
    inner: Vec<State>,
}

impl State {
    /// Random states in a state, three deep at most.
    fn some(dice: &mut Dice, outer: &str, depth: usize) -> Vec<Self> {
        let count = if depth == 0 { 2 + dice.below(3) } else { dice.below(4) };
        let state = |number| {
            let name = format!("{outer}{}{number}", ["a", "b", "c"][depth]);
            let inner = if depth < 2 { Self::some(dice, &name, depth + 1) } else { vec![] };
            Self { name, inner }
        };
        (0..count).map(state).collect()
    }

    /// Names of this state and all inside it, with `true` if there are some.
    fn names(&self) -> Vec<(String, bool)> {
        let own = (self.name.clone(), !self.inner.is_empty());
        [own].into_iter().chain(self.inner.iter().flat_map(Self::names)).collect()
    }
}

/// Writes a machine.
struct Writer<'a> {
    dice: &'a mut Dice,
    names: Vec<(String, bool)>,
    /// Depth of the states that have an `entry`, and of those that have an `exit`.
    depths: [usize; 2],
    text: String,
}

impl Writer<'_> {
    fn state(&mut self, state: &State, depth: usize) {
        let margin = " ".repeat(4 * depth + 4);
        let _ = writeln!(self.text, "{margin}state {} {{", state.name);
        for (number, word) in ["entry", "exit"].into_iter().enumerate() {
            if self.depths[number] == depth && self.dice.one_in(2) {
                let _ = writeln!(self.text, "{margin}    {word} -> {}({});", EVENTS[number], self.dice.below(9));
            }
        }
        for _ in 0..self.dice.below(4) {
            let (slot, target) = (*self.dice.of(&SLOTS), self.target());
            let guard = if self.dice.one_in(2) { format!(" if {}", self.guard(slot)) } else { String::new() };
            let sends = if target.is_empty() || self.dice.one_in(2) { self.sends(true) } else { "" };
            let _ = writeln!(self.text, "{margin}    on {slot}{guard}{target}{sends};");
        }
        if self.dice.one_in(4) {
            let (time, target) = (500 * (1 + self.dice.below(7)), self.target());
            let sends = if target.is_empty() || self.dice.one_in(2) { self.sends(false) } else { "" };
            let _ = writeln!(self.text, "{margin}    after {time}us{target}{sends};");
        }
        state.inner.iter().for_each(|inner| self.state(inner, depth + 1));
        let _ = writeln!(self.text, "{margin}}}");
    }

    /// Random target of a transition.
    fn target(&mut self) -> String {
        let (name, has_inner) = self.dice.of(&self.names).clone();
        match self.dice.below(6) {
            0 => String::new(),
            1..=3 if has_inner => format!(" => {} {name}", self.dice.of(&["resume", "repeat"])),
            _ => format!(" => {name}"),
        }
    }

    /// Random events of a transition; with a token, some carry it.
    fn sends(&mut self, has_token: bool) -> &'static str {
        let some: &[&str] =
            if has_token { &[" -> g", " -> g, u", " -> u", " -> g(3)"] } else { &[" -> u", " -> g(4), u"] };
        some[self.dice.below(some.len())]
    }

    /// Random condition on a token, sometimes without a result.
    fn guard(&mut self, token: &str) -> String {
        let (n, m) = (2 + self.dice.below(4), self.dice.below(4));
        match self.dice.below(6) {
            0 => format!("{token} % {n} == {m}"),
            1 => format!("{token} % {n} > 1 || !({token} % 3 < {m})"),
            2 => format!("12 / ({token} % {n}) > {m}"),
            3 => format!("{token} * {token} * {token} > {m} && {token} % 2 != 0"),
            4 => format!("-({token} % {n}) <= -{m}"),
            _ => format!("{token} > {m}"),
        }
    }
}

/// The text of a graph for a seed. It is not always legal.
pub fn machine(seed: u64, name: &str) -> String {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let states = State::some(&mut dice, "", 0);
    let names = states.iter().flat_map(State::names).collect();
    let depths = [dice.below(3), dice.below(3)];
    let mut writer = Writer { dice: &mut dice, names, depths, text: String::new() };
    states.iter().for_each(|state| writer.state(state, 0));
    let states = writer.text;
    let slots = SLOTS.map(|slot| format!("    slot {slot}: i64;\n")).concat();
    let events =
        EVENTS.map(|event| format!("    event {event}{};\n", if event == "u" { "" } else { ": i64" })).concat();
    let mut text = format!("fsm {name}States {{\n{slots}{events}{states}}}\n\n");
    let active = dice.one_in(2);
    let arrow = |dice: &mut Dice| if active && dice.one_in(2) { "=>" } else { "->" };
    let has_threads = dice.one_in(3);
    let on = |dice: &mut Dice| if has_threads { *dice.of(&["", " on x", " on y"]) } else { "" };
    let is_nested = dice.one_in(2);
    let machine = if is_nested { "g" } else { "m" };
    if is_nested {
        let _ = writeln!(text, "graph {name}Inner {{\n{slots}{events}    node m = {name}States(){};", on(&mut dice));
        text.extend(SLOTS.map(|slot| format!("    {slot} {} m.{slot};\n", arrow(&mut dice))));
        text.extend(EVENTS.map(|event| format!("    m.{event} {} {event};\n", arrow(&mut dice))));
        text.push_str("}\n\n");
    }
    let _ = writeln!(text, "graph {name} {{");
    let machine_on = if is_nested { "" } else { on(&mut dice) };
    let _ = writeln!(text, "    node {machine} = {name}{}(){machine_on};", if is_nested { "Inner" } else { "States" });
    for number in 1..=SLOTS.len() {
        let (mode, every) = (dice.below(2), 1 + dice.below(3));
        let every = if dice.one_in(3) { String::new() } else { format!(" every {every}ms") };
        let _ = writeln!(
            text,
            "    node t{number} = ScTicker(id = {number}, script = [{seed}, {mode}, 25]){every}{};",
            on(&mut dice)
        );
        let _ = writeln!(text, "    t{number}.e {} {machine}.{};", arrow(&mut dice), SLOTS[number - 1]);
    }
    for (number, ty) in [(4, "ScHandler"), (5, "ScHandler"), (6, "ScHandler"), (7, "ScKick")] {
        let _ = writeln!(text, "    node h{number} = {ty}(id = {number}, script = [{seed}, 0, 12]){};", on(&mut dice));
        let _ = writeln!(text, "    {machine}.{} {} h{number}.s;", EVENTS[number - 4], arrow(&mut dice));
    }
    if active {
        let _ = writeln!(text, "    start => {};", dice.of(&["t1", "t2", "h4"]));
    }
    // Tokens come back, and the machine is moved from outside.
    if dice.one_in(2) {
        let _ = writeln!(text, "    h4.f {} {machine}.{};", arrow(&mut dice), dice.of(&SLOTS));
    }
    let moves = [format!("{machine}.cancel"), format!("{machine}.resume"), "reset".to_owned()];
    for port in moves {
        // One thread takes all activity away at once.
        if !has_threads && dice.one_in(3) {
            let _ = writeln!(text, "    {} -> {port};", dice.of(&["h4.e", "h5.e", "h5.f", "h6.e", "h7.e"]));
        }
    }
    text + "}\n"
}

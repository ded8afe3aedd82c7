//! Random finite-state machines: as `fsm`, and translated to activity as in section 7.2.1 of the thesis.

use crate::Dice;
use std::fmt::Write as _;

/// Input letters of a machine.
pub const LETTERS: [&str; 3] = ["a", "b", "c"];

/// For each state, the target of each letter, or `None` if the state remains.
pub type Machine = Vec<[Option<usize>; LETTERS.len()]>;

/// The machine for `seed`.
pub fn machine(seed: u64) -> Machine {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let states = 2 + dice.below(7);
    let mut target = |from: usize| Some(dice.below(states)).filter(|to| *to != from);
    (0..states).map(|from| LETTERS.map(|_| target(from))).collect()
}

/// Source file with the machines 0 to `count`, each as the machine `A…` in the graph `Said…`, and translated as the
/// graph `Flow…`.
pub fn machines_text(count: u64) -> String {
    let mut text = "//! Made by `apex_tests::machines_text`.\nuse apex_tests::nodes::Phase;\n".to_owned();
    for number in 0..count {
        let machine = machine(number);
        said(&mut text, number, &machine);
        flow(&mut text, number, &machine);
    }
    text
}

fn said(text: &mut String, number: u64, machine: &Machine) {
    let slots = LETTERS.map(|letter| format!("slot {letter};")).join(" ");
    let _ = writeln!(text, "fsm A{number} {{ {slots}");
    for (state, targets) in machine.iter().enumerate() {
        let arms: Vec<String> = LETTERS
            .iter()
            .zip(targets)
            .filter_map(|(letter, target)| Some(format!("on {letter} => s{};", (*target)?)))
            .collect();
        let _ = writeln!(text, "state s{state} {{ {} }}", arms.join(" "));
    }
    let connections = LETTERS.map(|letter| format!("{letter} -> m.{letter};")).join(" ");
    let _ = writeln!(text, "}} graph Said{number} {{ {slots} node m = A{number}(); {connections} }}");
}

fn flow(text: &mut String, number: u64, machine: &Machine) {
    let slots = LETTERS.map(|letter| format!("slot {letter};")).join(" ");
    let _ = writeln!(text, "graph Flow{number} {{ {slots}");
    for state in 0..machine.len() {
        let _ = writeln!(text, "node s{state} = Phase();");
    }
    text.push_str("start => s0.enter;");
    for (state, targets) in machine.iter().enumerate() {
        for (letter, target) in LETTERS.iter().zip(targets) {
            let _ = writeln!(text, "{letter} -> s{state}.{letter};");
            if let Some(target) = target {
                let _ = writeln!(text, "s{state}.on_{letter} => s{target}.enter;");
            }
        }
    }
    text.push_str("}\n");
}

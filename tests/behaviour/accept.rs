//! ACT-11: random finite-state machines against their translations to activity.
//!
//! The texts are made by `apex_tests::machines_text` and committed; `APEX_BLESS=1` writes them anew.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::{Dice, LETTERS, active, machine, machines_text};

/// So many machines there are.
const COUNT: u64 = 12;
const WORD: usize = 60;

graph!("accept.afg");

#[test]
fn the_machines_are_those_of_the_generator() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/behaviour/accept.afg");
    let expected = apex_dsl::format(&machines_text(COUNT)).expect("the generator knows the syntax");
    if std::env::var_os("APEX_BLESS").is_some() {
        std::fs::write(file, &expected).expect("the folder of the tests can be written");
    }
    assert!(expected == include_str!("accept.afg"), "accept.afg is old: run with APEX_BLESS=1");
}

/// Tells both the same random word; each letter must lead all three to the same state.
macro_rules! compare {
    ($($number:literal $said:ident $flow:ident)*) => {
        $({
            let table = machine($number);
            let (mut said, mut flow) = ($said::new(), $flow::new());
            let (mut dice, mut state) = (Dice($number + 1), 0);
            said.react(Time::ZERO);
            flow.react(Time::ZERO);
            for at in 0..WORD {
                let letter = dice.below(LETTERS.len());
                match LETTERS[letter] {
                    "a" => { said.inputs().a.put(()).unwrap(); flow.inputs().a.put(()).unwrap(); }
                    "b" => { said.inputs().b.put(()).unwrap(); flow.inputs().b.put(()).unwrap(); }
                    _ => { said.inputs().c.put(()).unwrap(); flow.inputs().c.put(()).unwrap(); }
                }
                said.react(Time::ZERO);
                flow.react(Time::ZERO);
                state = table[state][letter].unwrap_or(state);
                assert_eq!(format!("{:?}", said.nodes().m.state()), format!("S{state}"), "machine {} at {at}", $number);
                // Exactly one node is active at every quiet moment: the state.
                assert_eq!(active(&flow), format!("s{state}"), "machine {} at {at}", $number);
            }
        })*
    };
}

#[test]
fn act_11_a_machine_and_its_translation_accept_the_same() {
    compare! {
        0 Said0 Flow0
        1 Said1 Flow1
        2 Said2 Flow2
        3 Said3 Flow3
        4 Said4 Flow4
        5 Said5 Flow5
        6 Said6 Flow6
        7 Said7 Flow7
        8 Said8 Flow8
        9 Said9 Flow9
        10 Said10 Flow10
        11 Said11 Flow11
    }
}

//! Generates random source files.

use super::{
    case::{Call, Case, Item, Shape, Text},
    extra,
    kinds::Kind,
    machine,
    maker::Maker,
    names, script,
    types::{ODD, PLAIN, Type},
    values, variant,
};

/// The case for `seed`.
pub fn generate(seed: u64) -> Case {
    let mut maker = Maker::new(seed);
    if maker.has(Kind::RustNames) {
        maker.colliding_items();
    }
    if maker.has(Kind::Constants) {
        maker.rust(values::CONSTANTS);
    }
    let graphs = 1 + maker.dice.below(3);
    if maker.has(Kind::Machines) || maker.dice.one_in(6) {
        (0..1 + maker.dice.below(2)).for_each(|_| machine::add(&mut maker));
    }
    for _ in 0..graphs {
        let whole = maker.graph();
        maker.graphs.push(whole);
    }
    if maker.has(Kind::Tests) || maker.has(Kind::Threads) || maker.dice.one_in(3) {
        script::add(&mut maker);
    }
    // Decided last, so that the rest of a case is what it was before there were variants.
    if maker.dice.one_in(3) {
        variant::add(&mut maker);
    }
    if maker.dice.one_in(3) {
        variant::publish(&mut maker);
    }
    extra::add(&mut maker);
    maker.case(seed)
}

impl Maker {
    /// Adds constants, tuple structs and types with colliding names.
    fn colliding_items(&mut self) {
        for _ in 0..2 + self.dice.below(4) {
            let name = *self.dice.of(names::ITEMS);
            if self.taken.iter().any(|taken| taken.as_str() == name) {
                continue;
            }
            let item = match self.dice.below(7) {
                0 => format!("pub const {name}: u8 = 1;"),
                1 => format!("#[derive(Debug, Clone, Copy, Default, PartialEq)]\npub struct {name};"),
                2 => format!("#[derive(Debug, Clone, Copy, Default, PartialEq)]\npub struct {name}(pub u8);"),
                3 => format!("pub static {name}: u8 = 1;"),
                4 => format!("pub fn {name}() {{}}"),
                5 => format!("pub mod {name} {{}}"),
                _ => format!(
                    "#[derive(Debug, Clone, Copy, Default, PartialEq)]\npub enum {name} {{\n    #[default]\n    A,\n}}"
                ),
            };
            self.taken.push(name.to_owned());
            self.rust.push(item);
        }
    }

    fn attributes(&mut self) -> Vec<String> {
        if !self.strikes(Kind::Attributes, 2) {
            return vec![];
        }
        let all = [
            "#![no_implicit_prelude]",
            "#![forbid(unsafe_code)]",
            "#![deny(clippy::all)]",
            "#![deny(unused_must_use, unreachable_code)]",
            "#![deny(unused_mut, unused_parens)]",
            "#![deny(unreachable_pub)]",
            "#![deny(private_interfaces, private_bounds)]",
            "#![deny(trivial_casts, unused_qualifications)]",
            "#![deny(warnings)]",
            "#![recursion_limit = \"64\"]",
        ];
        vec![(*self.dice.of(&all)).to_owned()]
    }

    fn case(mut self, seed: u64) -> Case {
        let shape = if self.dice.one_in(4) { Shape::Both } else { Shape::Library };
        let attributes = self.attributes();
        let prelude = if attributes.iter().any(|a| a.contains("implicit")) {
            "use ::apex_rt::prelude::*;\nuse ::std::prelude::rust_2024::*;\nuse ::std;"
        } else {
            "use apex_rt::prelude::*;"
        };
        let mut library = vec![prelude.to_owned()];
        library.extend(std::mem::take(&mut self.rust));
        let mut binary = vec![];
        if shape == Shape::Both {
            binary.push(prelude.to_owned());
            // Some nodes belong to the binary.
            if self.dice.one_in(3) && library.len() > 2 {
                let node = library.pop();
                binary.extend(node.filter(|n| n.contains("#[node]") && !names_a_type(n)));
            }
        }
        let mut texts = vec![Text { name: "robot".to_owned(), items: std::mem::take(&mut self.items) }];
        let mut calls = vec![self.call("robot")];
        self.files(&mut texts, &mut calls);
        Case { seed, kinds: self.kinds, shape, attributes, library, binary, texts, calls }
    }

    fn call(&mut self, text: &str) -> Call {
        let module = match self.dice.below(3) {
            0 => Some("made".to_owned()),
            _ => None,
        };
        Call { text: text.to_owned(), module, inline: self.dice.one_in(10) }
    }

    /// Splits the source file into several, some of which are also compiled separately.
    fn files(&mut self, texts: &mut Vec<Text>, calls: &mut Vec<Call>) {
        if !(self.has(Kind::Files) || self.dice.one_in(12)) || texts[0].items.len() < 2 {
            return;
        }
        let name = if self.strikes(Kind::Files, 3) {
            *self.dice.of(&["self", "crate", "match", "core", "std", "apex_nodes", "Robot"])
        } else {
            "parts"
        };
        let moved: Vec<Item> = texts[0].items.drain(..1).collect();
        let declared: Vec<String> =
            moved.iter().filter_map(|i| i.head.split([' ', '(', '<', ':']).nth(1)).map(str::to_owned).collect();
        for graph in declared {
            let line = match self.dice.below(6) {
                0 => format!("use {name}::{{{graph}}};"),
                1 => format!("use {name}::{graph} as {graph};"),
                2 if self.has(Kind::Files) => continue,
                _ => format!("use {name}::{graph};"),
            };
            texts[0].items.insert(0, Item::line(line));
        }
        // In a macro, source text has no folder of its own.
        calls.iter_mut().for_each(|call| call.inline = false);
        if self.dice.one_in(2) {
            let module = if self.has(Kind::Files) && self.dice.one_in(2) { None } else { Some("other".to_owned()) };
            calls.push(Call { text: name.to_owned(), module, inline: false });
        }
        texts.push(Text { name: name.to_owned(), items: moved });
    }
}

/// `true` if a Rust item names a type that is declared in the same crate.
fn names_a_type(item: &str) -> bool {
    let own = |ty: &Type| {
        !ty.item.is_empty() && ty.name.split(['<', ':', '>']).any(|w| !w.is_empty() && w != "Vec" && item.contains(w))
    };
    PLAIN.iter().chain(ODD).any(own)
}

//! Decisions about a random source file, and what it has so far.

use super::{
    case::Item,
    interface::{Interface, Node},
    kinds::{KINDS, Kind},
    names,
    types::{ODD, PLAIN, Type, WRONG},
    values::{self, PARAMS, Param},
};
use crate::Dice;

/// A case under construction.
pub struct Maker {
    /// Source of all decisions.
    pub dice: Dice,
    /// Hostile features of this case.
    pub kinds: Vec<Kind>,
    /// Types of its tokens.
    pub types: Vec<&'static Type>,
    /// Rust items.
    pub rust: Vec<String>,
    /// Declared nodes.
    pub nodes: Vec<Node>,
    /// Items of the source file.
    pub items: Vec<Item>,
    /// Complete graphs, to be used and tested.
    pub graphs: Vec<Interface>,
    /// State machines.
    pub machines: Vec<Node>,
    /// Names of Rust items.
    pub taken: Vec<String>,
    /// Thread groups, if any.
    pub groups: Vec<&'static str>,
    /// Number of mistakes so far.
    pub mistakes: usize,
    counter: usize,
}

impl Maker {
    /// Begins a case of one or two features.
    pub fn new(seed: u64) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        (0..4).for_each(|_| {
            dice.below(2);
        });
        let mut kinds = vec![*dice.of(&KINDS)];
        if dice.one_in(3) {
            kinds.push(*dice.of(&KINDS));
        }
        let mut types: Vec<&'static Type> = (0..1 + dice.below(3)).map(|_| dice.of(PLAIN)).collect();
        if kinds.contains(&Kind::OddTypes) {
            types.insert(0, dice.of(ODD));
        }
        let threads = kinds.contains(&Kind::Threads) || dice.one_in(10);
        let hard = kinds.contains(&Kind::Threads);
        let groups: &[&str] = match () {
            () if !threads => &[],
            () if hard && dice.one_in(3) => &["a_b", "aB"],
            () if hard && dice.one_in(3) => &["Main", "main"],
            () if hard && dice.one_in(3) => &["self", "Self"],
            () if hard && dice.one_in(3) => &["match", "crate", "State", "Nodes"],
            () if hard && dice.one_in(3) => &["links", "_", "__", "x_"],
            () => &["vision", "planning"],
        };
        let groups = groups.to_vec();
        Self {
            dice,
            kinds,
            types,
            rust: vec![],
            nodes: vec![],
            items: vec![],
            graphs: vec![],
            machines: vec![],
            taken: vec![],
            groups,
            mistakes: 0,
            counter: 0,
        }
    }

    /// `true` if this case has a feature.
    pub fn has(&self, kind: Kind) -> bool {
        self.kinds.contains(&kind)
    }

    /// Decides at random whether a feature occurs here.
    pub fn strikes(&mut self, kind: Kind, one_in: usize) -> bool {
        let strikes = self.has(kind) && self.dice.one_in(one_in);
        if !strikes || !kind.is_mostly_wrong() {
            return strikes;
        }
        // At most one mistake per source file, because only the first one would be reported reliably.
        self.mistakes += 1;
        self.mistakes == 1
    }

    /// A random word.
    pub fn word(&mut self, words: &[&'static str]) -> &'static str {
        words[self.dice.below(words.len())]
    }

    /// A type of this case.
    pub fn ty(&mut self) -> &'static Type {
        self.types[self.dice.below(self.types.len())]
    }

    /// Adds a Rust item, once.
    pub fn rust(&mut self, item: &str) {
        if !item.is_empty() && !self.rust.iter().any(|known| known.contains(item) || shares_a_name(known, item)) {
            self.rust.push(item.to_owned());
        }
    }

    /// A new number.
    pub fn number(&mut self) -> usize {
        self.counter += 1;
        self.counter
    }

    /// Notation of a type at a port.
    pub fn written(&mut self, ty: &Type) -> String {
        if self.strikes(Kind::WrongTypes, 4) {
            return (*self.dice.of(WRONG)).to_owned();
        }
        if ["f64", "u8", "i64"].contains(&ty.name) && self.dice.one_in(12) {
            return format!("{}[{}]", ty.name, self.dice.of(&["m", "mm", "rad", "m/s^2", "%"]));
        }
        let own = !ty.item.is_empty() && !ty.name.contains("::") && !ty.name.contains("Vec");
        if own && self.dice.one_in(5) { format!("crate::{}", ty.name) } else { ty.name.to_owned() }
    }

    /// Name of a node that is not in `used`.
    pub fn node_name(&mut self, used: &mut Vec<String>) -> String {
        let hard = self.strikes(Kind::NodeNames, 3);
        let list = if hard { names::HARD } else { names::PLAIN_NODES };
        let items = self.taken.clone();
        if self.has(Kind::RustNames) && !items.is_empty() && self.dice.one_in(2) {
            let name = self.dice.of(&items).clone();
            if !used.contains(&name) {
                used.push(name.clone());
                return name;
            }
        }
        self.free(list, used)
    }

    /// Name of a port or parameter that is not in `used`.
    pub fn port_name(&mut self, used: &mut Vec<String>) -> String {
        let list = if self.strikes(Kind::PortNames, 4) { names::HARD } else { names::PLAIN_PORTS };
        self.free(list, used)
    }

    /// An element of `list` that is not in `used`, with a number if there is none.
    pub fn free(&mut self, list: &[&str], used: &mut Vec<String>) -> String {
        let twice = self.strikes(Kind::Twice, 12);
        for _ in 0..6 {
            let name = (*self.dice.of(list)).to_owned();
            if twice || !used.contains(&name) {
                used.push(name.clone());
                return name;
            }
        }
        let name = format!("{}_{}", self.dice.of(list), self.number());
        used.push(name.clone());
        name
    }

    /// A type of parameters, mostly one with values in the language.
    pub fn param_type(&mut self) -> &'static Param {
        loop {
            let param = self.dice.of(PARAMS);
            if !param.good.is_empty() || self.dice.one_in(6) {
                return param;
            }
        }
    }

    /// A value for a parameter of this type.
    pub fn value(&mut self, param: &Param) -> Option<String> {
        if self.strikes(Kind::Values, 2) {
            return Some((*self.dice.of(param.bad)).to_owned());
        }
        if self.strikes(Kind::Constants, 2) {
            return Some((*self.dice.of(values::PATHS)).to_owned());
        }
        (!param.good.is_empty()).then(|| (*self.dice.of(param.good)).to_owned())
    }

    /// Value of a token, if the language has a notation for it.
    pub fn token(&mut self, ty: &Type) -> Option<String> {
        if self.strikes(Kind::Values, 2) {
            let odd = [
                "300",
                "-1",
                "1e40",
                "1.5",
                "\"s\"",
                "true",
                "[1]",
                "5m",
                "9223372036854775808",
                "1 / 0",
                "1 % 0",
                "crate::Pose { x: 1 }",
                "Pair { a: 1, b: true }",
                "Nope { }",
                "u8 { x: 1 }",
            ];
            return Some((*self.dice.of(&odd)).to_owned());
        }
        if self.strikes(Kind::Constants, 2) {
            return Some((*self.dice.of(values::PATHS)).to_owned());
        }
        (!ty.values.is_empty()).then(|| (*self.dice.of(ty.values)).to_owned())
    }
}

/// `true` if two Rust items declare the same name first.
fn shares_a_name(a: &str, b: &str) -> bool {
    let name = |item: &str| {
        let words = item.split(|c: char| !c.is_alphanumeric() && c != '_').collect::<Vec<_>>();
        let at =
            words.iter().position(|w| matches!(*w, "struct" | "enum" | "type" | "const" | "fn" | "mod" | "static"))?;
        words.get(at + 1).map(|w| (*w).to_owned())
    };
    name(a).is_some() && name(a) == name(b)
}

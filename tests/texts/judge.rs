//! rustc on texts that the compiler accepted.

use crate::cargo::{Message, check_all};
use apex_tests::texts::{Case, Shape};
use std::fmt;

/// What is wrong.
#[derive(Debug, Clone)]
pub enum Failure {
    /// The compiler panics.
    Panic(String),
    /// The compiler does not come to an end.
    Hang(String),
    /// The first error does not stand in the text.
    Outside(String),
    /// A node of the program has no path.
    Unspelled(String),
    /// rustc refuses it.
    Rustc(Vec<Message>),
    /// rustc refuses it as only it can, and says where in the text. This is how it should be.
    Named(Vec<Message>),
    /// The Rust beside the text is wrong: a mistake of the generator.
    Rust(Vec<Message>),
}

impl Failure {
    /// Failures of one class have the same cause, mostly.
    pub fn class(&self) -> String {
        match self {
            Self::Panic(text) => format!("panic: {}", plain(text)),
            Self::Hang(_) => "hang".to_owned(),
            Self::Outside(text) => format!("outside: {}", plain(text)),
            Self::Unspelled(_) => "a node without a path".to_owned(),
            Self::Rustc(messages) | Self::Named(messages) => {
                format!("rustc: {}", messages.first().map(class).unwrap_or_default())
            }
            Self::Rust(messages) => format!("RUST: {}", messages.first().map(class).unwrap_or_default()),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic(text) | Self::Hang(text) | Self::Outside(text) | Self::Unspelled(text) => write!(f, "{text}"),
            Self::Rustc(messages) | Self::Named(messages) | Self::Rust(messages) => {
                messages.iter().take(3).try_for_each(|m| write!(f, "{}", m.rendered))
            }
        }
    }
}

fn class(message: &Message) -> String {
    format!("{} {}", message.code, plain(&message.text))
}

/// A message without what stands between back quotes, and without numbers.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for (i, part) in text.lines().next().unwrap_or_default().split('`').enumerate() {
        plain.push_str(if i % 2 == 0 { part } else { "_" });
    }
    plain.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).take(120).collect()
}

/// What rustc says about accepted texts, each in the package of its number, with the names of its nodes.
pub fn judge(cases: &[(usize, &Case, &[String])]) -> Vec<Option<Failure>> {
    if cases.is_empty() {
        return vec![];
    }
    let packages: Vec<(usize, Shape)> = cases.iter().map(|(slot, case, _)| (*slot, case.shape)).collect();
    let messages = check_all(&packages);
    cases.iter().zip(messages).map(|((.., names), messages)| verdict(names, messages)).collect()
}

fn verdict(names: &[String], messages: Vec<Message>) -> Option<Failure> {
    if messages.is_empty() {
        return None;
    }
    if !messages.iter().any(|m| m.in_graph) {
        return Some(Failure::Rust(messages));
    }
    match messages.iter().any(|m| is_named(m, names)) {
        true => Some(Failure::Named(messages)),
        false => Some(Failure::Rustc(messages)),
    }
}

/// Whether a message names a node (or what is connected with it) and a line of the text.
fn is_named(message: &Message, names: &[String]) -> bool {
    let lines = message.rendered.split(".afg:").skip(1).any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    // A text in a Rust file has its place in a label.
    let inline = message.in_text || message.rendered.contains("^ --> ");
    let quoted = message.rendered.split('`').skip(1).step_by(2);
    // A node of a nested graph is named by its path: `split.filter`.
    let is_node = |word: &str| names.iter().any(|n| n == word);
    let named = quoted.flat_map(|q| q.split(['.', ' ', ':', '('])).any(is_node);
    (lines || inline) && named
}

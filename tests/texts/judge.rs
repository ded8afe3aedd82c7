//! Runs rustc on source files that the compiler accepted.

use crate::{
    cargo::{Message, check_all, compile_tests, run},
    interpreted::{self, MODULE},
};
use apex_tests::texts::{Case, Shape};
use std::fmt;

/// Kind of failure.
#[derive(Debug, Clone)]
pub enum Failure {
    /// The compiler panics.
    Panic(String),
    /// The compiler does not end.
    Hang(String),
    /// The first error is not in the source file.
    Outside(String),
    /// A node of the program has no path.
    Unspelled(String),
    /// rustc rejects the program.
    Rustc(Vec<Message>),
    /// rustc rejects the program for a reason that only rustc can detect, and names the place in the source file. This
    /// is correct.
    Named(Vec<Message>),
    /// The Rust code beside the source file has an error, because of a mistake of the generator.
    Rust(Vec<Message>),
    /// The same program in another form is refused, or compiled to something else.
    Form(&'static str, String),
    /// Its tests do not end, differ from run to run, or end by a panic that is not one of their own.
    Run(String),
}

impl Failure {
    /// Class of a failure; failures of one class mostly have the same cause.
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
            Self::Form(kind, _) => format!("form: {kind}"),
            Self::Run(why) => format!("run: {}", plain(why)),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panic(text) | Self::Hang(text) | Self::Outside(text) | Self::Unspelled(text) | Self::Run(text) => {
                write!(f, "{text}")
            }
            Self::Form(_, text) => write!(f, "{text}"),
            Self::Rustc(messages) | Self::Named(messages) | Self::Rust(messages) => {
                messages.iter().take(3).try_for_each(|m| write!(f, "{}", m.rendered))
            }
        }
    }
}

fn class(message: &Message) -> String {
    format!("{} {}", message.code, plain(&message.text))
}

/// A message without the text between back quotes, and without numbers.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    for (i, part) in text.lines().next().unwrap_or_default().split('`').enumerate() {
        plain.push_str(if i % 2 == 0 { part } else { "_" });
    }
    plain.chars().map(|c| if c.is_ascii_digit() { '0' } else { c }).take(120).collect()
}

/// Results of rustc for accepted cases, each given by its package and the names of its nodes.
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

/// `true` if a message names a node (or something connected with it) and a line of the source file.
fn is_named(message: &Message, names: &[String]) -> bool {
    let lines = message.rendered.split(".afg:").skip(1).any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    // Source text in a Rust file has its place in a label.
    let inline = message.in_text || message.rendered.contains("^ --> ");
    let quoted = message.rendered.split('`').skip(1).step_by(2);
    // A node of a nested graph is identified by its path: `split.filter`.
    let is_node = |word: &str| names.iter().any(|n| n == word);
    let named = quoted.flat_map(|q| q.split(['.', ' ', ':', '('])).any(is_node);
    (lines || inline) && named
}

/// Runs the tests of a text twice. They may fail, but say the same each time, for their own reasons, and when they are
/// interpreted.
pub fn judge_run(slot: usize, case: &Case) -> Option<Failure> {
    let pieces = interpreted::module(slot, case);
    let program = match compile_tests(slot, pieces.as_deref().unwrap_or("")) {
        Ok(program) => program,
        Err(said) => return Some(Failure::Run(format!("its pieces do not compile\n{said}"))),
    };
    let said = [(); 2].map(|()| run(&program, &["--skip", MODULE]));
    let [Some(first), Some(second)] = &said else { return Some(Failure::Run("it does not end".to_owned())) };
    if first != second {
        return Some(Failure::Run(format!("it differs from run to run\n{first}\n{second}")));
    }
    let reasons = first.split("panicked at ").skip(1).map(|text| text.split_once('\n').unwrap_or((text, "")));
    let foreign = reasons.clone().find(|(_, reason)| !reason.starts_with("test `"));
    if let Some((place, reason)) = foreign {
        return Some(Failure::Run(format!("{reason}\n{place}\n{first}")));
    }
    let interpreted = pieces.map(|_| run(&program, &[MODULE, "--nocapture"]));
    match interpreted {
        None => None,
        Some(None) => Some(Failure::Run("it does not end when it is interpreted".to_owned())),
        Some(Some(said)) => interpreted::difference(first, &said).map(Failure::Run),
    }
}

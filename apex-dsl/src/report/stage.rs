//! Order of the errors in a source file, and detection of those that only follow from another one.

use super::{Diagnostic, Severity};
use crate::source::Span;

/// Subject of a message. An error in one stage may cause apparent errors in every later one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Characters, brackets, keywords and punctuation.
    Syntax,
    /// Meaning of names.
    Names,
    /// Values, units and types.
    Values,
    /// Structure of the connections.
    Connections,
    /// Flow of tokens and activity.
    Activity,
    /// Claims about activity.
    Claims,
}

/// Codes that may only follow from a syntax error, wherever it is: the missing declaration could not be read.
const DECLARED_ANYWHERE: [&str; 5] = ["unknown-port", "unknown-name", "unknown-state", "no-state", "not-replaced"];
/// Codes that may only follow from a syntax error outside all items: the missing item could not be read.
const DECLARED_OUTSIDE: [&str; 3] = ["unknown-node", "unknown-import", "unknown-graph"];

impl Stage {
    /// The stage that messages with this code belong to.
    pub fn of(code: &str) -> Self {
        match code {
            "syntax" | "too-deep" | "too-large" | "unclosed" | "unknown-character" => Self::Syntax,
            "ambiguous-node" | "duplicate-name" | "fsm-port" | "no-graph" | "no-process" | "no-state"
            | "not-replaced" | "recursion" | "robot-port" | "unreadable" | "wrong-claim" => Self::Names,
            _ if code.starts_with("unknown-") => Self::Names,
            "connected-twice" | "cycle" | "open-input" | "open-output" | "own-event" | "rates" | "wrong-record" => {
                Self::Connections
            }
            _ if code.starts_with("each-") => Self::Connections,
            _ if code.starts_with("never-") => Self::Activity,
            _ if code.starts_with("claim-") => Self::Claims,
            _ => Self::Values,
        }
    }
}

/// The items of all source files. Messages within one item belong together.
#[derive(Debug, Default)]
pub struct Items(Vec<Span>);

impl Items {
    /// Adds the items of a source file.
    pub fn add(&mut self, items: impl Iterator<Item = Span>) {
        self.0.extend(items);
        self.0.sort_unstable();
    }

    /// The item that contains a place.
    fn around(&self, place: Span) -> Option<Span> {
        let behind = self.0.partition_point(|item| (item.file, item.start) <= (place.file, place.start));
        let item = self.0[..behind].last()?;
        (item.file == place.file && place.end <= item.end).then_some(*item)
    }

    /// Returns `true` if `message` may only be a consequence of `cause`, so that it need not be shown.
    pub fn explain(&self, cause: &Diagnostic, message: &Diagnostic) -> bool {
        let (from, to) = (Stage::of(cause.code), Stage::of(message.code));
        if cause.severity != Severity::Error || from >= to {
            return false;
        }
        let (at, item) = (self.around(cause.primary.span), self.around(message.primary.span));
        let is_together = at.is_some() && at == item;
        match (from, to) {
            (_, Stage::Activity | Stage::Claims) => true,
            (_, Stage::Connections) => is_together || from == Stage::Syntax,
            (Stage::Syntax, _) => {
                DECLARED_ANYWHERE.contains(&message.code)
                    || message.declared_in.is_some_and(|item| at == Some(item))
                    || (DECLARED_OUTSIDE.contains(&message.code) && at.is_none())
            }
            _ => false,
        }
    }
}

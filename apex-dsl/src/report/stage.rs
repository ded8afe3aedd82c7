//! The order of mistakes: what is told of a text with several of them, and what only follows from another one.

use super::{Diagnostic, Severity};
use crate::source::Span;

/// What a message is about. What is wrong in one stage may look wrong in every later one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Characters, brackets, words and signs.
    Syntax,
    /// What names stand for.
    Names,
    /// Values, units and types.
    Values,
    /// What is connected to what.
    Connections,
    /// Where tokens and activity come to.
    Activity,
    /// What is claimed of activity.
    Claims,
}

/// What may be wrong only because something that could not be read declares it, in whatever item that is.
const DECLARED_ANYWHERE: [&str; 5] = ["unknown-port", "unknown-name", "unknown-state", "no-state", "not-replaced"];
/// What may be wrong only because an item could not be read.
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

/// The items of all texts: what stands in one of them belongs together.
#[derive(Debug, Default)]
pub struct Items(Vec<Span>);

impl Items {
    /// Adds those of one text.
    pub fn add(&mut self, items: impl Iterator<Item = Span>) {
        self.0.extend(items);
        self.0.sort_unstable();
    }

    /// The item around a place.
    fn around(&self, place: Span) -> Option<Span> {
        let behind = self.0.partition_point(|item| (item.file, item.start) <= (place.file, place.start));
        let item = self.0[..behind].last()?;
        (item.file == place.file && place.end <= item.end).then_some(*item)
    }

    /// Whether `message` may be wrong because of what `cause` is about, so that there is no need to tell it.
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

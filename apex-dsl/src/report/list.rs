//! All messages of a run: each mistake once, without what follows from it.

use super::{
    Diagnostic, Severity,
    stage::{Items, Stage},
};
use crate::source::Span;

/// How many errors are collected before the rest is only counted; as many warnings.
pub const MAX_ERRORS: usize = 100;
/// Most nested graphs that a message remembers.
const MAX_INSTANCES: usize = 100;
/// Most nested graphs that a message names.
const MAX_NAMED: usize = 5;

/// All messages of a run. Errors are collected, never thrown.
#[derive(Debug, Default)]
pub struct Diagnostics {
    list: Vec<Entry>,
    left_out: usize,
    items: Items,
    /// The names of the nested graphs that are being opened, outermost first.
    open: Vec<String>,
}

/// A message with the nested graphs that it is about; an empty path stands for the text by itself.
#[derive(Debug)]
struct Entry {
    diagnostic: Diagnostic,
    instances: Vec<String>,
}

impl Diagnostics {
    /// Makes the items of a text known: an error in one of them hides what may follow from it there.
    pub fn add_items(&mut self, items: impl Iterator<Item = Span>) {
        self.items.add(items);
    }

    /// Enters a nested graph: messages are about it, until [`Diagnostics::leave`].
    pub fn enter(&mut self, name: &str) {
        self.open.push(name.to_owned());
    }

    /// Leaves the nested graph that was entered last.
    pub fn leave(&mut self) {
        self.open.pop();
    }

    /// Adds a message, unless it may follow from an earlier one. What is said of the same place of the text in another
    /// nested graph is one message with it.
    pub fn push(&mut self, mut diagnostic: Diagnostic) {
        if diagnostic.instance.is_empty() {
            diagnostic.instance = self.open.join(".");
        }
        if self.list.iter().any(|cause| self.items.explain(&cause.diagnostic, &diagnostic)) {
            return;
        }
        if let Some(same) = self.same(&diagnostic) {
            return self.list[same].merge(diagnostic);
        }
        let Self { list, items, .. } = self;
        list.retain(|entry| !items.explain(&diagnostic, &entry.diagnostic));
        if self.count(diagnostic.severity) >= MAX_ERRORS {
            self.left_out += 1;
        } else {
            let instances = vec![diagnostic.instance.clone()];
            self.list.push(Entry { diagnostic, instances });
        }
    }

    /// The message that says the same of the same place: of another nested graph it may say it in other words.
    fn same(&self, new: &Diagnostic) -> Option<usize> {
        let is_here = |old: &Diagnostic| old.code == new.code && old.primary.span == new.primary.span;
        let is_equal = |entry: &Entry| is_here(&entry.diagnostic) && entry.diagnostic.message == new.message;
        let is_other = |entry: &Entry| is_here(&entry.diagnostic) && !entry.instances.contains(&new.instance);
        self.list.iter().position(is_equal).or_else(|| self.list.iter().position(is_other))
    }

    fn count(&self, severity: Severity) -> usize {
        self.list.iter().filter(|entry| entry.diagnostic.severity == severity).count()
    }

    /// Adds a message unless there is one of its kind at the same place.
    pub fn push_once(&mut self, diagnostic: Diagnostic) {
        let same = |entry: &Entry| {
            entry.diagnostic.code == diagnostic.code && entry.diagnostic.primary.span == diagnostic.primary.span
        };
        if !self.list.iter().any(same) {
            self.push(diagnostic);
        }
    }

    /// Whether one of them is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|entry| entry.diagnostic.severity == Severity::Error)
    }

    /// Whether one of them is an error at this place or inside it.
    pub fn has_errors_in(&self, place: Span) -> bool {
        let is_inside = |span: Span| span.file == place.file && place.start <= span.start && span.end <= place.end;
        let errors = self.list.iter().map(|entry| &entry.diagnostic).filter(|d| d.severity == Severity::Error);
        errors.into_iter().any(|error| is_inside(error.primary.span))
    }

    /// Whether further errors are only counted: what goes on can stop.
    pub fn is_full(&self) -> bool {
        self.count(Severity::Error) >= MAX_ERRORS
    }

    /// Counts a message that is not worth making because [`Diagnostics::is_full`].
    pub fn leave_out(&mut self) {
        self.left_out += 1;
    }

    /// How many messages were left out for being too many.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The messages in the order of their stages, then in that of the text.
    pub fn sorted(&self) -> Vec<&Diagnostic> {
        let mut list: Vec<&Diagnostic> = self.list.iter().map(|entry| &entry.diagnostic).collect();
        list.sort_by_key(|d| (Stage::of(d.code), d.primary.span, d.severity));
        list
    }

    /// Removes all messages for which `keep` is false.
    pub fn retain(&mut self, mut keep: impl FnMut(&Diagnostic) -> bool) {
        self.list.retain(|entry| keep(&entry.diagnostic));
    }
}

impl Entry {
    /// Adds that the message is also about the nested graph of `other`. If it is about the text by itself, the nested
    /// graphs need not be named.
    fn merge(&mut self, other: Diagnostic) {
        if self.instances.len() >= MAX_INSTANCES || self.instances.contains(&other.instance) {
            return;
        }
        let had_note = self.instances.len() > 1 && !self.instances.contains(&String::new());
        if had_note {
            self.diagnostic.notes.pop();
        }
        self.instances.push(other.instance.clone());
        if other.instance.is_empty() {
            self.diagnostic = other;
        } else if !self.instances.contains(&String::new()) {
            let names = self.instances[1..].iter().take(MAX_NAMED).map(|name| format!("`{name}`"));
            let mut names: Vec<String> = names.collect();
            if self.instances.len() - 1 > MAX_NAMED {
                names.push(format!("{} more", self.instances.len() - 1 - MAX_NAMED));
            }
            self.diagnostic.notes.push(format!("also in {}", names.join(", ")));
        }
    }
}

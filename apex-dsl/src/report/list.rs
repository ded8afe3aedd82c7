//! All messages of a run: each error once, without its consequences.

use super::{
    Diagnostic, Severity,
    stage::{Items, Stage},
};
use crate::source::Span;

/// Number of errors after which further ones are only counted. The same limit holds for warnings.
pub const MAX_ERRORS: usize = 100;
/// Largest number of instances that are stored with a message.
const MAX_INSTANCES: usize = 100;
/// Largest number of instances that a message names.
const MAX_NAMED: usize = 5;

/// All messages of a run, which are collected instead of being returned.
#[derive(Debug, Default)]
pub struct Diagnostics {
    list: Vec<Entry>,
    left_out: usize,
    items: Items,
    /// Names of the nested graphs that are being instantiated, outermost first.
    open: Vec<String>,
    /// The place to which messages are moved.
    anchor: Option<Span>,
}

/// A message with the instances that it is about; an empty path stands for the source file itself.
#[derive(Debug)]
struct Entry {
    diagnostic: Diagnostic,
    instances: Vec<String>,
}

impl Diagnostics {
    /// Adds the items of a source file. An error in an item hides messages that may be its consequences there.
    pub fn add_items(&mut self, items: impl Iterator<Item = Span>) {
        self.items.add(items);
    }

    /// Enters a nested graph. Messages belong to it until [`Diagnostics::leave`].
    pub fn enter(&mut self, name: &str) {
        self.open.push(name.to_owned());
    }

    /// Moves messages to this place from now on, if there is one. Returns the place until now.
    pub fn anchor(&mut self, place: Option<Span>) -> Option<Span> {
        std::mem::replace(&mut self.anchor, place)
    }

    /// Leaves the nested graph that was entered last.
    pub fn leave(&mut self) {
        self.open.pop();
    }

    /// Adds a message, unless it may be a consequence of an earlier one. Messages about the same place in several
    /// instances become one.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let mut diagnostic = self.anchored(diagnostic);
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

    fn anchored(&self, diagnostic: Diagnostic) -> Diagnostic {
        if let Some(anchor) = self.anchor { diagnostic.moved_to(anchor) } else { diagnostic }
    }

    /// The message with the same code at the same place. Its wording may differ only if it is about another instance.
    fn same(&self, new: &Diagnostic) -> Option<usize> {
        let is_here = |old: &Diagnostic| old.code == new.code && old.primary.span == new.primary.span;
        let is_equal = |entry: &Entry| is_here(&entry.diagnostic) && entry.diagnostic.message == new.message;
        let is_other = |entry: &Entry| is_here(&entry.diagnostic) && !entry.instances.contains(&new.instance);
        self.list.iter().position(is_equal).or_else(|| self.list.iter().position(is_other))
    }

    fn count(&self, severity: Severity) -> usize {
        self.list.iter().filter(|entry| entry.diagnostic.severity == severity).count()
    }

    /// Adds a message unless there is one with the same code at the same place.
    pub fn push_once(&mut self, diagnostic: Diagnostic) {
        let diagnostic = self.anchored(diagnostic);
        let same = |entry: &Entry| {
            entry.diagnostic.code == diagnostic.code && entry.diagnostic.primary.span == diagnostic.primary.span
        };
        if !self.list.iter().any(same) {
            self.push(diagnostic);
        }
    }

    /// Returns `true` if there is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|entry| entry.diagnostic.severity == Severity::Error)
    }

    /// Returns `true` if there is an error at this place or inside it.
    pub fn has_errors_in(&self, place: Span) -> bool {
        let errors = self.list.iter().map(|entry| &entry.diagnostic).filter(|d| d.severity == Severity::Error);
        errors.into_iter().any(|error| place.contains(error.primary.span))
    }

    /// Returns `true` if further errors are only counted, so that checks may stop.
    pub fn is_full(&self) -> bool {
        self.count(Severity::Error) >= MAX_ERRORS
    }

    /// Counts a message that need not be made because [`Diagnostics::is_full`].
    pub fn leave_out(&mut self) {
        self.left_out += 1;
    }

    /// Number of messages that were left out because there were too many.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The messages in the order of their stages, then of their places.
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
    /// Adds the instance of `other`. No instances are named if the message is also about the source file itself.
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

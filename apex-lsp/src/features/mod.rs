//! One module per feature of the editor. They turn what `apex_dsl::ide` answers into what the protocol wants.

pub mod actions;
pub mod completion;
pub mod definition;
pub mod diagnostics;
pub mod formatting;
pub mod hints;
pub mod hover;
pub mod references;
pub mod rename;
pub mod symbols;

use crate::{analysis::Analysis, project::Project};
use apex_dsl::ide::{self, Occurrence, View};
use lsp_types::Position;

/// A text that is ready for questions.
pub struct Ready<'a> {
    /// What is known about it.
    pub analysis: &'a Analysis,
    /// Its package.
    pub project: &'a Project,
}

impl<'a> Ready<'a> {
    /// The text as the questions of `apex_dsl::ide` want it.
    pub fn view(&self) -> View<'a> {
        self.analysis.names.view(self.project)
    }

    /// The byte at a position.
    pub fn offset(&self, position: Position) -> usize {
        self.analysis.offset(position)
    }

    /// The name at a position.
    pub fn occurrence(&self, position: Position) -> Option<Occurrence> {
        ide::at(&self.analysis.names.occurrences, &self.view(), self.offset(position))
    }
}

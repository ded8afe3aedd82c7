//! Features of the editor, one module each. They convert the answers of `apex_dsl::ide` to the protocol.

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
use apex_ide::{Occurrence, View};
use lsp_types::Position;

/// A source file with its analysis and its package.
pub struct Ready<'a> {
    /// Analysis of the source file.
    pub analysis: &'a Analysis,
    /// Package of the source file.
    pub project: &'a Project,
}

impl<'a> Ready<'a> {
    /// View for queries to `apex_dsl::ide`.
    pub fn view(&self) -> View<'a> {
        self.analysis.names.view(self.project)
    }

    /// Byte offset of a position.
    pub fn offset(&self, position: Position) -> usize {
        self.analysis.offset(position)
    }

    /// Name at a position.
    pub fn occurrence(&self, position: Position) -> Option<Occurrence> {
        apex_ide::at(&self.analysis.names.occurrences, &self.view(), self.offset(position))
    }
}

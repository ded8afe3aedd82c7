//! Queries of an editor about a source file: the meaning of a place, other uses of a name, completions. All queries are
//! pure functions of trees, names and connections. A source file with errors is answered as far as it can be parsed.

mod argument;
mod by_name;
mod complete;
mod context;
mod definition;
pub mod explain;
pub mod fix;
pub mod format;
mod hover;
mod lex;
mod occurrences;
mod outline;
mod paint;
mod rename;
mod rust;
mod statement;

use apex_dsl::{
    catalog::Catalog,
    resolve::{Link, SourceSet},
    source::Sources,
};

pub use argument::{ArgumentPlace, set_argument};
pub use by_name::{WrittenOut, written_out};
pub use complete::{Completion, CompletionKind, Siblings, complete};
pub use definition::{Definition, MachineId, NodeType, Origin, ParamFacts, PortFacts};
pub use format::format;
pub use hover::{declaration, describe, describe_link, describe_word, flow_word};
pub use occurrences::{Occurrence, at, occurrences};
pub use outline::{Symbol, SymbolKind, outline};
pub use paint::{Paint, paint};
pub use rename::{may_rename, rename};
pub use rust::{Part, place_in_rust};
pub use statement::{Statement, statement};

/// A source file with the meanings of the names in it.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The source file, which is the first one, and those that it imports.
    pub texts: &'a SourceSet,
    /// Connections in it.
    pub links: &'a [Link],
    /// Contents and paths of the source files.
    pub sources: &'a Sources,
    /// Nodes that it can use.
    pub catalog: &'a Catalog,
}

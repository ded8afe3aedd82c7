//! What an editor asks about a text: what stands at a place, where else it is used, what could be written there.
//! Pure questions about trees, names and connections; a text that has errors is answered as far as it can be read.

mod complete;
mod context;
mod definition;
mod describe;
mod lex;
mod occurrences;
mod outline;
mod rename;
mod rust;

use crate::{
    catalog::Catalog,
    resolve::{Link, Texts},
    source::Sources,
};

pub use complete::{Completion, CompletionKind, Siblings, complete};
pub use definition::{Definition, MachineId, NodeType, Origin, ParamFacts, PortFacts};
pub use describe::{declaration, describe, describe_link, describe_word, flow_word};
pub use occurrences::{Occurrence, at, occurrences};
pub use outline::{Symbol, SymbolKind, outline};
pub use rename::{may_rename, rename};
pub use rust::{Part, place_in_rust};

/// A text with what is known of the names in it.
#[derive(Clone, Copy)]
pub struct View<'a> {
    /// The text, which is the first, and those that it imports.
    pub texts: &'a Texts,
    /// Its connections.
    pub links: &'a [Link],
    /// Where the texts are.
    pub sources: &'a Sources,
    /// The nodes that it can use.
    pub catalog: &'a Catalog,
}

//! Tree of the declarations in a source file.

use super::Ready;
use apex_ide::{Symbol, SymbolKind};
use lsp_types::DocumentSymbol;

/// Declarations in a source file.
pub fn symbols(ready: &Ready<'_>) -> Vec<DocumentSymbol> {
    apex_ide::outline(&ready.view()).iter().map(|s| symbol(ready, s)).collect()
}

fn symbol(ready: &Ready<'_>, found: &Symbol) -> DocumentSymbol {
    let children: Vec<_> = found.children.iter().map(|s| symbol(ready, s)).collect();
    #[expect(deprecated, reason = "the field has to be set")]
    DocumentSymbol {
        name: found.name.clone(),
        detail: (!found.detail.is_empty()).then(|| found.detail.clone()),
        kind: kind(found.kind),
        tags: None,
        deprecated: None,
        range: ready.analysis.names.places.range(found.extent),
        selection_range: ready.analysis.names.places.range(found.name_span),
        children: (!children.is_empty()).then_some(children),
    }
}

fn kind(kind: SymbolKind) -> lsp_types::SymbolKind {
    match kind {
        SymbolKind::Graph => lsp_types::SymbolKind::CLASS,
        SymbolKind::Machine => lsp_types::SymbolKind::ENUM,
        SymbolKind::State => lsp_types::SymbolKind::ENUM_MEMBER,
        SymbolKind::Test => lsp_types::SymbolKind::METHOD,
        SymbolKind::Param => lsp_types::SymbolKind::PROPERTY,
        SymbolKind::Port => lsp_types::SymbolKind::FIELD,
        SymbolKind::Node => lsp_types::SymbolKind::VARIABLE,
    }
}

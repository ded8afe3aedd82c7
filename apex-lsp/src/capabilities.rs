//! Capabilities of the server and of the client.

use crate::position::Encoding;
use lsp_types::{
    ClientCapabilities, CodeActionKind, CodeActionOptions, CodeActionProviderCapability, CompletionOptions,
    HoverProviderCapability, OneOf, RenameOptions, SaveOptions, ServerCapabilities, TextDocumentSyncCapability,
    TextDocumentSyncKind, TextDocumentSyncOptions, TextDocumentSyncSaveOptions,
};

/// Capabilities of the client.
#[derive(Debug, Clone, Copy)]
pub struct Client {
    /// Unit of columns.
    pub encoding: Encoding,
    /// `true` if completions may have placeholders.
    pub snippets: bool,
    /// `true` if it watches files on request.
    pub watches: bool,
    /// `true` if it updates inlay hints on request.
    pub refreshes_hints: bool,
}

impl Client {
    /// Reads the capabilities that the client announces.
    pub fn new(said: &ClientCapabilities) -> Self {
        let general = said.general.as_ref();
        let item = || said.text_document.as_ref()?.completion.as_ref()?.completion_item.as_ref();
        let workspace = said.workspace.as_ref();
        let watches = workspace.and_then(|w| w.did_change_watched_files.as_ref()?.dynamic_registration);
        let refreshes = workspace.and_then(|w| w.inlay_hint.as_ref()?.refresh_support);
        Self {
            encoding: Encoding::choose(general.and_then(|g| g.position_encodings.as_deref())),
            snippets: item().and_then(|i| i.snippet_support).unwrap_or(false),
            watches: watches.unwrap_or(false),
            refreshes_hints: refreshes.unwrap_or(false),
        }
    }
}

/// Capabilities of the server.
pub fn capabilities(encoding: Encoding) -> ServerCapabilities {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        save: Some(TextDocumentSyncSaveOptions::SaveOptions(SaveOptions { include_text: Some(false) })),
        ..TextDocumentSyncOptions::default()
    };
    // Besides words, these characters trigger a completion.
    let triggers = [".", ":", "(", ">", "=", " "].map(str::to_owned).to_vec();
    let actions = CodeActionOptions {
        code_action_kinds: Some(vec![CodeActionKind::QUICKFIX, CodeActionKind::REFACTOR_REWRITE]),
        ..CodeActionOptions::default()
    };
    ServerCapabilities {
        position_encoding: Some(encoding.kind()),
        text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(triggers),
            ..CompletionOptions::default()
        }),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        document_symbol_provider: Some(OneOf::Left(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(RenameOptions {
            prepare_provider: Some(true),
            work_done_progress_options: Default::default(),
        })),
        inlay_hint_provider: Some(OneOf::Left(true)),
        code_action_provider: Some(CodeActionProviderCapability::Options(actions)),
        ..ServerCapabilities::default()
    }
}

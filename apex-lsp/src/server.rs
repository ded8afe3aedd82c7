//! The worker: stores the open source files and their analyses, and answers requests.

use crate::{
    analysis::{Analysis, Certain},
    capabilities::Client,
    documents::Document,
    features::references::{self, Target},
    features::{Ready, actions, completion, definition, diagnostics, formatting, hints, hover, rename, symbols},
    project::{Overlay, Project, package_of},
    queue::{Queue, Task},
    uri,
};
use apex_dsl::source::World as _;
use crossbeam_channel::Sender;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::{
    CodeActionOrCommand, CodeActionParams, CompletionParams, CompletionResponse, DidChangeTextDocumentParams,
    DidChangeWatchedFilesParams, DidChangeWatchedFilesRegistrationOptions, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, DidSaveTextDocumentParams, DocumentSymbolResponse, FileSystemWatcher, GlobPattern,
    GotoDefinitionResponse, PublishDiagnosticsParams, ReferenceParams, Registration, RegistrationParams, RenameParams,
    TextDocumentPositionParams, TextEdit, Uri, WorkspaceEdit,
    notification::{self, Notification as _},
    request::{self, Request as _},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

/// Time without messages before diagnostics are published.
const QUIET: Duration = Duration::from_millis(5);
/// Maximum number of fixes that are tried for one request; each trial checks the source file.
const MAX_TRIALS: usize = 32;
/// Message about an error in the server itself.
const FAILED: &str = "the server failed; please report this";

/// The worker, with the open source files and their analyses.
pub struct Server {
    sender: Sender<Message>,
    queue: Arc<Queue>,
    client: Client,
    open: BTreeMap<PathBuf, Document>,
    /// Packages by folder; `None` is the key for source files outside of any package.
    projects: BTreeMap<Option<PathBuf>, Project>,
    analyses: BTreeMap<PathBuf, Analysis>,
    /// Source files whose diagnostics are not yet published, each with `true` for a thorough check.
    unsaid: BTreeMap<PathBuf, bool>,
}

type Answer<T> = Result<T, String>;

impl Server {
    /// A server that sends to a client through `sender` and takes its messages from `queue`.
    pub fn new(sender: Sender<Message>, queue: Arc<Queue>, client: Client) -> Self {
        let (open, projects, analyses, unsaid) = Default::default();
        Self { sender, queue, client, open, projects, analyses, unsaid }
    }

    /// Works until the client disconnects.
    pub fn run(&mut self) {
        self.watch_files();
        loop {
            // Diagnostics are published when there is nothing else to do.
            let quiet = (!self.unsaid.is_empty()).then_some(QUIET);
            match self.queue.take(quiet) {
                Some(Task::Message(Message::Request(request))) => self.answer(request),
                Some(Task::Message(Message::Notification(notification))) => {
                    let _ = self.guarded(|server| server.notification(notification));
                }
                Some(Task::Message(Message::Response(_))) => {}
                Some(Task::Quiet) => self.say_what_is_wrong(),
                None => return,
            }
        }
    }

    /// Runs a step and catches its panics, which must not end the session. After a panic all results are computed
    /// again.
    fn guarded<T>(&mut self, step: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let done = catch_unwind(AssertUnwindSafe(|| step(self))).ok();
        if done.is_none() {
            self.projects.clear();
            self.analyses.clear();
        }
        done
    }

    fn answer(&mut self, request: Request) {
        let id = request.id.clone();
        let answer = self
            .guarded(|server| server.request(request))
            .unwrap_or_else(|| Response::new_err(id.clone(), ErrorCode::InternalError as i32, FAILED.to_owned()));
        if self.queue.wants(&id) {
            self.send(answer.into());
        }
    }

    /// A closed connection is detected by the receiver.
    fn send(&self, message: Message) {
        let _ = self.sender.send(message);
    }

    fn request(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        match method.as_str() {
            request::Completion::METHOD => answer(id, params, |p| self.completion(&p)),
            request::HoverRequest::METHOD => answer(id, params, |p: lsp_types::HoverParams| {
                let at = p.text_document_position_params;
                Ok(self.ready(&at.text_document.uri).and_then(|r| hover::hover(&r, at.position)))
            }),
            request::GotoDefinition::METHOD => answer(id, params, |p: lsp_types::GotoDefinitionParams| {
                let at = p.text_document_position_params;
                let found = self.ready(&at.text_document.uri).and_then(|r| definition::definition(&r, at.position));
                Ok(found.map(GotoDefinitionResponse::Scalar))
            }),
            request::References::METHOD => answer(id, params, |p| Ok(self.references(&p))),
            request::DocumentHighlightRequest::METHOD => answer(id, params, |p: lsp_types::DocumentHighlightParams| {
                let at = p.text_document_position_params;
                Ok(self.ready(&at.text_document.uri).map(|r| references::highlights(&r, at.position)))
            }),
            request::PrepareRenameRequest::METHOD => answer(id, params, |p: TextDocumentPositionParams| {
                self.ready(&p.text_document.uri).map(|r| rename::prepare(&r, p.position)).transpose()
            }),
            request::Rename::METHOD => answer(id, params, |p| self.rename(&p)),
            request::InlayHintRequest::METHOD => answer(id, params, |p: lsp_types::InlayHintParams| {
                Ok(self.ready(&p.text_document.uri).map(|r| hints::hints(&r, p.range)))
            }),
            request::DocumentSymbolRequest::METHOD => answer(id, params, |p: lsp_types::DocumentSymbolParams| {
                let found = self.ready(&p.text_document.uri).map(|r| symbols::symbols(&r));
                Ok(found.map(DocumentSymbolResponse::Nested))
            }),
            request::Formatting::METHOD => answer(id, params, |p: lsp_types::DocumentFormattingParams| {
                Ok(self.ready(&p.text_document.uri).map(|r| formatting::formatting(&r)))
            }),
            request::CodeActionRequest::METHOD => answer(id, params, |p| Ok(self.actions(&p))),
            _ => Response::new_err(id, ErrorCode::MethodNotFound as i32, format!("`{method}` is not supported")),
        }
    }

    fn notification(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        match method.as_str() {
            notification::DidOpenTextDocument::METHOD => with(params, |p| self.opened(p)),
            notification::DidChangeTextDocument::METHOD => with(params, |p| self.changed(p)),
            notification::DidSaveTextDocument::METHOD => {
                with(params, |p: DidSaveTextDocumentParams| self.saved(&uri::to_path(&p.text_document.uri)));
            }
            notification::DidCloseTextDocument::METHOD => with(params, |p| self.closed(&p)),
            notification::DidChangeWatchedFiles::METHOD => with(params, |p| self.files_changed(&p)),
            _ => {}
        }
    }

    // Notifications from the editor

    fn opened(&mut self, params: DidOpenTextDocumentParams) {
        let item = params.text_document;
        let path = uri::to_path(&item.uri);
        self.open.insert(path.clone(), Document { uri: item.uri, version: item.version, text: item.text.into() });
        self.text_changed(&path, true);
    }

    fn changed(&mut self, params: DidChangeTextDocumentParams) {
        let path = uri::to_path(&params.text_document.uri);
        let Some(document) = self.open.get_mut(&path) else { return };
        document.change(params.text_document.version, &params.content_changes, self.client.encoding);
        self.text_changed(&path, false);
    }

    /// Nodes may have been saved too, and some clients do not watch files.
    fn saved(&mut self, path: &Path) {
        if self.client.watches {
            self.text_changed(path, true);
        } else {
            self.nodes_changed();
        }
    }

    fn closed(&mut self, params: &DidCloseTextDocumentParams) {
        let path = uri::to_path(&params.text_document.uri);
        if let Some(document) = self.open.remove(&path) {
            self.publish(document.uri, None, vec![]);
        }
        self.text_changed(&path, false);
        self.unsaid.remove(&path);
    }

    fn files_changed(&mut self, params: &DidChangeWatchedFilesParams) {
        let paths: Vec<PathBuf> = params.changes.iter().map(|c| uri::to_path(&c.uri)).collect();
        let is_text = |p: &PathBuf| p.extension().is_some_and(|e| e == "afg");
        if paths.iter().any(|p| !is_text(p)) {
            self.nodes_changed();
        } else if paths.iter().any(|p| !self.open.contains_key(p)) {
            // Other source files may import the new one.
            self.analyses.clear();
            self.unsaid.extend(self.open.keys().map(|p| (p.clone(), true)));
        }
    }

    /// Discards all results that depend on nodes.
    fn nodes_changed(&mut self) {
        self.projects.clear();
        self.analyses.clear();
        self.unsaid.extend(self.open.keys().map(|p| (p.clone(), true)));
    }

    /// Discards the results of a source file and of those that import it.
    fn text_changed(&mut self, path: &Path, thorough: bool) {
        self.analyses.retain(|_, analysis| !analysis.reads(path));
        let gone = self.open.keys().filter(|p| !self.analyses.contains_key(*p));
        for open in gone.cloned().collect::<Vec<_>>() {
            *self.unsaid.entry(open).or_default() |= thorough;
        }
    }

    // Messages to the editor

    fn watch_files(&self) {
        if !self.client.watches {
            return;
        }
        let watcher = |glob: &str| FileSystemWatcher { glob_pattern: GlobPattern::String(glob.to_owned()), kind: None };
        let watchers = ["**/*.rs", "**/*.afg", "**/Cargo.toml", "**/Cargo.lock"].map(watcher).to_vec();
        let options = DidChangeWatchedFilesRegistrationOptions { watchers };
        let registration = Registration {
            id: "files".to_owned(),
            method: notification::DidChangeWatchedFiles::METHOD.to_owned(),
            register_options: serde_json::to_value(options).ok(),
        };
        self.ask::<request::RegisterCapability>(RegistrationParams { registrations: vec![registration] });
    }

    /// Sends a request to the client. The answer is ignored.
    fn ask<R: request::Request>(&self, params: R::Params) {
        let id = RequestId::from(R::METHOD.to_owned());
        self.send(Request::new(id, R::METHOD.to_owned(), params).into());
    }

    /// Publishes diagnostics of the changed source files, one by one, while the queue is empty.
    fn say_what_is_wrong(&mut self) {
        while self.queue.is_empty()
            && let Some((path, thorough)) = self.unsaid.pop_first()
        {
            let Some(document) = self.open.get(&path) else { continue };
            let (uri, version) = (document.uri.clone(), document.version);
            if thorough {
                self.analyses.remove(&path);
            }
            let found = self.guarded(|server| server.analysed(&path, thorough).map(|r| diagnostics::diagnostics(&r)));
            let found = found.unwrap_or_else(|| Some(vec![diagnostics::failure(FAILED)]));
            self.publish(uri, Some(version), found.unwrap_or_default());
        }
        if self.unsaid.is_empty() && self.client.refreshes_hints {
            self.ask::<request::InlayHintRefreshRequest>(());
        }
    }

    fn publish(&self, uri: Uri, version: Option<i32>, diagnostics: Vec<lsp_types::Diagnostic>) {
        let params = PublishDiagnosticsParams::new(uri, diagnostics, version);
        self.send(Notification::new(notification::PublishDiagnostics::METHOD.to_owned(), params).into());
    }

    // Analyses

    /// Analysis of an open source file.
    fn ready(&mut self, uri: &Uri) -> Option<Ready<'_>> {
        let path = uri::to_path(uri);
        self.open.contains_key(&path).then(|| self.analysed(&path, false)).flatten()
    }

    /// Analysis of a source file, open or not.
    fn analysed(&mut self, path: &Path, thorough: bool) -> Option<Ready<'_>> {
        let folder = package_of(path);
        if !self.projects.contains_key(&folder) {
            self.projects.insert(folder.clone(), Project::load(folder.as_deref()));
        }
        let project = self.projects.get_mut(&folder)?;
        if !self.analyses.contains_key(path) {
            let mut world = Overlay { disk: &mut project.disk, open: &self.open };
            let text = world.read(path).ok()?;
            let parts = (&mut project.catalog, &mut world as &mut _);
            let analysis = Analysis::new(path, &text, parts, self.client.encoding, thorough);
            self.analyses.insert(path.to_owned(), analysis);
        }
        Some(Ready { analysis: &self.analyses[path], project: &self.projects[&folder] })
    }

    // Requests about several source files

    /// Code actions. A fix that is marked as unambiguous is tried, and preferred only if it removes an error.
    fn actions(&mut self, params: &CodeActionParams) -> Option<Vec<CodeActionOrCommand>> {
        let mut offered = actions::actions(&self.ready(&params.text_document.uri)?, params.range);
        let path = uri::to_path(&params.text_document.uri);
        let certain = offered.iter_mut().filter_map(|o| Some((&mut o.action, o.certain.as_ref()?)));
        for (action, fix) in certain.take(MAX_TRIALS) {
            action.is_preferred = Some(self.mends(&path, fix));
        }
        Some(offered.into_iter().map(|o| CodeActionOrCommand::CodeAction(o.action)).collect())
    }

    /// `true` if a fix of an open source file reduces the errors.
    fn mends(&mut self, path: &Path, fix: &Certain) -> bool {
        let folder = package_of(path);
        let (Some(project), Some(analysis)) = (self.projects.get_mut(&folder), self.analyses.get_mut(path)) else {
            return false;
        };
        let mut world = Overlay { disk: &mut project.disk, open: &self.open };
        analysis.mends(path, fix, (&mut project.catalog, &mut world as &mut _))
    }

    fn completion(&mut self, params: &CompletionParams) -> Answer<Option<CompletionResponse>> {
        let at = &params.text_document_position;
        let path = uri::to_path(&at.text_document.uri);
        let snippets = self.client.snippets;
        let trigger = params.context.as_ref().and_then(|c| c.trigger_character.as_deref());
        if self
            .ready(&at.text_document.uri)
            .is_none_or(|r| trigger == Some(" ") && completion::is_indent(&r, at.position))
        {
            return Ok(None);
        }
        let beside = self.beside(&path);
        let open = &self.open;
        let siblings = || completion::siblings(&beside, open);
        let folder = package_of(&path);
        let ready = Ready { analysis: &self.analyses[&path], project: &self.projects[&folder] };
        Ok(Some(CompletionResponse::Array(completion::completion(&ready, at.position, snippets, &siblings))))
    }

    /// Other source files in the folder of a source file: only they can import it.
    fn beside(&self, path: &Path) -> BTreeSet<PathBuf> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let entries = folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
        let open = self.open.keys().filter(|p| p.parent() == Some(folder)).cloned();
        entries.chain(open).filter(|p| p != path && p.extension().is_some_and(|e| e == "afg")).collect()
    }

    /// Source files that may use the target: the one at `path`, the one that declares it, and those in the same folder.
    fn concerned(&self, path: &Path, wanted: &Target) -> BTreeSet<PathBuf> {
        let declaring = match wanted {
            Target::Text(declaring, _) => declaring.clone(),
            Target::Rust(_) => path.to_owned(),
        };
        let beside = self.beside(&declaring);
        beside.into_iter().chain([path.to_owned(), declaring]).collect()
    }

    fn references(&mut self, params: &ReferenceParams) -> Option<Vec<lsp_types::Location>> {
        let at = &params.text_document_position;
        let wanted = references::target_at(&self.ready(&at.text_document.uri)?, at.position)?;
        let mut found = vec![];
        for path in self.concerned(&uri::to_path(&at.text_document.uri), &wanted) {
            let Some(ready) = self.analysed(&path, false) else { continue };
            found.extend(references::references(&ready, &wanted, params.context.include_declaration));
        }
        Some(found)
    }

    fn rename(&mut self, params: &RenameParams) -> Answer<Option<WorkspaceEdit>> {
        let at = &params.text_document_position;
        let Some(ready) = self.ready(&at.text_document.uri) else { return Ok(None) };
        rename::prepare(&ready, at.position)?;
        let Some(wanted) = references::target_at(&ready, at.position) else { return Ok(None) };
        let mut changes: Vec<(Uri, Vec<TextEdit>)> = vec![];
        for path in self.concerned(&uri::to_path(&at.text_document.uri), &wanted) {
            let uri = self.open.get(&path).map(|d| d.uri.clone()).or_else(|| uri::from_path(&path));
            let Some((uri, ready)) = uri.zip(self.analysed(&path, false)) else { continue };
            let edits = rename::edits(&ready, &wanted, &params.new_name)?;
            if !edits.is_empty() {
                changes.push((uri, edits));
            }
        }
        Ok(Some(WorkspaceEdit::new(changes.into_iter().collect())))
    }
}

/// Handles a request and returns its answer. A reason for a failure is shown to the user.
fn answer<P: serde::de::DeserializeOwned, T: serde::Serialize>(
    id: RequestId,
    params: serde_json::Value,
    handle: impl FnOnce(P) -> Answer<T>,
) -> Response {
    match serde_json::from_value(params) {
        Ok(params) => match handle(params) {
            Ok(result) => Response::new_ok(id, result),
            Err(reason) => Response::new_err(id, ErrorCode::RequestFailed as i32, reason),
        },
        Err(error) => Response::new_err(id, ErrorCode::InvalidParams as i32, error.to_string()),
    }
}

/// Handles a notification; invalid parameters are ignored.
fn with<P: serde::de::DeserializeOwned>(params: serde_json::Value, take: impl FnOnce(P)) {
    if let Ok(params) = serde_json::from_value(params) {
        take(params);
    }
}

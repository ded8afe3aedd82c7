//! `graph!`: finds the source, calls the compiler, and returns tokens.

use apex_dsl::{
    passes,
    report::{Diagnostic, Diagnostics, Severity, render},
    source::{FileId, Sources, Span, World},
};
use apex_host::{Disk, Kept, Seen, Workspace};
use proc_macro::TokenTree;
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use std::{
    env,
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Source of a call, with the positions of its tokens.
struct Text {
    sources: Sources,
    root: FileId,
    /// Tokens of an inline source with their line and column; empty for a file.
    tokens: Vec<((usize, usize), proc_macro2::Span)>,
}

/// Expands one call of `graph!`.
pub fn expand(input: proc_macro::TokenStream) -> TokenStream {
    match try_expand(input) {
        Ok(tokens) => tokens,
        Err(message) => quote! { ::core::compile_error!(#message); },
    }
}

fn try_expand(input: proc_macro::TokenStream) -> Result<TokenStream, String> {
    let folder = env::var_os("CARGO_MANIFEST_DIR")
        .map(PathBuf::from)
        .ok_or("`graph!` needs cargo: `CARGO_MANIFEST_DIR` is not set")?;
    // The value is taken out while it is used: a concurrent call, as in editors, begins with nothing. So does the next
    // call after a panic.
    let mut kept = lock().take().unwrap_or_default();
    let expanded = expand_with(input, &folder, &mut kept);
    *lock() = Some(kept);
    expanded
}

/// Locks the state that is kept between calls.
fn lock() -> MutexGuard<'static, Option<Kept>> {
    static KEPT: Mutex<Option<Kept>> = Mutex::new(None);
    KEPT.lock().unwrap_or_else(PoisonError::into_inner)
}

fn expand_with(input: proc_macro::TokenStream, folder: &Path, kept: &mut Kept) -> Result<TokenStream, String> {
    let workspace = kept.workspace(folder)?.clone();
    let mut disk = Disk::new(Some(&workspace.cache_folder()));
    let mut text = match file_name(&input) {
        Some(name) => from_file(&name, folder, &workspace, &mut disk)?,
        None => inline(input),
    };
    let name = env::var("CARGO_CRATE_NAME").unwrap_or_default();
    let seen = Seen::Crate(&name, env::var_os("CARGO_BIN_NAME").is_some());
    let crates = workspace.crates_for(&seen, &workspace.root.join(&text.sources.get(text.root).path));
    // With rustc's tokens, all positions would be on line 1.
    proc_macro2::fallback::force();
    let catalog = kept.catalog(crates, &mut disk);
    proc_macro2::fallback::unforce();
    let call = proc_macro::Span::call_site();
    if let Some(file) = call.local_file() {
        catalog.stand_at(&env::current_dir().unwrap_or_default().join(file), call.line());
    }
    let mut diagnostics = Diagnostics::default();
    let checked = passes::check(text.root, catalog, &mut text.sources, &mut disk, &mut diagnostics);
    disk.save();
    let place = |span: Span| place(&text, span);
    let mut generate = |recordable| {
        let (programs, machines) = (&checked.programs, &checked.texts.machines);
        passes::generate(programs, machines, catalog, &text.sources, &place, recordable, &mut diagnostics)
    };
    // Only the runtime knows whether it can record.
    let (recordable, plain) = (generate(true), generate(false));
    let code = quote! { ::apex_rt::__if_record! { { #recordable } { #plain } } };
    // The state machines belong to this source.
    catalog.forget_machines();
    let errors = diagnostics.sorted().into_iter().filter(|d| d.severity == Severity::Error).map(|d| error(d, &text));
    let watched = watched(&text, &workspace);
    Ok(quote! { #(#errors)* #(#watched)* #code })
}

/// Returns the file name if the call has only a string literal: `"robot.afg"`.
fn file_name(input: &proc_macro::TokenStream) -> Option<String> {
    let mut tokens = input.clone().into_iter();
    match (tokens.next(), tokens.next()) {
        (Some(TokenTree::Literal(literal)), None) => {
            syn::parse_str::<syn::LitStr>(&literal.to_string()).ok().map(|s| s.value())
        }
        _ => None,
    }
}

/// Reads the file, which is beside the Rust file of the call, or else in the folder of the package.
fn from_file(name: &str, folder: &Path, workspace: &Workspace, disk: &mut Disk) -> Result<Text, String> {
    let source = proc_macro::Span::call_site().local_file();
    let beside =
        source.as_ref().and_then(|s| s.parent()).map(|p| env::current_dir().unwrap_or_default().join(p).join(name));
    let path = beside.filter(|p| disk.exists(p)).unwrap_or_else(|| folder.join(name));
    let text = disk.read(&path).map_err(|reason| {
        format!(
            "cannot read `{name}`: {reason}\nnote: it is searched for next to this Rust file, then in the folder of the package"
        )
    })?;
    let shown = path.strip_prefix(&workspace.root).unwrap_or(&path).to_owned();
    let mut sources = Sources::default();
    // Messages show the path relative to the root of the workspace, in which cargo runs rustc.
    let here = env::current_dir().is_ok_and(|d| d == workspace.root);
    let root = sources.add(if here { shown } else { path }, text);
    Ok(Text { sources, root, tokens: vec![] })
}

fn inline(input: proc_macro::TokenStream) -> Text {
    let call = proc_macro::Span::call_site();
    let path = call.local_file().unwrap_or_else(|| "graph!".into());
    let mut sources = Sources::default();
    let whole = call.source_text();
    // The text between the brackets of the call. Everything before it is blanked, so that positions stay the same.
    let body = whole.as_ref().and_then(|text| {
        let open = text.find(['{', '(', '['])?;
        let close = text.rfind(['}', ')', ']']).filter(|c| *c > open)?;
        let blank: String = text[..=open].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        Some(blank + &text[open + 1..close])
    });
    let (text, origin) = match body {
        Some(text) => (text, (call.line() - 1, call.column() - 1)),
        None => (input.to_string(), (0, 0)),
    };
    let root = sources.add_at(path, text, origin);
    let mut tokens = vec![];
    collect(input, &mut tokens);
    Text { sources, root, tokens }
}

fn collect(stream: proc_macro::TokenStream, tokens: &mut Vec<((usize, usize), proc_macro2::Span)>) {
    for token in stream {
        let span = token.span();
        tokens.push(((span.line(), span.column()), span.into()));
        if let TokenTree::Group(group) = token {
            collect(group.stream(), tokens);
            let close = group.span_close();
            tokens.push(((close.line(), close.column()), close.into()));
        }
    }
}

/// Returns the token at a place of the source, for rustc to underline.
fn place(text: &Text, span: Span) -> proc_macro2::Span {
    let at = text.sources.line_column(span.file, span.start);
    let token = text.tokens.iter().filter(|(position, _)| *position <= at).max_by_key(|(position, _)| *position);
    let token = token.filter(|_| span.file == text.root);
    token.map_or_else(proc_macro2::Span::call_site, |(_, span)| *span)
}

fn error(diagnostic: &Diagnostic, text: &Text) -> TokenStream {
    let inline = !text.tokens.is_empty() && diagnostic.primary.span.file == text.root;
    let message = if inline {
        let fixes = diagnostic.fixes.iter().map(|f| format!("help: {}", f.title));
        let also = diagnostic.secondary.iter().map(|l| {
            let (line, column) = text.sources.line_column(l.span.file, l.span.start);
            format!("note: line {line}, column {column}: {}", l.text)
        });
        let notes = diagnostic.notes.iter().map(|n| format!("note: {n}"));
        let first = format!("{} [{}]", diagnostic.message, diagnostic.code);
        [first].into_iter().chain(also).chain(notes).chain(fixes).collect::<Vec<_>>().join("\n")
    } else {
        let rendered = render(diagnostic, &text.sources, false);
        let headline = format!("error[{}]: {}", diagnostic.code, diagnostic.message);
        let rest = rendered.strip_prefix(&headline).unwrap_or(&rendered);
        format!("{} [{}]{rest}", diagnostic.message, diagnostic.code)
    };
    let span = place(text, diagnostic.primary.span);
    quote_spanned! { span=> ::core::compile_error!(#message); }
}

/// Makes cargo build again when a source file changes.
fn watched(text: &Text, workspace: &Workspace) -> Vec<TokenStream> {
    let files = text.sources.iter().filter(|s| s.path.extension().is_some_and(|e| e == "afg"));
    files
        .map(|source| {
            let path = workspace.root.join(&source.path);
            let path = path.to_string_lossy();
            quote! { const _: &[u8] = ::core::include_bytes!(#path); }
        })
        .collect()
}

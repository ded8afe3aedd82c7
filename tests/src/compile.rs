//! The compiler as a library: its messages about a source file.

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    passes,
    report::{Diagnostic, Diagnostics, Severity},
    source::{Sources, Span},
};
use apex_host::{Disk, Seen, Workspace};
use std::path::Path;

/// A message with the texts at its places.
#[derive(Debug)]
pub struct Found {
    /// Code.
    pub code: &'static str,
    /// Message.
    pub message: String,
    /// Text at the place of the message.
    pub at: String,
    /// Line and column of that text, counted from 1.
    pub place: (usize, usize),
    /// Texts at all other places.
    pub also: Vec<String>,
    /// Notes, labels and titles of fixes.
    pub remarks: Vec<String>,
    /// Replacements of the fixes.
    pub fixes: Vec<String>,
}

impl Found {
    fn new(diagnostic: &Diagnostic, sources: &Sources) -> Self {
        let text = |span: Span| sources.text(span).to_owned();
        let primary = diagnostic.primary.span;
        let labels = diagnostic.secondary.iter().map(|l| l.text.clone());
        let titles = diagnostic.fixes.iter().map(|f| f.title.clone());
        Self {
            code: diagnostic.code,
            message: diagnostic.message.clone(),
            at: text(primary),
            place: sources.line_column(primary.file, primary.start),
            also: diagnostic.secondary.iter().map(|l| text(l.span)).collect(),
            remarks: diagnostic.notes.iter().cloned().chain(labels).chain(titles).collect(),
            fixes: diagnostic.fixes.iter().map(|f| f.replacement.clone()).collect(),
        }
    }

    /// `true` if one of the remarks contains `words`.
    pub fn says(&self, words: &str) -> bool {
        self.remarks.iter().any(|r| r.contains(words))
    }
}

/// All errors of `text`, which can use the nodes of this package, in the order of the text.
pub fn check(text: &str) -> Vec<Found> {
    compile(text).0
}

/// The programs of a `text`, which can use the nodes of this package, with the catalog; `None` if it has errors.
pub fn programs(text: &str) -> Option<(Vec<CheckedProgram>, Catalog)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("this package has a workspace");
    let mut disk = Disk::new(Some(&workspace.cache_folder()));
    let mut catalog = Catalog::load(workspace.crates(&Seen::Crate("behaviour", false)), &mut disk);
    let mut sources = Sources::default();
    let root = sources.add(folder.join("text.afg"), text);
    let mut diagnostics = Diagnostics::default();
    let checked = passes::check(root, &mut catalog, &mut sources, &mut disk, &mut diagnostics);
    (!diagnostics.has_errors()).then_some((checked.programs, catalog))
}

fn compile(text: &str) -> (Vec<Found>, String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("this package has a workspace");
    let mut disk = Disk::new(Some(&workspace.cache_folder()));
    let mut catalog = Catalog::load(workspace.crates(&Seen::Crate("behaviour", false)), &mut disk);
    let mut sources = Sources::default();
    let root = sources.add(folder.join("text.afg"), text);
    let mut diagnostics = Diagnostics::default();
    let checked = passes::check(root, &mut catalog, &mut sources, &mut disk, &mut diagnostics);
    let code = passes::generate(
        &checked.programs,
        &checked.texts.machines,
        &catalog,
        &sources,
        &|_| proc_macro2::Span::call_site(),
        false,
        &mut diagnostics,
    );
    disk.save();
    let errors = diagnostics.sorted().into_iter().filter(|d| d.severity == Severity::Error);
    (errors.map(|d| Found::new(d, &sources)).collect(), code.to_string())
}

/// The only error of `text`.
///
/// # Panics
/// Panics if there is none, or more than one.
pub fn error(text: &str) -> Found {
    let mut found = check(text);
    assert_eq!(found.len(), 1, "one error is expected: {found:#?}");
    found.remove(0)
}

/// Rust code for `text`.
///
/// # Panics
/// Panics if it has errors.
pub fn expand(text: &str) -> String {
    let (found, code) = compile(text);
    assert!(found.is_empty(), "{found:#?}");
    code
}

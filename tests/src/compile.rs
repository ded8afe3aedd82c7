//! The compiler as a library: its messages about a source file.

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    passes::{self, Checked},
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

/// The compiler, with the nodes of this package.
pub struct Compiler {
    disk: Disk,
    catalog: Catalog,
}

impl Compiler {
    /// The compiler before its first text.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let workspace = Workspace::load(folder).expect("this package has a workspace");
        let mut disk = Disk::new(Some(&workspace.cache_folder()));
        let catalog = Catalog::load(workspace.crates(&Seen::Crate("behaviour", false)), &mut disk);
        Self { disk, catalog }
    }

    /// The node types.
    pub fn catalog(&self) -> &Catalog {
        &self.catalog
    }

    /// The programs of a `text`; `None` if it has errors.
    pub fn programs(&mut self, text: &str) -> Option<Vec<CheckedProgram>> {
        let (checked, _, diagnostics) = self.check(text);
        (!diagnostics.has_errors()).then_some(checked.programs)
    }

    fn check(&mut self, text: &str) -> (Checked, Sources, Diagnostics) {
        let mut sources = Sources::default();
        let root = sources.add(Path::new(env!("CARGO_MANIFEST_DIR")).join("text.afg"), text);
        let mut diagnostics = Diagnostics::default();
        let checked = passes::check(root, &mut self.catalog, &mut sources, &mut self.disk, &mut diagnostics);
        (checked, sources, diagnostics)
    }
}

fn compile(text: &str) -> (Vec<Found>, String) {
    let mut compiler = Compiler::new();
    let (checked, sources, mut diagnostics) = compiler.check(text);
    let code = passes::generate(
        &checked.programs,
        &checked.texts.machines,
        &compiler.catalog,
        &sources,
        &|_| proc_macro2::Span::call_site(),
        false,
        &mut diagnostics,
    );
    compiler.disk.save();
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

//! What is known about one text.

use crate::{
    position::{Encoding, Lines},
    project::Project,
};
use apex_dsl::{
    catalog::Catalog,
    claims,
    ide::{self, Occurrence, View},
    passes::{self, Checked},
    report::{Diagnostic, Diagnostics},
    resolve::{Link, Texts},
    source::{FileId, Sources, Span, World},
    syntax,
};
use lsp_types::{Location, Range};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

/// States that are looked at to decide claims while somebody types.
const QUICK_STATES: usize = 1000;

/// What is known about one text.
pub struct Analysis {
    /// What it said.
    pub text: Arc<str>,
    /// Where its lines begin.
    pub lines: Lines,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// The names in it and in what it imports.
    pub occurrences: Vec<Occurrence>,
    /// The texts; the first is this one, mended if it was half-written.
    pub sources: Sources,
    texts: Texts,
    links: Vec<Link>,
    encoding: Encoding,
}

impl Analysis {
    /// Checks `text`. Only if it is `thorough`, claims with very many states are decided.
    pub fn new(
        path: &Path,
        text: &Arc<str>,
        project: (&mut Catalog, &mut dyn World),
        encoding: Encoding,
        thorough: bool,
    ) -> Self {
        let (catalog, world) = project;
        let states = if thorough { claims::MAX_STATES } else { QUICK_STATES };
        let mut diagnostics = Diagnostics::default();
        let (mut sources, mut checked) = check(path, text, catalog, world, states, &mut diagnostics);
        if let Some(mended) = syntax::mended(text) {
            let mut said_already = Diagnostics::default();
            (sources, checked) = check(path, &mended.into(), catalog, world, states, &mut said_already);
        }
        if !thorough {
            diagnostics.retain(|d| d.code != "claim-undecided");
        }
        let Checked { texts, links, .. } = checked;
        let occurrences = ide::occurrences(&View { texts: &texts, links: &links, sources: &sources, catalog });
        let diagnostics = diagnostics.sorted().into_iter().cloned().collect();
        let lines = Lines::new(text, encoding);
        Self { text: text.clone(), lines, diagnostics, occurrences, sources, texts, links, encoding }
    }

    /// The text as the questions of `apex_dsl::ide` want it.
    pub fn view<'a>(&'a self, project: &'a Project) -> View<'a> {
        View { texts: &self.texts, links: &self.links, sources: &self.sources, catalog: &project.catalog }
    }

    /// Whether the text at `path` is part of it.
    pub fn reads(&self, path: &Path) -> bool {
        self.sources.find(path).is_some()
    }

    /// The file that a span lies in.
    pub fn path(&self, span: Span) -> &PathBuf {
        &self.sources.get(span.file).path
    }

    /// Whether a span lies in the text itself.
    pub fn is_own(&self, span: Span) -> bool {
        span.file == FileId(0)
    }

    /// The lines and columns of a span.
    pub fn range(&self, span: Span) -> Range {
        let (start, end) = (span.start as usize, span.end as usize);
        if self.is_own(span) {
            return self.lines.range(&self.text, start, end);
        }
        let text = &self.sources.get(span.file).text;
        Lines::new(text, self.encoding).range(text, start, end)
    }

    /// A span as the protocol wants it.
    pub fn location(&self, span: Span) -> Option<Location> {
        Some(Location::new(crate::uri::from_path(self.path(span))?, self.range(span)))
    }
}

fn check(
    path: &Path,
    text: &Arc<str>,
    catalog: &mut Catalog,
    world: &mut dyn World,
    states: usize,
    diagnostics: &mut Diagnostics,
) -> (Sources, Checked) {
    let mut sources = Sources::default();
    let root = sources.add(path, text.clone());
    let checked = passes::check_all(root, catalog, &mut sources, world, states, diagnostics);
    (sources, checked)
}

//! Results of the checks of one source file.

use crate::{
    places::Places,
    position::{Encoding, Lines},
    project::Project,
};
use apex_dsl::{
    catalog::Catalog,
    claims,
    passes::{self, Checked},
    report::{Diagnostics, Fix},
    resolve::{Link, SourceSet},
    source::{Sources, World},
    syntax,
};
use apex_ide::{Occurrence, View, fix};
use lsp_types::Position;
use std::{path::Path, sync::Arc};

/// A fix that its diagnostic marks as unambiguous.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Certain {
    /// The fix.
    pub fix: Fix,
    /// Message of the error that it should remove.
    pub message: String,
}

/// Maximum number of states to visit for claims while the user types.
const QUICK_STATES: usize = 1000;

/// Analysis of one source file.
pub struct Analysis {
    /// Text of the source file.
    pub text: Arc<str>,
    /// Diagnostics of the source file.
    pub report: Report,
    /// Names and connections. For a half-written source file, those of the repaired text that was checked instead.
    pub names: Names,
    lines: Lines,
    encoding: Encoding,
}

/// Diagnostics of a check, with the places that they refer to.
pub struct Report {
    /// Diagnostics.
    pub diagnostics: Diagnostics,
    /// Places.
    pub places: Places,
    /// Maximum number of states that were visited for claims.
    states: usize,
    /// Fixes that were tried, each with `true` if it removes an error.
    tried: Vec<(Certain, bool)>,
}

/// Names and connections of a check, with the places that they refer to.
pub struct Names {
    /// Names in the source file and in its imports.
    pub occurrences: Vec<Occurrence>,
    /// Places.
    pub places: Places,
    texts: SourceSet,
    links: Vec<Link>,
}

impl Analysis {
    /// Checks `text`. Claims that need very many states are checked only if `thorough` is set.
    pub fn new(
        path: &Path,
        text: &Arc<str>,
        project: (&mut Catalog, &mut dyn World),
        encoding: Encoding,
        thorough: bool,
    ) -> Self {
        let (catalog, world) = project;
        let states = if thorough { claims::MAX_STATES } else { QUICK_STATES };
        let places = |sources| Places::new(sources, text, encoding);
        let mut diagnostics = Diagnostics::default();
        let (sources, checked) = check(path, text, catalog, world, states, &mut diagnostics);
        if !thorough {
            diagnostics.retain(|d| d.code != "claim-undecided");
        }
        let names = match syntax::repaired(text) {
            Some(repaired) => {
                let mut said_already = Diagnostics::default();
                let (sources, checked) = check(path, &repaired.into(), catalog, world, states, &mut said_already);
                Names::new(checked, places(sources), catalog)
            }
            None => Names::new(checked, places(sources.clone()), catalog),
        };
        let report = Report { diagnostics, places: places(sources), states, tried: vec![] };
        Self { text: text.clone(), report, names, lines: Lines::new(text, encoding), encoding }
    }

    /// Checks the source file with a fix applied, once for each fix. Returns `true` if the fix removes an error.
    pub fn mends(&mut self, path: &Path, certain: &Certain, project: (&mut Catalog, &mut dyn World)) -> bool {
        if let Some((_, mends)) = self.report.tried.iter().find(|(tried, _)| tried == certain) {
            return *mends;
        }
        let (catalog, world) = project;
        let changed = fix::applied(&self.text, &certain.fix).into();
        let mut after = Diagnostics::default();
        check(path, &changed, catalog, world, self.report.states, &mut after);
        let mends = fix::mends(&self.report.diagnostics, &after, &certain.message);
        self.report.tried.push((certain.clone(), mends));
        mends
    }

    /// `true` if the check read the source file at `path`.
    pub fn reads(&self, path: &Path) -> bool {
        self.report.places.reads(path) || self.names.places.reads(path)
    }

    /// Byte offset of a position.
    pub fn offset(&self, position: Position) -> usize {
        self.lines.offset(&self.text, self.encoding, position)
    }

    /// Lines of another text, in the encoding of the client.
    pub fn lines_of(&self, text: &str) -> Lines {
        Lines::new(text, self.encoding)
    }

    /// Lines of the source file.
    pub fn lines(&self) -> &Lines {
        &self.lines
    }
}

impl Names {
    fn new(checked: Checked, places: Places, catalog: &Catalog) -> Self {
        let Checked { texts, links, .. } = checked;
        let sources = places.sources();
        let occurrences = apex_ide::occurrences(&View { texts: &texts, links: &links, sources, catalog });
        Self { occurrences, places, texts, links }
    }

    /// View for queries to `apex_dsl::ide`.
    pub fn view<'a>(&'a self, project: &'a Project) -> View<'a> {
        let sources = self.places.sources();
        View { texts: &self.texts, links: &self.links, sources, catalog: &project.catalog }
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

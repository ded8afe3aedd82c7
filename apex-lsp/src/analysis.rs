//! Results of the checks of one text.

use crate::{
    features::actions::Certain,
    places::Places,
    position::{Encoding, Lines},
    project::Project,
};
use apex_dsl::{
    catalog::Catalog,
    claims, fix,
    ide::{self, Occurrence, View},
    passes::{self, Checked},
    report::Diagnostics,
    resolve::{Link, SourceSet},
    source::{Sources, World},
    syntax,
};
use lsp_types::Position;
use std::{path::Path, sync::Arc};

/// States that are looked at to decide claims while somebody types.
const QUICK_STATES: usize = 1000;

/// What is known about one text.
pub struct Analysis {
    /// The text.
    pub text: Arc<str>,
    /// Its messages.
    pub report: Report,
    /// Its names and connections; if it is half-written, those of the text that was checked in its place.
    pub names: Names,
    lines: Lines,
    encoding: Encoding,
}

/// The messages of a check, with the places that they name.
pub struct Report {
    /// The messages.
    pub diagnostics: Diagnostics,
    /// The places.
    pub places: Places,
    /// States that were looked at to decide claims.
    states: usize,
    /// Changes that were tried, and whether they mend something.
    tried: Vec<(Certain, bool)>,
}

/// The names and connections of a check, with the places that they name.
pub struct Names {
    /// The names in the text and in those that it imports.
    pub occurrences: Vec<Occurrence>,
    /// The places.
    pub places: Places,
    texts: SourceSet,
    links: Vec<Link>,
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

    /// Whether a change of the text mends something: checks the changed text, once for each change.
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

    /// Whether the text at `path` is part of it.
    pub fn reads(&self, path: &Path) -> bool {
        self.report.places.reads(path) || self.names.places.reads(path)
    }

    /// The byte at a position.
    pub fn offset(&self, position: Position) -> usize {
        self.lines.offset(&self.text, self.encoding, position)
    }

    /// The lines of another text, in the encoding of the client.
    pub fn lines_of(&self, text: &str) -> Lines {
        Lines::new(text, self.encoding)
    }

    /// The lines of the text.
    pub fn lines(&self) -> &Lines {
        &self.lines
    }
}

impl Names {
    fn new(checked: Checked, places: Places, catalog: &Catalog) -> Self {
        let Checked { texts, links, .. } = checked;
        let sources = places.sources();
        let occurrences = ide::occurrences(&View { texts: &texts, links: &links, sources, catalog });
        Self { occurrences, places, texts, links }
    }

    /// The text as the questions of `apex_dsl::ide` want it.
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

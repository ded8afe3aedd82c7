//! `apex doc`: pages about graphs and nodes. This module reads the source files, [`collect`] collects the contents of
//! the pages, [`pages`] converts them to HTML, and [`folder`] writes them.

mod book;
mod collect;
mod folder;
mod html;
mod markdown;
mod names;
mod pages;

use crate::{
    project::{self, Checker},
    texts,
};
use apex_dsl::report::render;
use apex_ide::View;
use book::{Book, Files, Item, Key, Text};
use folder::Folder;
use std::{
    collections::{BTreeMap, BTreeSet, VecDeque, btree_map::Entry},
    env, fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Writes pages about source files and their imports to a folder, by default in the target folder.
pub fn run(paths: &[PathBuf], output: Option<&Path>) -> Result<ExitCode, String> {
    let named: Vec<Vec<PathBuf>> = paths.iter().map(|path| texts::named(path)).collect::<Result<_, _>>()?;
    let mut reader = Reader::new(named.concat());
    let folder = Folder::open(match output {
        Some(folder) => folder.to_owned(),
        None => reader.folder()?,
    })?;
    let Some(book) = reader.read()? else { return Ok(ExitCode::from(1)) };
    let pages = pages::pages(&book);
    folder.write(&pages)?;
    let index = folder.index();
    let here = env::current_dir().unwrap_or_default();
    let shown = index.strip_prefix(here).unwrap_or(&index);
    project::print(&format!("wrote {} pages; begin with {}", pages.len(), shown.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// Reader of source files and their imports.
struct Reader {
    /// Source files that have not been read yet.
    waiting: VecDeque<PathBuf>,
    /// One checker for each package.
    checkers: BTreeMap<Option<PathBuf>, Checker>,
    files: Files,
    /// Source files that have been or will be read.
    known: BTreeSet<PathBuf>,
    /// Printed messages: a source file that several others import is checked with each of them.
    said: BTreeSet<String>,
    texts: Vec<Text>,
    nodes: BTreeMap<Key, Item>,
}

impl Reader {
    fn new(paths: Vec<PathBuf>) -> Self {
        let mut places = BTreeMap::new();
        let (mut waiting, mut known) = (VecDeque::new(), BTreeSet::new());
        let mut base: Option<PathBuf> = None;
        for path in paths {
            let file = real(&path);
            let folder = file.parent().unwrap_or(&file);
            base = Some(base.map_or_else(|| folder.to_owned(), |base| common(&base, folder)));
            places.insert(path.clone(), file.clone());
            if known.insert(file) {
                waiting.push_back(path);
            }
        }
        let files = Files { base: base.unwrap_or_default(), real: places };
        let (checkers, said, nodes) = (BTreeMap::new(), BTreeSet::new(), BTreeMap::new());
        Self { waiting, checkers, files, known, said, texts: vec![], nodes }
    }

    /// Default folder for the pages.
    fn folder(&mut self) -> Result<PathBuf, String> {
        let Some(first) = self.waiting.front().cloned() else { return Err("there is no source file".to_owned()) };
        let checker = checker(&mut self.checkers, &first)?;
        // A missing source file is reported before any other problem.
        checker.read(&first)?;
        checker.workspace.as_ref().map(|workspace| workspace.cache_folder().join("doc")).ok_or_else(|| {
            format!("`{}` does not belong to a package: choose a folder for the pages with `--output`", first.display())
        })
    }

    /// Reads all source files with the nodes that they use. Returns `None` if one has errors, which are printed.
    fn read(mut self) -> Result<Option<Book>, String> {
        let mut is_wrong = false;
        while let Some(path) = self.waiting.pop_front() {
            is_wrong |= !self.text(&path)?;
        }
        self.checkers.values_mut().for_each(Checker::save);
        self.texts.sort_by(|a, b| (&a.path, &a.key).cmp(&(&b.path, &b.key)));
        let mut nodes: Vec<Item> = self.nodes.into_values().collect();
        nodes.sort_by(|a, b| (&a.module, &a.key.name, &a.key).cmp(&(&b.module, &b.key.name, &b.key)));
        Ok((!is_wrong).then_some(Book { texts: self.texts, nodes }))
    }

    /// Reads one source file. Returns `false` if it has errors.
    fn text(&mut self, path: &Path) -> Result<bool, String> {
        let checker = checker(&mut self.checkers, path)?;
        let text = checker.read(path)?;
        let (sources, mut diagnostics, checked) = checker.check(path, text);
        let is_wrong = diagnostics.has_errors();
        diagnostics.retain(|diagnostic| self.said.insert(render(diagnostic, &sources, false)));
        project::print_diagnostics(&diagnostics, &sources);
        if is_wrong {
            return Ok(false);
        }
        for source in sources.iter() {
            let file = real(&source.path);
            self.files.real.insert(source.path.clone(), file.clone());
            if self.known.insert(file) {
                self.waiting.push_back(source.path.clone());
            }
        }
        let package = checker.workspace.as_ref().map(|workspace| (workspace.root.as_path(), workspace.binary().0));
        let (texts, links, catalog) = (&checked.texts, &checked.links[..], &checker.catalog);
        let view = View { texts, links, sources: &sources, catalog };
        let (programs, parts, files) = (&checked.programs[..], &checked.parts[..], &self.files);
        let checked = collect::Checked { view, programs, parts, files, package };
        self.texts.push(checked.text(&mut self.nodes));
        Ok(true)
    }
}

/// Checker for the package that a source file belongs to.
fn checker<'a>(checkers: &'a mut BTreeMap<Option<PathBuf>, Checker>, file: &Path) -> Result<&'a mut Checker, String> {
    Ok(match checkers.entry(project::package_of(file)) {
        Entry::Occupied(known) => known.into_mut(),
        Entry::Vacant(free) => free.insert(Checker::new(file)?),
    })
}

/// Canonical path of a source file. A missing file is reported when it is read.
fn real(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Folder that contains both.
fn common(a: &Path, b: &Path) -> PathBuf {
    a.components().zip(b.components()).take_while(|(a, b)| a == b).map(|(a, _)| a).collect()
}

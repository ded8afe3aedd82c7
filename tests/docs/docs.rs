//! Checks of the documentation: its graphs are checked, its Rust is compiled and run, its messages are real.

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    machine::Machines,
    passes,
    report::{Diagnostics, render},
    source::Sources,
};
use apex_host::{Disk, Seen, Workspace};
use std::{
    env, fs,
    path::{Path, PathBuf},
};

mod book;
mod circles;
mod embedding;
mod examples;
mod files;
mod from;
mod generated;
mod language;
#[allow(dead_code)]
mod nodes;
mod prose;
#[allow(dead_code)]
mod rates;
mod readme;
mod recording;
#[allow(dead_code)]
mod safety;
mod silence;
mod studio;
mod texts;
#[path = "../../apex-ros/examples/goals/tokens.rs"]
mod tokens;
mod tour;

/// Page whose source files belong to a package of their own.
const TOUR: &str = "docs/tour.md";

/// Page that another test writes from the source files in `tests/figures`, whose tests run there.
const FIGURES: &str = "docs/figures.md";

/// Folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All pages, as paths from the root.
fn pages() -> Vec<String> {
    let mut pages = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(str::to_owned).to_vec();
    collect("docs", &mut pages);
    pages.sort();
    assert!(pages.len() > 10, "only {} pages were found", pages.len());
    pages
}

fn collect(folder: &str, pages: &mut Vec<String>) {
    for entry in fs::read_dir(root().join(folder)).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{folder}/{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            collect(&name, pages);
        } else if name.ends_with(".md") {
            pages.push(name);
        }
    }
}

fn page(name: &str) -> String {
    let path = root().join(name);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Blocks of a page that are marked with exactly this word.
fn blocks(page: &str, word: &str) -> Vec<String> {
    let fence = format!("```{word}\n");
    page.split(&fence).skip(1).filter_map(|rest| rest.split_once("```").map(|(block, _)| block.to_owned())).collect()
}

/// Pages whose source files are checked here. Those about errors have tests of their own.
fn pages_with_texts() -> impl Iterator<Item = String> {
    pages().into_iter().filter(|name| !name.starts_with("docs/errors/"))
}

/// Graphs of all pages, each with the name of its page.
fn graphs() -> Vec<(String, String)> {
    let of = |name: String| blocks(&page(&name), "afg").into_iter().map(move |block| (name.clone(), block));
    pages_with_texts().flat_map(of).collect()
}

/// A package for source files.
struct Package {
    catalog: Catalog,
    disk: Disk,
    file: &'static str,
}

/// Result of the compiler for a source file.
struct Checked {
    messages: Vec<String>,
    programs: Vec<CheckedProgram>,
    machines: Machines,
    sources: Sources,
}

impl Package {
    /// Package whose nodes the source files of a page use.
    fn of(page: &str) -> Self {
        // The nodes of the other pages are in the modules of this test.
        let (folder, file, seen) = match page {
            TOUR => ("robots/rover", "near.afg", Seen::Package),
            _ => ("tests", "robot.afg", Seen::Crate("docs", false)),
        };
        let workspace = Workspace::load(&root().join(folder)).expect("cargo knows the package");
        let mut disk = Disk::new(None);
        Self { catalog: Catalog::load(workspace.crates(&seen), &mut disk), disk, file }
    }

    /// Checks a source file as `apex check` does.
    fn check(&mut self, text: &str) -> Checked {
        let mut sources = Sources::default();
        let file = sources.add(self.file, text);
        let mut diagnostics = Diagnostics::default();
        let checked = passes::check(file, &mut self.catalog, &mut sources, &mut self.disk, &mut diagnostics);
        let messages = diagnostics.sorted().into_iter().map(|d| render(d, &sources, false).replace(tour::FOLDER, ""));
        let messages = messages.collect();
        Checked { messages, programs: checked.programs, machines: checked.texts.machines, sources }
    }
}

#[test]
fn every_graph_in_the_documentation_is_right() {
    let (mut rover, mut tests) = (Package::of(TOUR), Package::of("README.md"));
    let mut graphs = graphs();
    // Its graphs refer to each other, and are checked by the test that writes the page.
    graphs.retain(|(name, _)| name != FIGURES);
    for (name, block) in &graphs {
        let package = if name == TOUR { &mut rover } else { &mut tests };
        assert_eq!(package.check(block).messages, Vec::<String>::new(), "{name}:\n{block}");
    }
    assert!(graphs.len() > 30, "only {} graphs were found", graphs.len());
}

#[test]
fn every_test_in_the_documentation_is_run() {
    let with_tests = graphs().into_iter().filter(|(_, block)| block.contains("\ntest "));
    for (name, block) in with_tests.filter(|(name, _)| ![TOUR, FIGURES].contains(&name.as_str())) {
        assert!(texts::TEXTS.contains(&block.as_str()), "{name}: no file in tests/docs/texts is\n{block}");
    }
}

/// A page with the messages for its wrong source files, each of which is before its messages.
fn with_messages(page: &str, package: &mut Package, count: &mut usize) -> String {
    let mut parts = page.split("```afg wrong\n");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (wrong, rest) = part.split_once("```").expect("the text ends");
        let (between, rest) = rest.split_once("```text\n").expect("there are messages");
        let (_, rest) = rest.split_once("```").expect("they end");
        let messages = package.check(wrong).messages;
        assert!(!messages.is_empty(), "nothing is wrong:\n{wrong}");
        text += &format!("```afg wrong\n{wrong}```{between}```text\n{}\n```{rest}", messages.join("\n\n"));
        *count += 1;
    }
    text
}

/// With `APEX_UPDATE_EXPECTATIONS=1` the pages are written again.
#[test]
fn what_the_documentation_shows_of_the_compiler_is_real() {
    let (mut rover, mut tests) = (Package::of(TOUR), Package::of("README.md"));
    let update = env::var_os("APEX_UPDATE_EXPECTATIONS").is_some();
    let mut count = 0;
    for name in pages_with_texts() {
        let page = page(&name);
        let real = if name == TOUR {
            tour::with_explained(&with_messages(&page, &mut rover, &mut count), &mut rover)
        } else {
            with_messages(&page, &mut tests, &mut count)
        };
        if update {
            fs::write(root().join(&name), &real).unwrap();
        } else {
            assert_eq!(page, real, "{name}: APEX_UPDATE_EXPECTATIONS=1 writes it again");
        }
    }
    assert!(count > 5, "only {count} errors were found");
}

#[test]
fn the_rust_in_the_documentation_is_compiled_here() {
    assert_eq!(blocks(&page("README.md"), "rust"), [include_str!("readme.rs")]);
    assert_eq!(blocks(&page("docs/nodes.md"), "rust"), [include_str!("nodes.rs"), include_str!("silence.rs")]);
    assert_eq!(blocks(&page("docs/safety.md"), "rust"), [include_str!("safety.rs")]);
    assert_eq!(blocks(&page("docs/language.md"), "rust"), [include_str!("language.rs"), include_str!("rates.rs")]);
    assert_eq!(blocks(&page("docs/embedding.md"), "rust"), embedding::BLOCKS);
    assert_eq!(blocks(&page("docs/from/copper.md"), "rust"), [include_str!("from/copper.rs")]);
    assert_eq!(blocks(&page("docs/from/cs-apex.md"), "rust"), [include_str!("from/cs_apex.rs")]);
    assert_eq!(blocks(&page("docs/recording.md"), "rust"), [include_str!("recording.rs")]);
    assert_eq!(blocks(&page("docs/studio.md"), "rust"), [include_str!("studio.rs")]);
    studio::drive(readme::Parity::new(), |bytes| assert!(!bytes.is_empty()));
    readme::main();
    recording::main().expect("the file can be written and read");
    language::main();
    embedding::main();
    silence::main();
    from::copper::main();
    from::cs_apex::main();
}

#[test]
fn the_message_in_the_readme_is_the_real_one() {
    let text = "use apex_nodes::scan::{JumpDistance, Scan, Segments};\n\ngraph Segment {\n    in  scan: Scan;\n    out segments: Segments;\n\n    scan -> JumpDistance(gap = 15) -> segments;\n}\n";
    assert_eq!(blocks(&page("README.md"), "text"), [Package::of("README.md").check(text).messages.remove(0) + "\n"]);
}

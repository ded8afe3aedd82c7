//! The documentation is true: its graphs are checked, its Rust is compiled and run, its messages are the real ones.

use apex_dsl::{
    catalog::Catalog,
    passes,
    report::{Diagnostics, render},
    source::Sources,
};
use apex_host::{Disk, Seen, Workspace};
use std::{fs, path::Path};

mod language;
#[allow(dead_code)]
mod nodes;
mod readme;

const PAGES: [&str; 5] = ["README.md", "docs/language.md", "docs/nodes.md", "docs/compiler.md", "docs/performance.md"];

fn page(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The blocks of a page that are marked with exactly this word.
fn blocks(page: &str, word: &str) -> Vec<String> {
    let fence = format!("```{word}\n");
    page.split(&fence).skip(1).filter_map(|rest| rest.split_once("```").map(|(block, _)| block.to_owned())).collect()
}

/// The messages about a text, as `apex check` prints them.
fn messages(text: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("cargo knows the package");
    let mut disk = Disk::new(None);
    let mut catalog = Catalog::load(workspace.crates(&Seen::Package), &mut disk);
    let mut sources = Sources::default();
    let root = sources.add("robot.afg", text);
    let mut diagnostics = Diagnostics::default();
    passes::check(root, &mut catalog, &mut sources, &mut disk, &mut diagnostics);
    diagnostics.sorted().into_iter().map(|d| render(d, &sources, false)).collect()
}

#[test]
fn every_graph_in_the_documentation_is_right() {
    let mut count = 0;
    for name in PAGES {
        for block in blocks(&page(name), "afg") {
            count += 1;
            assert_eq!(messages(&block), Vec::<String>::new(), "{name}:\n{block}");
        }
    }
    assert!(count >= 4, "only {count} graphs were found");
}

#[test]
fn the_rust_in_the_documentation_is_compiled_here() {
    assert_eq!(blocks(&page("README.md"), "rust"), [include_str!("readme.rs")]);
    assert_eq!(blocks(&page("docs/nodes.md"), "rust"), [include_str!("nodes.rs")]);
    assert_eq!(blocks(&page("docs/language.md"), "rust"), [include_str!("language.rs")]);
    readme::main();
    language::main();
}

#[test]
fn the_message_in_the_readme_is_the_real_one() {
    let text = "use apex_nodes::scan::{JumpDistance, Scan, Segments};\n\ngraph Segment {\n    in  scan: Scan;\n    out segments: Segments;\n\n    scan -> JumpDistance(gap = 15) -> segments;\n}\n";
    assert_eq!(blocks(&page("README.md"), "text"), [messages(text).remove(0) + "\n"]);
}

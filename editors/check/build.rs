//! Compiles the parser.

fn main() {
    let folder = "../tree-sitter-afg/src";
    println!("cargo::rerun-if-changed={folder}/parser.c");
    cc::Build::new().file(format!("{folder}/parser.c")).include(folder).warnings(false).compile("tree_sitter_afg");
}

//! The tree-sitter grammar of `.afg` texts: how its parser is made, and the parser itself.
//!
//! Needs a C compiler, and `node` to read the grammar; therefore it is no default member of the workspace.

use std::path::{Path, PathBuf};
use tree_sitter::{Language, Parser, Tree};
use tree_sitter_generate::{OptLevel, generate_parser_in_directory};

/// The version of the tables that editors of the last years can read.
const ABI: usize = 14;

/// The folder of the grammar.
pub fn grammar() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tree-sitter-afg")
}

/// Makes the parser from `grammar.js` and writes it into the folder `out`.
///
/// # Errors
/// Says what is wrong with the grammar.
pub fn generate(out: &Path) -> Result<(), String> {
    let script = grammar().join("grammar.js");
    generate_parser_in_directory(grammar(), Some(out), Some(script), ABI, None, None, true, OptLevel::default())
        .map_err(|e| e.to_string())
}

/// The parser as it was compiled.
pub fn language() -> Language {
    unsafe extern "C" {
        fn tree_sitter_afg() -> *const tree_sitter::ffi::TSLanguage;
    }
    // SAFETY: the function stands in the `parser.c` that `build.rs` compiles, and gives a constant.
    unsafe { Language::from_raw(tree_sitter_afg()) }
}

/// Reads a text.
pub fn parse(text: &str) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&language()).expect("tables of a version that this library reads");
    parser.parse(text, None).expect("a parser without a time limit always has a result")
}

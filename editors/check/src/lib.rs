//! The tree-sitter grammar of `.afg` source files: generation of its parser, and the parser itself.
//!
//! Needs a C compiler, and `node` to read the grammar; therefore it is not a default member of the workspace.

mod generate;

pub use generate::{generate, grammar};
use tree_sitter::{Language, Parser, Tree};

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

//! The parser as the grammar makes it; the build script uses this file too.

use std::path::{Path, PathBuf};
use tree_sitter_generate::{OptLevel, generate_parser_in_directory};

/// The version of the tables that editors of the last years can read.
const ABI: usize = 14;

/// The folder of the grammar.
pub fn grammar() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tree-sitter-afg")
}

/// Makes the parser from `grammar.js` and writes it, with its headers, into the folder `out`.
///
/// # Errors
/// Says what is wrong with the grammar, or that `node` is missing.
pub fn generate(out: &Path) -> Result<(), String> {
    let script = grammar().join("grammar.js");
    generate_parser_in_directory(grammar(), Some(out), Some(script), ABI, None, None, true, OptLevel::default())
        .map_err(|e| e.to_string())
}

//! Generates the parser and compiles it.

use std::{env, path::PathBuf};

#[path = "src/generate.rs"]
mod generate;

fn main() {
    let grammar = generate::grammar();
    println!("cargo::rerun-if-changed={}", grammar.join("grammar.js").display());
    println!("cargo::rerun-if-changed=src/generate.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    if let Err(reason) = generate::generate(&out) {
        // Cargo shows this as an error of the package, and stops.
        println!("cargo::error={reason}");
        return;
    }
    cc::Build::new().file(out.join("parser.c")).include(&out).warnings(false).compile("tree_sitter_afg");
}

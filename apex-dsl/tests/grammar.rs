//! The parser in `src/syntax/grammar.rs` is the one that pest generates from the grammar. It is generated here and not
//! in each build: else every robot would compile the generator, and a second `syn` for it.
#![allow(clippy::disallowed_methods, reason = "it writes a source of the compiler")]

use quote::quote;
use std::{env, fs, path::Path};

const HEAD: &str = "\
// Generated from `afg.pest`: `APEX_UPDATE_EXPECTATIONS=1 cargo test -p apex-dsl --test grammar` writes it again.

/// The parser that pest generates from the grammar, where the rules are documented.
pub struct Grammar;

";

#[test]
fn the_parser_is_that_of_the_grammar() {
    let item = quote! {
        #[grammar = "src/syntax/afg.pest"]
        pub struct Grammar;
    };
    let code = pest_generator::derive_parser(item, false);
    let code = syn::parse2(code).expect("pest generates Rust");
    let text = HEAD.to_owned() + &prettyplease::unparse(&code);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/syntax/grammar.rs");
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&file, &text).expect("the file can be written");
    }
    let is = fs::read_to_string(&file).expect("the file is there");
    assert!(is == text, "the grammar has changed: run with APEX_UPDATE_EXPECTATIONS=1");
}

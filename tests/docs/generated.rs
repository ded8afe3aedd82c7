//! The page about generated code shows what the compiler generates.

use crate::{Checked, Package, page, root};
use apex_dsl::{
    passes::{self, listings},
    report::Diagnostics,
};
use std::{env, fs};

const PAGE: &str = "docs/generated.md";
const LISTING: &str = "```text\n";
const BEGIN: &str = "```rust,ignore\n";

/// Rust of the first program of a source file, without the module of the file and its attributes.
fn expanded(package: &Package, checked: &Checked) -> String {
    let place = |_| proc_macro2::Span::call_site();
    let mut diagnostics = Diagnostics::default();
    let (catalog, sources) = (&package.catalog, &checked.sources);
    let code =
        passes::generate(&checked.programs, &checked.machines, catalog, sources, &place, false, &mut diagnostics);
    let mut code: syn::File = syn::parse2(code).expect("it is Rust");
    let modules = std::mem::take(&mut code.items).into_iter().filter_map(|item| match item {
        syn::Item::Mod(module) => module.content,
        _ => None,
    });
    let programs = modules.flat_map(|(_, items)| items).filter(|item| matches!(item, syn::Item::Mod(_)));
    code.items = programs.take(1).collect();
    prettyplease::unparse(&code)
}

/// A page whose block after `fence` has other contents.
fn with(page: &str, fence: &str, contents: &str) -> String {
    let (before, rest) = page.split_once(fence).expect("there is a block");
    let (_, after) = rest.split_once("```").expect("it ends");
    format!("{before}{fence}{contents}```{after}")
}

/// With `APEX_UPDATE_EXPECTATIONS=1` the page is written again.
#[test]
fn the_page_about_generated_code_shows_the_code() {
    let mut package = Package::of(PAGE);
    let page = page(PAGE);
    let mut parts = page.split("```afg\n");
    let mut real = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (text, rest) = part.split_once("```").expect("the text ends");
        let checked = package.check(text);
        assert_eq!(checked.messages, Vec::<String>::new(), "{text}");
        let rest = with(rest, BEGIN, &expanded(&package, &checked));
        let rest = match rest.contains(LISTING) {
            true => with(&rest, LISTING, &listings(&checked.programs, &package.catalog, &checked.sources).concat()),
            false => rest,
        };
        real += &format!("```afg\n{text}```{rest}");
    }
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(root().join(PAGE), &real).unwrap();
    } else {
        assert_eq!(page, real, "{PAGE}: APEX_UPDATE_EXPECTATIONS=1 writes it again");
    }
}

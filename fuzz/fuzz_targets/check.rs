//! Arbitrary source files: diagnostics or a program, never a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::{
    path::Path,
    sync::{LazyLock, Mutex},
};

#[path = "../../tests/errors/compile.rs"]
mod compile;

static CATALOG: LazyLock<Mutex<apex_dsl::catalog::Catalog>> = LazyLock::new(|| Mutex::new(compile::catalog()));

fuzz_target!(|text: &str| {
    let compiled = compile::compile(Path::new("fuzz.afg"), text, &mut CATALOG.lock().expect("no other thread panics"));
    for diagnostic in compiled.diagnostics.sorted() {
        apex_dsl::report::render(diagnostic, &compiled.sources, false);
        apex_dsl::report::json(diagnostic, &compiled.sources);
    }
});

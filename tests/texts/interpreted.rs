//! The tests of a text, interpreted with the nodes of the text: they end as the compiled ones do, with the same words.

use crate::cargo::{call_of, package_folder};
use apex_interpret::{MARK, Source};
use apex_tests::texts::{Case, Shape};
use std::collections::BTreeMap;

/// Module of the interpreted tests, among the compiled ones.
pub const MODULE: &str = "interpreted::";

/// Rust code that interprets the tests of a case; `None` if they can only be compiled.
pub fn module(slot: usize, case: &Case) -> Option<String> {
    let (folder, name) = (package_folder(slot), call_of(slot, Shape::Library));
    let mut code = "#![allow(unused, clippy::all)]".to_owned();
    for call in case.calls.iter().filter(|call| !call.inline) {
        let text = folder.join("src").join(format!("{}.afg", call.text));
        let source = Source::load(&folder, (&name, false), &text, &folder).ok()?;
        let scripts = source.checked.programs.iter().flat_map(|program| &program.scripts);
        let names: Vec<&str> = scripts.map(|script| script.name.as_str()).collect();
        let pieces = source.pieces(&names).ok()?;
        let module = format!("of_{}", call.text);
        code += &format!(
            "mod {module} {{ {pieces} #[test] fn all() {{
                let (folder, text) = (std::path::Path::new({folder:?}), std::path::Path::new({text:?}));
                let source = apex_interpret::Source::load(folder, ({name:?}, false), text, folder).unwrap();
                println!();
                apex_interpret::run_tests(&source, &{names:?}, std::path::Path::new(\"\"), PIECES).unwrap();
            }} }}"
        );
    }
    Some(code)
}

/// Messages of tests, by their names; empty for those that pass.
type Said<'a> = BTreeMap<&'a str, &'a str>;

/// A difference between compiled and interpreted tests, from what both write.
pub fn difference(compiled: &str, interpreted: &str) -> Option<String> {
    let (of_rust, of_interpreter) = (compiled_tests(compiled), interpreted_tests(interpreted));
    for (name, message) in of_interpreter {
        let other = of_rust.get(name).copied();
        if other != Some(message) {
            return Some(format!(
                "a test ends otherwise when it is interpreted\n`{name}` compiled:\n{}\ninterpreted:\n{message}\n{interpreted}",
                other.unwrap_or("it does not exist")
            ));
        }
    }
    (!interpreted.contains("test result: ok")).then(|| format!("it is not interpreted to the end\n{interpreted}"))
}

/// Name of a test in its source file, from its path in Rust.
fn name_of(path: &str) -> &str {
    path.rsplit("::").next().unwrap_or(path).trim_start_matches("r#")
}

fn compiled_tests(said: &str) -> Said<'_> {
    let results = said.lines().filter_map(|line| line.strip_prefix("test ")?.split_once(" ... "));
    let mut tests: Said = results.map(|(path, _)| (name_of(path), "")).collect();
    for part in said.split("\n---- ").skip(1) {
        let Some((path, output)) = part.split_once(" stdout ----\n") else { continue };
        let message = output.find("test `").map_or(output, |at| &output[at..]);
        let message = message.split("\nnote: run with").next().unwrap_or(message);
        let message = message.split("\n\nfailures:\n").next().unwrap_or(message);
        tests.insert(name_of(path), message.trim());
    }
    tests
}

fn interpreted_tests(said: &str) -> Said<'_> {
    let mut tests = Said::new();
    for part in said.split(&format!("{MARK}begin ")).skip(1) {
        let Some((name, output)) = part.split_once('\n') else { continue };
        let message = output.split_once(&format!("{MARK}failed\n")).map_or("", |(_, message)| message);
        let message = message.split(MARK).next().unwrap_or(message);
        // The line with the place of a panic is left out of what compiled tests say, too.
        let place = message.starts_with("panicked at ").then(|| message.split_once('\n')).flatten();
        tests.insert(name, place.map_or(message, |(_, reason)| reason).trim());
    }
    tests
}

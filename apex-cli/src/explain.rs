//! `apex explain`.

use crate::{answer::Answer, memory, project, times};
use apex_dsl::{
    passes::listings,
    report::{PAGES, nearest, page},
};
use apex_ide::explain::{by_name, explain, explain_json};
use serde_json::{Value, json};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// Part of an explanation of a source file.
pub enum Shown {
    /// Decisions of the compiler.
    Decisions,
    /// The program that Rust is generated from.
    Program,
    /// The Petri net.
    Net,
    /// Memory of each part, in bytes.
    Memory,
    /// Execution times, from this profile.
    Times(PathBuf),
}

/// Explains a source file or a code; without either, lists the codes.
pub fn run(what: Option<&Path>, shown: Shown, answer: &mut Answer) -> Result<ExitCode, String> {
    let Some(what) = what else {
        let codes = || PAGES.iter().map(|(code, page)| (code, first_sentence(page)));
        let lines = || codes().map(|(code, summary)| format!("{code:<24}{summary}")).collect::<Vec<_>>().join("\n");
        let list = || codes().map(|(code, summary)| json!({ "code": code, "summary": summary })).collect::<Vec<_>>();
        answer.give(lines, || json!({ "codes": list() }))?;
        return Ok(ExitCode::SUCCESS);
    };
    let is_word = what.extension().is_none() && what.components().count() == 1 && !what.exists();
    let is_word = is_word && !project::is_input(what);
    match (what.to_str().filter(|_| is_word), shown) {
        (Some(code), _) => self::code(code, answer),
        (None, Shown::Program) => program(what),
        (None, Shown::Net) => net(what),
        (None, Shown::Memory) => memory::run(what, answer),
        (None, Shown::Times(profile)) => times::run(what, &profile, answer),
        (None, Shown::Decisions) => text(what, answer),
    }
}

/// Prints the page of a code.
fn code(code: &str, answer: &mut Answer) -> Result<ExitCode, String> {
    let Some(page) = page(code) else {
        let near = nearest(code, PAGES.iter().map(|(code, _)| *code));
        let hint =
            near.map_or("`apex explain --list` lists the codes".to_owned(), |near| format!("did you mean `{near}`?"));
        return Err(format!("`{code}` is neither a source file nor the code of a diagnostic; {hint}"));
    };
    answer.give(|| page.to_owned(), || json!({ "code": code, "page": page }))?;
    Ok(ExitCode::SUCCESS)
}

/// First sentence of a page, in one line.
fn first_sentence(page: &str) -> String {
    let text = page.split_once("\n\n").map_or("", |(_, text)| text);
    apex_dsl::catalog::first_sentence(text).trim_end_matches('.').to_owned()
}

/// Prints each program of a source file as Rust is generated from it.
fn program(file: &Path) -> Result<ExitCode, String> {
    let checked = project::check_text(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let listings = listings(&checked.programs, &checked.catalog, &checked.sources);
    project::print(listings.join("\n").trim_end())?;
    Ok(ExitCode::SUCCESS)
}

/// Prints what was decided about each program of a text.
fn text(file: &Path, answer: &mut Answer) -> Result<ExitCode, String> {
    let checked = project::check_text(file)?;
    answer.messages(&checked.diagnostics, &checked.sources);
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let lines = || {
        let programs = checked.programs.iter().map(|p| explain(p, &checked.texts.machines, &checked.catalog));
        let by_name = by_name(&checked.links, &checked.sources);
        programs.chain((!by_name.is_empty()).then_some(by_name)).collect::<Vec<_>>().join("\n")
    };
    let values = || -> Vec<Value> { checked.programs.iter().map(|p| explain_json(p, &checked.catalog)).collect() };
    answer.give(lines, || json!({ "programs": values() }))?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the Petri net of each program of a source file.
fn net(file: &Path) -> Result<ExitCode, String> {
    let checked = project::check_text(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    for program in &checked.programs {
        let net = apex_petri::net(&program.graph, &checked.catalog).map_err(|e| e.to_string())?;
        project::print(&apex_petri::pnml(&net))?;
    }
    Ok(ExitCode::SUCCESS)
}

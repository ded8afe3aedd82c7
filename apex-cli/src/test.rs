//! `apex test`: the tests of a text, as Rust tests.

use crate::{project, run};
use apex_dsl::script::Step;
use apex_host::{Workspace, cargo, no_cargo};
use std::{path::Path, process::ExitCode};

/// Checks, builds and runs the tests whose names contain `filter`.
pub fn run(file: &Path, filter: Option<&str>) -> Result<ExitCode, String> {
    let checked = project::check(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let count = checked.programs.iter().filter(|p| p.script.is_some()).count();
    if count == 0 {
        project::print(&format!("`{}` has no `test`", file.display()))?;
        return Ok(ExitCode::SUCCESS);
    }
    let folder = run::package(file)?;
    let workspace = Workspace::load(&folder)?;
    run::has_runtime(&folder, &workspace)?;
    let text = run::absolute(file)?;
    let name = text.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let folder = workspace.cache_folder().join("test").join(name);
    let code = format!("use apex_rt::prelude::*;\n\ngraph!({text:?});\n");
    let is_recorded = |step: &Step| matches!(step, Step::FeedRecorded { .. });
    let scripts = checked.programs.iter().filter_map(|p| p.script.as_ref());
    let recorded = scripts.flat_map(|script| &script.steps).any(is_recorded);
    let features: &[&str] = if recorded { &[run::RECORDS] } else { &[] };
    let manifest = run::make_package(&folder, &workspace, features, "src/lib.rs", &code)?;
    let target = workspace.target.join("apex/test");
    run::say_if_first(&target);
    let mut command = cargo();
    command.args(["test", "--quiet", "--lib", "--manifest-path"]).arg(manifest);
    command.arg("--target-dir").arg(target);
    command.args(filter).env("RUST_BACKTRACE", "0");
    let status = command.status().map_err(|e| no_cargo(&e))?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

//! `apex import`: converts graph files of CS::APEX to source files, and messages of ROS 2 to Rust ([`msg`]).

mod graph;
mod known;
pub mod msg;
mod names;
mod ports;
mod skeletons;
mod text;
mod wrong;
mod yaml;

use crate::{project, replace};
use apex_host::read_text;
use std::{path::Path, process::ExitCode};
use wrong::Wrong;

/// Maximum size of a graph file in bytes.
const MAX_BYTES: usize = 16 << 20;

/// Writes the graph of `file` as a source file to `output`, or prints it. Skeletons of the nodes that the library lacks
/// are written to `nodes`. If `file` has an error, nothing is written.
pub fn run(file: &Path, output: Option<&Path>, nodes: Option<&Path>) -> Result<ExitCode, String> {
    for path in [output, nodes].into_iter().flatten() {
        if path.exists() {
            return Err(format!("`{}` already exists: remove it first, or choose another name", path.display()));
        }
    }
    if output.is_some() && output == nodes {
        return Err(
            "the source file and its nodes need separate files: `--output` and `--nodes` name the same one".to_owned()
        );
    }
    let yaml = read_text(file, MAX_BYTES).map_err(|reason| format!("cannot read `{}`: {reason}", file.display()))?;
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let imported = yaml::read(&yaml).and_then(|yaml| graph::read(&yaml, &name));
    let imported = match imported {
        Ok(imported) => imported,
        Err(Wrong { line, message }) => {
            project::print_error(&format!("error: {}:{line}: {message}", file.display()));
            return Ok(ExitCode::from(1));
        }
    };
    let module = nodes.map_or_else(|| "crate".to_owned(), module);
    let text = apex_ide::format(&text::write(&imported, &module))
        .map_err(|errors| format!("this graph cannot be written as a source file: {}", errors.sorted()[0].message))?;
    let skeletons = nodes.map(|path| Ok::<_, String>((path, skeletons::write(&imported)?))).transpose()?;
    match output {
        Some(path) => replace::write(path, &text)?,
        None => project::print(text.trim_end())?,
    }
    if let Some((path, rust)) = skeletons {
        replace::write(path, &rust)?;
    }
    let unknown = skeletons::types(&imported);
    if !unknown.is_empty() {
        let names: Vec<&str> = unknown.keys().copied().collect();
        project::print_error(&format!("note: not in the library: {}", names.join(", ")));
    }
    Ok(ExitCode::SUCCESS)
}

/// Module of a Rust file in the folder `src` of a package.
fn module(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    if ["lib", "main"].contains(&&*stem) { "crate".to_owned() } else { format!("crate::{}", names::snake(&stem)) }
}

//! `apex import --msg`: reads definitions of messages, services and actions of ROS 2 (`.msg`, `.srv`, `.action`), and
//! writes Rust structs that are encoded as these messages.
//!
//! A definition file becomes [`Type`](parse::Type)s ([`parse`]): a service is two messages, an action eight. [`Types`]
//! are all of them, with those of the crate `apex-messages`, to which they may refer. They give the complete definition
//! of a type and its hash ([`hash`]). Each package becomes a Rust module ([`rust`]).

mod hash;
mod parse;
mod rust;
mod types;

use crate::{project, replace};
use apex_host::read_text;
use parse::Kind;
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};
use types::Types;

/// Maximum size of a definition file in bytes.
const MAX_BYTES: usize = 1 << 20;
/// Maximum depth of folders.
const MAX_DEPTH: usize = 16;

/// Writes the Rust code of all definitions in `paths`, files or folders, to `output`, or prints it. If a file has an
/// error, nothing is written.
pub fn run(paths: &[PathBuf], output: Option<&Path>) -> Result<ExitCode, String> {
    let mut files = BTreeSet::new();
    for path in paths {
        find(path, 0, &mut files)?;
    }
    if files.is_empty() {
        return Err("there is no `.msg`, `.srv` or `.action` file in it".to_owned());
    }
    let (mut types, mut has_errors) = (Types::common(), false);
    for file in &files {
        if let Err(message) = add(file, &mut types) {
            project::print_error(&format!("error: {message}"));
            has_errors = true;
        }
    }
    let rust = if has_errors { None } else { report(rust::write(&types)) };
    let Some(rust) = rust else { return Ok(ExitCode::from(1)) };
    match output {
        Some(path) => replace::write(path, &rust)?,
        None => project::write(&rust)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints an error of a definition.
fn report(result: Result<String, String>) -> Option<String> {
    result.inspect_err(|message| project::print_error(&format!("error: {message}"))).ok()
}

/// Adds the definition files in a folder, or the file.
fn find(path: &Path, depth: usize, files: &mut BTreeSet<PathBuf>) -> Result<(), String> {
    let cannot_read = |error| format!("cannot read `{}`: {error}", path.display());
    if path.is_dir() {
        if depth < MAX_DEPTH {
            for entry in fs::read_dir(path).map_err(cannot_read)? {
                let entry = entry.map_err(cannot_read)?.path();
                if entry.is_dir() || kind(&entry).is_some() {
                    find(&entry, depth + 1, files)?;
                }
            }
        }
    } else if kind(path).is_some() {
        files.insert(path.to_owned());
    } else {
        fs::metadata(path).map_err(cannot_read)?;
        return Err(format!("`{}` is not a `.msg`, `.srv` or `.action` file", path.display()));
    }
    Ok(())
}

fn kind(path: &Path) -> Option<Kind> {
    match path.extension()?.to_str()? {
        "msg" => Some(Kind::Message),
        "srv" => Some(Kind::Service),
        "action" => Some(Kind::Action),
        _ => None,
    }
}

/// Adds the types of a file, which is in a folder `msg`, `srv` or `action` of its package, or in the package itself.
fn add(file: &Path, types: &mut Types) -> Result<(), String> {
    let at = |message: String| format!("{}:{message}", file.display());
    let text = read_text(file, MAX_BYTES).map_err(|reason| format!("cannot read `{}`: {reason}", file.display()))?;
    let whole = file.canonicalize().unwrap_or_else(|_| file.to_owned());
    let folders = whole.ancestors().skip(1).filter_map(Path::file_name).filter_map(|name| name.to_str());
    let package = folders.into_iter().find(|name| !["msg", "srv", "action"].contains(name));
    let package = package.ok_or_else(|| at(" the folder of a package is missing around it".to_owned()))?;
    let name = file.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
    let kind = kind(file).unwrap_or(Kind::Message);
    for ty in
        parse::read(&text, package, name, kind).map_err(|wrong| at(format!("{}: {}", wrong.line, wrong.message)))?
    {
        types.add(ty).map_err(|message| at(format!(" {message}")))?;
    }
    Ok(())
}

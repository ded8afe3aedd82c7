//! `apex new`: a project that runs at once.

mod name;

use crate::project;
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// The files of a project. `{name}`, `{checkout}`, `{runtime}` and `{nodes}` are filled in.
const FILES: [(&str, &str); 6] = [
    ("Cargo.toml", include_str!("template/Cargo.toml.txt")),
    ("README.md", include_str!("template/README.md")),
    (".gitignore", include_str!("template/gitignore.txt")),
    ("robot.afg", include_str!("template/robot.afg")),
    ("src/lib.rs", include_str!("template/src/lib.rs")),
    ("src/main.rs", include_str!("template/src/main.rs")),
];

/// Makes a project in `folder`, which is named as the folder is. Its crates are those of `checkout`, or of the one that
/// this command was built from.
pub fn run(folder: &Path, checkout: Option<&Path>) -> Result<ExitCode, String> {
    let name = name::of(folder)?;
    is_free(folder)?;
    let checkout = find(checkout)?;
    let path = |path: PathBuf| toml_string(&path);
    let (runtime, nodes) = (path(checkout.join("apex-rt"))?, path(checkout.join("nodes"))?);
    for (file, template) in FILES {
        let text = template
            .replace("{name}", name)
            .replace("{checkout}", &checkout.display().to_string())
            .replace("{runtime}", &runtime)
            .replace("{nodes}", &nodes);
        write(&folder.join(file), &text)?;
    }
    project::print(&format!("made `{name}`; next\n  cd {}\n  cargo run", shell_word(folder)))?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses a folder in which there is something already.
fn is_free(folder: &Path) -> Result<(), String> {
    let shown = folder.display();
    match fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) => Err(format!("the folder `{shown}` is not empty: take another name")),
        },
        Err(_) if fs::symlink_metadata(folder).is_err() => Ok(()),
        Err(reason) => Err(format!("cannot make a project in `{shown}`: {reason}")),
    }
}

/// The checkout with the crates of Apex.
fn find(given: Option<&Path>) -> Result<PathBuf, String> {
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("/"));
    let checkout = given.unwrap_or(built_from);
    if ["apex-rt", "nodes"].iter().all(|name| checkout.join(name).join("Cargo.toml").is_file()) {
        return fs::canonicalize(checkout).map_err(|e| format!("cannot find `{}`: {e}", checkout.display()));
    }
    let shown = checkout.display();
    Err(match given {
        Some(_) => format!("`{shown}` is no checkout of Apex: there is no `apex-rt` and no `nodes` in it"),
        None => format!("the checkout of Apex is no longer in `{shown}`: say where it is with `--path`"),
    })
}

/// A path as a string of TOML, which JSON's strings are too.
fn toml_string(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let text = path.to_str().ok_or_else(|| format!("the path `{shown}` is not UTF-8: move the checkout of Apex"))?;
    serde_json::to_string(text).map_err(|e| format!("cannot write the path `{shown}`: {e}"))
}

/// A path as one word of a shell.
fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = text.chars().all(|c| c.is_alphanumeric() || "/\\:._-~".contains(c));
    if plain { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|e| format!("cannot write `{}`: {e}", path.display()))
}

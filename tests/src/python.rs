//! External tools that are written in Python.

use std::{path::Path, process::Command};

/// A Python that has `module` of `package`: that of the environment `python` in the target folder, or the system's.
/// Without one, prints instructions. `temporary` is `env!("CARGO_TARGET_TMPDIR")`, which is in the target folder.
pub fn python(temporary: &Path, module: &str, package: &str) -> Option<String> {
    let environment = temporary.with_file_name("python").display().to_string();
    let import = format!("import {module}");
    let has = |p: &String| Command::new(p).args(["-c", &import]).output().is_ok_and(|o| o.status.success());
    let found = [format!("{environment}/bin/python3"), "python3".to_owned()].into_iter().find(has);
    if found.is_none() {
        println!(
            "skipped: no Python has `{module}`; `python3 -m venv {environment} && {environment}/bin/pip install {package}`"
        );
    }
    found
}

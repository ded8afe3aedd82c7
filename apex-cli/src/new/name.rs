//! Names that a package can have.

use std::path::Path;

/// Words that cannot be the name of a crate: cargo, rustc or the project itself uses them.
const TAKEN: &[&str] = &[
    "abstract",
    "alloc",
    "apex-nodes",
    "apex-rt",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "build",
    "const",
    "continue",
    "core",
    "crate",
    "deps",
    "do",
    "dyn",
    "else",
    "enum",
    "examples",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "incremental",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "proc-macro",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "std",
    "struct",
    "super",
    "test",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
];

/// Cargo's own limit is the file system's.
const LONGEST: usize = 64;

/// The name of the package in `folder`: that of the folder.
pub fn of(folder: &Path) -> Result<&str, String> {
    let Some(name) = folder.file_name() else {
        return Err(format!(
            "`{}` has no name for the project: give the folder one, as in `my-robot`",
            folder.display()
        ));
    };
    let shown = name.to_string_lossy();
    match problem(&shown).map_or_else(|| name.to_str().ok_or("it is not UTF-8"), Err) {
        Ok(name) => Ok(name),
        Err(reason) => {
            Err(format!("`{shown}` cannot be the name of a package: {reason}; try `{}`", suggestion(&shown)))
        }
    }
}

/// What is wrong with a name.
fn problem(name: &str) -> Option<&'static str> {
    let first = name.chars().next()?;
    if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') {
        Some("only the letters `a` to `z`, digits, `-` and `_` are allowed")
    } else if !first.is_ascii_alphabetic() {
        Some("it must begin with a letter")
    } else if TAKEN.contains(&name.to_ascii_lowercase().replace('_', "-").as_str()) {
        Some("it is taken by Rust, cargo or Apex")
    } else if name.len() > LONGEST {
        Some("it is longer than 64 letters")
    } else {
        None
    }
}

/// A name near to the one that was wished for.
fn suggestion(name: &str) -> String {
    let words: Vec<String> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    let plain: String = words.join("-").chars().skip_while(|c| !c.is_ascii_alphabetic()).take(LONGEST).collect();
    let plain = plain.trim_end_matches('-');
    if plain.is_empty() {
        return "my-robot".to_owned();
    }
    if problem(plain).is_none() { plain.to_owned() } else { format!("{plain}-robot") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_refused_with_a_better_one() {
        for (name, better) in [
            ("My Robot", "my-robot"),
            ("für_alle", "f-r-alle"),
            ("2nd-robot", "nd-robot"),
            ("-x", "x"),
            ("_", "my-robot"),
            ("Ω", "my-robot"),
            ("self", "self-robot"),
            ("apex_rt", "apex-rt-robot"),
            (&"long".repeat(20), &"long".repeat(16)),
        ] {
            let message = of(Path::new(name)).unwrap_err();
            assert!(message.ends_with(&format!("; try `{better}`")), "{message}");
            assert!(of(Path::new(better)).is_ok(), "{better}");
        }
        assert_eq!(of(Path::new("some/folder/My_robot-2")), Ok("My_robot-2"));
        assert!(of(Path::new("..")).is_err());
    }
}

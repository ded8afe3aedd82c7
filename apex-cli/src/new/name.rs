//! Valid names of packages.

use std::{fs, path::Path};

/// Words that cannot be the name of a crate, because Rust or cargo uses them.
const TAKEN: &str = "\
    abstract alloc as async await become box break build const continue core crate deps do dyn else enum \
    examples extern false final fn for gen if impl in incremental let loop macro match mod move mut \
    override priv proc-macro pub ref return self static std struct super test trait true try type typeof \
    unsafe unsized use virtual where while yield";

/// Names that files cannot have on Windows, with any extension. `com` and `lpt` followed by a digit are also forbidden.
const DEVICES: &str = "aux con nul prn";

/// Maximum length of a name; cargo's own limit is that of the file system.
const LONGEST: usize = 64;

/// External crates in the lock file of Apex: cargo would take a package of the same name for one of them.
pub fn locked(checkout: &Path) -> Vec<String> {
    let lock = fs::read_to_string(checkout.join("Cargo.lock")).unwrap_or_default();
    let name = |block: &str| block.split_once("name = \"")?.1.split_once('"').map(|(name, _)| name.to_owned());
    lock.split("[[package]]").filter(|block| block.contains("\nsource = ")).filter_map(name).collect()
}

/// Name of the package in `folder`: that of the folder. It must differ from all `others`.
pub fn of<'a>(folder: &'a Path, others: &[String]) -> Result<&'a str, String> {
    let Some(name) = folder.file_name() else {
        return Err(format!("`{}` is not a name for the project: name a folder, such as `my-robot`", folder.display()));
    };
    let shown = name.to_string_lossy();
    match problem(&shown, others).map_or_else(|| name.to_str().ok_or("it is not UTF-8"), Err) {
        Ok(name) => Ok(name),
        Err(reason) => {
            Err(format!("`{shown}` cannot be the name of a package: {reason}; try `{}`", suggestion(&shown, others)))
        }
    }
}

/// Reason why a name is not valid.
fn problem(name: &str, others: &[String]) -> Option<&'static str> {
    let first = name.chars().next()?;
    let plain = name.to_ascii_lowercase().replace('_', "-");
    if !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_') {
        Some("only the letters `a` to `z`, digits, `-` and `_` are allowed")
    } else if !first.is_ascii_alphabetic() {
        Some("it must begin with a letter")
    } else if TAKEN.split(' ').any(|word| word == plain) {
        Some("it is reserved by Rust or cargo")
    } else if is_device(&plain) {
        Some("Windows does not allow files of this name")
    } else if plain == "apex" || plain.starts_with("apex-") {
        Some("names that begin with `apex` are reserved for Apex itself")
    } else if others.iter().any(|other| other.replace('_', "-") == plain) {
        Some("it is the name of a crate that Apex needs")
    } else if name.len() > LONGEST {
        Some("it is longer than 64 letters")
    } else {
        None
    }
}

/// `true` for the name of a device on Windows.
fn is_device(name: &str) -> bool {
    let port = |word| name.strip_prefix(word).is_some_and(|n| n.len() == 1 && n.chars().all(|c| c.is_ascii_digit()));
    DEVICES.split(' ').any(|device| device == name) || port("com") || port("lpt")
}

/// A valid name similar to the requested one.
fn suggestion(name: &str, others: &[String]) -> String {
    let words: Vec<String> = name
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    let plain: String = words.join("-").chars().skip_while(|c| !c.is_ascii_alphabetic()).take(LONGEST).collect();
    let plain = plain.trim_end_matches('-');
    let candidates = [plain.to_owned(), format!("{plain}-robot"), format!("my-{plain}")];
    let right = |name: &String| !plain.is_empty() && problem(name, others).is_none();
    candidates.into_iter().find(right).unwrap_or_else(|| "my-robot".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_refused_with_a_better_one() {
        let others = ["syn".to_owned(), "proc_macro2".to_owned()];
        for (name, better) in [
            ("My Robot", "my-robot"),
            ("für_alle", "f-r-alle"),
            ("2nd-robot", "nd-robot"),
            ("-x", "x"),
            ("_", "my-robot"),
            ("Ω", "my-robot"),
            ("self", "self-robot"),
            ("Self", "self-robot"),
            ("apex_rt", "my-apex-rt"),
            ("apex", "my-apex"),
            ("syn", "syn-robot"),
            ("proc-macro2", "proc-macro2-robot"),
            ("con", "con-robot"),
            ("AUX", "aux-robot"),
            ("nul", "nul-robot"),
            ("prn", "prn-robot"),
            ("com1", "com1-robot"),
            ("LPT9", "lpt9-robot"),
            (&"long".repeat(20), &"long".repeat(16)),
        ] {
            let message = of(Path::new(name), &others).unwrap_err();
            assert!(message.ends_with(&format!("; try `{better}`")), "{message}");
            assert!(of(Path::new(better), &others).is_ok(), "{better}");
        }
        for name in ["some/folder/My_robot-2", "com10", "console", "auxiliary", "apexes", "rover"] {
            assert!(of(Path::new(name), &others).is_ok(), "{name}");
        }
        assert!(of(Path::new(".."), &others).is_err());
    }

    #[test]
    fn no_word_of_rust_can_be_a_name() {
        // rustc's own list is not accessible; syn knows the keywords, which are not identifiers.
        let words = TAKEN.split(' ').filter(|word| syn::parse_str::<syn::Ident>(&word.replace('-', "_")).is_err());
        assert!(words.count() > 35);
        for word in ["async", "await", "dyn", "gen", "try", "fn", "yield", "crate", "super", "Self", "self"] {
            assert!(of(Path::new(word), &[]).is_err(), "{word}");
        }
    }

    #[test]
    fn crates_from_elsewhere_are_read_from_the_lock() {
        let names = locked(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
        assert!(names.iter().any(|name| name == "heapless") && !names.iter().any(|name| name == "rover"), "{names:?}");
        assert!(locked(Path::new("/nowhere")).is_empty());
    }
}

//! Files of a crate do not use one another in circles: whoever reads them can begin with those that use no others.

use crate::files::names;
use proc_macro2::{TokenStream, TokenTree};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

/// Files that use each other because their types contain one another.
const RECURSIVE: [[&str; 2]; 3] = [
    // A bag of several files is a recording, and has recordings.
    ["apex-bag/src/folder.rs", "apex-bag/src/recording.rs"],
    // A node may have a graph inside.
    ["apex-dsl/src/graph/mod.rs", "apex-dsl/src/graph/node.rs"],
    // A tap is an observer, and an observer may have one.
    ["apex-rt/src/observer.rs", "apex-rt/src/record/tap.rs"],
];

/// A module by its path in the crate. It has a file.
type Module = Vec<String>;

/// Names that a file declares, and paths that it uses.
#[derive(Default)]
struct File {
    /// Its path in the repository.
    path: String,
    /// Names that come from elsewhere, with their paths as written.
    imports: BTreeMap<String, Vec<String>>,
    /// Those of them that are public.
    exports: BTreeSet<String>,
    /// All paths that it uses, but for those of names that it hands on.
    uses: Vec<Vec<String>>,
}

/// Adds the parts of Rust code: identifiers, characters, and the ends of groups.
fn flat(stream: TokenStream, out: &mut Vec<String>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    proc_macro2::Delimiter::Parenthesis => ("(", ")"),
                    proc_macro2::Delimiter::Bracket => ("[", "]"),
                    _ => ("{", "}"),
                };
                out.push(open.to_owned());
                flat(group.stream(), out);
                out.push(close.to_owned());
            }
            TokenTree::Literal(_) => out.push("\"".to_owned()),
            other => out.push(other.to_string()),
        }
    }
}

/// The tokens without items that only tests have.
fn without_tests(words: &[String]) -> Vec<String> {
    const TESTS: [&[&str]; 2] =
        [&["#", "[", "cfg", "(", "test", ")"], &["#", "[", "cfg", "(", "all", "(", "test", ","]];
    let (mut left, mut at) = (vec![], 0);
    while at < words.len() {
        if TESTS.iter().any(|test| words[at..].iter().take(test.len()).eq(test.iter())) {
            let attribute = words[at..].iter().position(|word| word == "]").unwrap_or_default();
            at = end_of_item(words, at + attribute + 1);
        } else {
            left.push(words[at].clone());
            at += 1;
        }
    }
    left
}

/// The place behind an item: a semicolon, or the end of its braces.
fn end_of_item(words: &[String], mut at: usize) -> usize {
    let mut depth = 0_usize;
    while at < words.len() {
        match words[at].as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" if depth == 1 => return at + 1,
            // In code that is quoted, the item may be a variable.
            "}" | ")" | "]" if depth == 0 => return at,
            "}" | ")" | "]" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
        at += 1;
    }
    at
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Reads a path `a::b::c` at `at`. Returns its end.
fn path_at(words: &[String], mut at: usize, path: &mut Vec<String>) -> usize {
    while at < words.len() && is_name(&words[at]) {
        path.push(words[at].clone());
        at += 1;
        if !words[at..].iter().take(2).eq([":", ":"]) {
            break;
        }
        at += 2;
    }
    at
}

/// Reads a tree of imports at `at`, each with the name that it gets. Returns its end.
fn tree_at(words: &[String], mut at: usize, before: &[String], found: &mut Vec<(String, Vec<String>)>) -> usize {
    let mut path = before.to_vec();
    at = path_at(words, at, &mut path);
    match words.get(at).map(String::as_str) {
        Some("{") => {
            at += 1;
            while words[at] != "}" {
                at = tree_at(words, at, &path, found);
                at += usize::from(words[at] == ",");
            }
            at + 1
        }
        Some("*") => at + 1,
        Some("as") => {
            found.push((words[at + 1].clone(), path));
            at + 2
        }
        _ => {
            found.push((path.last().cloned().unwrap_or_default(), path));
            at
        }
    }
}

/// A path in modules inside a file, `depth` of them, as the file itself would write it.
fn of_file(mut path: Vec<String>, depth: usize) -> Vec<String> {
    let left = path.iter().take_while(|word| *word == "super").count().min(depth);
    if left > 0 {
        path.drain(..left);
        if path.first().is_none_or(|word| word != "super") {
            path.insert(0, "self".to_owned());
        }
    }
    path
}

impl File {
    fn read(path: String, code: &str) -> Self {
        let mut words = vec![];
        flat(code.parse().expect("it is Rust"), &mut words);
        let words = without_tests(&words);
        let mut file = Self { path, ..Self::default() };
        // What a module inside the file or a function imports has that name only there.
        let (mut at, mut depth) = (0, 0_usize);
        // Depths of the modules inside the file that are open.
        let mut inside = vec![];
        while at < words.len() {
            if words[at] == "use" {
                let is_public = at > 0 && (words[at - 1] == "pub" || words[at - 1] == ")");
                let mut found = vec![];
                at = tree_at(&words, at + 1, &[], &mut found);
                for (name, path) in found {
                    let path = of_file(path, inside.len());
                    match is_public {
                        true if depth > 0 => continue,
                        true => drop(file.exports.insert(name.clone())),
                        false => file.uses.push(path.clone()),
                    }
                    if depth == 0 {
                        file.imports.insert(name, path);
                    } else {
                        file.imports.entry(name).or_insert(path);
                    }
                }
            } else if is_name(&words[at]) {
                let mut path = vec![];
                let end = path_at(&words, at, &mut path);
                // In a macro, the module's name may be a variable.
                let body = end + 1 + usize::from(words.get(end).is_some_and(|word| word == "$"));
                if words[at] == "mod" && words.get(body).is_some_and(|word| word == "{") {
                    inside.push(depth);
                }
                at = end;
                file.uses.extend((path.len() > 1).then(|| of_file(path, inside.len())));
            } else {
                depth = match words[at].as_str() {
                    "{" => depth + 1,
                    "}" => depth.saturating_sub(1),
                    _ => depth,
                };
                if words[at] == "}" {
                    inside.pop_if(|before| *before == depth);
                }
                at += 1;
            }
        }
        file
    }
}

/// Folders with the sources of crates.
fn crates(root: &Path) -> Vec<String> {
    let manifests = names("toml").into_iter().filter_map(|name| Some(name.strip_suffix("/Cargo.toml")?.to_owned()));
    manifests.map(|name| format!("{name}/src")).filter(|folder| root.join(folder).is_dir()).collect()
}

/// The files of a crate, by module.
fn files(root: &Path, folder: &str) -> BTreeMap<Module, File> {
    let mut found = BTreeMap::new();
    let mut open = vec![root.join(folder)];
    while let Some(at) = open.pop() {
        for entry in fs::read_dir(&at).expect("a folder") {
            let path = entry.expect("an entry").path();
            let code = match path.extension() {
                None if path.is_dir() => {
                    open.push(path);
                    continue;
                }
                Some(extension) if extension == "rs" => fs::read_to_string(&path).expect("a text"),
                _ => continue,
            };
            let below = path.strip_prefix(root.join(folder)).expect("it is inside").with_extension("");
            let mut module: Module = below.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            module.pop_if(|last| last == "mod" || last == "lib");
            let name = path.strip_prefix(root).expect("it is inside").to_string_lossy().replace('\\', "/");
            // What a program has written has modules inside the file.
            let is_generated = ["// Generated", "//! Generated"].iter().any(|mark| code.starts_with(mark));
            let code = if is_generated { "" } else { code.as_str() };
            found.insert(module, File::read(name, code));
        }
    }
    found
}

/// The module whose file has what a path means in a module; `None` if it is elsewhere.
fn module_of(files: &BTreeMap<Module, File>, from: &Module, path: &[String], depth: usize) -> Option<Module> {
    let mut at = from.clone();
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => at.clear(),
        "self" | "super" => {}
        first => {
            let below = [from.as_slice(), &path[..1]].concat();
            if !files.contains_key(&below) {
                let import = files[from].imports.get(first).filter(|import| *import != path && depth < 8)?;
                return module_of(files, from, &[import.as_slice(), &path[1..]].concat(), depth + 1);
            }
            at = below;
        }
    }
    rest = &rest[1..];
    if path[0] == "super" {
        at.pop();
        while rest.first().is_some_and(|word| word == "super") {
            at.pop();
            rest = &rest[1..];
        }
    }
    while let Some(next) = rest.first() {
        let below = [at.as_slice(), std::slice::from_ref(next)].concat();
        if files.contains_key(&below) {
            at = below;
            rest = &rest[1..];
            continue;
        }
        let file = files.get(&at)?;
        if file.exports.contains(next) && depth < 8 {
            return module_of(files, &at, &[file.imports[next].as_slice(), &rest[1..]].concat(), depth + 1);
        }
        break;
    }
    files.contains_key(&at).then_some(at)
}

/// The modules that each module uses.
fn used(files: &BTreeMap<Module, File>) -> BTreeMap<&Module, BTreeSet<&Module>> {
    let of = |(module, file): (&'_ Module, &File)| {
        let all = file.uses.iter().filter_map(|path| module_of(files, module, path, 0));
        all.filter(|other| other != module).collect::<BTreeSet<Module>>()
    };
    let key = |module: &Module| files.get_key_value(module).expect("it has a file").0;
    files.iter().map(|(module, file)| (module, of((module, file)).iter().map(key).collect())).collect()
}

/// Files that are on circles: what is left when those that use none that are left, or are used by none, are removed.
fn on_circles(files: &BTreeMap<Module, File>) -> Vec<String> {
    let mut left = used(files);
    for (module, uses) in &mut left {
        uses.retain(|other| {
            let pair = [files[*module].path.as_str(), files[*other].path.as_str()];
            !RECURSIVE.iter().any(|[a, b]| pair == [*a, *b] || pair == [*b, *a])
        });
    }
    loop {
        let before = left.len();
        let (there, wanted): (BTreeSet<_>, BTreeSet<_>) =
            (left.keys().copied().collect(), left.values().flatten().copied().collect());
        left.retain(|module, uses| wanted.contains(module) && uses.iter().any(|other| there.contains(other)));
        if left.len() == before {
            break;
        }
    }
    let there: BTreeSet<_> = left.keys().copied().collect();
    let shown = |(module, uses): (&&Module, &BTreeSet<&Module>)| {
        let uses = uses.iter().filter(|other| there.contains(*other)).map(|other| files[*other].path.as_str());
        format!("{} uses {}", files[*module].path, uses.collect::<Vec<_>>().join(", "))
    };
    left.iter().map(shown).collect()
}

#[test]
fn files_use_one_another_in_no_circle() {
    let root = crate::root();
    let crates = crates(&root);
    assert!(crates.len() > 30, "only the crates {crates:?} were found");
    let wrong: Vec<String> = crates.iter().flat_map(|folder| on_circles(&files(&root, folder))).collect();
    assert!(wrong.is_empty(), "files use one another in circles, or are between them:\n{}", wrong.join("\n"));
}

/// The test would find a circle, whichever way the files name each other.
#[test]
fn circles_are_found() {
    let file = |module: &str, code: &str| {
        let module: Module = module.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect();
        let path = format!("{}.rs", module.join("/"));
        (module, File::read(path, code))
    };
    let circle = |a: &str, b: &str| {
        let files = BTreeMap::from([
            file(
                "",
                "mod a; mod b; mod c; pub use a::A; pub use self::b::{B, Other}; pub mod prelude { pub use crate::{A, B}; }",
            ),
            file("a", a),
            file("b", b),
            file("c", "use crate::{A, B};"),
        ]);
        on_circles(&files)
    };
    let found = ["a.rs uses b.rs", "b.rs uses a.rs"];
    assert_eq!(circle("use super::B; pub struct A(B);", "pub struct B; fn f(x: crate::A) {}"), found);
    assert_eq!(
        circle("use crate::b::{self, Other as X}; fn f() { b::g(); }", "use super::a; fn g() { a::f() }"),
        found
    );
    assert_eq!(circle("pub struct A(super::B);", "#[cfg(test)] mod tests { use crate::A; } pub struct B;"), [""; 0]);
    assert_eq!(circle("pub struct A;", "use super::A; pub struct B(A);"), [""; 0]);
    let inner = |path: &str| format!("pub mod inner {{ pub fn f(x: {path}) {{}} }} pub struct A; struct Other;");
    assert_eq!(circle(&inner("super::Other"), "fn f(x: crate::A) {}"), [""; 0]);
    assert_eq!(circle(&inner("super::super::Other"), "fn f(x: crate::A) {}"), found);
}

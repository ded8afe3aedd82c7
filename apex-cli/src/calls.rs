//! Calls of `graph!("…")` in the Rust code of a package.

use apex_dsl::syntax::MAX_BYTES;
use apex_host::read_text;
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};
use syn::{Attribute, Expr, ExprLit, Item, Lit, LitStr, Meta};

/// A call that compiles the source file.
pub struct Call {
    /// Modules around the call, from the root of its crate.
    pub module: Vec<String>,
}

/// Finds the calls that compile `text` in the crate with this root file, in the package in `folder`.
pub fn find(root: &Path, folder: &Path, text: &Path) -> Vec<Call> {
    let mut search = Search { folder, text, files: BTreeSet::new(), calls: vec![] };
    search.file(root, root.parent().unwrap_or(Path::new(".")), &mut vec![]);
    search.calls
}

struct Search<'a> {
    folder: &'a Path,
    text: &'a Path,
    /// Files that have been read: a file may contain itself as a module.
    files: BTreeSet<PathBuf>,
    calls: Vec<Call>,
}

impl Search<'_> {
    /// Searches a file whose modules are in the folder `below`. A file that cannot be read has no calls; rustc reports
    /// it.
    fn file(&mut self, file: &Path, below: &Path, module: &mut Vec<String>) {
        let Ok(text) = read_text(file, MAX_BYTES) else { return };
        if fs::canonicalize(file).is_ok_and(|file| self.files.insert(file))
            && let Ok(parsed) = syn::parse_file(&text)
        {
            self.items(&parsed.items, file, below, module);
        }
    }

    /// `true` for a `graph!` with the source file.
    fn is_call(&self, item: &syn::ItemMacro, file: &Path) -> bool {
        item.mac.path.segments.last().is_some_and(|last| last.ident == "graph")
            && item.mac.parse_body::<LitStr>().is_ok_and(|name| self.is_meant(&name.value(), file))
    }

    fn items(&mut self, items: &[Item], file: &Path, below: &Path, module: &mut Vec<String>) {
        for item in items {
            match item {
                Item::Macro(item) if self.is_call(item, file) => self.calls.push(Call { module: module.clone() }),
                Item::Mod(item) => {
                    let name = item.ident.to_string();
                    let name = name.trim_start_matches("r#");
                    let inner = below.join(name);
                    module.push(name.to_owned());
                    match (&item.content, path(&item.attrs)) {
                        (Some((_, items)), _) => self.items(items, file, &inner, module),
                        (None, Some(path)) => {
                            let path = file.parent().unwrap_or(below).join(path);
                            let inner = path.parent().unwrap_or(below).to_owned();
                            self.file(&path, &inner, module);
                        }
                        (None, None) => {
                            let beside = below.join(format!("{name}.rs"));
                            let path = if beside.is_file() { beside } else { inner.join("mod.rs") };
                            self.file(&path, &inner, module);
                        }
                    }
                    module.pop();
                }
                _ => {}
            }
        }
    }

    /// `true` if `name` in a call in `file` refers to the source file. A path is relative to the folder of `file`, or
    /// else to the folder of the package.
    fn is_meant(&self, name: &str, file: &Path) -> bool {
        let beside = file.with_file_name(name);
        let path = if beside.is_file() { beside } else { self.folder.join(name) };
        fs::canonicalize(path).is_ok_and(|path| path == self.text)
    }
}

/// Value of the attribute `#[path = "…"]`.
fn path(attributes: &[Attribute]) -> Option<String> {
    attributes.iter().find_map(|attribute| match &attribute.meta {
        Meta::NameValue(value) if value.path.is_ident("path") => match &value.value {
            Expr::Lit(ExprLit { lit: Lit::Str(path), .. }) => Some(path.value()),
            _ => None,
        },
        _ => None,
    })
}

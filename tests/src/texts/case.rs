//! A random source file with its Rust code.

use super::kinds::Kind;

/// Another binary of the package, whose items cannot be used.
const OTHER: &str = "use apex_rt::prelude::*;\n\npub struct Elsewhere;\npub const AWAY: u8 = 1;\n\n#[node]\npub fn elsewhere(x: &f64) -> f64 {\n    \
    *x\n}\n\nfn main() {}\n";

/// Crates of the package of a source file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A library.
    Library,
    /// A library with the nodes, and a binary with the source file.
    Both,
}

/// A source file.
#[derive(Debug, Clone)]
pub struct Text {
    /// Name of the file, without extension.
    pub name: String,
    /// Items.
    pub items: Vec<Item>,
}

/// An item: one line, or a head, statements of one line each, and `}`.
#[derive(Debug, Clone)]
pub struct Item {
    /// First line.
    pub head: String,
    /// Statements, if any.
    pub body: Option<Vec<String>>,
}

/// A call of `graph!`.
#[derive(Debug, Clone)]
pub struct Call {
    /// Name of the source file.
    pub text: String,
    /// Module of the call, or `None` for the root of the crate.
    pub module: Option<String>,
    /// `true` if the call contains the source text instead of a file name.
    pub inline: bool,
}

/// A random source file with its Rust code.
#[derive(Debug, Clone)]
pub struct Case {
    /// Seed.
    pub seed: u64,
    /// Hostile features.
    pub kinds: Vec<Kind>,
    /// Crates of the package.
    pub shape: Shape,
    /// Attributes of the crate.
    pub attributes: Vec<String>,
    /// Items of the library.
    pub library: Vec<String>,
    /// Items of the binary, if any.
    pub binary: Vec<String>,
    /// Source files.
    pub texts: Vec<Text>,
    /// Calls of `graph!`.
    pub calls: Vec<Call>,
}

impl Text {
    /// Content of the file.
    pub fn text(&self) -> String {
        self.items.iter().map(Item::text).collect()
    }
}

impl Item {
    /// An item of one line.
    pub fn line(head: impl Into<String>) -> Self {
        Self { head: head.into(), body: None }
    }

    fn text(&self) -> String {
        match &self.body {
            None => format!("{}\n", self.head),
            Some(body) => {
                let lines: String = body.iter().map(|line| format!("    {line}\n")).collect();
                format!("{} {{\n{lines}}}\n\n", self.head)
            }
        }
    }
}

impl Case {
    /// Files of the package, relative to `src`.
    pub fn files(&self) -> Vec<(String, String)> {
        let mut files: Vec<(String, String)> =
            self.texts.iter().map(|text| (format!("{}.afg", text.name), text.text())).collect();
        let calls: String = self.calls.iter().map(|call| self.call(call)).collect();
        match self.shape {
            Shape::Library => files.push(("lib.rs".to_owned(), self.root(&self.library, &calls))),
            Shape::Both => {
                files.push(("lib.rs".to_owned(), self.root(&self.library, "")));
                files.push(("bin/other.rs".to_owned(), OTHER.to_owned()));
                files.push(("main.rs".to_owned(), self.root(&self.binary, &calls) + "\nfn main() {}\n"));
            }
        }
        files
    }

    fn root(&self, items: &[String], calls: &str) -> String {
        let attributes: String = self.attributes.iter().map(|a| format!("{a}\n")).collect();
        let all = [attributes, items.join("\n\n"), calls.to_owned()].join("\n");
        format!(
            "//! Made by a test.\n#![allow(unused, dead_code, non_camel_case_types, non_upper_case_globals, non_snake_case)]\n{all}"
        )
    }

    fn call(&self, call: &Call) -> String {
        let text = self.texts.iter().find(|text| text.name == call.text).map(Text::text).unwrap_or_default();
        let macro_call = if call.inline {
            format!("::apex_macros::graph! {{\n{text}}}\n")
        } else {
            format!("::apex_macros::graph!(\"{}.afg\");\n", call.text)
        };
        match &call.module {
            Some(module) => format!("\npub mod {module} {{\n    use ::apex_rt::prelude::*;\n{macro_call}}}\n"),
            None => format!("\n{macro_call}"),
        }
    }

    /// Contents of all files, for people.
    pub fn shown(&self) -> String {
        let files = self.files();
        let mut shown = format!("// seed {}: {:?}\n", self.seed, self.kinds);
        for (name, text) in files {
            shown.push_str(&format!("// ---- src/{name}\n{text}\n"));
        }
        shown
    }

    /// Size of all files in bytes, to compare cases.
    pub fn size(&self) -> usize {
        self.files().iter().map(|(_, text)| text.len()).sum()
    }

    /// All cases that are a little smaller: without an item, statements, a call, an attribute.
    pub fn smaller(&self) -> Vec<Self> {
        let mut found = vec![];
        let mut add = |change: &dyn Fn(&mut Self)| {
            let mut case = self.clone();
            change(&mut case);
            found.push(case);
        };
        for t in 0..self.texts.len() {
            for i in 0..self.texts[t].items.len() {
                add(&|c| drop(c.texts[t].items.remove(i)));
                let lines = self.texts[t].items[i].body.as_ref().map_or(0, Vec::len);
                let mut size = lines / 2;
                while size > 0 {
                    for start in (0..lines).step_by(size) {
                        let end = (start + size).min(lines);
                        add(&|c| c.texts[t].items[i].body.iter_mut().for_each(|b| drop(b.drain(start..end))));
                    }
                    size /= 2;
                }
            }
        }
        (0..self.calls.len()).for_each(|i| add(&|c| drop(c.calls.remove(i))));
        (0..self.attributes.len()).for_each(|i| add(&|c| drop(c.attributes.remove(i))));
        (0..self.library.len()).for_each(|i| add(&|c| drop(c.library.remove(i))));
        (0..self.binary.len()).for_each(|i| add(&|c| drop(c.binary.remove(i))));
        found
    }
}

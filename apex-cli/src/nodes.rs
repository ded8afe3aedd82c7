//! `apex nodes`: the nodes that a package can use, with their ports and parameters.

use crate::{answer::Answer, project::Checker};
use apex_dsl::{
    catalog::{Catalog, Signature, SignatureId, first_sentence, linkless},
    passes::Checked,
    report::nearest,
    source::Sources,
    syntax::tree::PortKind,
};
use apex_ide::{NodeType, ParamFacts, PortFacts, View};
use serde_json::{Value, json};
use std::{collections::BTreeMap, fmt::Write as _, path::Path, process::ExitCode};

/// Order of the ports in a list.
const KINDS: [PortKind; 4] = [PortKind::Input, PortKind::Output, PortKind::Slot, PortKind::Event];

/// Lists the nodes of the package in `folder`, or of the library outside of any package, that match all `words`;
/// describes a node with this exact name.
pub fn run(folder: &Path, words: &[String], markdown: bool, answer: &mut Answer) -> Result<ExitCode, String> {
    let mut checker = Checker::new(&folder.join(NO_TEXT))?;
    let package = checker.workspace.as_ref().map_or_else(String::new, |workspace| workspace.binary().0.to_owned());
    let nodes = Nodes::of(folder, &package, &mut checker);
    let index = nodes.index();
    let found = index.find(words)?;
    let text = || if markdown { page(&found) } else { text(&found, words) };
    answer.give(text, || json!({ "nodes": found.iter().map(|entry| entry.json()).collect::<Vec<_>>() }))?;
    Ok(ExitCode::SUCCESS)
}

/// Name of an empty source file, in which all nodes of its package can be used.
const NO_TEXT: &str = "nodes.afg";

/// Nodes that a package can use.
pub struct Nodes<'a> {
    package: String,
    sources: Sources,
    checked: Checked,
    catalog: &'a Catalog,
}

impl<'a> Nodes<'a> {
    /// Nodes that the package in `folder` can use.
    pub fn of(folder: &Path, package: &str, checker: &'a mut Checker) -> Self {
        let (sources, _, checked) = checker.check(&folder.join(NO_TEXT), "".into());
        checker.save();
        Self { package: package.replace('-', "_"), sources, checked, catalog: &checker.catalog }
    }

    fn index(&self) -> Index<'_> {
        let Self { package, sources, checked, catalog } = self;
        Index::new(View { texts: &checked.texts, links: &checked.links, sources, catalog }, package)
    }

    /// Interfaces of the package's own nodes, each in a line of Markdown.
    pub fn own(&self) -> Vec<String> {
        let index = self.index();
        let is_own = |entry: &&Entry<'_>| entry.module.split("::").next() == Some(&self.package);
        index.entries.iter().filter(is_own).map(Entry::line).collect()
    }
}

/// A node of the index.
struct Entry<'a> {
    signature: &'a Signature,
    /// Crate and modules of the node.
    module: String,
    ports: Vec<PortFacts>,
    params: Vec<ParamFacts>,
}

/// Nodes of a package, sorted by module and name.
struct Index<'a> {
    entries: Vec<Entry<'a>>,
}

impl<'a> Index<'a> {
    fn new(view: View<'a>, package: &str) -> Self {
        let reachable = view.catalog.rust_nodes().filter(|(_, signature)| !signature.path.is_empty());
        let entry = |(id, signature): (SignatureId, &'a Signature)| {
            let written = view.catalog.written(&signature.path);
            let path: Vec<&str> = written.iter().map(String::as_str).collect();
            let module: Vec<&str> = match path.split_last() {
                Some((_, ["crate", inner @ ..])) => [package].into_iter().chain(inner.iter().copied()).collect(),
                Some((_, module)) => module.to_vec(),
                None => vec![],
            };
            let (node, module) = (NodeType::Rust(id), module.join("::"));
            Entry { signature, module, ports: view.ports(node), params: view.params(node) }
        };
        let mut entries: Vec<Entry<'a>> = reachable.map(entry).collect();
        entries.sort_by_cached_key(|entry| (entry.module.clone(), entry.signature.name.to_lowercase()));
        Self { entries }
    }

    /// Nodes that match all `words`. Fails if there is none.
    fn find(&self, words: &[String]) -> Result<Vec<&Entry<'a>>, String> {
        let found: Vec<&Entry<'a>> = self.entries.iter().filter(|entry| entry.matches(words)).collect();
        if found.is_empty() { Err(self.nothing(words)) } else { Ok(found) }
    }

    fn nothing(&self, words: &[String]) -> String {
        let names = self.entries.iter().map(|entry| entry.signature.name.as_str());
        match words {
            [] => "neither the package nor its dependencies have nodes".to_owned(),
            [word] => match nearest(word, names) {
                Some(near) => format!("no node matches `{word}`; did you mean `{near}`?"),
                None => format!("no node matches `{word}`; `apex nodes` lists them all"),
            },
            several => format!("no node matches all of `{}`; give fewer words", several.join("`, `")),
        }
    }
}

impl Entry<'_> {
    /// `true` if each word is part of the path, the documentation, a port, a parameter or a type.
    fn matches(&self, words: &[String]) -> bool {
        let mut all = format!("{}::{} {}", self.module, self.signature.name, self.signature.docs);
        for port in &self.ports {
            let _ = write!(all, " {} {}", port.name, port.ty);
        }
        for param in &self.params {
            let _ = write!(all, " {} {}", param.name, param.ty);
        }
        let all = all.to_lowercase();
        words.iter().all(|word| all.contains(&word.to_lowercase()))
    }

    /// `true` if this is the name of the node, with or without the modules before it.
    fn is_named(&self, word: &str) -> bool {
        let path = format!("::{}::{}", self.module, self.signature.name).to_lowercase();
        path.ends_with(&format!("::{}", word.to_lowercase()))
    }

    /// Full description for a terminal.
    fn text(&self) -> String {
        let mut text = format!("{}::{}\n", self.module, self.signature.name);
        for line in self.signature.docs.trim().lines() {
            text += format!("  {}", plain(line)).trim_end();
            text.push('\n');
        }
        let rows = self.rows();
        let widths = [0, 1, 2].map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
        for [kind, name, ty, docs] in &rows {
            let (a, b, c) = (widths[0], widths[1], widths[2]);
            let line = format!("  {kind:a$}  {name:b$}  {ty:c$}  {docs}");
            text += line.trim_end();
            text.push('\n');
        }
        text
    }

    /// Ports in the order of a list.
    fn ports(&self) -> impl Iterator<Item = &PortFacts> {
        KINDS.iter().flat_map(|kind| self.ports.iter().filter(move |port| port.kind == *kind))
    }

    /// Description for programs. Values are written as in a source file.
    fn json(&self) -> Value {
        let ports = self.ports();
        let port = |port: &PortFacts| {
            json!({
                "kind": port.kind.word(), "name": port.name, "type": port.type_text(), "optional": port.optional,
                "any_number": port.any_number, "docs": port.docs.trim(),
            })
        };
        let param = |param: &ParamFacts| {
            json!({
                "name": param.name, "type": param.ty, "unit": param.unit, "default": param.default,
                "range": param.range, "docs": param.docs.trim(),
            })
        };
        json!({
            "name": self.signature.name,
            "module": self.module,
            "docs": self.signature.docs.trim(),
            "file": self.signature.file,
            "line": self.signature.line,
            "ports": ports.map(port).collect::<Vec<_>>(),
            "params": self.params.iter().map(param).collect::<Vec<_>>(),
        })
    }

    /// Interface in one line, as in a source file, and the first sentence of the documentation.
    fn line(&self) -> String {
        let typed = |name: &str, ty: &str| if ty == "()" { name.to_owned() } else { format!("{name}: {ty}") };
        let param = |param: &ParamFacts| {
            let unit = param.unit.as_ref().map(|unit| format!("[{unit}]")).unwrap_or_default();
            let default = param.default.as_ref().filter(|default| !default.contains('\n'));
            let default = default.map(|default| format!(" = {default}")).unwrap_or_default();
            let range = param.range.as_ref().map(|range| format!(" in {range}")).unwrap_or_default();
            format!("{}: {}{unit}{default}{range}", param.name, param.ty)
        };
        let ports = self.ports();
        let port = |port: &PortFacts| format!("{} {}", port.kind.keyword(), typed(&port.name, &port.type_text()));
        let params: Vec<String> = self.params.iter().map(param).collect();
        let ports: Vec<String> = ports.map(port).collect();
        let (name, docs) = (&self.signature.name, linkless(&first_sentence(&self.signature.docs)));
        format!("`{name}({})`: `{}`. {docs}", params.join(", "), ports.join("; "))
    }

    /// Rows with the ports and parameters: kind, name, type with unit, default and range, documentation.
    fn rows(&self) -> Vec<[String; 4]> {
        let ports = self.ports();
        let port = |port: &PortFacts| {
            let ty = if port.ty.is_unit() { String::new() } else { port.type_text() };
            let remarks: Vec<&str> = port.remarks().collect();
            let remarks = if remarks.is_empty() { String::new() } else { format!(" ({})", remarks.join(", ")) };
            [port.kind.word().to_owned(), port.name.clone(), ty + &remarks, plain(&first_sentence(&port.docs))]
        };
        let param = |param: &ParamFacts| {
            let unit = param.unit.as_ref().map(|unit| format!("[{unit}]")).unwrap_or_default();
            let default = match param.default.as_deref() {
                None => String::new(),
                Some(long) if long.contains('\n') => " = …".to_owned(),
                Some(default) => format!(" = {default}"),
            };
            let range = param.range.as_ref().map(|range| format!(" in {range}")).unwrap_or_default();
            let ty = format!("{}{unit}{default}{range}", param.ty);
            ["param".to_owned(), param.name.clone(), ty, plain(&first_sentence(&param.docs))]
        };
        ports.map(port).chain(self.params.iter().map(param)).collect()
    }
}

/// Description of the node with the name that is searched for, or else a list of all nodes that match.
fn text(found: &[&Entry<'_>], words: &[String]) -> String {
    let named: Vec<&Entry<'_>> = match words {
        [word] => found.iter().copied().filter(|entry| entry.is_named(word)).collect(),
        _ => vec![],
    };
    match (&named[..], found) {
        ([], [only]) => only.text(),
        ([], _) => list(found),
        _ => named.iter().map(|entry| entry.text()).collect::<Vec<_>>().join("\n"),
    }
}

/// Names with their first sentences, by module.
fn list(found: &[&Entry<'_>]) -> String {
    let width = found.iter().map(|entry| entry.signature.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for group in found.chunk_by(|a, b| a.module == b.module) {
        let _ = writeln!(text, "{}{}", if text.is_empty() { "" } else { "\n" }, group[0].module);
        for entry in group {
            let line = format!("  {:width$}  {}", entry.signature.name, plain(&first_sentence(&entry.signature.docs)));
            text += line.trim_end();
            text.push('\n');
        }
    }
    text
}

/// Full descriptions in Markdown: a table for each module, then a section for each node.
fn page(found: &[&Entry<'_>]) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut text = String::new();
    for group in found.chunk_by(|a, b| a.module == b.module) {
        let _ = writeln!(text, "## {}\n\n| node | |\n|---|---|", group[0].module);
        let anchors: Vec<String> = group.iter().map(|entry| anchor(&entry.signature.name, &mut counts)).collect();
        for (entry, anchor) in group.iter().zip(&anchors) {
            let docs = cell(&first_sentence(&entry.signature.docs));
            let _ = writeln!(text, "| [`{}`](#{anchor}) | {docs} |", entry.signature.name);
        }
        text.push('\n');
        group.iter().for_each(|entry| text += &section(entry));
    }
    text
}

fn section(entry: &Entry<'_>) -> String {
    let (module, name) = (&entry.module, &entry.signature.name);
    let mut text =
        format!("### {name}\n\n`{module}::{name}`: {}\n\n", linkless(&first_sentence(&entry.signature.docs)));
    let rows = entry.rows();
    if !rows.is_empty() {
        text += "| | name | type | |\n|---|---|---|---|\n";
    }
    for [kind, name, ty, docs] in rows {
        let ty = if ty.is_empty() { String::new() } else { format!("`{}`", ty.replace('|', "\\|")) };
        let _ = writeln!(text, "| {kind} | `{name}` | {ty} | {} |", cell(&docs));
    }
    text + "\n"
}

/// Anchor of a heading; the second one with the same name gets a number.
fn anchor(name: &str, counts: &mut BTreeMap<String, usize>) -> String {
    let name = name.to_lowercase();
    let count = counts.entry(name.clone()).or_default();
    *count += 1;
    if *count == 1 { name } else { format!("{name}-{}", *count - 1) }
}

/// Removes links and back quotes, for a terminal.
fn plain(text: &str) -> String {
    linkless(text).replace('`', "")
}

/// Text for a cell of a Markdown table.
fn cell(text: &str) -> String {
    linkless(text).replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_no_markup() {
        assert_eq!(plain("`a` | [`B`]"), "a | B");
        assert_eq!(cell("`a` | b"), "`a` \\| b");
    }

    #[test]
    fn headings_of_one_name_have_anchors_of_their_own() {
        let mut counts = BTreeMap::new();
        assert_eq!(["Note", "Other", "Note"].map(|name| anchor(name, &mut counts)), ["note", "other", "note-1"]);
    }
}

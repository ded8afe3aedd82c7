//! Converts the contents of pages to HTML.

use super::{
    book::{Book, Claim, Item, Key, Picture, State, Test, Text, Use},
    html::{block, code, escaped, folded, link, page, section},
    markdown,
    names::Names,
};
use apex_dsl::syntax::tree::PortKind;
use apex_ide::{ParamFacts, PortFacts};
use std::collections::BTreeMap;

/// All pages by file name. Equal books give equal pages.
pub fn pages(book: &Book) -> BTreeMap<String, String> {
    let site = Site::new(book);
    let mut pages = BTreeMap::from([(Names::INDEX.to_owned(), site.index(book))]);
    for text in &book.texts {
        pages.extend(site.names.page(&text.key).map(|name| (name.to_owned(), site.text(text))));
        for item in &text.items {
            let name = site.names.page(&item.key);
            pages.extend(name.map(|name| (name.to_owned(), site.item(item, Some(text)))));
        }
    }
    for node in &book.nodes {
        pages.extend(site.names.page(&node.key).map(|name| (name.to_owned(), site.item(node, None))));
    }
    pages
}

/// Data about all pages that a single page needs.
struct Site<'a> {
    names: Names<'a>,
    /// Graphs that use an item.
    users: BTreeMap<&'a Key, Vec<&'a Key>>,
    /// Tests of a graph.
    tests: BTreeMap<&'a Key, Vec<&'a Test>>,
}

impl<'a> Site<'a> {
    fn new(book: &'a Book) -> Self {
        let mut users: BTreeMap<&Key, Vec<&Key>> = BTreeMap::new();
        for item in book.items() {
            for used in item.nodes.iter().filter_map(|node| node.of.as_ref()) {
                let users = users.entry(used).or_default();
                if users.last() != Some(&&item.key) {
                    users.push(&item.key);
                }
            }
        }
        let mut tests: BTreeMap<&Key, Vec<&Test>> = BTreeMap::new();
        for test in book.texts.iter().flat_map(|text| &text.tests) {
            if let Some(graph) = &test.of {
                tests.entry(graph).or_default().push(test);
            }
        }
        Self { names: Names::new(book), users, tests }
    }

    fn index(&self, book: &Book) -> String {
        let text = |text: &Text| {
            let tests: String = text.tests.iter().map(|test| self.test_entry(test)).collect();
            let title = self.link_to(&text.key, &escaped(&text.path));
            let docs = markdown::first_sentence(&text.docs);
            let docs = if docs.is_empty() { docs } else { format!("<p>{docs}</p>\n") };
            format!("<h3>{title}</h3>\n{docs}{}", list(&(self.entries(&text.items) + &tests)))
        };
        let texts: String = book.texts.iter().map(text).collect();
        let modules = book.nodes.chunk_by(|a, b| a.module == b.module);
        let nodes = modules.map(|m| format!("<h3>{}</h3>\n{}", code(&m[0].module), list(&self.entries(m))));
        let title = "Graphs and nodes";
        let body = section("Source files", &texts) + &section("Nodes", &nodes.collect::<String>());
        page(title, &[], &format!("<h1>{title}</h1>\n{body}"))
    }

    /// List of names with first sentences.
    fn entries(&self, items: &[Item]) -> String {
        let entry = |item: &Item| {
            let name = self.link_to(&item.key, &code(&item.key.name));
            let docs = markdown::first_sentence(&item.docs);
            format!("<dt>{name} <span class=\"soft\">{}</span></dt>\n<dd>{docs}</dd>\n", item.word)
        };
        items.iter().map(entry).collect()
    }

    fn test_entry(&self, test: &Test) -> String {
        let name = match &test.of {
            Some(graph) => self.link_to(graph, &code(&test.name)),
            None => code(&test.name),
        };
        let docs = markdown::first_sentence(&test.docs);
        format!("<dt>{name} <span class=\"soft\">test</span></dt>\n<dd>{docs}</dd>\n")
    }

    fn text(&self, text: &Text) -> String {
        let tests: String = text.tests.iter().map(|test| self.test(test)).collect();
        let body = format!(
            "<h1>{}</h1>\n{}{}{}",
            escaped(&text.path),
            self.docs(&text.docs),
            section("Contents", &list(&self.entries(&text.items))),
            section("Tests", &tests)
        );
        page(&text.path, &[link(Names::INDEX, "All")], &body)
    }

    fn item(&self, item: &Item, text: Option<&Text>) -> String {
        let name = &item.key.name;
        let module = text.map_or_else(|| code(&item.module), |text| self.link_to(&text.key, &escaped(&text.path)));
        let tests = self.tests.get(&item.key).into_iter().flatten().map(|test| self.test(test));
        let pictures = item.pictures.iter().map(|picture| section(picture.title, &figure(picture, name)));
        let body = [
            format!("<h1><small>{}</small> {}</h1>\n", item.word, escaped(name)),
            place(item),
            self.docs(&item.docs),
            pictures.collect(),
            section("Signature", &item.signature.as_deref().map(block).unwrap_or_default()),
            section("Parameters", &self.params(&item.params)),
            section("Ports", &self.ports(&item.ports)),
            section("Nodes", &self.uses(&item.nodes)),
            section("States", &self.states(&item.states)),
            section("Claims", &claims(&item.claims)),
            section("Tests", &tests.collect::<String>()),
            section("Used in", &self.used_in(&item.key)),
            item.code.as_deref().map(|text| folded("Text", &block(text))).unwrap_or_default(),
        ];
        page(name, &[link(Names::INDEX, "All"), module], &body.concat())
    }

    fn docs(&self, docs: &str) -> String {
        markdown::html(docs, &|name| self.names.of_word(name).map(str::to_owned))
    }

    fn link_to(&self, key: &Key, inner: &str) -> String {
        self.names.page(key).map_or_else(|| inner.to_owned(), |page| link(page, inner))
    }

    fn entry(&self, term: &str, docs: &str) -> String {
        format!("<dt>{term}</dt>\n<dd>{}</dd>\n", self.docs(docs))
    }

    fn params(&self, params: &[ParamFacts]) -> String {
        let param = |param: &ParamFacts| {
            let unit = param.unit.as_ref().map(|unit| format!(" · in {}", code(unit)));
            let range = param.range.as_ref().map(|range| format!(" · range {}", code(range)));
            let (default, lines) = match param.default.as_deref() {
                None => (None, String::new()),
                Some("…") => (Some(" · default in Rust".to_owned()), String::new()),
                Some(lines) if lines.contains('\n') => (Some(" · default".to_owned()), block(&unindented(lines))),
                Some(default) => (Some(format!(" · default {}", code(default))), String::new()),
            };
            let facts: String = [Some(code(&param.ty)), unit, range, default].into_iter().flatten().collect();
            let name = format!("{} <span class=\"soft\">{facts}</span>", code(&param.name));
            format!("<dt>{name}</dt>\n<dd>{lines}{}</dd>\n", self.docs(&param.docs))
        };
        definitions(&params.iter().map(param).collect::<String>())
    }

    fn ports(&self, ports: &[PortFacts]) -> String {
        let port = |port: &PortFacts| {
            let ty = if port.ty.is_unit() { String::new() } else { format!(" · {}", code(&port.type_text())) };
            let remarks: String = port.remarks().map(|remark| format!(" · {remark}")).collect();
            let facts = format!("<span class=\"soft\">{}{ty}{remarks}</span>", port.kind.word());
            self.entry(&format!("{} {facts}", code(&port.name)), &port.docs)
        };
        let order = [PortKind::Input, PortKind::Output, PortKind::Slot, PortKind::Event];
        let sorted = order.iter().flat_map(|kind| ports.iter().filter(move |port| port.kind == *kind));
        definitions(&sorted.map(port).collect::<String>())
    }

    fn uses(&self, nodes: &[Use]) -> String {
        let node = |node: &Use| {
            let name = node.name.as_deref().map_or_else(|| "<i>in place</i>".to_owned(), code);
            let ty = node.of.as_ref().map_or_else(|| code(&node.ty), |key| self.link_to(key, &code(&node.ty)));
            let handed_in = if node.handed_in { ", handed in by Rust" } else { "" };
            let given: Vec<String> = node.given.iter().map(|given| code(given)).collect();
            let given = if given.is_empty() { String::new() } else { format!("<p>{}</p>\n", given.join(", ")) };
            let docs = given + &self.docs(&node.docs);
            format!("<dt>{name} <span class=\"soft\">{ty}{handed_in}</span></dt>\n<dd>{docs}</dd>\n")
        };
        definitions(&nodes.iter().map(node).collect::<String>())
    }

    fn states(&self, states: &[State]) -> String {
        let state = |state: &State| self.entry(&code(&state.path), &state.docs);
        definitions(&states.iter().map(state).collect::<String>())
    }

    fn test(&self, test: &Test) -> String {
        let graph = code(&test.graph);
        let graph = test.of.as_ref().map_or_else(|| graph.clone(), |key| self.link_to(key, &graph));
        let title = format!("<h3>{} <span class=\"soft\">of {graph}</span></h3>\n", code(&test.name));
        title + &self.docs(&test.docs) + &folded("Text", &block(&test.code))
    }

    fn used_in(&self, key: &Key) -> String {
        let users = self.users.get(key).into_iter().flatten();
        let items: String = users.map(|user| format!("<li>{}</li>\n", self.link_to(user, &code(&user.name)))).collect();
        if items.is_empty() { items } else { format!("<ul>\n{items}</ul>\n") }
    }
}

/// Import and declaration of an item.
fn place(item: &Item) -> String {
    let import = item.import.as_ref().map(|path| code(&format!("use {path};")));
    let parts: Vec<String> = import.into_iter().chain(item.place.as_deref().map(escaped)).collect();
    if parts.is_empty() { String::new() } else { format!("<p class=\"soft\">{}</p>\n", parts.join(" · ")) }
}

fn figure(picture: &Picture, of: &str) -> String {
    match &picture.svg {
        Ok(svg) => {
            let label = format!("{} of {}", picture.title, escaped(of));
            let width = width(svg).map(|width| format!(" style=\"--width: {width}px\"")).unwrap_or_default();
            format!("<figure role=\"group\" aria-label=\"{label}\" tabindex=\"0\"{width}>\n{svg}</figure>\n")
        }
        Err(count) => format!("<p>A diagram would have {count} boxes, too many to be readable.</p>\n"),
    }
}

/// Width of a picture at its full size.
fn width(svg: &str) -> Option<u32> {
    let (_, width) = svg.split_once("width=\"")?;
    width.split_once('"')?.0.parse().ok()
}

fn claims(claims: &[Claim]) -> String {
    let claim = |claim: &Claim| {
        let verdict = claim.verdict.map_or_else(String::new, |words| format!(" <span class=\"soft\">{words}</span>"));
        format!("<li>{}{verdict}</li>\n", code(&claim.text))
    };
    let items: String = claims.iter().map(claim).collect();
    if items.is_empty() { items } else { format!("<ul>\n{items}</ul>\n") }
}

fn definitions(entries: &str) -> String {
    if entries.is_empty() { String::new() } else { format!("<dl>\n{entries}</dl>\n") }
}

/// List of entries with short terms, each on one line if there is room.
fn list(entries: &str) -> String {
    if entries.is_empty() { String::new() } else { format!("<dl class=\"list\">\n{entries}</dl>\n") }
}

/// Removes the indentation that all lines but the first have in common.
fn unindented(lines: &str) -> String {
    let indentation = |line: &str| line.len() - line.trim_start_matches(' ').len();
    let common = lines.lines().skip(1).filter(|line| !line.trim().is_empty()).map(indentation).min().unwrap_or(0);
    let cut = |line: &str| line.get(common.min(indentation(line))..).unwrap_or_default().to_owned();
    lines.lines().map(cut).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::unindented;

    #[test]
    fn lines_keep_their_places() {
        assert_eq!(unindented("[\n        1,\n\n      2,\n    ]"), "[\n    1,\n\n  2,\n]");
    }
}

//! Other forms of a source file, which mean the same: they have to be compiled to the same.

use apex_dsl::source::Span;
use apex_ide::{View, format, occurrences, rename, written_out};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeSet;

/// A source file in another form.
pub struct Form {
    /// Name of the form.
    pub kind: &'static str,
    /// The text.
    pub text: String,
}

/// End of new names, which no other name has. It comes before all that names go on with, so that the order of names is
/// that of the old ones.
const NEW: &str = "0zq";

/// The other forms of the first source file of a view.
pub fn forms(view: &View<'_>, text: &str) -> Vec<Form> {
    let mut found = rearranged(view, text);
    found.push(Form { kind: "renamed", text: renamed(view, text) });
    found.push(Form { kind: "varied", text: varied(view, text) });
    let edits: Vec<(Span, String)> =
        written_out(view, 0, text.len() as u32).into_iter().map(|w| (w.chain, w.text)).collect();
    if !edits.is_empty() {
        found.push(Form { kind: "written out", text: edited(text, edits) });
    }
    found
}

/// The forms that a text with mistakes has, too.
pub fn rearranged(view: &View<'_>, text: &str) -> Vec<Form> {
    let formatted = format(text).ok().map(|text| Form { kind: "formatted", text });
    [Form { kind: "reversed", text: reversed(view, text) }].into_iter().chain(formatted).collect()
}

/// The text with a new name for everything that may have one and is known only here.
fn renamed(view: &View<'_>, text: &str) -> String {
    let all = occurrences(view);
    let root = view.texts.file_id(0);
    let definitions: BTreeSet<_> = all.iter().map(|o| o.definition).collect();
    let mut edits = vec![];
    for definition in definitions {
        if all.iter().any(|o| o.definition == definition && o.span.file != root) {
            continue;
        }
        let Some(old) = view.declared_name(definition) else { continue };
        let name = format!("{}{NEW}", old.text);
        if let Ok(places) = rename(view, &all, definition, &name) {
            edits.extend(places.into_iter().map(|place| (place, name.clone())));
        }
    }
    edited(text, edits)
}

/// The text with its graphs, state machines and tests in the opposite order.
fn reversed(view: &View<'_>, text: &str) -> String {
    let mut places: Vec<Span> = view.texts.files[0].1.extents().collect();
    places.sort_by_key(|place| place.start);
    let texts = places.iter().rev().map(|place| view.sources.text(*place).to_owned());
    edited(text, places.iter().copied().zip(texts).collect())
}

/// The text with each graph as a variant without changes of what it was.
fn varied(view: &View<'_>, text: &str) -> String {
    let graphs = view.texts.files[0].1.graphs.iter().filter(|graph| graph.generics.is_empty());
    let (mut edits, mut variants) = (vec![], String::new());
    for graph in graphs {
        let (name, word) = (&graph.name.text, if graph.robot { "robot" } else { "graph" });
        let published = if graph.is_public { "pub " } else { "" };
        edits.push((graph.name.span, format!("{name}{NEW}")));
        variants += &format!("\n{published}{word} {name} = {name}{NEW} {{}}\n");
    }
    edited(text, edits) + &variants
}

/// The text with other texts in these places.
fn edited(text: &str, mut edits: Vec<(Span, String)>) -> String {
    edits.sort_by_key(|(span, _)| span.start);
    let mut text = text.to_owned();
    for (span, new) in edits.into_iter().rev() {
        text.replace_range(span.start as usize..span.end as usize, &new);
    }
    text
}

/// The items of generated code, also of those in modules, without new names and line numbers.
pub fn items(code: &TokenStream) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    collect(code, "", &mut found);
    found
}

fn collect(code: &TokenStream, path: &str, found: &mut BTreeSet<String>) {
    let (mut item, mut is_module) = (path.to_owned(), false);
    for token in code.clone() {
        is_module |= token.to_string() == "mod";
        match token {
            TokenTree::Group(group) if is_module && group.delimiter() == Delimiter::Brace => {
                collect(&group.stream(), &item, found);
                found.insert(std::mem::replace(&mut item, path.to_owned()));
                is_module = false;
            }
            token => {
                let ends = match &token {
                    TokenTree::Punct(sign) => sign.as_char() == ';',
                    TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                    _ => false,
                };
                write(token, &mut item);
                if ends {
                    found.insert(std::mem::replace(&mut item, path.to_owned()));
                }
            }
        }
    }
}

fn write(token: TokenTree, out: &mut String) {
    match token {
        TokenTree::Group(group) => {
            let all: Vec<TokenTree> = group.stream().into_iter().collect();
            // File, line and column.
            let is_place = group.delimiter() == Delimiter::Bracket
                && all.len() == 5
                && all.iter().step_by(2).all(|part| matches!(part, TokenTree::Literal(_)));
            let [open, close] = match group.delimiter() {
                Delimiter::Parenthesis => ["(", ")"],
                Delimiter::Brace => ["{", "}"],
                Delimiter::Bracket => ["[", "]"],
                Delimiter::None => ["", ""],
            };
            out.push_str(open);
            if !is_place {
                all.into_iter().for_each(|part| write(part, out));
            }
            out.push_str(close);
            out.push('\n');
        }
        // Names that were taken end in `_`, also as a part of others; words of Rust begin with `r#`.
        TokenTree::Ident(name) => {
            let name = old(&name.to_string()).replace("__", "_");
            out.push_str(&format!("{} ", name.trim_start_matches("r_").trim_end_matches('_')));
        }
        TokenTree::Literal(value) => out.push_str(&old(&without_lines(&format!("{value} ")))),
        TokenTree::Punct(sign) => out.push(sign.as_char()),
    }
}

fn old(name: &str) -> String {
    name.replace(NEW, "").replace(&NEW.to_uppercase(), "").replace("r#", "").replace(", }", " }")
}

/// A text without the lines and columns behind names of files.
fn without_lines(text: &str) -> String {
    let mut parts = text.split(".afg:");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| all + ".afg:" + part.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':'))
}

/// The first difference between the items of a program and those of the same in another form, which may have more.
pub fn difference(written: &BTreeSet<String>, form: &BTreeSet<String>) -> Option<String> {
    let lost = written.difference(form).next()?;
    let new: Vec<&str> = form.difference(written).flat_map(|item| item.lines()).collect();
    let lines: Vec<&str> = lost.lines().filter(|line| !new.contains(line)).take(4).collect();
    Some(format!("there is nothing like\n{}", lines.join("\n")))
}

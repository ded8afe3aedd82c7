//! Renaming, and the reasons why a name cannot be changed.

use super::{Definition, NodeType, Occurrence, View};
use apex_dsl::{
    source::Span,
    syntax::{
        keywords::{self, KeywordPosition, words_at},
        tree::{Ident, PathExpr},
    },
};

/// The places in these source files where `name` has to be written if it becomes the name of `definition`.
///
/// # Errors
/// Returns the reason why the definition cannot have that name.
pub fn rename(
    view: &View<'_>,
    occurrences: &[Occurrence],
    definition: Definition,
    name: &str,
) -> Result<Vec<Span>, String> {
    let old = may_rename(view, definition)?;
    check_name(definition, name)?;
    check_connected_by_name(view, definition, &old.text)?;
    let uses: Vec<Span> = occurrences.iter().filter(|o| o.definition == definition).map(|o| o.span).collect();
    check_clash(view, &uses, definition, name)?;
    // Uses through an import with a name of its own keep that name.
    Ok(uses.into_iter().filter(|span| view.sources.text(*span) == old.text).collect())
}

/// The name that would be changed.
///
/// # Errors
/// Returns the reason why it cannot be changed.
pub fn may_rename<'a>(view: &View<'a>, definition: Definition) -> Result<&'a Ident, String> {
    view.declared_name(definition).ok_or_else(|| match definition {
        Definition::Own(name) => format!("`{name}` is predefined in every graph and cannot be renamed"),
        Definition::Standard(port) => format!("every node has a port `{}`, which cannot be renamed", port.name()),
        Definition::Text(_) => "this is the name of a file; rename the file".to_owned(),
        _ => "this is declared in Rust; rename it there".to_owned(),
    })
}

fn check_name(definition: Definition, name: &str) -> Result<(), String> {
    if keywords::RESERVED.contains(&name) {
        return Err(format!("`{name}` is a reserved word"));
    }
    if !keywords::is_name(name) {
        return Err(format!("`{name}` is not a valid name: use letters, digits and `_`, not starting with a digit"));
    }
    let stands_in_graph = matches!(definition, Definition::Instance(..) | Definition::Port(NodeType::Graph(_), _));
    if stands_in_graph && words_at(KeywordPosition::Node).any(|w| w.text == name) {
        return Err(format!("`{name}` is predefined in every graph and would be hidden"));
    }
    Ok(())
}

/// Fails if the name of a port decides what it is connected with.
fn check_connected_by_name(view: &View<'_>, definition: Definition, old: &str) -> Result<(), String> {
    let is_port = matches!(definition, Definition::Port(..));
    let decides = view.links.iter().any(|link| is_port && link.by_name && link.to.port() == old);
    clash(decides, format!("`.*` connects `{old}` by its name; write these connections out first"))
}

fn check_clash(view: &View<'_>, uses: &[Span], definition: Definition, name: &str) -> Result<(), String> {
    let has = |mut names: &mut dyn Iterator<Item = &Ident>| Iterator::any(&mut names, |n| n.text == name);
    let texts = view.texts;
    match definition {
        Definition::Instance(id, _) | Definition::Port(NodeType::Graph(id), _) => {
            let item = texts.graph(id);
            let mut names = item.ports.iter().map(|p| &p.name).chain(item.nodes.iter().map(|n| &n.name));
            clash(has(&mut names), format!("`{}` already has a port or node `{name}`", item.name.text))
        }
        Definition::Param(NodeType::Graph(id), _) => {
            let item = texts.graph(id);
            clash(
                has(&mut item.params.iter().map(|p| &p.name)),
                format!("`{}` already has a parameter `{name}`", item.name.text),
            )
        }
        Definition::Generic(id, _) => {
            let item = texts.graph(id);
            clash(has(&mut item.generics.iter()), format!("`{}` already has a type parameter `{name}`", item.name.text))
        }
        Definition::Port(NodeType::Machine(id), _) => {
            let item = view.machine(id);
            clash(
                has(&mut item.ports.iter().map(|p| &p.name)),
                format!("`{}` already has a port `{name}`", item.name.text),
            )
        }
        Definition::State(id, _) => {
            let mut names = view.states(id).into_iter().map(|s| &s.name);
            clash(has(&mut names), format!("`{}` already has a state `{name}`", view.machine(id).name.text))
        }
        Definition::Test(file, _) => clash(
            has(&mut texts.files[file].1.tests.iter().map(|t| &t.name)),
            format!("there is already a test `{name}`"),
        ),
        Definition::Node(_) => uses.iter().try_for_each(|at| item_clash(view, *at, name)),
        _ => Ok(()),
    }
}

/// Fails if a graph or state machine that is used at `at` would have another meaning there.
fn item_clash(view: &View<'_>, at: Span, name: &str) -> Result<(), String> {
    let Some(file) = view.texts.files.iter().position(|(id, _)| *id == at.file) else { return Ok(()) };
    let path = view.sources.get(at.file).path.display().to_string();
    clash(view.texts.names(file).contains_key(name), format!("`{name}` already has a meaning in {path}"))?;
    let word = Ident { text: name.to_owned(), span: at };
    let path = PathExpr { segments: vec![word], span: at };
    clash(view.node_type(&path).is_some(), format!("there is already a node `{name}`, which would be hidden"))
}

fn clash(clashes: bool, reason: String) -> Result<(), String> {
    if clashes { Err(reason) } else { Ok(()) }
}

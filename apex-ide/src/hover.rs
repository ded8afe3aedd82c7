//! Texts of hover and completion, as Markdown.

use super::{Definition, NodeType, ParamFacts, PortFacts, View, lex::tokens_before};
use apex_dsl::{
    graph::{Flow, Standard},
    resolve::Link,
    source::Span,
    syntax::{
        keywords::{KEYWORDS, Keyword, KeywordPosition, words_at},
        tree::PortKind,
    },
};

/// A definition: its declaration, then its documentation.
pub fn describe(view: &View<'_>, definition: Definition) -> String {
    match definition {
        Definition::Node(node) => page(&declaration(view, node), view.docs_of(node)),
        Definition::Instance(id, i) => {
            let item = &view.texts.graph(id).nodes[i];
            let made = view.made_of(id, i).0;
            let declaration = made.map_or_else(String::new, |made| declaration(view, made));
            let docs = match made {
                Some(made) if item.docs.is_empty() => view.docs_of(made),
                _ => &item.docs,
            };
            page(&format!("node {}\n{declaration}", item.name.text), docs)
        }
        Definition::Param(node, i) => {
            let params = view.params(node);
            page(&param(&params[i]), &format!("{}\n\nParameter of `{}`.", params[i].docs, view.name_of(node)))
        }
        Definition::Port(node, i) => {
            let ports = view.ports(node);
            let (facts, kind) = (&ports[i], kind_in_words(ports[i].kind));
            let optional = if facts.optional { " It is optional." } else { "" };
            let number = if facts.any_number { " It takes any number of connections." } else { "" };
            page(&port(facts), &format!("{}\n\n{kind} of `{}`.{optional}{number}", facts.docs, view.name_of(node)))
        }
        Definition::Standard(standard) => {
            let declaration = format!("{} {}: {}", standard.kind().keyword(), standard.name(), standard.ty());
            page(&declaration, &format!("{}\n\nEvery node has this port.", standard_docs(standard)))
        }
        Definition::State(id, i) => {
            let state = view.states(id)[i];
            page(&format!("state {}", state.name.text), &state.docs)
        }
        Definition::Test(file, i) => {
            let test = &view.texts.files[file].1.tests[i];
            page(&format!("{} {}: {}", test.word(), test.name.text, test.graph.text()), &test.docs)
        }
        Definition::Text(file) => page("", &view.texts.files[file].1.docs),
        Definition::Generic(id, i) => page(
            &view.texts.graph(id).generics[i].text,
            "A type parameter: inferred from the connections, or written where the graph is used.",
        ),
        Definition::Own(name) => {
            page(name, words_at(KeywordPosition::Node).find(|w| w.text == name).map_or("", |w| w.docs))
        }
        Definition::Type(def) => page(&format!("type {}", view.catalog.name(def)), ""),
    }
}

/// Description of a connection: its ends and types, and the manner in which tokens travel.
pub fn describe_link(link: &Link) -> String {
    let what = match (link.flow(), link.from.kind) {
        (Flow::Synchronous, _) => "one token per iteration, a value or ⊥",
        (Flow::ToSlot, PortKind::Output) => "one call for each value, none for ⊥",
        (Flow::ToSlot, _) => "one call for each token, in the order in which the tokens were sent",
        (Flow::ToInput, _) => "each token triggers one iteration downstream of the input",
    };
    let activity = if link.active { "; lets activity pass" } else { "" };
    let arrow = if link.active { "=>" } else { "->" };
    let declaration = format!("{} {arrow} {}", link.from.name, link.to.name);
    let types = format!("`{}` → `{}`", link.from.ty, link.to.ty);
    page(&declaration, &format!("{}: {what}{activity}\n\n{types}", flow_word(link)))
}

/// Description of the keyword at `offset` of `text`; `None` if there is none.
pub fn describe_word(view: &View<'_>, text: &str, offset: usize) -> Option<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let start = text.get(..offset)?.rfind(|c| !is_part(c)).map_or(0, |i| i + 1);
    let end = text[offset..].find(|c| !is_part(c)).map_or(text.len(), |i| offset + i);
    let word = text.get(start..end)?;
    tokens_before(text, start)?;
    let tree = &view.texts.files[0].1;
    let around = |s: Span| s.start as usize <= offset && offset <= s.end as usize;
    let place = match () {
        () if tree.machines.iter().any(|m| around(m.extent)) => KeywordPosition::Machine,
        () if tree.tests.iter().any(|t| around(t.extent) && t.study.is_some()) => KeywordPosition::Tune,
        () if tree.tests.iter().any(|t| around(t.extent)) => KeywordPosition::Test,
        () => KeywordPosition::Graph,
    };
    let is_word = |w: &&Keyword| w.text == word;
    let found = words_at(place).find(is_word).or_else(|| KEYWORDS.iter().find(is_word))?;
    Some(page(word, found.docs))
}

/// The flow of tokens as a word: between synchronous ports, between asynchronous ones, or between both kinds.
pub fn flow_word(link: &Link) -> &'static str {
    match (link.from.kind.is_synchronous(), link.to.kind.is_synchronous()) {
        (true, true) => "synchronous",
        (false, false) => "asynchronous",
        _ => "hybrid",
    }
}

/// A page with a declaration and its documentation.
fn page(declaration: &str, docs: &str) -> String {
    let code =
        if declaration.is_empty() { String::new() } else { format!("```afg\n{}\n```\n\n", declaration.trim_end()) };
    format!("{code}{}", docs.trim()).trim_end().to_owned()
}

/// A graph, state machine or node with its parameters and ports, as declared in a source file.
pub fn declaration(view: &View<'_>, node: NodeType) -> String {
    let word = match node {
        NodeType::Graph(id) if view.texts.graph(id).robot => "robot",
        NodeType::Graph(_) => "graph",
        NodeType::Machine(_) => "fsm",
        NodeType::Rust(_) => "node",
    };
    let params: Vec<String> = view.params(node).iter().map(param).collect();
    let params = match params.as_slice() {
        [] => String::new(),
        [one] => format!("({one})"),
        several => format!("(\n    {},\n)", several.join(",\n    ")),
    };
    let ports: String = view.ports(node).iter().map(|p| format!("    {}\n", port(p))).collect();
    format!("{word} {}{params}\n{ports}", view.name_of(node))
}

/// `gap: f32[m] = 0.15 in 0..=1`
pub fn param(param: &ParamFacts) -> String {
    let unit = param.unit.as_ref().map(|u| format!("[{u}]")).unwrap_or_default();
    let default = param.default.as_ref().map(|d| format!(" = {d}")).unwrap_or_default();
    let range = param.range.as_ref().map(|r| format!(" in {r}")).unwrap_or_default();
    format!("{}: {}{unit}{default}{range}", param.name, param.ty)
}

/// `in  scan: Scan`
pub fn port(port: &PortFacts) -> String {
    format!("{:5} {}: {}", port.kind.keyword(), port.name, port.type_text())
}

fn kind_in_words(kind: PortKind) -> &'static str {
    match kind {
        PortKind::Input => "Input",
        PortKind::Output => "Output",
        PortKind::Slot => "Slot",
        PortKind::Event => "Event",
    }
}

/// Documentation of a standard port.
pub fn standard_docs(standard: Standard) -> &'static str {
    match standard {
        Standard::Enable => "Enables the node again. Activity can also enter a node without other slots here.",
        Standard::Disable => {
            "Disables the node: it takes its tokens and sends ⊥, and its slots except `enable` discard theirs."
        }
        Standard::Activated => "The node became active.",
        Standard::Deactivated => "The node is no longer active.",
        Standard::Processed => "`process` was called. Not triggered if the call was skipped because of ⊥.",
        Standard::Failed => "`process` or a slot failed; the token contains the reason.",
        Standard::Timeout => "The node has been active for the time of its modifier `timeout`.",
        Standard::Cancel => "Takes all activity out of the node, or out of everything in the nested graph.",
        Standard::Resume => "Gives the activity back to where the last `cancel` took it from.",
        Standard::Cancelled => "`cancel` has taken activity, which this event takes along over `=>`.",
        Standard::Late => "The node finished later after the firing of its source than its `deadline` allows.",
    }
}

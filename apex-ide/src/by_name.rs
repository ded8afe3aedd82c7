//! Connections by name (`.*`), written out.

use super::View;
use apex_dsl::{resolve::Link, source::Span, syntax::tree::Chain};

/// A chain with `.*`, and the text that makes the same connections by the names of their ports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenOut {
    /// The chain without its `;`.
    pub chain: Span,
    /// The text without the last `;`.
    pub text: String,
}

/// The chains with `.*` of the first source file that touch the bytes from `start` to `end` and connect something.
pub fn written_out(view: &View<'_>, start: u32, end: u32) -> Vec<WrittenOut> {
    let by_name: Vec<&Link> = view.links.iter().filter(|link| link.by_name).collect();
    let chains = view.texts.files[0].1.graphs.iter().flat_map(|graph| &graph.chains);
    let touched = chains.filter(|chain| {
        let span = chain.span();
        span.start <= end && start <= span.end
    });
    touched.filter_map(|chain| write_out(view, chain, &by_name)).collect()
}

fn write_out(view: &View<'_>, chain: &Chain, by_name: &[&Link]) -> Option<WrittenOut> {
    let made = by_name.iter().filter(|link| chain.arrows.iter().any(|arrow| arrow.span == link.arrow));
    let mut senders: Vec<(&str, Vec<&Link>)> = vec![];
    for link in made {
        match senders.iter_mut().find(|(name, _)| *name == link.from.name) {
            Some((_, links)) => links.push(link),
            None => senders.push((&link.from.name, vec![link])),
        }
    }
    let lines = senders.iter().map(|(from, links)| {
        let to: Vec<&str> = links.iter().map(|link| link.to.name.as_str()).collect();
        if let [to] = to[..] { format!("{from} -> {to}") } else { format!("{from} -> [{}]", to.join(", ")) }
    });
    let span = chain.span();
    let before = &view.sources.get(span.file).text[..span.start as usize];
    let line = &before[before.rfind('\n').map_or(0, |at| at + 1)..];
    let indent: String = line.chars().take_while(|c| c.is_whitespace()).collect();
    let text = lines.collect::<Vec<_>>().join(&format!(";\n{indent}"));
    (!text.is_empty()).then_some(WrittenOut { chain: span, text })
}

//! Variants of the graphs of a source file, and graphs that are programs although others contain them.

use super::{case::Item, maker::Maker, names};

/// Adds a variant of a graph, which has some of its nodes again.
pub fn add(maker: &mut Maker) {
    let graphs: Vec<Item> = maker.items.iter().filter(|item| base(item).is_some()).cloned().collect();
    let taken = graphs.iter().filter_map(base).map(|(_, name)| name.to_owned());
    let mut used: Vec<String> = taken.chain(maker.machines.iter().map(|m| m.name.clone())).collect();
    let graph = maker.dice.of(&graphs).clone();
    let Some((word, of)) = base(&graph) else { return };
    let name = maker.free(names::PLAIN_GRAPHS, &mut used);
    let nodes = graph.body.iter().flatten().filter(|line| line.starts_with("node "));
    let body: Vec<String> = nodes.filter(|_| maker.dice.one_in(2)).cloned().collect();
    maker.items.push(Item { head: format!("{word} {name} = {of}"), body: Some(body) });
}

/// Makes a graph whose parameters all have defaults a program in any case.
pub fn publish(maker: &mut Maker) {
    let number = maker.dice.below(maker.items.len());
    let item = &mut maker.items[number];
    let params = item.head.split_once('(').map_or("", |(_, params)| params);
    let complete = params.split(", ").all(|param| param.is_empty() || param.contains(" = "));
    if complete && item.head.starts_with("graph ") && !item.head.contains('<') {
        item.head.insert_str(0, "pub ");
    }
}

/// The keyword and the name of a graph.
fn base(item: &Item) -> Option<(&str, &str)> {
    let (word, rest) = item.head.split_once(' ')?;
    let name = rest.split(['(', ' ', '<']).next()?;
    (matches!(word, "graph" | "robot") && item.body.is_some()).then_some((word, name))
}

#[cfg(test)]
mod tests {
    use crate::texts::generate;

    #[test]
    fn both_occur() {
        let heads: Vec<String> = (0..200)
            .flat_map(|seed| generate(seed).texts)
            .flat_map(|text| text.items.into_iter().map(|item| item.head))
            .collect();
        let variants = heads.iter().filter(|head| {
            let words: Vec<&str> = head.split(' ').collect();
            matches!(words[..], ["graph" | "robot", _, "=", _])
        });
        let public = heads.iter().filter(|head| head.starts_with("pub graph "));
        assert!(variants.clone().count() > 40 && public.clone().count() > 10, "{heads:?}");
    }
}

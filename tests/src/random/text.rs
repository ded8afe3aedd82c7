use super::{Case, End, Instance};
use std::{collections::BTreeSet, fmt::Write as _, ops::Range};

/// Formatted source file of `cases`: graphs `Flat0`, `Nested0`, `Flat1`, …
///
/// # Panics
/// Panics if it has errors.
pub fn text(cases: &[Case]) -> String {
    let mut text = String::from("//! Written by the generator in tests/src/random; see tests/behaviour/random.rs.\n");
    for (number, case) in cases.iter().enumerate() {
        let whole = 0..case.nodes.len();
        let _ = write!(text, "\ngraph Flat{number} {{\n{}}}\n", case.body(whole.clone(), &(0..0)));
        let _ = write!(text, "\ngraph Group{number} {{\n{}}}\n", case.body(case.group.clone(), &(0..0)));
        let _ = write!(
            text,
            "\ngraph Nested{number} {{\n{}}}\n",
            case.body(whole, &case.group).replace("GROUP", &format!("Group{number}"))
        );
    }
    apex_ide::format(&text).unwrap_or_else(|diagnostics| panic!("{:?}", diagnostics.sorted()))
}

impl Case {
    /// Statements for the nodes in `range`, with those in `group` replaced by a nested graph.
    fn body(&self, range: Range<usize>, group: &Range<usize>) -> String {
        let mut text = String::new();
        let ports = |ends: BTreeSet<End>, word: &str, text: &mut String| {
            for end in ends {
                let _ = writeln!(text, "    {word} {}: i64;", port(end));
            }
        };
        if range.len() < self.nodes.len() {
            ports(self.entering(&range), "in", &mut text);
            ports(self.leaving(&range), "out", &mut text);
        }
        for id in range.clone().filter(|id| !group.contains(id)) {
            let _ = writeln!(text, "    node {} = {};", self.name(id), self.instance(id));
        }
        if !group.is_empty() {
            let _ = writeln!(text, "    node group = GROUP();");
            for end in self.entering(group) {
                let _ = writeln!(text, "    {} -> group.{};", self.end(end, &range, &(0..0)), port(end));
            }
        }
        for id in range.clone().filter(|id| !group.contains(id)) {
            for (name, from) in self.nodes[id].kind.inputs.iter().zip(&self.nodes[id].inputs) {
                if let Some(from) = from {
                    let _ = writeln!(text, "    {} -> {}.{name};", self.end(*from, &range, group), self.name(id));
                }
            }
        }
        if range.len() < self.nodes.len() {
            for end in self.leaving(&range) {
                let _ = writeln!(text, "    {} -> {};", self.end(end, &range, group), port(end));
            }
        }
        text
    }

    fn instance(&self, id: usize) -> String {
        let Instance { kind, parameter, delay, .. } = &self.nodes[id];
        let argument = match &kind.parameter {
            Some((name, _)) => format!("{name} = {parameter}"),
            None if kind.outputs.is_empty() => format!("id = {parameter}"),
            None => String::new(),
        };
        let delay = match delay.as_deref() {
            None => String::new(),
            Some([None]) => " delay".to_owned(),
            Some([Some(only)]) => format!(" delay {only}"),
            Some(tokens) => format!(" delay {:?}", tokens.iter().flatten().collect::<Vec<_>>()),
        };
        format!("{}({argument}){delay}", kind.name)
    }

    /// Notation of an output in the body of the nodes in `range`, with those in `group` as a nested graph.
    fn end(&self, end: End, range: &Range<usize>, group: &Range<usize>) -> String {
        if group.contains(&end.node) {
            format!("group.{}", port(end))
        } else if range.contains(&end.node) {
            format!("{}.{}", self.name(end.node), self.nodes[end.node].kind.outputs[end.output])
        } else {
            port(end)
        }
    }

    fn entering(&self, range: &Range<usize>) -> BTreeSet<End> {
        self.nodes[range.clone()]
            .iter()
            .flat_map(|n| n.inputs.iter().flatten())
            .filter(|e| !range.contains(&e.node))
            .copied()
            .collect()
    }

    fn leaving(&self, range: &Range<usize>) -> BTreeSet<End> {
        let outside = self.nodes.iter().enumerate().filter(|(id, _)| !range.contains(id));
        outside.flat_map(|(_, n)| n.inputs.iter().flatten()).filter(|e| range.contains(&e.node)).copied().collect()
    }
}

fn port(end: End) -> String {
    format!("from_{}_{}", end.node, end.output)
}

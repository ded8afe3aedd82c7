//! Output for Graphviz.

use crate::model::{Anchor, Flow, Frame, Item, Line, Shape, Side};
use std::fmt::Write as _;

/// Diagram of an item in the DOT language.
pub fn dot(item: &Item) -> String {
    let mut text = String::from(
        "digraph {\n  rankdir=LR; compound=true; fontname=\"Helvetica\";\n  node [shape=box fontname=\"Helvetica\" fontsize=11];\n  edge [fontname=\"Helvetica\" fontsize=9];\n",
    );
    draw(&mut text, item, "g", 1);
    text.push_str("}\n");
    text
}

/// Writes an item. The names of its parts begin with `id`.
fn draw(out: &mut String, item: &Item, id: &str, depth: usize) {
    let pad = "  ".repeat(depth);
    let label = [item.name.clone()].into_iter().chain(item.words.clone()).collect::<Vec<_>>().join("\n");
    let label = quoted(&label);
    let colour = match (item.active, item.new) {
        (true, false) => " style=filled fillcolor=\"#fdf0d5\" color=\"#b3701b\"",
        (true, true) => " style=filled fillcolor=\"#fdf0d5\" color=\"#1c5d99\" penwidth=3",
        (false, true) => " color=\"#1c5d99\" penwidth=3",
        (false, false) => "",
    };
    let Some(frame) = &item.inside else {
        let _ = match item.shape {
            Shape::Node => writeln!(out, "{pad}{id} [label={label}{colour}];"),
            Shape::State => writeln!(out, "{pad}{id} [label={label} style=\"rounded,filled\" fillcolor=\"#fdf0d5\"];"),
            Shape::Start => writeln!(out, "{pad}{id} [label=\"\" shape=point width=0.15];"),
            Shape::End => writeln!(out, "{pad}{id} [label=\"\" xlabel={label} shape=doublecircle width=0.1];"),
            Shape::Event => {
                writeln!(out, "{pad}{id} [label=\"\" xlabel={label} shape=circle peripheries=2 width=0.1];")
            }
            Shape::Reset => writeln!(out, "{pad}{id} [label=\"\" xlabel={label} shape=circle width=0.15];"),
        };
        return;
    };
    let frame_colour = if item.new { "\"#1c5d99\"; penwidth=3" } else { "\"#999999\"" };
    let _ = writeln!(out, "{pad}subgraph cluster_{id} {{\n{pad}  label={label}; color={frame_colour};");
    for (index, port) in item.ports.iter().enumerate() {
        let shape = if matches!(port.side, Side::Left | Side::Right) { "plain" } else { "oval" };
        let _ = writeln!(out, "{pad}  {id}_p{index} [label={} shape={shape} fontsize=9];", quoted(&port.name));
    }
    for (index, inner) in frame.items.iter().enumerate() {
        draw(out, inner, &format!("{id}_{index}"), depth + 1);
    }
    for line in &frame.lines {
        edge(out, frame, line, id, &pad);
    }
    let _ = writeln!(out, "{pad}}}");
}

fn edge(out: &mut String, frame: &Frame, line: &Line, id: &str, pad: &str) {
    let node = |end: Anchor| match end {
        Anchor::Own(port) => (format!("{id}_p{port}"), ""),
        Anchor::Of(item, port) if frame.items[item].inside.is_some() && !frame.items[item].ports.is_empty() => {
            (format!("{id}_{item}_p{port}"), "")
        }
        Anchor::Of(item, port) => (format!("{id}_{item}"), frame.items[item].ports[port].name.as_str()),
    };
    let ((from, tail), (to, head)) = (node(line.from), node(line.to));
    let style = match line.flow {
        Flow::Synchronous => "solid",
        Flow::Asynchronous => "dashed",
        Flow::Hybrid => "dotted",
    };
    let double = if line.active { " color=\"black:invis:black\"" } else { "" };
    let labels = format!("label={} taillabel={} headlabel={}", quoted(&line.label), quoted(tail), quoted(head));
    let _ = writeln!(out, "{pad}  {from} -> {to} [{labels} style={style}{double}];");
}

/// A quoted string. Backslashes are escaped, except in the ends of lines.
fn quoted(text: &str) -> String {
    let text = text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
    format!("\"{}\"", text.replace(|c: char| c.is_control(), " "))
}

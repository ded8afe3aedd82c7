//! Output as a self-contained SVG document, without scripts, fonts and images. Attributes give the full names of items
//! (`data-item`) and of the ports at the ends of lines (`data-from`, `data-to`: `fast.planner:path`).

use crate::{
    layout::{Align, Placed, Point, Stroke, Text, place, strokes},
    model::{Anchor, Frame, Item, Line, Shape, joined},
};
use std::{collections::BTreeMap, fmt::Write as _};

/// Distance around the diagram.
const MARGIN: i64 = 10;
/// Radius of the corners of lines.
const CORNER: i64 = 4;

const STYLE: &str = "\
text { font-family: Helvetica, Arial, 'DejaVu Sans', sans-serif; fill: #222 }
.name { font-weight: bold }
.box { fill: #fff; stroke: #555 }
.active > .box { fill: #fdf0d5; stroke: #b3701b }
.frame > .box { fill: #000; fill-opacity: 0.025; stroke: #999 }
.active.frame > .box { fill: #fdf0d5; fill-opacity: 0.3; stroke: #b3701b }
.line { fill: none; stroke: #444 }
.wide { stroke-width: 4 }
.core { fill: none; stroke: #fff; stroke-width: 2 }
.asynchronous { stroke-dasharray: 5 3 }
.hybrid { stroke-dasharray: 8 3 2 3 }
.dot { fill: #222; stroke: #222 }
.ring { fill: #fff; stroke: #222 }
";

/// Style of what is new.
const NEW: &str = ".new > .box { stroke: #1c5d99; stroke-width: 3 }
.new > text > .name { fill: #1c5d99 }
";

/// Diagram of an item as an SVG document.
pub fn svg(item: &Item) -> String {
    let placed = place(item);
    let (width, height) = (placed.size.0 + 2 * MARGIN, placed.size.1 + 2 * MARGIN);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n<style>\n{STYLE}{}</style>\n",
        if has_new(item) { NEW } else { "" }
    );
    let _ = writeln!(text, "<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>");
    let connected = vec![false; item.ports.len()];
    draw(&mut text, item, &placed, "", (MARGIN, MARGIN), &connected);
    text.push_str("</svg>\n");
    text
}

fn has_new(item: &Item) -> bool {
    item.new || item.items().any(has_new)
}

/// Draws an item with its upper left corner at `at`. `taking` is `true` for ports at which a line from outside ends:
/// they have an arrow head. `path` is its full name.
fn draw(out: &mut String, item: &Item, placed: &Placed, path: &str, at: Point, taking: &[bool]) {
    let classes = [("item", true), ("active", item.active), ("new", item.new), ("frame", item.inside.is_some())];
    let classes: Vec<&str> = classes.into_iter().filter(|(_, on)| *on).map(|(class, _)| class).collect();
    let (classes, name) = (classes.join(" "), escaped(path));
    let _ = writeln!(out, "<g class=\"{classes}\" data-item=\"{name}\" transform=\"translate({} {})\">", at.0, at.1);
    title(out, &item_title(item));
    shape(out, item, placed);
    if let Some(frame) = &item.inside {
        inside(out, item, frame, placed, path);
    }
    for text in &placed.texts {
        words(out, text);
    }
    if matches!(item.shape, Shape::Node | Shape::State) {
        for ((port, at), taking) in item.ports.iter().zip(&placed.ports).zip(taking) {
            if *taking && item.inside.is_none() || item.shape == Shape::State && port.name.is_empty() {
                continue;
            }
            let fill = if port.connected { "#444" } else { "#fff" };
            let (x, y) = (at.0 - 2, at.1 - 2);
            let square = format!("x=\"{x}\" y=\"{y}\" width=\"4\" height=\"4\" fill=\"{fill}\" stroke=\"#444\"");
            let docs = escaped(&[port.name.as_str(), port.docs.as_str()].join(": "));
            let _ = writeln!(out, "<rect {square}><title>{docs}</title></rect>");
        }
    }
    out.push_str("</g>\n");
}

fn item_title(item: &Item) -> String {
    let mut title = item.name.clone();
    if let Some(kind) = item.words.first() {
        let _ = write!(title, ": {kind}");
    }
    if !item.docs.is_empty() {
        let _ = write!(title, "\n{}", item.docs.trim());
    }
    title
}

fn title(out: &mut String, words: &str) {
    let _ = writeln!(out, "<title>{}</title>", escaped(words));
}

fn shape(out: &mut String, item: &Item, placed: &Placed) {
    let (width, height) = placed.size;
    let radius = match (item.shape, &item.inside) {
        (Shape::State, _) => 10,
        (_, Some(_)) => 6,
        _ => 2,
    };
    let middle = height / 2;
    let _ = match item.shape {
        Shape::Node | Shape::State => {
            if item.each {
                // A stack of boxes stands for the elements of the list.
                for shift in [6, 3] {
                    let _ = writeln!(
                        out,
                        "<rect class=\"box\" x=\"{shift}\" y=\"-{shift}\" width=\"{width}\" height=\"{height}\" rx=\"{radius}\"/>"
                    );
                }
                let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" rx=\"{radius}\" fill=\"#fff\"/>");
            }
            writeln!(out, "<rect class=\"box\" width=\"{width}\" height=\"{height}\" rx=\"{radius}\"/>")
        }
        Shape::Start => writeln!(out, "<circle class=\"dot\" cx=\"{middle}\" cy=\"{middle}\" r=\"{}\"/>", middle - 1),
        Shape::End => writeln!(
            out,
            "<circle class=\"ring\" cx=\"{middle}\" cy=\"{middle}\" r=\"{}\"/><circle class=\"dot\" cx=\"{middle}\" cy=\"{middle}\" r=\"{}\"/>",
            middle - 1,
            middle - 4
        ),
        Shape::Event => writeln!(
            out,
            "<circle class=\"ring\" cx=\"{0}\" cy=\"{middle}\" r=\"{1}\"/><circle class=\"ring\" cx=\"{0}\" cy=\"{middle}\" r=\"{2}\"/>",
            width - middle,
            middle - 1,
            middle - 3
        ),
        Shape::Reset => {
            writeln!(out, "<circle class=\"ring\" cx=\"{middle}\" cy=\"{middle}\" r=\"{}\"/>", middle - 1)
        }
    };
}

fn inside(out: &mut String, item: &Item, frame: &Frame, placed: &Placed, path: &str) {
    lines(out, item, frame, placed, path);
    for (index, (inner, place)) in frame.items.iter().zip(&placed.items).enumerate() {
        let mut taking = vec![false; inner.ports.len()];
        for line in &frame.lines {
            if let Anchor::Of(to, port) = line.to
                && to == index
            {
                taking[port] = true;
            }
        }
        draw(out, inner, place, &joined(path, &inner.name), place.at, &taking);
    }
}

/// Draws all lines: thin ones first, then double ones with a white core. Dots at branches and arrow heads are on top.
fn lines(out: &mut String, item: &Item, frame: &Frame, placed: &Placed, within: &str) {
    let strokes = strokes(frame, placed);
    for active in [false, true] {
        for stroke in strokes.iter().filter(|s| frame.lines[s.line].active == active && s.points.len() > 1) {
            let line = &frame.lines[stroke.line];
            let (wide, path) = (if active { " wide" } else { "" }, path(&stroke.points, back(line, stroke)));
            let ends = [line.from, line.to].map(|end| escaped(&end_name(item, frame, within, end)));
            let names = format!("data-from=\"{}\" data-to=\"{}\"", ends[0], ends[1]);
            let _ = write!(out, "<path class=\"line {}{wide}\" {names} d=\"{path}\">", line.flow.word());
            let _ = writeln!(out, "<title>{}</title></path>", escaped(&line_title(item, frame, line)));
            if active {
                let _ = writeln!(out, "<path class=\"core\" d=\"{path}\"/>");
            }
        }
    }
    forks(out, frame, &strokes);
    for stroke in strokes.iter().filter(|stroke| !stroke.joins) {
        head(out, &placed.routes[stroke.line], frame.lines[stroke.line].active);
    }
}

/// Distance between the end of a line and its last point, which leaves space for an arrow head.
fn back(line: &Line, stroke: &Stroke) -> i64 {
    match (stroke.joins, line.active) {
        (true, _) => 0,
        (_, true) => 7,
        (_, false) => 5,
    }
}

/// Draws dots where lines branch and merge; larger ones on double lines.
fn forks(out: &mut String, frame: &Frame, strokes: &[Stroke]) {
    let mut dots: BTreeMap<Point, bool> = BTreeMap::new();
    for stroke in strokes {
        let line = &frame.lines[stroke.line];
        let ends = [(stroke.parts, stroke.points.first()), (stroke.joins, stroke.points.last())];
        for at in ends.into_iter().filter_map(|(is_fork, at)| at.filter(|_| is_fork)) {
            let meets_double = frame.lines.iter().any(|o| o.active && (o.from == line.from || o.to == line.to));
            *dots.entry(*at).or_default() |= meets_double;
        }
    }
    for ((x, y), is_double) in dots {
        let radius = if is_double { 3 } else { 2 };
        let _ = writeln!(out, "<circle class=\"dot\" cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>");
    }
}

fn line_title(item: &Item, frame: &Frame, line: &Line) -> String {
    let name = |end: Anchor| match end {
        Anchor::Own(port) => item.ports[port].name.clone(),
        Anchor::Of(inner, port) => {
            let inner = &frame.items[inner];
            match inner.ports[port].name.as_str() {
                "" => inner.name.clone(),
                port => format!("{}.{port}", inner.name),
            }
        }
    };
    let arrow = if line.active { "=>" } else { "->" };
    format!("{} {arrow} {} ({})", name(line.from), name(line.to), line.flow.word())
}

/// Full name of the item at an end of a line, and its port.
fn end_name(item: &Item, frame: &Frame, path: &str, end: Anchor) -> String {
    match end {
        Anchor::Own(port) => format!("{path}:{}", item.ports[port].name),
        Anchor::Of(inner, port) => {
            let inner = &frame.items[inner];
            format!("{}:{}", joined(path, &inner.name), inner.ports[port].name)
        }
    }
}

/// SVG path of a line with rounded corners, which ends `back` pixels before its last point.
fn path(route: &[Point], back: i64) -> String {
    let mut points = route.to_vec();
    if let [.., before, last] = &mut points[..] {
        last.0 -= (last.0 - before.0).signum() * back;
        last.1 -= (last.1 - before.1).signum() * back;
    }
    let mut text = String::new();
    for (i, &(x, y)) in points.iter().enumerate() {
        let _ = match (i.checked_sub(1).map(|i| points[i]), points.get(i + 1)) {
            (None, _) => write!(text, "M{x} {y}"),
            (_, None) => write!(text, "L{x} {y}"),
            (Some(before), Some(&after)) => {
                let towards = |to: Point| {
                    let length = (to.0 - x).abs() + (to.1 - y).abs();
                    let step = CORNER.min(length / 2);
                    (x + (to.0 - x).signum() * step, y + (to.1 - y).signum() * step)
                };
                let ((ax, ay), (bx, by)) = (towards(before), towards(after));
                write!(text, "L{ax} {ay}Q{x} {y} {bx} {by}")
            }
        };
    }
    text
}

/// Draws the arrow head at the end of a line.
fn head(out: &mut String, route: &[Point], active: bool) {
    let [.., before, (x, y)] = route[..] else { return };
    let (dx, dy) = ((x - before.0).signum(), (y - before.1).signum());
    let (long, half) = if active { (9, 5) } else { (7, 3) };
    let (bx, by) = (x - dx * long, y - dy * long);
    let _ = writeln!(
        out,
        "<path d=\"M{x} {y}L{} {}L{} {}Z\" fill=\"#444\"/>",
        bx + dy * half,
        by + dx * half,
        bx - dy * half,
        by - dx * half
    );
}

fn words(out: &mut String, text: &Text) {
    let anchor = match text.align {
        Align::Begin => "start",
        Align::Middle => "middle",
        Align::End => "end",
    };
    let (x, y) = text.at;
    let _ = write!(out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\">", text.size);
    if !text.bold.is_empty() {
        let _ = write!(out, "<tspan class=\"name\">{}</tspan>", escaped(&text.bold));
    }
    let _ = writeln!(out, "{}</text>", escaped(&text.plain));
}

/// Escapes text for XML.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            // XML cannot represent these characters.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

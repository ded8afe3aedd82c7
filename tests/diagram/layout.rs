//! Layout.

use crate::{Drawer, random};
use apex_diagram::{
    Anchor, Frame, Item,
    layout::{Placed, Point, Stroke, Text, place, strokes},
    states, svg,
};

/// Left, top, right, bottom.
type Rect = (i64, i64, i64, i64);

fn rect(placed: &Placed) -> Rect {
    let ((x, y), (width, height)) = (placed.at, placed.size);
    (x, y, x + width, y + height)
}

fn overlap(a: Rect, b: Rect) -> bool {
    a.0 < b.2 && b.0 < a.2 && a.1 < b.3 && b.1 < a.3
}

fn inside(inner: Rect, outer: Rect) -> bool {
    outer.0 <= inner.0 && outer.1 <= inner.1 && inner.2 <= outer.2 && inner.3 <= outer.3
}

/// Pieces of a line.
fn pieces(route: &[Point]) -> impl Iterator<Item = Rect> {
    route.windows(2).map(|p| (p[0].0.min(p[1].0), p[0].1.min(p[1].1), p[0].0.max(p[1].0), p[0].1.max(p[1].1)))
}

/// Faults of a picture.
fn faults(item: &Item, placed: &Placed) -> Vec<String> {
    let mut faults = vec![];
    let whole = (0, 0, placed.size.0, placed.size.1);
    let texts: Vec<Rect> = placed.texts.iter().map(Text::bounds).collect();
    for (i, text) in texts.iter().enumerate() {
        let words = &placed.texts[i];
        if !inside(*text, whole) {
            faults.push(format!("`{}{}` leaves `{}`", words.bold, words.plain, item.name));
        }
        if texts[..i].iter().any(|other| overlap(*text, *other)) {
            faults.push(format!("`{}{}` in `{}` stands on another text", words.bold, words.plain, item.name));
        }
    }
    let Some(frame) = &item.inside else { return faults };
    let boxes: Vec<Rect> = placed.items.iter().map(rect).collect();
    for (i, one) in boxes.iter().enumerate() {
        let name = &frame.items[i].name;
        if !inside(*one, whole) {
            faults.push(format!("`{name}` leaves `{}`", item.name));
        }
        faults.extend(
            (0..i).filter(|j| overlap(*one, boxes[*j])).map(|j| format!("`{name}` overlaps {}", frame.items[j].name)),
        );
        if texts.iter().any(|text| overlap(*one, *text)) {
            faults.push(format!("`{name}` covers a text"));
        }
    }
    faults.extend(lines(frame, placed, &boxes));
    for (inner, placed) in frame.items.iter().zip(&placed.items) {
        faults.extend(self::faults(inner, placed));
    }
    faults
}

fn lines(frame: &Frame, placed: &Placed, boxes: &[Rect]) -> Vec<String> {
    let mut faults = vec![];
    let port = |end: Anchor| match end {
        Anchor::Own(port) => placed.ports[port],
        Anchor::Of(item, port) => {
            let item = &placed.items[item];
            (item.at.0 + item.ports[port].0, item.at.1 + item.ports[port].1)
        }
    };
    assert_eq!(frame.lines.len(), placed.routes.len());
    for (line, route) in frame.lines.iter().zip(&placed.routes) {
        if (route.first(), route.last()) != (Some(&port(line.from)), Some(&port(line.to))) {
            faults.push(format!("{line:?} does not end at its ports: {route:?}"));
        }
        if route.windows(2).any(|p| p[0].0 != p[1].0 && p[0].1 != p[1].1) {
            faults.push(format!("{line:?} is not orthogonal: {route:?}"));
        }
        for piece in pieces(route) {
            if !inside(piece, (0, 0, placed.size.0, placed.size.1)) {
                faults.push(format!("{line:?} leaves the picture"));
            }
            let through = boxes.iter().position(|b| overlap(piece, (b.0 + 1, b.1 + 1, b.2 - 1, b.3 - 1)));
            faults.extend(through.map(|i| format!("{line:?} runs through `{}`", frame.items[i].name)));
        }
    }
    faults
}

fn on_each_other((p, q): &(Rect, Rect)) -> bool {
    let (x, y) = (p.2.min(q.2) - p.0.max(q.0), p.3.min(q.3) - p.1.max(q.1));
    x == 0 && y > 0 && p.0 == p.2 && q.0 == q.2 || y == 0 && x > 0 && p.1 == p.3 && q.1 == q.3
}

/// Overlapping pieces of lines that have no common end.
fn hidden(frame: &Frame, placed: &Placed) -> Vec<String> {
    let mut found = vec![];
    for (i, a) in frame.lines.iter().enumerate() {
        for (j, b) in frame.lines.iter().enumerate().skip(i + 1) {
            if a.from == b.from || a.to == b.to {
                continue;
            }
            let pairs = pieces(&placed.routes[i]).flat_map(|p| pieces(&placed.routes[j]).map(move |q| (p, q)));
            found.extend(pairs.filter(on_each_other).map(|(p, q)| format!("{a:?} at {p:?} and {b:?} at {q:?}")));
        }
    }
    let inner = frame.items.iter().zip(&placed.items);
    found.extend(inner.filter_map(|(i, p)| Some(hidden(i.inside.as_ref()?, p))).flatten());
    found
}

/// Overlapping pieces of strokes. A common part of lines is drawn once, because otherwise their dashes would overlap.
fn drawn_twice(frame: &Frame, placed: &Placed) -> Vec<String> {
    let strokes = strokes(frame, placed);
    let mut found = vec![];
    for (i, a) in strokes.iter().enumerate() {
        for b in &strokes[i + 1..] {
            let pairs = pieces(&a.points).flat_map(|p| pieces(&b.points).map(move |q| (p, q)));
            found.extend(pairs.filter(on_each_other).map(|(p, q)| format!("{a:?} at {p:?} and {b:?} at {q:?}")));
        }
    }
    let inner = frame.items.iter().zip(&placed.items);
    found.extend(inner.filter_map(|(i, p)| Some(drawn_twice(i.inside.as_ref()?, p))).flatten());
    found
}

/// Numbers of strokes that begin or end at another one, at all depths.
fn forks(frame: &Frame, placed: &Placed) -> (usize, usize) {
    let strokes = strokes(frame, placed);
    let count = |is: fn(&Stroke) -> bool| strokes.iter().filter(|stroke| is(stroke)).count();
    let mut sum = (count(|stroke| stroke.parts), count(|stroke| stroke.joins));
    for (item, placed) in frame.items.iter().zip(&placed.items) {
        let (parts, joins) = item.inside.as_ref().map_or((0, 0), |frame| forks(frame, placed));
        sum = (sum.0 + parts, sum.1 + joins);
    }
    sum
}

#[test]
fn nothing_stands_or_runs_over_anything_else() {
    let (mut activity, mut met) = (0, (0, 0));
    for (text, item) in random(50) {
        let seen = states(&item);
        activity += usize::from(seen.is_some());
        for picture in [Some(item), seen].into_iter().flatten() {
            let placed = place(&picture);
            let mut found = faults(&picture, &placed);
            let frame = picture.inside.as_ref().unwrap();
            found.extend(hidden(frame, &placed));
            found.extend(drawn_twice(frame, &placed));
            let (parts, joins) = forks(frame, &placed);
            met = (met.0 + parts, met.1 + joins);
            assert!(found.is_empty(), "{}\n{text}", found.join("\n"));
        }
    }
    assert!(activity > 12, "only {activity} pictures with activity");
    assert!(met.0 > 20 && met.1 > 5, "few lines part and join: {met:?}");
}

#[test]
fn the_same_graph_gives_the_same_picture() {
    let (one, other) = (random(12), random(12));
    for ((text, a), (_, b)) in one.iter().zip(&other) {
        assert_eq!(svg(a), svg(b), "{text}");
    }
}

#[test]
fn long_ways_are_labelled_at_both_ends() {
    let text = "use apex_tests::nodes::{Count, Snk, add, mul};
graph A {
    node s = Count();
    node a = mul(k = 1);
    node b = mul(k = 1);
    node c = mul(k = 1);
    node j = add();
    s -> a -> b -> c -> j.a;
    s -> j.b;
    j -> Snk();
}";
    let placed = place(&Drawer::new().one(text));
    let labels: Vec<&str> = placed.texts.iter().map(|text| text.plain.as_str()).filter(|t| t.contains('→')).collect();
    assert_eq!(labels, ["→ j.b", "s →"]);
}

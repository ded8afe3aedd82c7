//! Layout of a box without contents: size, texts and ports.

use super::placed::{Align, NAME, Placed, Point, SMALL, TYPE, Text, wide};
use crate::{
    model::{Item, Shape, Side},
    text,
};

/// Height of a row with names of ports.
const ROW: i64 = 15;
/// Diameter of a dot.
const DOT: i64 = 14;

/// Ports of an item, from top to bottom. At the top and the bottom side their order is from right to left, so that
/// lines do not cross.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sides {
    pub slots: Vec<usize>,
    pub left: Vec<usize>,
    pub right: Vec<usize>,
    pub events: Vec<usize>,
}

impl Sides {
    /// Ports in the order of the model.
    pub fn of(item: &Item) -> Self {
        let reversed = |side| item.at(side).into_iter().rev().collect();
        Self {
            slots: reversed(Side::Top),
            left: item.at(Side::Left),
            right: item.at(Side::Right),
            events: reversed(Side::Bottom),
        }
    }

    /// Moves these ports before all others of their sides.
    pub fn first(mut self, these: &dyn Fn(&usize) -> bool) -> Self {
        for ports in [&mut self.slots, &mut self.left, &mut self.right, &mut self.events] {
            ports.sort_by_key(|port| !these(port));
        }
        self
    }
}

/// Layout of a box with its ports in this order.
pub fn place(item: &Item, sides: &Sides) -> Placed {
    if !matches!(item.shape, Shape::Node | Shape::State) {
        return dot(item);
    }
    let mut made = Box { item, sides, size: (0, 0), texts: vec![], ports: vec![(0, 0); item.ports.len()] };
    made.size.0 = made.width();
    let top = made.row_across(&sides.slots, 0);
    let top = if top == 0 { 5 } else { top };
    let texts = made.texts.len();
    let header = made.header(top);
    let y = made.rows(top, header) + 5;
    if !made.is_named() {
        let down = (y - 5 - header) / 2;
        made.texts[texts..].iter_mut().for_each(|text| text.at.1 += down);
    }
    let has_names = sides.events.iter().any(|p| !item.ports[*p].name.is_empty());
    made.size.1 = y + if has_names { ROW } else { 0 };
    let bottom = made.size.1;
    made.row_across(&sides.events, bottom);
    Placed { at: (0, 0), size: made.size, texts: made.texts, ports: made.ports, items: vec![], routes: vec![] }
}

/// Layout of a dot. Its name is on the side without a line; a start dot has no name.
fn dot(item: &Item) -> Placed {
    let mut placed = Placed {
        at: (0, 0),
        size: (DOT, DOT),
        texts: vec![],
        ports: vec![(0, DOT / 2); item.ports.len()],
        items: vec![],
        routes: vec![],
    };
    match item.shape {
        Shape::Start => placed.ports.iter_mut().for_each(|p| p.0 = DOT),
        Shape::Event => {
            let text = Text::new((0, DOT - 3), &item.name, TYPE, Align::Begin);
            placed.size.0 += 4 + text.width();
            placed.ports.iter_mut().for_each(|p| p.0 = placed.size.0);
            placed.texts.push(text);
        }
        _ => {
            let text = Text::new((DOT + 4, DOT - 3), &item.name, TYPE, Align::Begin);
            placed.size.0 += 4 + text.width();
            placed.texts.push(text);
        }
    }
    placed
}

struct Box<'a> {
    item: &'a Item,
    sides: &'a Sides,
    size: Point,
    texts: Vec<Text>,
    ports: Vec<Point>,
}

impl Box<'_> {
    fn name(&self, port: usize) -> &str {
        &self.item.ports[port].name
    }

    /// `true` if a port on the left or the right has a name.
    fn is_named(&self) -> bool {
        self.sides.left.iter().chain(&self.sides.right).any(|p| !self.name(*p).is_empty())
    }

    /// Width that a port at the top or the bottom needs.
    fn share(&self, port: usize) -> i64 {
        (wide(self.name(port), SMALL) + 10).max(16)
    }

    fn width(&self) -> i64 {
        let longest = |ports: &[usize]| ports.iter().map(|p| wide(self.name(*p), SMALL)).max().unwrap_or(0);
        let rows = longest(&self.sides.left) + longest(&self.sides.right) + 26;
        let across = |ports: &[usize]| ports.iter().map(|p| self.share(*p)).sum::<i64>() + 8;
        let header = self.item.words.iter().map(|w| wide(w, TYPE)).max().unwrap_or(0);
        let header = header.max(text::bold_width(&self.item.name, NAME as f64).ceil() as i64) + 20;
        let width = [rows, header, across(&self.sides.slots), across(&self.sides.events), 44];
        // An even width, so that the middle is on a pixel.
        (width.into_iter().max().unwrap_or(0) + 1) / 2 * 2
    }

    /// Places ports at the top (`y` is 0) or the bottom, with their names inside. Returns the end of the row.
    fn row_across(&mut self, ports: &[usize], y: i64) -> i64 {
        let total: i64 = ports.iter().map(|p| self.share(*p)).sum();
        let mut right = (self.size.0 + total) / 2;
        let base = if y == 0 { SMALL + 3 } else { y - 6 };
        for &port in ports {
            let share = self.share(port);
            let x = right - share / 2;
            right -= share;
            self.ports[port] = (x, y);
            if !self.name(port).is_empty() {
                self.texts.push(Text::new((x, base), self.name(port), SMALL, Align::Middle));
            }
        }
        let has_names = ports.iter().any(|p| !self.name(*p).is_empty());
        if has_names { y + ROW } else { y }
    }

    /// Places the name, the type and other texts. Returns the end of the header.
    fn header(&mut self, y: i64) -> i64 {
        let middle = self.size.0 / 2;
        let mut y = y + NAME;
        let bold = self.item.name.clone();
        self.texts.push(Text { bold, ..Text::new((middle, y), "", NAME, Align::Middle) });
        for words in &self.item.words {
            y += TYPE + 2;
            self.texts.push(Text::new((middle, y), words, TYPE, Align::Middle));
        }
        y + 4
    }

    /// Places ports on the left and the right, in rows below the header. Without names, the ports are distributed over
    /// the height.
    fn rows(&mut self, top: i64, header: i64) -> i64 {
        let sides = self.sides;
        let count = sides.left.len().max(sides.right.len()) as i64;
        let is_named = self.is_named();
        let end = if is_named { header + count * ROW } else { header.max(top + count * 12) };
        for (ports, x, align) in [(&sides.left, 0, Align::Begin), (&sides.right, self.size.0, Align::End)] {
            let room = end - top;
            for (i, &port) in ports.iter().enumerate() {
                let i = i as i64;
                let spread = top + room * (2 * i + 1) / (2 * ports.len() as i64);
                let y = if is_named { header + i * ROW + ROW / 2 } else { spread };
                self.ports[port] = (x, y);
                let inset = if align == Align::Begin { 6 } else { -6 };
                if !self.name(port).is_empty() {
                    self.texts.push(Text::new((x + inset, y + 4), self.name(port), SMALL, align));
                }
            }
        }
        end
    }
}

//! Layout of an item with a frame: orders its cells, assigns positions and sizes, and routes lines.

use super::{
    cells::{CLEAR, Cells, ROW, Role},
    coordinates, leaf, order,
    placed::{Align, NAME, Placed, Point, SMALL, TYPE, Text},
    route::{self, Gap},
};
use crate::model::{Frame, Item, Side};

/// Distance between the outline and the contents.
const PAD: i64 = 14;
/// Maximum number of rounds that separate overlapping lines.
const ROUNDS: usize = 6;
/// Distance between lines that lead from the top or to the bottom of a frame.
const STAIR: i64 = 9;

/// Lays out an item and all items in it.
pub fn place(item: &Item) -> Placed {
    item.inside.as_ref().map_or_else(|| leaf::place(item, &leaf::Sides::of(item)), |frame| framed(item, frame))
}

/// Layout of an item that contains `frame`.
fn framed(item: &Item, frame: &Frame) -> Placed {
    let inner = frame.items.iter().map(|item| Some(framed(item, item.inside.as_ref()?))).collect();
    let mut cells = Cells::new(item, frame, inner);
    order::order(&mut cells, &|port| item.ports[port].side);
    let (y, gaps) = heights(&cells, title_height(item) + PAD);
    let mut layout = Layout { item, frame, cells: &cells, y, gaps, layers: vec![], placed: empty(item) };
    layout.columns();
    layout.title();
    layout.pins();
    layout.items();
    layout.labels();
    layout.routes();
    layout.placed
}

/// Top of each cell, and the gaps between the layers. Repeated while lines would overlap.
fn heights(cells: &Cells, top: i64) -> (Vec<i64>, Vec<Gap>) {
    let mut apart = vec![];
    for round in 0..=ROUNDS {
        let y: Vec<i64> = coordinates::heights(cells, &apart).iter().map(|y| y + top).collect();
        let gaps = route::gaps(cells, &|term| y[cells.terms[term].cell] + cells.offset(term));
        let before = apart.len();
        for pair in gaps.iter().flat_map(|gap| &gap.hidden) {
            if !apart.contains(pair) {
                apart.push(*pair);
            }
        }
        if round == ROUNDS || apart.len() == before {
            return (y, gaps);
        }
    }
    unreachable!("the last round returns")
}

fn empty(item: &Item) -> Placed {
    let ports = vec![(0, 0); item.ports.len()];
    Placed { at: (0, 0), size: (0, 0), texts: vec![], ports, items: vec![], routes: vec![] }
}

fn title_height(item: &Item) -> i64 {
    let lines = item.words.len().saturating_sub(1) as i64;
    NAME + 10 + lines * (TYPE + 2)
}

struct Layout<'a> {
    item: &'a Item,
    frame: &'a Frame,
    cells: &'a Cells,
    /// Top of each cell.
    y: Vec<i64>,
    gaps: Vec<Gap>,
    /// Left and right side of each layer.
    layers: Vec<(i64, i64)>,
    placed: Placed,
}

impl Layout<'_> {
    /// Ports of the frame on a side, from top to bottom.
    fn pins_at(&self, side: Side) -> Vec<(usize, usize)> {
        let column = if matches!(side, Side::Left | Side::Top) { 0 } else { self.cells.layers.len() - 1 };
        let pins = self.cells.layers[column].iter().filter_map(|&cell| match self.cells.cells[cell].role {
            Role::Pin(port) if self.item.ports[port].side == side => Some((cell, port)),
            _ => None,
        });
        pins.collect()
    }

    /// Assigns horizontal positions to the layers, and sizes to the frame.
    fn columns(&mut self) {
        let mut x = 0;
        let last = self.cells.layers.len() - 1;
        let stairs = |side| self.pins_at(side).len() as i64 * STAIR;
        let (slots, events) = (stairs(Side::Top), stairs(Side::Bottom));
        for (index, layer) in self.cells.layers.iter().enumerate() {
            let mut width = layer.iter().map(|cell| self.cells.cells[*cell].size.0).max().unwrap_or(0);
            if index == 0 {
                width += slots;
            } else if index == last {
                width += events;
            }
            self.layers.push((x, x + width));
            x += width + if index == last { 0 } else { self.gaps[index].width };
        }
        let title = self.title_x() + self.title_texts().iter().map(Text::width).max().unwrap_or(0) + PAD;
        if title > x {
            self.layers[last] = (self.layers[last].0 + title - x, title);
            x = title;
        }
        let cells = self.cells.cells.iter().zip(&self.y);
        let bottom = cells.map(|(cell, y)| y + cell.size.1).max().unwrap_or(title_height(self.item));
        self.placed.size = (x, bottom + PAD);
    }

    /// Left end of the title. Lines from slots at the top pass to the left of it.
    fn title_x(&self) -> i64 {
        let slots = self.pins_at(Side::Top).len() as i64;
        if slots == 0 { 8 } else { 6 + (slots + 1) * STAIR }
    }

    fn title_texts(&self) -> Vec<Text> {
        let x = self.title_x();
        let mut words = self.item.words.iter();
        let plain = words.next().map_or(String::new(), |w| format!(": {w}"));
        let bold = self.item.name.clone();
        let first = Text { at: (x, NAME + 4), bold, plain, size: NAME, align: Align::Begin };
        let more = words.enumerate().map(|(i, w)| {
            let y = NAME + 4 + (i as i64 + 1) * (TYPE + 2);
            Text::new((x, y), w, TYPE, Align::Begin)
        });
        [first].into_iter().chain(more).collect()
    }

    fn title(&mut self) {
        self.placed.texts = self.title_texts();
    }

    /// Vertical position of an end.
    fn height(&self, term: usize) -> i64 {
        self.y[self.cells.terms[term].cell] + self.cells.offset(term)
    }

    /// Places the ports of the frame, with their names above their lines.
    fn pins(&mut self) {
        let (width, height) = self.placed.size;
        for side in [Side::Left, Side::Top, Side::Right, Side::Bottom] {
            let pins = self.pins_at(side);
            let count = pins.len() as i64;
            for (rank, (cell, port)) in pins.into_iter().enumerate() {
                let y = self.y[cell] + 13;
                // The line of the uppermost port is next to the contents at the top, and next to the outline at the
                // bottom.
                let stair = (count - rank as i64) * STAIR;
                let (at, text) = match side {
                    Side::Left => ((0, y), (5, Align::Begin)),
                    Side::Top => ((stair, 0), (stair + 4, Align::Begin)),
                    Side::Right => ((width, y), (width - 5, Align::End)),
                    Side::Bottom => {
                        let x = width - (rank as i64 + 1) * STAIR;
                        ((x, height), (x - 4, Align::End))
                    }
                };
                self.placed.ports[port] = at;
                let name = &self.item.ports[port].name;
                if !name.is_empty() {
                    self.placed.texts.push(Text::new((text.0, y - 4), name, SMALL, text.1));
                }
            }
        }
    }

    fn items(&mut self) {
        for (index, item) in self.frame.items.iter().enumerate() {
            // The first cells are the items, in their order.
            let cell = &self.cells.cells[index];
            let ports = |terms: &[usize]| -> Vec<usize> { terms.iter().map(|t| self.cells.terms[*t].port).collect() };
            let mut placed = if item.inside.is_some() {
                self.cells.placed[index].clone()
            } else {
                let default = leaf::Sides::of(item);
                let sides = leaf::Sides {
                    slots: completed(ports(&cell.left[..cell.slots]), &default.slots),
                    left: completed(ports(&cell.left[cell.slots..]), &default.left),
                    right: completed(ports(&cell.right[..cell.outputs]), &default.right),
                    events: completed(ports(&cell.right[cell.outputs..]), &default.events),
                };
                leaf::place(item, &sides)
            };
            let (left, right) = self.layers[cell.layer];
            let above = if cell.slots == 0 { 0 } else { (cell.slots as i64 - 1) * ROW + CLEAR };
            placed.at = ((left + right - placed.size.0) / 2, self.y[index] + above);
            self.placed.items.push(placed);
        }
    }

    fn labels(&mut self) {
        for (index, cell) in self.cells.cells.iter().enumerate() {
            let Role::Label(label) = cell.role else { continue };
            let (left, right) = self.layers[cell.layer];
            let at = ((left + right) / 2, self.y[index] + 9);
            self.placed.texts.push(Text::new(at, &self.cells.labels[label], SMALL, Align::Middle));
        }
    }

    /// Points from the port of an end to the side of its layer.
    fn way_out(&self, term: usize) -> Vec<Point> {
        let at = self.cells.terms[term];
        let y = self.height(term);
        match self.cells.cells[at.cell].role {
            Role::Item(item) => {
                let placed = &self.placed.items[item];
                let port = placed.ports[at.port];
                let port = (port.0 + placed.at.0, port.1 + placed.at.1);
                vec![port, (port.0, y)]
            }
            Role::Pin(port) => {
                let port = self.placed.ports[port];
                vec![port, (port.0, y)]
            }
            Role::Bend | Role::Label(_) => vec![],
        }
    }

    fn routes(&mut self) {
        for path in &self.cells.paths {
            let (Some(first), Some(last)) = (path.first(), path.last()) else { continue };
            let mut points = self.way_out(first.from);
            for link in path {
                let gap = &self.gaps[link.gap];
                if let Some(track) = gap.tracks.get(&link.net) {
                    let x = self.layers[link.gap].1 + track;
                    points.push((x, self.height(link.from)));
                    points.push((x, self.height(link.to)));
                }
            }
            points.extend(self.way_out(last.to).into_iter().rev());
            let route = route::simplified(points);
            self.placed.routes.push(route);
        }
    }
}

/// `first`, then all other ports.
fn completed(first: Vec<usize>, all: &[usize]) -> Vec<usize> {
    let more: Vec<usize> = all.iter().copied().filter(|p| !first.contains(p)).collect();
    first.into_iter().chain(more).collect()
}

//! Contents of a diagram.

/// Maximum number of boxes in a diagram, beyond which it is not readable.
pub const MAX_ITEMS: usize = 500;

/// A box with ports: a node, a nested graph, or the whole graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// Shape.
    pub shape: Shape,
    /// Instance name.
    pub name: String,
    /// Its type: of a node type file and name, of a graph or a state machine the name alone; empty for dots and delays.
    pub ty: String,
    /// Type, parameters and modifiers, one per line.
    pub words: Vec<String>,
    /// Documentation.
    pub docs: String,
    /// `true` if activity can reach it.
    pub active: bool,
    /// `true` if others lack it (see [`mark_new`](crate::mark_new)).
    pub new: bool,
    /// `true` if it runs once per element of a list.
    pub each: bool,
    /// Ports.
    pub ports: Vec<Port>,
    /// Contents of a nested graph.
    pub inside: Option<Frame>,
    /// States of a state machine.
    pub states: Option<Frame>,
}

/// Shape of an item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A box.
    Node,
    /// A rounded box: a node that can be active.
    State,
    /// A filled dot: the start of activity.
    Start,
    /// A dot in a ring: the program ends.
    End,
    /// A ring: the slot `reset`.
    Reset,
    /// Two rings: an event that every program has, such as `hung`.
    Event,
}

/// The contents of an item.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frame {
    /// Items.
    pub items: Vec<Item>,
    /// Connections between the items and with the ports of the frame.
    pub lines: Vec<Line>,
}

/// A side of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// Inputs.
    Left,
    /// Outputs.
    Right,
    /// Slots.
    Top,
    /// Events.
    Bottom,
}

/// A port.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// Name; empty if it would not be informative.
    pub name: String,
    /// Side of the box.
    pub side: Side,
    /// Type and documentation.
    pub docs: String,
    /// `true` if a line begins or ends at it.
    pub connected: bool,
}

/// An end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Anchor {
    /// Port of the frame itself, seen from inside.
    Own(usize),
    /// Port of an item: the item, then its port.
    Of(usize, usize),
}

/// Kind of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Flow {
    /// Output to input.
    Synchronous,
    /// Event to slot.
    Asynchronous,
    /// Output to slot, or event to input.
    Hybrid,
}

/// A connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// End that sends tokens.
    pub from: Anchor,
    /// End that takes tokens.
    pub to: Anchor,
    /// `true` for `=>`, which is drawn double.
    pub active: bool,
    /// Kind of the connection.
    pub flow: Flow,
    /// Label.
    pub label: String,
}

impl Item {
    /// An item without ports.
    pub fn new(shape: Shape, name: &str) -> Self {
        let (name, ty, docs) = (name.to_owned(), String::new(), String::new());
        let (words, ports) = (vec![], vec![]);
        Self { shape, name, ty, words, docs, active: false, new: false, each: false, ports, inside: None, states: None }
    }

    /// Items directly in it.
    pub fn items(&self) -> impl Iterator<Item = &Self> {
        self.inside.iter().flat_map(|frame| &frame.items)
    }

    /// Number of items in it, including itself.
    pub fn count(&self) -> usize {
        1 + self.items().map(Self::count).sum::<usize>()
    }

    /// Closes everything that is nested deeper than `depth`, so that boxes with ports remain.
    #[must_use]
    pub fn closed(self, depth: usize) -> Self {
        let inside = self.inside.zip(depth.checked_sub(1)).map(|(frame, depth)| Frame {
            items: frame.items.into_iter().map(|item| item.closed(depth)).collect(),
            ..frame
        });
        Self { inside, ..self }
    }

    /// Closes the nested graphs whose path `is_open` refuses: their full name within this item, `fast.avoid`.
    #[must_use]
    pub fn opened(self, is_open: &dyn Fn(&str) -> bool) -> Self {
        self.opened_below("", is_open)
    }

    fn opened_below(self, path: &str, is_open: &dyn Fn(&str) -> bool) -> Self {
        let open = |item: Self| {
            let path = joined(path, &item.name);
            let inside = item.inside.filter(|_| is_open(&path));
            Self { inside, ..item }.opened_below(&path, is_open)
        };
        let inside = self.inside.map(|frame| Frame { items: frame.items.into_iter().map(open).collect(), ..frame });
        Self { inside, ..self }
    }

    /// Indices of its ports on one side.
    pub fn at(&self, side: Side) -> Vec<usize> {
        (0..self.ports.len()).filter(|p| self.ports[*p].side == side).collect()
    }
}

impl Port {
    /// A port without a name at which a line begins or ends.
    pub fn unnamed(side: Side) -> Self {
        Self { name: String::new(), side, docs: String::new(), connected: true }
    }
}

impl Anchor {
    /// Item that the port belongs to.
    pub fn item(self) -> Option<usize> {
        if let Self::Of(item, _) = self { Some(item) } else { None }
    }
}

impl Flow {
    /// Name of the kind.
    pub fn word(self) -> &'static str {
        match self {
            Self::Synchronous => "synchronous",
            Self::Asynchronous => "asynchronous",
            Self::Hybrid => "hybrid",
        }
    }
}

/// Full name of the item `name` in the item with the full name `path`, which is empty for the whole graph.
pub fn joined(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

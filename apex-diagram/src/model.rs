//! What a picture shows.

/// Most boxes of one picture; nobody can read more.
pub const MAX_ITEMS: usize = 500;

/// A thing with ports: a node, a nested graph, or the whole graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// How it is drawn.
    pub shape: Shape,
    /// Instance name.
    pub name: String,
    /// Its type, parameters and modifiers, a line each.
    pub words: Vec<String>,
    /// Documentation.
    pub docs: String,
    /// Activity can come to it.
    pub active: bool,
    /// It runs once per element of a list.
    pub each: bool,
    /// Its ports.
    pub ports: Vec<Port>,
    /// What is drawn inside.
    pub inside: Option<Frame>,
    /// The states of a state machine.
    pub states: Option<Frame>,
}

/// How an item is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A box.
    Node,
    /// A rounded box: a place where activity can be.
    State,
    /// A filled dot: where activity begins.
    Start,
    /// A dot in a ring: the program ends.
    PortId,
    /// A ring: the slot `reset`.
    Reset,
    /// Two rings: an event that every program has, such as `hung`.
    Event,
}

/// The inside of an item.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frame {
    /// What stands in it.
    pub items: Vec<Item>,
    /// Connections between them, and with the ports of the frame.
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
    /// Its name; empty where it says nothing.
    pub name: String,
    /// Where it stands.
    pub side: Side,
    /// Type and documentation.
    pub docs: String,
    /// Whether a line begins or ends at it.
    pub connected: bool,
}

/// An end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Anchor {
    /// A port of the frame itself, from inside.
    Own(usize),
    /// Port of an item: the item, then its port.
    Of(usize, usize),
}

/// How tokens travel on a line.
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
    /// Where tokens come from.
    pub from: Anchor,
    /// Where they go.
    pub to: Anchor,
    /// `=>`: drawn double.
    pub active: bool,
    /// How tokens travel.
    pub flow: Flow,
    /// What stands at it.
    pub label: String,
}

impl Item {
    /// An item without ports.
    pub fn new(shape: Shape, name: &str) -> Self {
        let (name, words, docs) = (name.to_owned(), vec![], String::new());
        Self { shape, name, words, docs, active: false, each: false, ports: vec![], inside: None, states: None }
    }

    /// How many items there are in it, itself included.
    pub fn count(&self) -> usize {
        1 + self.inside.iter().flat_map(|frame| &frame.items).map(Self::count).sum::<usize>()
    }

    /// The same with what is nested deeper than `depth` closed: a box with its ports.
    #[must_use]
    pub fn closed(self, depth: usize) -> Self {
        let inside = self.inside.zip(depth.checked_sub(1)).map(|(frame, depth)| Frame {
            items: frame.items.into_iter().map(|item| item.closed(depth)).collect(),
            ..frame
        });
        Self { inside, ..self }
    }

    /// Its ports at one side, by number.
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
    /// The item that it belongs to.
    pub fn item(self) -> Option<usize> {
        if let Self::Of(item, _) = self { Some(item) } else { None }
    }
}

impl Flow {
    /// The word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Synchronous => "synchronous",
            Self::Asynchronous => "asynchronous",
            Self::Hybrid => "hybrid",
        }
    }
}

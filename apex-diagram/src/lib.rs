//! Diagrams of graphs: a graph becomes a model of boxes, ports and lines; a layout adds coordinates; the result is
//! drawn as SVG.
//!
//! All functions are pure and deterministic: no files, no clock, no unordered iteration.

mod build;
mod dot;
mod fold;
pub mod layout;
mod model;
mod new;
mod states;
mod svg;
mod text;
mod words;

pub use build::diagram;
pub use dot::dot;
pub use fold::{Folding, READABLE, folded, folded_states};
pub use model::{Anchor, Flow, Frame, Item, Line, MAX_ITEMS, Port, Shape, Side, joined};
pub use new::{News, mark_new};
pub use states::{chart, states};
pub use svg::svg;

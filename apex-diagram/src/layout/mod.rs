//! Coordinates for a model. Boxes are in layers from left to right (Sugiyama, Tagawa, Toda: Methods for visual
//! understanding of hierarchical system structures, 1981). Nested frames are laid out first; each then counts as one
//! large box.
//!
//! Slots and events are at the top and the bottom of a box, but their lines lead to the left and to the right: each has
//! a row above or below the box. With its rows, a box has ends of lines on two sides only.

mod cells;
mod coordinates;
mod cycles;
mod frame;
mod labels;
mod leaf;
mod order;
mod placed;
mod route;
pub mod simplex;
mod strokes;

pub use frame::place;
pub use placed::{Align, Placed, Point, Text};
pub use strokes::{Stroke, strokes};

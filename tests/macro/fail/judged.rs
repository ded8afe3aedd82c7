//! Bounds of nodes and tokens that only rustc can check: its message names the node, the port and the line.
use apex_macros::graph;
use apex_rt::prelude::*;
use std::{ops::Add, rc::Rc};

pub struct Image;

/// A type without `Default` and `Send`.
pub struct Lens(Rc<u8>);

#[node]
pub fn camera() -> Image {
    Image
}

/// Sums its tokens.
#[node]
#[derive(Default)]
pub struct Total<T> {
    sum: Option<T>,
}

#[node]
impl<T: Clone + Add<Output = T>> Total<T> {
    fn process(&mut self, x: &T) -> T {
        self.sum.insert(x.clone()).clone()
    }
}

#[node]
pub struct Telescope {
    lens: Lens,
}

#[node]
impl Telescope {
    fn process(&mut self) -> u8 {
        *self.lens.0
    }
}

pub trait Levels {
    type Level;
}
pub struct Few;
impl Levels for Few {
    type Level = std::num::NonZeroU8;
}

#[node]
pub struct Limit {
    #[param(default = std::num::NonZeroU8::MIN)]
    most: <Few as Levels>::Level,
}

#[node]
impl Limit {
    fn process(&mut self, x: &u8) -> u8 {
        (*x).min(self.most.get())
    }
}

graph! {
    graph Bounds {
        out sum: Image;
        node cam = camera();
        node total = Total();
        cam -> total -> sum;
    }
}

graph! {
    graph Copies {
        out picture: Image;
        node cam = camera();
        cam -> picture;
    }
}

graph! {
    graph Makes {
        out seen: u8;
        node telescope = Telescope();
        telescope -> seen;
    }
}

graph! {
    graph Arguments {
        in x: u8;
        out y: u8;
        node limit = Limit(most = 5);
        x -> limit -> y;
    }
}

fn main() {}

//! Bounds of thread groups that only rustc can check: nodes and tokens must be `Send`.
use apex_macros::graph;
use apex_rt::prelude::*;
use std::rc::Rc;

#[derive(Clone)]
pub struct Frame(Rc<u8>);

#[node]
#[derive(Default)]
pub struct Camera {
    last: Option<Rc<u8>>,
}

#[node]
impl Camera {
    fn process(&mut self) -> Frame {
        Frame(self.last.get_or_insert_default().clone())
    }
}

#[node]
pub fn show(frame: &Frame) -> u8 {
    *frame.0
}

graph! {
    graph Robot {
        out seen: u8;
        node cam = Camera() on vision every 40ms;
        node screen = show();
        cam => screen -> seen;
    }
}

fn main() {}

//! Types behind traits, which only rustc knows.
use apex_macros::graph;
use apex_rt::prelude::*;

pub struct Image;
pub struct Cloud;

pub trait Sensor {
    type Token;
}
pub struct Camera;
impl Sensor for Camera {
    type Token = Image;
}

#[node]
fn camera() -> <Camera as Sensor>::Token {
    Image
}

#[node]
fn detect(cloud: &Cloud) {
    let _ = cloud;
}

graph! {
    graph Robot {
        node cam = camera();
        node detector = detect();
        cam -> detector;
    }
}

fn main() {}

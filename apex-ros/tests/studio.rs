//! Reasons for silence in the studio: its viewers are told, also those that come later.

mod common;

use apex_macros::graph;
use apex_ros::Ros;
use apex_rt::studio::{
    StreamedTime, Studio, connect,
    message::{self, Report},
};
use common::free_address;
use std::io::Read;

graph! {
    use apex_nodes::math::LowPass;

    graph Smooth {
        in  x: f64;
        out y: f64;
        node low = LowPass(weight = 0.5);
        x -> low -> y;
    }
}

/// Waits for a problem beside the program, with these words.
fn problem(mut from: &mut dyn Read, words: &str) {
    while let Ok(Some(report)) = message::read::<Report>(&mut from) {
        if matches!(&report, Report::Beside(text) if text.contains(words)) {
            return;
        }
    }
    panic!("the stream ended");
}

#[test]
fn the_studio_shows_why_nothing_comes() {
    let studio = Studio::open::<Smooth>("127.0.0.1:0", StreamedTime::Real).expect("a socket");
    let (mut early, _to) = connect(studio.address()).expect("it listens");
    let ros = Ros::node("rover").args([""; 0]).domain(0).router(&free_address()).tell(|_| {}).open().expect("a node");
    problem(&mut *early, "no router of Zenoh answers at");
    let (mut late, _to) = connect(studio.address()).expect("it listens");
    problem(&mut *late, "no router of Zenoh answers at");
    drop(ros);
}

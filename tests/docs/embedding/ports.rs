use apex_macros::graph;
use apex_rt::{Ports, drive_from, prelude::*};
use std::thread;

/// Answers each word with its length.
#[node]
#[derive(Default)]
pub struct Measure;

#[node]
impl Measure {
    #[slot]
    fn word(&mut self, word: &String, length: Event<usize>) {
        length.emit(word.len());
    }
}

graph! {
    graph Lengths {
        slot  word: String;
        event length: usize;

        node measure = Measure();
        word           -> measure.word;
        measure.length -> length;
    }
}

pub fn main() {
    let mut ports = Ports::<Lengths>::new();
    let words = ports.input(|inputs| &mut inputs.word);
    let lengths = ports.event(|events| &mut events.length);
    let user = thread::spawn(move || {
        let ask = |word: &str| words.send(word.to_owned()).ok().and_then(|()| lengths.receive());
        [ask("one"), ask("three")]
    });
    // It sleeps until a word comes, and ends when the last end of an input is dropped.
    assert_eq!(drive_from(Lengths::new(), WallClock::new(), ports), 0);
    assert_eq!(user.join().ok(), Some([Some(3), Some(5)]));
}

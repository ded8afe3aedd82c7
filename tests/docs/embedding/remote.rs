use apex_macros::graph;
use apex_rt::{Ports, drive_from, prelude::*};
use std::thread;

/// Multiplies words by a factor.
#[node]
pub struct Amplify {
    #[param(default = 2, range = 0..=9)]
    factor: i64,
}

#[node]
impl Amplify {
    #[slot]
    fn put(&mut self, x: &i64, amplified: Event<i64>) {
        amplified.emit(self.factor * x);
    }
}

graph! {
    graph Amplifier {
        slot  x: i64;
        event y: i64;

        node amplify = Amplify();
        x                 -> amplify.put;
        amplify.amplified -> y;
    }
}

pub fn main() {
    let mut ports = Ports::<Amplifier>::new();
    let (x, y) = (ports.input(|inputs| &mut inputs.x), ports.event(|events| &mut events.y));
    let params = ports.params();
    let user = thread::spawn(move || {
        let ask = |token| x.send(token).ok().and_then(|()| y.receive());
        let before = ask(10);
        params.set("amplify.factor", 5i64).expect("the program waits, and 5 is in the range");
        let error = params.set("amplify.factor", 50i64).expect_err("50 is not");
        assert_eq!(error.to_string(), "the value of `amplify.factor` is out of range: its range is 0..=9");
        (before, ask(10))
    });
    assert_eq!(drive_from(Amplifier::new(), WallClock::new(), ports), 0);
    assert_eq!(user.join().ok(), Some((Some(20), Some(50))));
}

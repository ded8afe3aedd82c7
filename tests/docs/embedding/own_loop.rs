use apex_macros::graph;
use apex_rt::prelude::*;

graph! {
    use apex_nodes::flow::{Counter, tick};

    graph Blink {
        slot  again;
        event times: u64;

        node clock = tick() every 20ms;
        node count = Counter();
        again -> count.reset;
        clock -> count.put;
        count -> times;
    }
}

pub fn main() {
    let mut blink = Blink::new();
    let mut now = Time::ZERO;
    let mut times = 0;
    while times < 5 {
        match blink.react(now) {
            // A robot sleeps until then; here the time is made up.
            Next::At(time) => now = time,
            Next::Now => {}
            Next::Input | Next::Exit(_) => break,
        }
        times = blink.events().times.take().unwrap_or(times);
    }
    assert_eq!((times, now), (5, Time::from_millis(100)));

    // A mailbox holds one token. The next one is given back.
    assert_eq!(blink.inputs().again.put(()), Ok(()));
    assert_eq!(blink.inputs().again.put(()), Err(()));
    blink.react(now);
    assert_eq!(blink.events().times.take(), Some(1));
}

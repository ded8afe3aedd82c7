use apex_macros::graph;
use apex_rt::prelude::*;

graph! {
    use apex_nodes::flow::Counter;

    graph Doorbell {
        slot  button: u32;
        event rung: u64;

        node count = Counter();
        button -> count.put;
        count -> rung;
    }
}

pub fn main() {
    let mut bell = Doorbell::new();
    assert_eq!(bell.inputs().button.put(7), Ok(()));
    bell.react(Time::ZERO);
    assert_eq!(bell.events().rung.take(), Some(1));
}

use apex_macros::graph;
use apex_rt::{Switch, UntilStopped, drive, prelude::*};
use std::time::Duration;

graph! {
    use apex_nodes::flow::tick;

    robot EggTimer {
        node done = tick() after 4min;
        done -> exit;
    }
}

pub fn main() {
    // Four minutes of simulated time, at once.
    assert_eq!(drive(EggTimer::new(), SimClock::until(Time::MAX)), 0);

    // A step of 10 ms wherever the program wants to be called again at once, and an end.
    let clock = SimClock::until(Time::from_secs(60)).with_step(Duration::from_millis(10));
    assert_eq!(drive(EggTimer::new(), clock), 0);

    // The machine's clock, until another thread or the handler of a signal sets the switch, which ends every wait.
    static STOP: Switch = Switch::new();
    STOP.set();
    run(EggTimer::new(), UntilStopped::new(WallClock::new(), &STOP));
}

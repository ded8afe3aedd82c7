//! The compiled graphs, each as a function from a number of ticks to the checksum.

use apex_rt::prelude::*;

graph!("graphs/chain3.afg");
graph!("graphs/chain10.afg");
graph!("graphs/chain100.afg");
graph!("graphs/chain1000.afg");
graph!("graphs/silent10.afg");
graph!("graphs/silent100.afg");
graph!("graphs/silent1000.afg");
graph!("graphs/diamond8.afg");
graph!("graphs/diamond64.afg");
graph!("graphs/bot100.afg");
graph!("graphs/throttle.afg");
graph!("graphs/rate23.afg");
graph!("graphs/nested1000.afg");
graph!("graphs/image.afg");
graph!("graphs/timer10.afg");
graph!("graphs/timers2.afg");
graph!("graphs/timers3.afg");

/// The times of `ticks` ticks.
pub(crate) fn milliseconds(ticks: u64) -> impl Iterator<Item = Time> {
    (0..ticks).map(|t| Time::from_millis(t as i64))
}

macro_rules! runs {
    ($($name:ident: $graph:ident),*) => {
        $(
            #[doc = concat!("Ticks of `", stringify!($graph), "`.")]
            #[inline(never)]
            pub fn $name(ticks: u64) -> u64 {
                let mut graph = $graph::new();
                for now in milliseconds(ticks) {
                    graph.react(now);
                }
                graph.nodes().sink.checksum()
            }
        )*
    };
}

runs!(
    chain3: Chain3, chain10: Chain10, chain100: Chain100, chain1000: Chain1000,
    silent10: Silent10, silent100: Silent100, silent1000: Silent1000,
    diamond8: Diamond8, diamond64: Diamond64,
    bot100: Bot100, throttle: Throttle, rate23: Rate23, nested1000: Nested1000, image: Image,
    timer10: Timer10, timers2: Timers2, timers3: Timers3
);

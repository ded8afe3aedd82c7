//! The compiled graphs, each as a function from a number of ticks to the checksum.

use apex_macros::graph;
use apex_rt::prelude::*;
use std::time::Instant;

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
graph!("graphs/merge8.afg");
graph!("graphs/throttle.afg");
graph!("graphs/rate23.afg");
graph!("graphs/nested1000.afg");
graph!("graphs/image.afg");
graph!("graphs/timer10.afg");
graph!("graphs/timers2.afg");
graph!("graphs/timers3.afg");
graph!("graphs/pingpong.afg");
graph!("graphs/pingpong1.afg");
graph!("graphs/mpse8.afg");
graph!("graphs/fsm16.afg");
graph!("graphs/fsm16nodes.afg");
graph!("graphs/mixed1000.afg");
graph!("graphs/frames.afg");

/// Times of `ticks` ticks.
pub(crate) fn milliseconds(ticks: u64) -> impl Iterator<Item = Time> {
    (0..ticks).map(|t| Time::from_millis(t as i64))
}

macro_rules! runs {
    ($sink:ident => $($name:ident: $graph:ident),*) => {
        $(
            #[doc = concat!("Ticks of `", stringify!($graph), "`.")]
            #[inline(never)]
            pub fn $name(ticks: u64) -> u64 {
                let mut graph = $graph::new();
                for now in milliseconds(ticks) {
                    graph.react(now);
                }
                graph.nodes().$sink.checksum()
            }
        )*
    };
}

runs! { sink =>
    chain3: Chain3, chain10: Chain10, chain100: Chain100, chain1000: Chain1000,
    silent10: Silent10, silent100: Silent100, silent1000: Silent1000,
    diamond8: Diamond8, diamond64: Diamond64,
    bot100: Bot100, merge8: Merge8, throttle: Throttle, rate23: Rate23, nested1000: Nested1000, image: Image,
    timer10: Timer10, timers2: Timers2, timers3: Timers3,
    mpse8: Mpse8, fsm16: Fsm16, fsm16_nodes: StateRing,
    frames_by_value: FramesByValue, frames_by_out: FramesByOut, frames_by_event: FramesByEvent
}

runs! { a => pingpong1: PingPong1 }

/// Ticks of `Chain10`, driven by a simulated clock.
#[inline(never)]
pub fn drive10(ticks: u64) -> u64 {
    let mut graph = Chain10::new();
    apex_rt::drive(&mut graph, SimClock::until(Time::from_millis(ticks as i64)));
    graph.nodes().sink.checksum()
}

/// Round trips of `PingPong`. The ball would go back and forth forever in one reaction, so the budget of the reaction
/// ends it. A round trip is two steps, and the start is one more.
#[inline(never)]
pub fn pingpong(ticks: u64) -> u64 {
    let mut graph = PingPong::new();
    graph.set_budget(u32::try_from(2 * ticks + 1).unwrap_or(u32::MAX));
    graph.react(Time::ZERO);
    graph.nodes().a.checksum()
}

/// Ticks of `Mixed1000`. The result is the sum of a tick.
#[inline(never)]
pub fn mixed1000(ticks: u64) -> u64 {
    let mut graph = Mixed1000::new();
    for now in milliseconds(ticks) {
        graph.react(now);
        std::hint::black_box(&mut graph);
    }
    crate::hand::mixed1000::checksum(&graph)
}

/// Reads the clock of the machine when the first node of a cluster fires: one time stamp for all nodes of a tick.
struct Stamps {
    clusters: &'static [&'static [usize]],
}

impl Observer for Stamps {
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        if self.clusters.iter().any(|cluster| cluster[0] == node) {
            std::hint::black_box(Instant::now());
        }
    }
}

macro_rules! stamped {
    ($($name:ident: $graph:ident),*) => {
        /// The same graphs with a time stamp per cluster.
        pub mod stamped {
            use super::*;
            $(
                #[doc = concat!("Ticks of `", stringify!($graph), "`.")]
                #[inline(never)]
                pub fn $name(ticks: u64) -> u64 {
                    let mut graph = $graph::new();
                    let mut stamps = Stamps { clusters: $graph::INFO.clusters };
                    for now in milliseconds(ticks) {
                        graph.react_with(now, &mut stamps);
                    }
                    graph.nodes().sink.checksum()
                }
            )*
        }
    };
}

stamped! {
    chain3: Chain3, chain10: Chain10, chain100: Chain100, diamond8: Diamond8, bot100: Bot100, throttle: Throttle
}

//! timely dataflow: one worker. A tick is an epoch, which ends when the probe at the end has passed it.

use crate::{Ran, timed};
use apex_bench::nodes::{Count, OneOf, Sink, op};
use std::{cell::RefCell, rc::Rc};
use timely::dataflow::{
    InputHandle, ProbeHandle, StreamVec,
    operators::{Input, Inspect, Probe, vec::Map},
};

/// A chain of operations.
fn ops<'s>(from: StreamVec<'s, u64, u64>, numbers: impl Iterator<Item = u64>) -> StreamVec<'s, u64, u64> {
    numbers.fold(from, |from, k| from.map(move |x| op(&x, k)))
}

/// Runs one epoch per tick.
fn lockstep(
    ticks: u64,
    graph: impl for<'s> FnOnce(StreamVec<'s, u64, u64>) -> StreamVec<'s, u64, u64> + Send + Sync + 'static,
) -> Ran {
    timely::execute_directly(move |worker| {
        let (mut source, sink) = (Count::default(), Rc::<RefCell<Sink>>::default());
        let (mut input, probe, inner) = (InputHandle::new(), ProbeHandle::new(), sink.clone());
        worker.dataflow(|scope| {
            let from = scope.input_from(&mut input);
            graph(from).inspect(move |x| inner.borrow_mut().process(x)).probe_with(&probe);
        });
        let time = timed(|| {
            for tick in 0..ticks {
                input.send(source.process());
                input.advance_to(tick + 1);
                while probe.less_than(input.time()) {
                    worker.step();
                }
            }
        });
        let checksum = sink.borrow().checksum();
        Ran { time, checksum }
    })
}

macro_rules! chain {
    ($($name:ident: $n:literal;)*) => {
        $(
            #[doc = concat!(stringify!($n), " operations in a row.")]
            pub fn $name(ticks: u64) -> Ran {
                lockstep(ticks, |from| ops(from, 1..=$n))
            }
        )*
    };
}

chain! {
    chain3: 3;
    chain10: 10;
    chain100: 100;
}

/// A filter that passes 1 % of the values to 98 operations.
pub fn bot100(ticks: u64) -> Ran {
    let mut filter = OneOf::new(100);
    lockstep(ticks, move |from| ops(ops(from, 1..=1).flat_map(move |x| filter.process(&x)), 3..=100))
}

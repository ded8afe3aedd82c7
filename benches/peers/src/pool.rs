//! rayon: a task of the pool for each node.

use crate::{Ran, timed};
use apex_bench::nodes::{Count, Rows, Sink, op, sum};
use rayon::{Scope, prelude::*};
use std::sync::atomic::{AtomicU64, Ordering};

/// Runs `ticks` on a thread of the pool. Otherwise each tick would wait until one wakes up.
fn in_pool(ticks: u64, tick: impl FnMut(u64) -> u64 + Send) -> Ran {
    let mut tick = tick;
    let (mut source, mut sink) = (Count::default(), Sink::default());
    let mut time = std::time::Duration::ZERO;
    rayon::scope(|_| {
        time = timed(|| {
            for _ in 0..ticks {
                sink.process(&tick(source.process()));
            }
        });
    });
    Ran { time, checksum: sink.checksum() }
}

/// Operations from `k` to `n`, each spawned by the previous one.
fn step<'a>(scope: &Scope<'a>, x: u64, k: u64, n: u64, last: &'a AtomicU64) {
    scope.spawn(move |scope| {
        let x = op(&x, k);
        if k == n { last.store(x, Ordering::Relaxed) } else { step(scope, x, k + 1, n, last) }
    });
}

/// A chain of `N` operations.
pub fn chain<const N: u64>(ticks: u64) -> Ran {
    let last = AtomicU64::new(0);
    in_pool(ticks, |x| {
        rayon::scope(|scope| step(scope, x, 1, N, &last));
        last.load(Ordering::Relaxed)
    })
}

/// `N` parallel operations.
pub fn diamond<const N: u64>(ticks: u64) -> Ran {
    in_pool(ticks, |x| (1..=N).into_par_iter().map(|k| op(&x, k)).reduce(|| 0, u64::wrapping_add))
}

/// Three operations for each of 1000 elements.
pub fn nested1000(ticks: u64) -> Ran {
    let (mut source, mut list, mut results) = (Rows::default(), apex_rt::Out::new(), Vec::new());
    in_pool(ticks, |_| {
        source.process(&mut list);
        let list = list.get().map_or(&[][..], |list| &list[..]);
        list.par_iter().map(|x| op(&op(&op(x, 1), 2), 3)).collect_into_vec(&mut results);
        sum(&results)
    })
}

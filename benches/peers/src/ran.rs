use std::time::{Duration, Instant};

/// Result of a run.
#[derive(Clone, Copy)]
pub struct Ran {
    /// Time of all ticks, without initialization.
    pub time: Duration,
    /// Final checksum of the sink.
    pub checksum: u64,
}

/// Time of `ticks`.
pub fn timed(ticks: impl FnOnce()) -> Duration {
    let start = Instant::now();
    ticks();
    start.elapsed()
}

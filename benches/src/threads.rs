//! Nodes and programs that run on two threads.

use crate::tworegion;
use apex_macros::graph;
use apex_rt::{prelude::*, threads::drive_on_threads};
use std::{
    hint::black_box,
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

graph!("graphs/threads.afg");

/// Amount of work of the running programs: number of firings or balls.
static WANTED: AtomicU64 = AtomicU64::new(0);
/// Time for which a player holds the ball, in ns.
static PAUSE: AtomicU64 = AtomicU64::new(0);

/// A few microseconds of work.
#[inline(never)]
fn work(seed: u64) -> u64 {
    (0..4_000).fold(seed, |x, i| black_box(x.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(7) ^ i))
}

/// A source that works until it has fired as often as wanted.
#[node]
#[derive(Default)]
pub struct Worker {
    fired: u64,
    seed: u64,
}

#[node]
impl Worker {
    fn process(&mut self, done: Event<()>) {
        let wanted = WANTED.load(Ordering::Relaxed);
        if self.fired < wanted {
            self.seed = work(self.seed);
            self.fired += 1;
            if self.fired == wanted {
                done.emit(());
            }
        }
    }
}

/// Waits until two nodes have reported that they are done.
#[node]
#[derive(Default)]
pub struct Both {
    count: u32,
}

#[node]
impl Both {
    #[slot]
    fn one(&mut self, all: Event<()>) {
        self.count += 1;
        if self.count == 2 {
            all.emit(());
        }
    }
}

/// Returns a ball, and measures its travel time.
#[node]
#[derive(Default)]
pub struct Ball {
    count: u64,
    /// Travel times of balls, in ns.
    pub took: Vec<u64>,
}

#[node]
impl Ball {
    #[slot]
    fn begin(&mut self, hit: Event<Instant>) {
        hit.emit(Instant::now());
    }
    #[slot]
    fn ball(&mut self, hit_at: &Instant, hit: Event<Instant>, done: Event<()>) {
        self.took.push(hit_at.elapsed().as_nanos() as u64);
        self.count += 1;
        if self.count == WANTED.load(Ordering::Relaxed) {
            return done.emit(());
        }
        let pause = Duration::from_nanos(PAUSE.load(Ordering::Relaxed));
        if !pause.is_zero() {
            std::thread::sleep(pause);
        }
        hit.emit(Instant::now());
    }
}

/// One of the two regions.
#[node]
#[derive(Default)]
pub struct Region {
    region: tworegion::Region,
    other: tworegion::Value,
    ticks: u64,
}

#[node]
impl Region {
    fn process(&mut self, value: &mut Out<tworegion::Value>, done: Event<()>) {
        value.set(self.region.tick(&self.other));
        self.ticks += 1;
        if self.ticks == WANTED.load(Ordering::Relaxed) {
            done.emit(());
        }
    }
    #[slot]
    fn latest(&mut self, value: &tworegion::Value) {
        self.other = *value;
    }
}

fn drive<P: Program>(program: &mut P) -> Duration {
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    let start = Instant::now();
    drive_on_threads(program, pace, |_| ());
    start.elapsed()
}

/// Times of `firings` firings of each of two workers, on one thread and on two.
pub fn scaling(firings: u64) -> (Duration, Duration) {
    WANTED.store(firings, Ordering::Relaxed);
    (drive(&mut Together::new()), drive(&mut Apart::new()))
}

/// Travel times of `balls` balls to another thread and back, one by one. Each player pauses between them.
pub fn latencies(balls: u64, pause: Duration) -> Vec<u64> {
    WANTED.store(balls, Ordering::Relaxed);
    PAUSE.store(pause.as_nanos() as u64, Ordering::Relaxed);
    let mut volley = Volley::new();
    drive(&mut volley);
    let mut took = volley.nodes().here.took.clone();
    took.extend(&volley.nodes().there.took);
    took
}

/// Time of `ticks` of two regions on two threads, and number of torn values.
pub fn two_regions(ticks: u64) -> (Duration, u64) {
    WANTED.store(ticks, Ordering::Relaxed);
    let mut program = TwoRegion::new();
    let took = drive(&mut program);
    (took, program.nodes().left.region.torn() + program.nodes().right.region.torn())
}

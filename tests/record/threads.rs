//! Programs that are recorded while they run on several threads: a replay gives every thread what it had from the others,
//! when it had it.

use crate::{Folder, repeat};
use apex_rt::{
    Program, StdErr,
    prelude::*,
    record::{Finished, record_on_threads},
};
use std::{
    fs,
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

/// Something that nobody knows before.
fn chance() -> u64 {
    static SEED: AtomicU64 = AtomicU64::new(0);
    let seed = SEED.fetch_add(0x9e37_79b9_7f4a_7c15, Ordering::Relaxed);
    let now = std::time::SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
    let mixed = (seed ^ now.as_nanos() as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed ^ (mixed >> 31)
}

/// Takes its time, or not.
fn dawdle() {
    match chance() % 8 {
        0 => thread::sleep(Duration::from_micros(chance() % 300)),
        1 | 2 => thread::yield_now(),
        _ => {}
    }
}

/// A source that nobody can foresee.
#[node]
pub fn dice() -> u64 {
    dawdle();
    chance()
}

/// Passes on what comes, sooner or later.
#[node]
pub fn slow(number: &u64) -> u64 {
    dawdle();
    *number
}

/// Both of two numbers.
#[node]
pub fn both(a: &u64, b: &u64) -> u64 {
    a.rotate_left(9) ^ b
}

/// Makes one number of all that came, in their order, and says it each time.
#[node]
pub struct Mix {
    /// What it begins with.
    #[param(default = 0)]
    seed: i64,
    mixed: u64,
    /// How many came.
    pub count: u64,
}

#[node]
impl Mix {
    fn mix(&mut self, number: u64, ctx: &Ctx) -> u64 {
        dawdle();
        self.count += 1;
        let all = self.mixed.rotate_left(5) ^ number ^ self.seed as u64 ^ ctx.now().as_nanos() as u64;
        self.mixed = all.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.mixed
    }

    #[slot]
    fn left(&mut self, number: &u64, ctx: &Ctx, told: Event<u64>) {
        told.emit(self.mix(*number, ctx));
    }

    #[slot]
    fn right(&mut self, number: &u64, ctx: &Ctx, told: Event<u64>) {
        told.emit(self.mix(!*number, ctx));
    }
}

/// Passes on what comes, and whether it is active.
#[node]
#[derive(Default)]
pub struct Awake;

#[node]
impl Awake {
    #[slot]
    fn hear(&mut self, number: &u64, ctx: &Ctx, told: Event<u64>) {
        dawdle();
        told.emit(number << 1 | u64::from(ctx.active()));
    }
}

/// Says when enough has come.
#[node]
pub struct Enough {
    /// So much.
    #[param]
    after: i64,
    count: i64,
}

#[node]
impl Enough {
    #[slot]
    fn more(&mut self, _number: &u64, now: Event<()>) {
        self.count += 1;
        if self.count == self.after {
            now.emit(());
        }
    }
}

graph! {
    use crate::threads::{Awake, Enough, Mix, both, dice, slow};
    use apex_tests::nodes::swallow;

    /// Three threads that talk to each other all the time.
    robot Crowd {
        // Sources without a pace and with one.
        node free   = dice();
        node pace   = dice() every 300us on arms;
        node own    = dice() every 500us on eyes;

        // A region over two threads.
        node far    = slow() on eyes;
        node sum    = both();
        free -> [far, sum.a];
        far  -> sum.b;
        sum  -> swallow();

        // Events both ways: what comes first is chance.
        node arms   = Mix() on arms;
        node eyes   = Mix() on eyes;
        node head   = Mix();
        node again  = Mix() on arms;
        pace      -> arms.left;
        own       -> arms.right;
        arms.told -> [head.left, eyes.left];
        own       -> eyes.right;
        eyes.told -> [head.right, again.left];
        head.told -> again.right;

        // Activity that goes round.
        node first  = Awake();
        node second = Awake() on eyes;
        node third  = Awake() on arms;
        start       => first;
        again.told  -> first.hear;
        first.told  => second.hear;
        second.told => third.hear;

        node enough = Enough(after = 150);
        third.told  -> enough.more;
        enough.now  -> exit;

        record "crowd.mcap" {
            sum;
            arms.told;
            eyes.told;
            head.told;
            again.told;
            third.told;
        }
    }
}

fn crowd(path: &Path) -> (Crowd, Finished) {
    let mut program = Crowd::new();
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    let recorded = record_on_threads(&mut program, pace, path, |_| StdErr(const { &Crowd::INFO }));
    let (code, finished) = recorded.expect("room for the file");
    assert!(code == 0 && finished.dropped.is_empty(), "{code} {finished:?}");
    (program, finished)
}

#[test]
fn what_threads_do_is_the_same_again_and_again() {
    let folder = Folder::new();
    for run in 0..30 {
        let path = folder.file(&format!("{run}.mcap"));
        let (first, _) = crowd(&path);
        for _ in 0..2 {
            let mut second = Crowd::new();
            let report = repeat(&mut second, &path);
            assert!(report.is_same() && report.missing.is_empty() && report.params.is_empty(), "{report}");
            assert_eq!(report.compared.len(), 6, "{report}");
            assert!(report.compared.iter().all(|c| c.equal > 10), "{report}");
            assert_eq!(first.nodes().again.count, second.nodes().again.count);
        }
    }
}

#[test]
fn another_graph_shows_the_first_difference_and_ends() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    crowd(&path);
    let mut other = Crowd::new();
    other.set_param("eyes.seed", 7).expect("there is one");
    let report = repeat(&mut other, &path);
    let of = |name: &str| report.compared.iter().find(|c| c.name == name).expect("it is compared");
    assert!(of("arms.told").different == 0, "{report}");
    assert!(of("eyes.told").equal == 0 && of("eyes.told").first.is_some(), "{report}");
    assert_eq!(report.params, ["`eyes.seed` was 0 and is 7"]);
}

#[test]
fn a_file_that_was_cut_is_repeated_up_to_the_cut() {
    let folder = Folder::new();
    let (whole, cut) = (folder.file("whole.mcap"), folder.file("cut.mcap"));
    crowd(&whole);
    let bytes = fs::read(&whole).expect("it was written");
    let all = repeat(Crowd::new(), &whole).reactions;
    let mut last = 0;
    for part in 1..20 {
        fs::write(&cut, &bytes[..bytes.len() * part / 20]).expect("room for it");
        let report = repeat(Crowd::new(), &cut);
        assert!(report.is_same(), "{part}: {report}");
        assert!(report.reactions >= last && report.reactions <= all, "{part}: {report}");
        last = report.reactions;
    }
    assert!(last > all / 2, "{last} of {all}");
}

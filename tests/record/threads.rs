//! Programs that are recorded while they run on several threads. A replay gives every thread the tokens of the others
//! at the same points of its run.

use crate::{Folder, record, repeat};
use apex_macros::graph;
use apex_rt::{
    Program, drive_with,
    prelude::*,
    record::{Compared, Report, record_on_threads, replay},
};
use std::{
    fs,
    path::Path,
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

/// An unpredictable number.
fn chance() -> u64 {
    static SEED: AtomicU64 = AtomicU64::new(0);
    let seed = SEED.fetch_add(0x9e37_79b9_7f4a_7c15, Ordering::Relaxed);
    let now = std::time::SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
    let mixed = (seed ^ now.as_nanos() as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed ^ (mixed >> 31)
}

/// Pauses for a random time.
fn dawdle() {
    match chance() % 8 {
        0 => thread::sleep(Duration::from_micros(chance() % 300)),
        1 | 2 => thread::yield_now(),
        _ => {}
    }
}

/// A source of unpredictable numbers.
#[node]
pub fn dice() -> u64 {
    dawdle();
    chance()
}

/// Passes tokens on after a random pause.
#[node]
pub fn slow(number: &u64) -> u64 {
    dawdle();
    *number
}

/// Combines two numbers.
#[node]
pub fn both(a: &u64, b: &u64) -> u64 {
    a.rotate_left(9) ^ b
}

/// Folds all numbers into one, in their order, and sends it after each.
#[node]
pub struct Mix {
    /// Initial value.
    #[param(default = 0)]
    seed: i64,
    /// Number of tokens after which it stops sending.
    #[param(default = 1_000_000)]
    talks: i64,
    mixed: u64,
    /// Number of tokens.
    pub count: u64,
}

#[node]
impl Mix {
    fn mix(&mut self, number: u64, ctx: &Ctx, told: Event<u64>) {
        dawdle();
        self.count += 1;
        let all = self.mixed.rotate_left(5) ^ number ^ self.seed as u64 ^ ctx.now().as_nanos() as u64;
        self.mixed = all.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        if self.count <= self.talks as u64 {
            told.emit(self.mixed);
        }
    }

    #[slot]
    fn left(&mut self, number: &u64, ctx: &Ctx, told: Event<u64>) {
        self.mix(*number, ctx, told);
    }

    #[slot]
    fn right(&mut self, number: &u64, ctx: &Ctx, told: Event<u64>) {
        self.mix(!*number, ctx, told);
    }
}

/// Passes numbers on, each with a bit for its own activity.
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

/// Hangs for a while at the third token.
#[node]
#[derive(Default)]
pub struct Stuck {
    count: u64,
}

#[node]
impl Stuck {
    fn process(&mut self, number: &u64) -> u64 {
        self.count += 1;
        if self.count == 3 {
            thread::sleep(Duration::from_millis(150));
        }
        *number
    }
}

/// Counts calls and sends the count.
#[node]
#[derive(Default)]
pub struct Heard {
    count: u64,
}

#[node]
impl Heard {
    #[slot]
    fn hung(&mut self, told: Event<u64>) {
        self.count += 1;
        told.emit(self.count);
    }

    #[slot]
    fn number(&mut self, number: &u64, told: Event<u64>) {
        told.emit(self.count << 32 | number & 0xffff);
    }
}

/// Reports that enough tokens have arrived.
#[node]
pub struct Enough {
    /// Number of tokens.
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

    /// Three threads that exchange tokens all the time.
    robot Crowd {
        // Sources without and with a period.
        node free   = dice();
        node pace   = dice() every 300us on arms;
        node own    = dice() every 500us on eyes;

        // A region on two threads.
        node far    = slow() on eyes;
        node sum    = both();
        free -> [far, sum.a];
        far  -> sum.b;
        sum  -> swallow();

        // Events in both directions, in a random order.
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

        // Activity in a cycle.
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

graph! {
    use crate::threads::{Enough, Heard, Stuck, dice, slow};

    /// A node hangs, others are late, and a node on another thread is notified.
    robot Troubles {
        thread main { hang = 40ms }
        node s      = dice() every 5ms;
        node stuck  = Stuck();
        node heard  = Heard() on ears;
        node late   = slow() on legs deadline 1us;
        node enough = Enough(after = 60);
        hung        -> heard.hung;
        s           -> [stuck, late];
        stuck       -> heard.number;
        late.late   -> heard.hung;
        heard.told  -> enough.more;
        enough.now  -> exit;
        record "troubles.mcap" { heard.told; late.late; }
    }

    /// A token is put in before the threads begin.
    graph Asked {
        slot question: u64;
        event answer: u64;
        node far    = Heard() on other;
        node enough = Enough(after = 1);
        question   -> far.number;
        far.told   -> [answer, enough.more];
        enough.now -> exit;
        record "asked.mcap" { far.told; }
    }
}

mod before {
    apex_macros::graph! {
        use crate::threads::{Enough, Heard};

        graph Asked {
            slot question: u64;
            node far    = Heard() on elsewhere;
            node enough = Enough(after = 1);
            question   -> far.number;
            far.told   -> enough.more;
            enough.now -> exit;
        }
    }
}

/// Runs a program on its threads and records it.
fn on_threads<P: Program>(program: &mut P, path: &Path) {
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    let (code, finished) = record_on_threads(program, pace, path, |_| ()).expect("room for the file");
    assert!(code == 0 && finished.dropped.is_empty() && finished.path == path, "{code} {finished:?}");
}

/// Changes the seeds of the nodes of its group before the third reaction, between which tokens come and go.
#[derive(Default)]
struct Reseed(u32);

impl Observer for Reseed {
    fn before_reaction(&mut self, _: Time, params: &mut impl Parameters) {
        self.0 += 1;
        if self.0 == 3 {
            for name in ["arms.seed", "eyes.seed", "head.seed"] {
                // It belongs to another group unless this succeeds.
                let _ = params.set_param(name, 77);
            }
        }
    }
}

fn crowd(path: &Path) -> Crowd {
    let mut program = Crowd::new();
    on_threads(&mut program, path);
    program
}

fn compared<'a>(report: &'a Report, name: &str) -> &'a Compared {
    report.compared.iter().find(|c| c.name == name).expect("it is compared")
}

#[test]
fn what_threads_do_is_the_same_again_and_again() {
    let folder = Folder::new();
    let same = |run: usize| {
        let path = folder.file(&format!("{run}.mcap"));
        let first = crowd(&path);
        for _ in 0..2 {
            let mut second = Crowd::new();
            let report = repeat(&mut second, &path);
            assert!(report.is_same() && report.missing.is_empty() && report.params.is_empty(), "{report}");
            assert_eq!(report.compared.len(), 6, "{report}");
            assert!(report.compared.iter().all(|c| c.equal > 10), "{report}");
            assert_eq!(first.nodes().again.count, second.nodes().again.count);
        }
    };
    // Side by side, so that threads wait for cores, too.
    thread::scope(|scope| {
        let halves = [0..15, 15..30];
        halves.into_iter().for_each(|runs| drop(scope.spawn(move || runs.for_each(same))));
    });
}

#[test]
fn another_graph_shows_the_first_difference_and_ends() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    crowd(&path);
    let mut other = Crowd::new();
    other.set_param("eyes.seed", 7).expect("there is one");
    let report = repeat(&mut other, &path);
    let (arms, eyes) = (compared(&report, "arms.told"), compared(&report, "eyes.told"));
    assert!(arms.different == 0 && arms.equal > 10, "what does not depend on it is the same: {report}");
    assert!(eyes.equal == 0 && eyes.first.is_some() && report.missed == 0, "{report}");
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
        let report = match replay(Crowd::new(), &cut, ()) {
            Ok(report) => report,
            // The file contains no reaction.
            Err(error) => {
                assert!(last == 0, "{part}: {error}");
                continue;
            }
        };
        assert!(report.is_same() && !report.is_whole(), "{part}: {report}");
        assert!(report.reactions >= last && report.reactions <= all, "{part}: {report}");
        last = report.reactions;
    }
    assert!(last > all / 2, "{last} of {all}");
}

#[test]
fn a_file_with_other_bits_never_hangs() {
    let folder = Folder::new();
    let (whole, bad) = (folder.file("whole.mcap"), folder.file("bad.mcap"));
    crowd(&whole);
    let bytes = fs::read(&whole).expect("it was written");
    for part in 0..40 {
        let mut bytes = bytes.clone();
        let at = part * (bytes.len() - 2000) / 40 + chance() as usize % 2000;
        bytes[at] ^= 0x55;
        fs::write(&bad, &bytes).expect("room for it");
        // Any result is valid, as long as there is one.
        let _ = replay(Crowd::new(), &bad, ());
    }
}

#[test]
fn a_file_that_lost_messages_never_hangs() {
    let folder = Folder::new();
    let (whole, lossy) = (folder.file("whole.mcap"), folder.file("lossy.mcap"));
    crowd(&whole);
    let bytes = fs::read(&whole).expect("it was written");
    let file = fs::File::create(&lossy).expect("room for it");
    let mut writer = mcap::WriteOptions::new().compression(None).create(file).expect("a writer");
    let groups: Vec<&str> = Crowd::INFO.groups.iter().map(|group| group.name).collect();
    let about = [("name", "Crowd".to_owned()), ("threads", groups.join(" "))];
    let metadata = about.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    let metadata = mcap::records::Metadata { name: "apex/program".to_owned(), metadata };
    writer.write_metadata(&metadata).expect("room for it");
    let mut looks = 0;
    for message in mcap::MessageStream::new(&bytes).expect("a recording") {
        let message = message.expect("a message");
        looks += u32::from(message.channel.topic == "/apex/looked");
        if message.channel.topic != "/apex/looked" || looks % 50 != 0 {
            writer.write(&message).expect("room for it");
        }
    }
    writer.finish().expect("room for it");
    let report = repeat(Crowd::new(), &lossy);
    assert!(looks > 500 && report.missed > 0 && !report.is_same(), "{looks} looks; {report}");
}

#[test]
fn tokens_that_do_not_come_any_more_are_not_waited_for() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    crowd(&path);
    let silent = || {
        let mut other = Crowd::new();
        other.set_param("arms.talks", 5).expect("there is one");
        let report = repeat(&mut other, &path);
        let nodes = other.nodes();
        (report, [&nodes.arms, &nodes.eyes, &nodes.head, &nodes.again].map(|node| node.mixed))
    };
    let (report, mixed) = silent();
    let arms = compared(&report, "arms.told");
    assert!(arms.equal == 5 && arms.different > 5 && report.missed > 0 && !report.is_same(), "{report}");
    let first = compared(&report, "arms.told").first.as_ref().expect("a difference");
    assert!(first.index == 5 && first.is.is_none(), "{report}");
    let (again, mixed_again) = silent();
    assert_eq!(report.to_string(), again.to_string(), "also what differs is the same each time");
    assert_eq!(mixed, mixed_again, "{report}");
}

#[test]
fn parameters_that_change_while_groups_run_change_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let pace = WallClock::new().pace().expect("it is the machine's clock");
    let mut first = Crowd::new();
    record_on_threads(&mut first, pace, &path, |_| Reseed::default()).expect("room for the file");
    let mut second = Crowd::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && report.params.is_empty(), "{report}");
    for name in ["arms.seed", "eyes.seed", "head.seed"] {
        assert_eq!((first.param(name), second.param(name)), (Ok(77), Ok(77)), "{name}");
    }
    let mut other = Crowd::new();
    other.set_param("eyes.seed", 5).expect("there is one");
    let report = repeat(&mut other, &path);
    assert_eq!(report.params, ["`eyes.seed` was 0 and is 5"], "{report}");
}

#[test]
fn nodes_that_hang_or_are_late_do_so_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    on_threads(&mut Troubles::new(), &path);
    let report = repeat(Troubles::new(), &path);
    assert!(report.is_same() && report.missed == 0, "{report}");
    assert!(compared(&report, "heard.told").equal >= 60 && compared(&report, "late.late").equal > 10, "{report}");
}

#[test]
fn what_was_put_in_before_is_there_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Asked::new();
    first.inputs().question.put(7).expect("there is room");
    on_threads(&mut first, &path);
    let mut second = Asked::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && compared(&report, "far.told").equal == 1, "{report}");
    assert_eq!((first.events().answer.take(), second.events().answer.take()), (Some(7), Some(7)));
}

#[test]
fn a_recording_of_other_threads_is_refused() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Asked::new();
    first.inputs().question.put(7).expect("there is room");
    on_threads(&mut first, &path);
    let error = replay(before::Asked::new(), &path, ()).expect_err("other threads").to_string();
    let end = "was recorded on the threads `main other`, but the program has `main elsewhere`: replay it with the same `on` as recorded";
    assert!(error.ends_with(end), "{error}");
}

#[test]
fn in_simulated_time_groups_are_recorded_and_repeated_in_turn() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Crowd::new();
    record::<Crowd>(&path, |tap| {
        drive_with(&mut first, SimClock::until(Time::from_millis(50)), tap);
    });
    let mut second = Crowd::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && report.reactions > 5 && compared(&report, "third.told").equal > 10, "{report}");
    assert_eq!(first.nodes().again.count, second.nodes().again.count);
}

//! Frames go through a ring of bytes to a thread that writes them into an MCAP file.

use super::{Channel, Schema, cdr::STD_HEADER};
use mcap::{WriteOptions, Writer, records::MessageHeader, records::Metadata};
use rtrb::{Consumer, Producer, RingBuffer};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, BufWriter},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    thread::{self, JoinHandle, Thread},
    time::{Duration, Instant},
};

/// So many bytes can wait to be written.
pub const ROOM: usize = 16 << 20;
/// What came within this time is written together; a power failure takes no more.
const FLUSH: Duration = Duration::from_millis(500);
/// How long the thread sleeps when it has written all there is: what comes meanwhile is written together. If nothing
/// comes, it sleeps until something does.
const NAP: Duration = Duration::from_millis(2);
/// The largest part of a file that is read and found as a whole.
const CHUNK: u64 = 1 << 20;

/// The channels that every recording has, before those of the program.
pub const REACTION: u16 = 0;
/// How long reactions had been going on, where a deadline asked.
pub const ELAPSED: u16 = 1;
/// Parameters, when they were set from outside.
pub const PARAMETER: u16 = 2;
/// Events of the program that were taken out.
pub const TAKEN: u16 = 3;
/// Looks at what is between groups of threads that found something.
pub const LOOKED: u16 = 4;
/// The end of a reaction of a group of threads.
pub const ENDED: u16 = 5;
/// The first channel of the program.
pub const FIRST: usize = 6;

/// The names and messages of the channels that every recording has.
pub const OWN: [(&str, Schema); FIRST] = [
    ("apex/reaction", own("apex_msgs/msg/Reaction", "uint32 group\nint64 nanoseconds")),
    ("apex/elapsed", own("apex_msgs/msg/Elapsed", "uint64 nanoseconds\nuint32 group")),
    ("apex/parameter", own("apex_msgs/msg/Parameter", "string name\nstring value\nbool changed")),
    ("apex/taken", own("apex_msgs/msg/Taken", "string event")),
    ("apex/looked", own("apex_msgs/msg/Looked", "uint32 group\nuint32 look")),
    ("apex/ended", own("apex_msgs/msg/Ended", "uint32 group")),
];

const fn own(name: &'static str, definition: &'static str) -> Schema {
    Schema { name, definition, encoding: "cdr" }
}

/// The name under which the file says what was lost.
pub const DROPPED: &str = "apex/dropped";
/// The name under which the file says what program was recorded.
pub const PROGRAM: &str = "apex/program";

/// In what the file says of the program: the groups of threads that ran side by side, if any did.
pub const THREADS: &str = "threads";

/// Bytes before each frame: channel, call, time, length.
const HEADER: usize = 2 + 4 + 8 + 4;

/// A message on its way to the ring.
#[derive(Default)]
pub struct Frame(Vec<u8>);

impl Frame {
    /// Begins a message; what is in it is written behind.
    pub fn begin(&mut self, channel: u16, call: u32, time: u64) -> &mut Vec<u8> {
        self.0.clear();
        self.0.extend_from_slice(&channel.to_le_bytes());
        self.0.extend_from_slice(&call.to_le_bytes());
        self.0.extend_from_slice(&time.to_le_bytes());
        self.0.extend_from_slice(&[0; 4]);
        &mut self.0
    }

    /// The bytes with their length; `None` if they are too many.
    fn whole(&mut self) -> Option<&[u8]> {
        let length = u32::try_from(self.0.len() - HEADER).ok()?;
        self.0[HEADER - 4..HEADER].copy_from_slice(&length.to_le_bytes());
        Some(&self.0)
    }
}

/// The near ends of the rings: one for each thread that writes, so that none of them ever waits for another one.
pub struct Sink {
    shared: Arc<Shared>,
    /// Until it has ended.
    thread: Option<JoinHandle<io::Result<()>>>,
}

/// What the near end of a ring and the thread at the far ends share.
struct Shared {
    over: AtomicBool,
    /// The thread sleeps until it is unparked.
    sleeps: AtomicBool,
    /// Messages that were lost, by channel.
    dropped: Box<[AtomicU64]>,
}

/// The near end of one ring.
pub struct Near {
    ring: Producer<u8>,
    shared: Arc<Shared>,
    far: Thread,
    /// Bytes of the largest frame that ever fits.
    room: usize,
}

impl Sink {
    /// Makes the file and begins to write, from so many `rings`. `about` says what program it is, and `room` bytes can
    /// wait in each ring. What is in the first ring is written before what is in the others, once it is
    /// [`settled`](Near::settle).
    pub fn new(
        path: PathBuf,
        about: BTreeMap<String, String>,
        channels: &[Channel],
        rings: usize,
        room: usize,
    ) -> io::Result<(Self, Vec<Near>)> {
        let (near, far): (Vec<_>, Vec<_>) = (0..rings).map(|_| RingBuffer::new(room)).unzip();
        let file = File::create_new(&path)?;
        let writer = open(file.try_clone()?, about, channels).map_err(as_io)?;
        let dropped = (0..FIRST + channels.len()).map(|_| AtomicU64::new(0)).collect();
        let shared = Arc::new(Shared { over: AtomicBool::new(false), sleeps: AtomicBool::new(false), dropped });
        let far = Far { rings: far, writer, file, shared: Arc::clone(&shared), frame: vec![], path };
        let thread = thread::Builder::new().name("apex-record".to_owned()).spawn(move || far.run())?;
        let near =
            near.into_iter().map(|ring| Near { ring, shared: Arc::clone(&shared), far: thread.thread().clone(), room });
        let near = near.collect();
        Ok((Self { shared, thread: Some(thread) }, near))
    }

    /// How many messages were lost, by channel.
    pub fn dropped(&self) -> impl Iterator<Item = u64> + '_ {
        self.shared.dropped.iter().map(|count| count.load(Ordering::Relaxed))
    }

    /// Writes what is left, and what was lost, and ends the file. `near` is any of the ends; the others are not used
    /// any more.
    pub fn finish(mut self, near: &mut Near, dropped: &[(String, u64)]) -> io::Result<()> {
        let fields: BTreeMap<String, String> = dropped.iter().map(|(name, n)| (name.clone(), n.to_string())).collect();
        if let Ok(text) = postcard::to_allocvec(&fields) {
            let mut frame = Frame::default();
            frame.begin(u16::MAX, 0, 0).extend_from_slice(&text);
            while !near.send(&mut frame) && near.may_fit(&frame) {
                thread::sleep(NAP);
            }
        }
        self.end()
    }

    /// Ends the file with what was sent.
    fn end(&mut self) -> io::Result<()> {
        let Some(thread) = self.thread.take() else { return Ok(()) };
        self.shared.over.store(true, Ordering::Release);
        self.shared.stir(thread.thread());
        thread.join().unwrap_or_else(|_| Err(io::Error::other("the thread that writes it panicked")))
    }
}

impl Drop for Sink {
    fn drop(&mut self) {
        let _ = self.end();
    }
}

impl Shared {
    /// Wakes the thread that writes, if it sleeps until somebody does. It says that it sleeps and looks once more; here
    /// one sends and asks then: whoever changes `sleeps` last has seen what the other did before.
    fn stir(&self, far: &Thread) {
        if self.sleeps.swap(false, Ordering::AcqRel) {
            far.unpark();
        }
    }
}

impl Near {
    /// Sends a message; whether there was room for it.
    pub fn send(&mut self, frame: &mut Frame) -> bool {
        let sent = frame.whole().is_some_and(|bytes| self.ring.push_entire_slice(bytes).is_ok());
        if sent {
            self.shared.stir(&self.far);
        }
        sent
    }

    /// Whether there will be room for a message, if one waits.
    pub fn may_fit(&self, frame: &Frame) -> bool {
        frame.0.len() <= self.room && !self.ring.is_abandoned()
    }

    /// A message of a channel was lost.
    pub fn lose(&self, channel: usize) {
        self.shared.dropped[channel].fetch_add(1, Ordering::Relaxed);
    }

    /// Waits until all that was sent is on its way to the file, before anything that is sent from now on by others.
    pub fn settle(&self) {
        while self.ring.slots() < self.room && !self.ring.is_abandoned() {
            thread::sleep(NAP);
        }
    }
}

type Out = Writer<BufWriter<File>>;

fn open(file: File, about: BTreeMap<String, String>, channels: &[Channel]) -> mcap::McapResult<Out> {
    let options = WriteOptions::new()
        .compression(None)
        .chunk_size(Some(CHUNK))
        // A chunk is written when it is whole: one that was begun could not be read.
        .disable_seeking(true)
        .profile("ros2")
        .library(concat!("apex ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(BufWriter::new(file))?;
    writer.write_metadata(&Metadata { name: PROGRAM.to_owned(), metadata: about })?;
    let own = OWN.iter().map(|(name, schema)| (*name, Some(*schema)));
    for (index, (name, schema)) in own.chain(channels.iter().map(|c| (c.name, c.schema))).enumerate() {
        let Some(schema) = schema else { continue };
        let header = if schema.definition.starts_with("std_msgs/Header ") { STD_HEADER } else { "" };
        let definition = format!("{}{header}", schema.definition);
        let encoding = if schema.encoding == "cdr" { "ros2msg" } else { "" };
        let id = writer.add_schema(schema.name, encoding, definition.as_bytes())?;
        writer.add_channel_with_id(index as u16, id, name, schema.encoding, &BTreeMap::new())?;
    }
    writer.flush()?;
    Ok(writer)
}

/// The far ends of the rings.
struct Far {
    rings: Vec<Consumer<u8>>,
    writer: Out,
    file: File,
    shared: Arc<Shared>,
    frame: Vec<u8>,
    path: PathBuf,
}

impl Far {
    fn run(mut self) -> io::Result<()> {
        let result = self.write_all().and_then(|()| self.writer.finish().map(drop).map_err(as_io));
        if let Err(error) = &result {
            eprintln!("error: cannot write `{}` any further: {error}", self.path.display());
            // The program goes on; what it says is dropped from now on, as the rings are abandoned.
        }
        result
    }

    fn write_all(&mut self) -> io::Result<()> {
        let (mut flushed, mut dirty, mut idle) = (Instant::now(), false, false);
        loop {
            // Asked before looking: what was sent before the end is then seen.
            let over = self.shared.over.load(Ordering::Acquire);
            let wrote = self.write_waiting(flushed + FLUSH)?;
            dirty |= wrote;
            if dirty && flushed.elapsed() >= FLUSH {
                self.writer.flush().map_err(as_io)?;
                self.file.sync_data()?;
                (flushed, dirty) = (Instant::now(), false);
            }
            if self.rings.iter().any(|ring| !ring.is_empty()) {
                continue;
            }
            if over {
                return Ok(());
            }
            if wrote || !idle {
                thread::sleep(NAP);
                idle = !wrote;
            } else {
                self.sleep(dirty.then(|| FLUSH.saturating_sub(flushed.elapsed())));
                // Nothing to flush came long ago.
                flushed = if dirty { flushed } else { Instant::now() };
                idle = false;
            }
        }
    }

    /// Sleeps until something is sent, or for some time.
    fn sleep(&self, time: Option<Duration>) {
        self.shared.sleeps.swap(true, Ordering::AcqRel);
        let is_quiet = self.rings.iter().all(Consumer::is_empty) && !self.shared.over.load(Ordering::Acquire);
        match time {
            _ if !is_quiet => {}
            Some(time) => thread::park_timeout(time),
            None => thread::park(),
        }
        self.shared.sleeps.store(false, Ordering::Release);
    }

    /// Writes what waits in the rings, one after the other, until `end`; whether there was anything.
    fn write_waiting(&mut self, end: Instant) -> io::Result<bool> {
        let mut any = false;
        for ring in 0..self.rings.len() {
            while self.write_one(ring)? {
                any = true;
                if Instant::now() >= end {
                    break;
                }
            }
        }
        Ok(any)
    }

    /// Writes a frame of a ring, if one is there.
    fn write_one(&mut self, ring: usize) -> io::Result<bool> {
        let (ring, mut head) = (&mut self.rings[ring], [0; HEADER]);
        // Frames come in one piece: with the head the rest is there.
        if ring.pop_entire_slice(&mut head).is_err() {
            return Ok(false);
        }
        let [c0, c1, s0, s1, s2, s3, t0, t1, t2, t3, t4, t5, t6, t7, l0, l1, l2, l3] = head;
        let length = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
        self.frame.resize(length, 0);
        let _ = ring.pop_entire_slice(&mut self.frame);
        let channel_id = u16::from_le_bytes([c0, c1]);
        if channel_id == u16::MAX {
            return self.write_dropped().map(|()| true);
        }
        let time = u64::from_le_bytes([t0, t1, t2, t3, t4, t5, t6, t7]);
        let sequence = u32::from_le_bytes([s0, s1, s2, s3]);
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, &self.frame).map_err(as_io)?;
        Ok(true)
    }

    fn write_dropped(&mut self) -> io::Result<()> {
        let metadata = postcard::from_bytes(&self.frame).unwrap_or_default();
        self.writer.write_metadata(&Metadata { name: DROPPED.to_owned(), metadata }).map_err(as_io)
    }
}

fn as_io(error: mcap::McapError) -> io::Error {
    match error {
        mcap::McapError::Io(error) => error,
        other => io::Error::other(other),
    }
}

/// `path`, or, as nothing is overwritten, the first of `run-2.mcap`, `run-3.mcap` … that is not there yet.
pub fn free(path: &Path) -> PathBuf {
    let (stem, end) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let numbered = |n: u32| {
        let mut name = stem.to_owned();
        name.push(format!("-{n}"));
        let mut file = path.with_file_name(name);
        if !end.is_empty() {
            // `with_extension` would take a part of a name with points for one.
            file.as_mut_os_string().push(".");
            file.as_mut_os_string().push(end);
        }
        file
    };
    let taken = |path: &PathBuf| path.symlink_metadata().is_ok();
    std::iter::once(path.to_owned()).chain((2..).map(numbered)).find(|p| !taken(p)).unwrap_or_else(|| path.to_owned())
}

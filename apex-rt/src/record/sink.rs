//! Output of recordings: frames pass through rings of bytes to a thread that writes them into an MCAP file.

use super::{Channel, Schema};
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

/// Size of a ring, in bytes.
pub const ROOM: usize = 16 << 20;
/// Time between two writes to the disk; a power failure destroys no more than that.
const FLUSH: Duration = Duration::from_millis(500);
/// Sleep of the thread when it has written all frames, so that later frames are written together. If no frame comes
/// meanwhile, it sleeps until one does.
const NAP: Duration = Duration::from_millis(2);
/// Size of a chunk of the file, in bytes. A chunk is read and indexed as a whole.
const CHUNK: u64 = 1 << 20;

/// Beginnings of reactions. The channels that every recording has come before those of the program.
pub const REACTION: u16 = 0;
/// Times since the beginning of a reaction, for deadlines.
pub const ELAPSED: u16 = 1;
/// Parameters that were set from outside.
pub const PARAMETER: u16 = 2;
/// Events of the program that were taken out.
pub const TAKEN: u16 = 3;
/// Checks of cells between thread groups that found something.
pub const LOOKED: u16 = 4;
/// Ends of reactions of a thread group.
pub const ENDED: u16 = 5;
/// Number of the first channel of the program.
pub const FIRST: usize = 6;

/// Names and schemas of the channels that every recording has.
pub const OWN: [(&str, Schema); FIRST] = [
    ("apex/reaction", own("apex_msgs/msg/Reaction", "uint32 group\nint64 nanoseconds")),
    ("apex/elapsed", own("apex_msgs/msg/Elapsed", "uint64 nanoseconds\nuint32 group")),
    ("apex/parameter", own("apex_msgs/msg/Parameter", "string name\nstring value\nbool changed\nuint32 group")),
    ("apex/taken", own("apex_msgs/msg/Taken", "string event")),
    ("apex/looked", own("apex_msgs/msg/Looked", "uint32 group\nuint32 look")),
    ("apex/ended", own("apex_msgs/msg/Ended", "uint32 group")),
];

const fn own(name: &'static str, definition: &'static str) -> Schema {
    Schema { name, definition, encoding: "cdr" }
}

/// Name of the metadata with the numbers of lost messages.
pub const DROPPED: &str = "apex/dropped";
/// Name of the metadata on the recorded program.
pub const PROGRAM: &str = "apex/program";

/// Key of the thread groups that ran in parallel, in the metadata on the program.
pub const THREADS: &str = "threads";

/// Encoding of the schemas of types that are not messages.
const SHAPE: &str = "apex";

/// Length of the header of each frame, in bytes: channel, call, time, length.
const HEADER: usize = 2 + 4 + 8 + 4;

/// A message for the ring, with its header.
#[derive(Default)]
pub struct Frame(Vec<u8>);

impl Frame {
    /// Begins a message. Its content is appended to the result.
    pub fn begin(&mut self, channel: u16, call: u32, time: u64) -> &mut Vec<u8> {
        self.0.clear();
        self.0.extend_from_slice(&channel.to_le_bytes());
        self.0.extend_from_slice(&call.to_le_bytes());
        self.0.extend_from_slice(&time.to_le_bytes());
        self.0.extend_from_slice(&[0; 4]);
        &mut self.0
    }

    /// Returns the bytes of header and message; `None` if the message is too long.
    fn whole(&mut self) -> Option<&[u8]> {
        let length = u32::try_from(self.0.len() - HEADER).ok()?;
        self.0[HEADER - 4..HEADER].copy_from_slice(&length.to_le_bytes());
        Some(&self.0)
    }
}

/// Access to the thread that writes the file. Each thread that sends has a ring of its own, so that none ever waits for
/// another.
pub struct Sink {
    shared: Arc<Shared>,
    /// The thread, until it has ended.
    thread: Option<JoinHandle<io::Result<()>>>,
}

/// State that the sending ends and the writing thread share.
struct Shared {
    over: AtomicBool,
    /// `true` if the thread sleeps until it is unparked.
    sleeps: AtomicBool,
    /// Numbers of lost messages, by channel.
    dropped: Box<[AtomicU64]>,
}

/// The sending end of a ring.
pub struct Near {
    ring: Producer<u8>,
    shared: Arc<Shared>,
    far: Thread,
    /// Size of the ring, and thus of the largest frame that fits, in bytes.
    room: usize,
}

impl Sink {
    /// Creates the file, and starts the thread that writes frames from `rings` rings of `room` bytes. `about` is the
    /// metadata on the program. Frames in the first ring are written before those that other rings get after
    /// [`settle`](Near::settle).
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

    /// Returns the numbers of lost messages, by channel.
    pub fn dropped(&self) -> impl Iterator<Item = u64> + '_ {
        self.shared.dropped.iter().map(|count| count.load(Ordering::Relaxed))
    }

    /// Writes all remaining frames and the numbers of lost messages, and ends the file. `near` is any of the sending
    /// ends; the others are not used any more.
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

    /// Ends the file after all frames that were sent.
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
    /// Wakes the thread that writes, if it sleeps. That thread sets `sleeps` and then looks at the rings once more; the
    /// caller sends a frame and then clears `sleeps`. The one that changes `sleeps` last sees what the other did
    /// before.
    fn stir(&self, far: &Thread) {
        if self.sleeps.swap(false, Ordering::AcqRel) {
            far.unpark();
        }
    }
}

impl Near {
    /// Sends a message. Returns `false` if there is no room for it.
    pub fn send(&mut self, frame: &mut Frame) -> bool {
        let sent = frame.whole().is_some_and(|bytes| self.ring.push_entire_slice(bytes).is_ok());
        if sent {
            self.shared.stir(&self.far);
        }
        sent
    }

    /// Returns `true` if there will be room for a message after a wait.
    pub fn may_fit(&self, frame: &Frame) -> bool {
        frame.0.len() <= self.room && !self.ring.is_abandoned()
    }

    /// Counts a lost message of a channel.
    pub fn lose(&self, channel: usize) {
        self.shared.dropped[channel].fetch_add(1, Ordering::Relaxed);
    }

    /// Waits until the ring is empty: all its frames then come before those that other rings get from now on.
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
        // A chunk is written as a whole: an incomplete one could not be read.
        .disable_seeking(true)
        .profile("ros2")
        .library(concat!("apex ", env!("CARGO_PKG_VERSION")));
    let mut writer = options.create(BufWriter::new(file))?;
    writer.write_metadata(&Metadata { name: PROGRAM.to_owned(), metadata: about })?;
    let own = OWN.iter().map(|(name, schema)| (*name, Some((*schema, schema.complete_definition()))));
    let others = channels.iter().map(|c| (c.name, c.schema.map(|schema| (schema, (c.shape)()))));
    for (index, (name, schema)) in own.chain(others).enumerate() {
        let Some((schema, shape)) = schema else { continue };
        let encoding = if schema.encoding == "cdr" { "ros2msg" } else { SHAPE };
        let id = writer.add_schema(schema.name, encoding, shape.as_bytes())?;
        writer.add_channel_with_id(index as u16, id, name, schema.encoding, &BTreeMap::new())?;
    }
    writer.flush()?;
    Ok(writer)
}

/// The receiving ends of the rings, on the thread that writes.
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
            // The program continues. Its messages are dropped from now on, because the rings are abandoned.
        }
        result
    }

    fn write_all(&mut self) -> io::Result<()> {
        let (mut flushed, mut dirty, mut idle) = (Instant::now(), false, false);
        loop {
            // Loaded before the rings are read, so that all frames from before the end are seen.
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
                // Without unflushed data the time until the next flush begins now.
                flushed = if dirty { flushed } else { Instant::now() };
                idle = false;
            }
        }
    }

    /// Sleeps until a frame is sent, at most for `time`.
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

    /// Writes the frames of all rings in sequence, until `end`. Returns `true` if there were any.
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

    /// Writes a frame of a ring. Returns `false` if there is none.
    fn write_one(&mut self, ring: usize) -> io::Result<bool> {
        let (ring, mut head) = (&mut self.rings[ring], [0; HEADER]);
        // A frame is pushed as a whole: if its header is there, so is the rest.
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

/// Returns `path`, or the first of `run-2.mcap`, `run-3.mcap`, … that does not exist: nothing is overwritten.
pub fn free(path: &Path) -> PathBuf {
    let (stem, end) = (path.file_stem().unwrap_or_default(), path.extension().unwrap_or_default());
    let numbered = |n: u32| {
        let mut name = stem.to_owned();
        name.push(format!("-{n}"));
        let mut file = path.with_file_name(name);
        if !end.is_empty() {
            // `with_extension` would replace the last part of a name with dots.
            file.as_mut_os_string().push(".");
            file.as_mut_os_string().push(end);
        }
        file
    };
    let taken = |path: &PathBuf| path.symlink_metadata().is_ok();
    std::iter::once(path.to_owned()).chain((2..).map(numbered)).find(|p| !taken(p)).unwrap_or_else(|| path.to_owned())
}

//! Output of recordings: frames pass through rings of bytes to a thread that writes them into an MCAP file.

use super::{
    Channel, Schema,
    file::{Head, Out},
    limits::{Files, RecordOptions, first_free},
};
use apex_bag::format::{CHANNEL_NAME, DROPPED, GOES_ON, MESSAGES, NEXT, NUMBER, PROGRAM, SHAPE};
use rtrb::{Consumer, Producer, RingBuffer};
use std::{
    collections::BTreeMap,
    fs::File,
    io,
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
/// Time that the thread has to end the file if the process ends without its threads.
const LAST: Duration = Duration::from_secs(2);
/// Size of a chunk of the file, in bytes. A chunk is read and indexed as a whole.
const CHUNK: usize = 1 << 20;

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
    ("apex/reaction", own("apex_msgs/msg/Reaction", "uint32 group\nint64 nanoseconds\nbool ends_early")),
    ("apex/elapsed", own("apex_msgs/msg/Elapsed", "uint64 nanoseconds\nuint32 group")),
    ("apex/parameter", own("apex_msgs/msg/Parameter", "string name\nstring value\nbool changed\nuint32 group")),
    ("apex/taken", own("apex_msgs/msg/Taken", "string event")),
    ("apex/looked", own("apex_msgs/msg/Looked", "uint32 group\nuint32 look")),
    ("apex/ended", own("apex_msgs/msg/Ended", "uint32 group")),
];

const fn own(name: &'static str, definition: &'static str) -> Schema {
    Schema { name, definition, encoding: "cdr" }
}

/// Number in the header of a frame with the numbers of lost messages.
const LOST: u16 = u16::MAX;
/// Number in the header of a frame after which the next file begins.
const FILE: u16 = u16::MAX - 1;

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
    thread: Option<JoinHandle<io::Result<Vec<PathBuf>>>>,
}

/// State that the sending ends and the writing thread share.
struct Shared {
    over: AtomicBool,
    /// `true` if the thread sleeps until it is unparked.
    sleeps: AtomicBool,
    /// Numbers of lost messages, by channel.
    dropped: Box<[AtomicU64]>,
    /// Number of the file that shall be written. Senders begin it between two reactions.
    file: AtomicU64,
    /// `true` when the thread has ended.
    has_ended: AtomicBool,
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
    /// [`settle`](Near::settle). Also returns the path of the file.
    pub fn new(
        path: &Path,
        options: RecordOptions,
        about: BTreeMap<String, String>,
        channels: &[Channel],
        rings: usize,
        room: usize,
    ) -> io::Result<(Self, Vec<Near>, PathBuf)> {
        // What waits in the rings goes into the present file, which must not exceed the limit.
        let room = options.check()?.limit.map_or(room, |limit| room.min((limit / 16) as usize));
        let (near, far): (Vec<_>, Vec<_>) = (0..rings).map(|_| RingBuffer::new(room)).unzip();
        let files = options.divides().then(|| Files::new(path, options));
        let path = files.as_ref().map_or_else(|| free(path), Files::path);
        let beginning = Beginning { about, channels: rows(channels), compress: options.compress };
        let (file, out) = beginning.file(&path, files.as_ref().map(Files::number))?;
        let dropped = (0..FIRST + channels.len()).map(|_| AtomicU64::new(0)).collect();
        let (over, sleeps) = (AtomicBool::new(false), AtomicBool::new(false));
        let shared =
            Arc::new(Shared { over, sleeps, dropped, file: AtomicU64::new(1), has_ended: AtomicBool::new(false) });
        let far = Far {
            rings: far,
            out: Some(out),
            file,
            files,
            beginning,
            shared: Arc::clone(&shared),
            frame: vec![],
            path: path.clone(),
        };
        let ended = Arc::clone(&shared);
        let thread = thread::Builder::new().name("apex-record".to_owned()).spawn(move || {
            let paths = far.run();
            ended.has_ended.store(true, Ordering::Release);
            paths
        })?;
        let (left, far) = (Arc::downgrade(&shared), thread.thread().clone());
        crate::end::finish_at_exit(move || {
            if let Some(shared) = left.upgrade() {
                shared.end(&far);
            }
        });
        let near =
            near.into_iter().map(|ring| Near { ring, shared: Arc::clone(&shared), far: thread.thread().clone(), room });
        let near = near.collect();
        Ok((Self { shared, thread: Some(thread) }, near, path))
    }

    /// Returns the numbers of lost messages, by channel.
    pub fn dropped(&self) -> impl Iterator<Item = u64> + '_ {
        self.shared.dropped.iter().map(|count| count.load(Ordering::Relaxed))
    }

    /// Writes all remaining frames and the numbers of lost messages, and ends the file. `near` is any of the sending
    /// ends; the others are not used any more. Returns the paths of all files.
    pub fn finish(mut self, near: &mut Near, dropped: &[(String, u64)]) -> io::Result<Vec<PathBuf>> {
        let fields: BTreeMap<String, String> = dropped.iter().map(|(name, n)| (name.clone(), n.to_string())).collect();
        if let Ok(text) = postcard::to_allocvec(&fields) {
            let mut frame = Frame::default();
            frame.begin(LOST, 0, 0).extend_from_slice(&text);
            while !near.send(&mut frame) && near.may_fit(&frame) {
                thread::sleep(NAP);
            }
        }
        self.end()
    }

    /// Ends the file after all frames that were sent.
    fn end(&mut self) -> io::Result<Vec<PathBuf>> {
        let Some(thread) = self.thread.take() else { return Ok(vec![]) };
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
    /// Lets the thread write what was sent, and end the file, within a time limit. For the end of a process in which a
    /// node hangs: the groups that still run may lose their last frames.
    fn end(&self, far: &Thread) {
        let begun = Instant::now();
        self.over.store(true, Ordering::Release);
        self.stir(far);
        while !self.has_ended.load(Ordering::Acquire) && begun.elapsed() < LAST {
            thread::sleep(NAP);
        }
    }

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

    /// Number of the file that shall be written.
    pub fn file(&self) -> u64 {
        self.shared.file.load(Ordering::Relaxed)
    }

    /// Requests that the file after `number` is written.
    pub fn end_file(&self, number: u64) {
        self.shared.file.fetch_max(number + 1, Ordering::Relaxed);
    }

    /// Lets all later messages go into the file `number`. Returns `false` if there is no room to say so.
    pub fn begin_file(&mut self, number: u64) -> bool {
        let mut frame = Frame::default();
        frame.begin(FILE, 0, number);
        self.send(&mut frame)
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

/// Topic of a channel: its name in the form that ROS 2 allows, such as `/laser/scan` for `laser.scan`.
fn topic(name: &str) -> String {
    let mut topic = String::with_capacity(name.len() + 1);
    for part in name.split(['.', '/']).filter(|part| !part.is_empty()) {
        topic.push('/');
        // A part does not begin with a digit.
        if part.starts_with(|letter: char| letter.is_ascii_digit()) {
            topic.push('_');
        }
        topic.extend(part.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }));
    }
    topic
}

/// A channel in a file: name, encoding, and the name, encoding and text of its schema.
type Row = (u16, &'static str, &'static str, (&'static str, &'static str, String));

fn rows(channels: &[Channel]) -> Vec<Row> {
    let own = OWN.iter().map(|(name, schema)| Some((*name, *schema, schema.complete_definition())));
    let others = channels.iter().map(|c| c.schema.map(|schema| (c.name, schema, (c.shape)())));
    let all = own.chain(others).enumerate().filter_map(|(index, row)| Some((index as u16, row?)));
    all.map(|(id, (name, schema, shape))| {
        let encoding = if schema.encoding == "cdr" { MESSAGES } else { SHAPE };
        (id, name, schema.encoding, (schema.name, encoding, shape))
    })
    .collect()
}

/// The part that all files of a recording begin with.
struct Beginning {
    about: BTreeMap<String, String>,
    channels: Vec<Row>,
    compress: bool,
}

impl Beginning {
    /// Creates a file, which has a number in a recording that is divided.
    fn file(&self, path: &Path, number: Option<u64>) -> io::Result<(File, Out)> {
        let file = File::create_new(path)?;
        let mut out = Out::new(file.try_clone()?, self.compress)?;
        let mut about = self.about.clone();
        about.extend(number.map(|number| (NUMBER.to_owned(), number.to_string())));
        out.metadata(PROGRAM, &about)?;
        for (id, name, encoding, (schema, schema_encoding, text)) in &self.channels {
            let metadata = (CHANNEL_NAME, *name);
            out.channel(*id, &topic(name), metadata, encoding, (schema, schema_encoding, text))?;
        }
        out.flush()?;
        Ok((file, out))
    }
}

/// The receiving ends of the rings, on the thread that writes.
struct Far {
    rings: Vec<Consumer<u8>>,
    /// The file that is being written; `None` after an error.
    out: Option<Out>,
    file: File,
    /// The files of a recording that is divided.
    files: Option<Files>,
    beginning: Beginning,
    shared: Arc<Shared>,
    frame: Vec<u8>,
    path: PathBuf,
}

impl Far {
    fn run(mut self) -> io::Result<Vec<PathBuf>> {
        let result = self.write_all().and_then(|()| self.end_chunk()).and_then(|()| self.end_file());
        if let Err(error) = &result {
            eprintln!("error: cannot write `{}` any further: {error}", self.path.display());
            // The program continues. Its messages are dropped from now on, because the rings are abandoned.
        }
        result.map(|()| self.files.as_ref().map_or_else(|| vec![self.path.clone()], Files::paths))
    }

    /// Ends the file with its index.
    fn end_file(&mut self) -> io::Result<()> {
        self.out.take().map_or(Ok(()), Out::finish)
    }

    fn out(&mut self) -> io::Result<&mut Out> {
        self.out.as_mut().ok_or_else(|| io::Error::other("it has ended"))
    }

    /// Ends the chunk. Of a recording that is divided, old files make room for it before.
    fn end_chunk(&mut self) -> io::Result<()> {
        if let (Some(files), Some(out)) = (&mut self.files, &self.out) {
            files.make_room(out.size() + out.rest(), out.last())?;
        }
        self.out()?.end_chunk()?;
        if let (Some(files), Some(out)) = (&self.files, &self.out)
            && files.is_full(out.size())
        {
            self.shared.file.fetch_max(files.number() + 1, Ordering::Relaxed);
        }
        Ok(())
    }

    /// Ends the file, and goes on to the next one, if it is the one before `number`. Several threads send messages: the
    /// first one of them begins the file for all.
    fn begin_file(&mut self, number: u64) -> io::Result<()> {
        if self.files.as_ref().is_none_or(|files| files.number() + 1 != number) {
            return Ok(());
        }
        self.end_chunk()?;
        let (Some(files), Some(out)) = (&mut self.files, self.out.as_mut()) else { return Ok(()) };
        let next = files.next();
        let name = next.file_name().unwrap_or_default().to_string_lossy().into_owned();
        out.metadata(GOES_ON, &BTreeMap::from([(NEXT.to_owned(), name)]))?;
        let (size, last) = (out.size() + out.rest(), out.last());
        files.advance(size, last);
        self.end_file()?;
        let (file, out) = self.beginning.file(&next, Some(number))?;
        (self.file, self.out, self.path) = (file, Some(out), next);
        Ok(())
    }

    fn write_all(&mut self) -> io::Result<()> {
        let (mut flushed, mut dirty, mut idle) = (Instant::now(), false, false);
        loop {
            // Loaded before the rings are read, so that all frames from before the end are seen.
            let over = self.shared.over.load(Ordering::Acquire);
            let wrote = self.write_waiting(flushed + FLUSH)?;
            dirty |= wrote;
            if dirty && flushed.elapsed() >= FLUSH {
                self.end_chunk()?;
                self.out()?.flush()?;
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
        let time = u64::from_le_bytes([t0, t1, t2, t3, t4, t5, t6, t7]);
        match u16::from_le_bytes([c0, c1]) {
            LOST => self.write_dropped()?,
            FILE => self.begin_file(time)?,
            channel => {
                let sequence = u32::from_le_bytes([s0, s1, s2, s3]);
                self.write_message(&Head { channel, sequence, time })?;
            }
        }
        Ok(true)
    }

    fn write_message(&mut self, head: &Head) -> io::Result<()> {
        let frame = std::mem::take(&mut self.frame);
        let out = self.out()?;
        out.message(head, &frame);
        let is_full = out.chunk_len() >= CHUNK;
        self.frame = frame;
        if is_full { self.end_chunk() } else { Ok(()) }
    }

    fn write_dropped(&mut self) -> io::Result<()> {
        let metadata = postcard::from_bytes(&self.frame).unwrap_or_default();
        self.out()?.metadata(DROPPED, &metadata)
    }
}

/// Returns `path`, or the first of `run-2.mcap`, `run-3.mcap`, … that does not exist: nothing is overwritten.
pub fn free(path: &Path) -> PathBuf {
    first_free(path, |path| path.symlink_metadata().is_ok())
}

#[cfg(test)]
mod tests {
    use super::topic;

    #[test]
    fn topics_are_names_that_ros_allows() {
        for (name, expected) in [
            ("laser.scan", "/laser/scan"),
            ("find.jumps.segments", "/find/jumps/segments"),
            ("apex/reaction", "/apex/reaction"),
            ("start", "/start"),
            ("merge.2", "/merge/_2"),
            ("a[0].b", "/a_0_/b"),
        ] {
            assert_eq!(topic(name), expected);
        }
    }
}

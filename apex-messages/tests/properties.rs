//! Encoding of all messages: an encoder that follows the definitions writes random values in both orders of bytes. They
//! are read and written again. Damaged bytes are refused without a panic and without much memory.

use apex_messages::{ALL, Known};
use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
    collections::BTreeMap,
    env,
    path::Path,
    process::{Command, Stdio},
};

/// Number of random values for all messages together, in each order.
const VALUES: usize = 100_000;
/// Number of damaged messages, unless `APEX_DAMAGED` is another one.
const DAMAGED: usize = 200_000;

thread_local! {
    /// Bytes that the thread has allocated.
    static ALLOCATED: Cell<usize> = const { Cell::new(0) };
}

/// The allocator of the system, which counts.
struct Counting;

#[allow(unsafe_code, reason = "an allocator")]
// SAFETY: all calls are passed on to the system.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = ALLOCATED.try_with(|bytes| bytes.set(bytes.get() + layout.size()));
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// Type and name of each field, by message.
type Fields<'a> = BTreeMap<&'a str, Vec<(&'a str, &'a str)>>;

/// Fields of a message and of those in it, by the names in the definition; that of the message itself is empty.
fn fields(definition: &str) -> Fields<'_> {
    let (mut fields, mut name) = (Fields::new(), "");
    fields.insert(name, vec![]);
    for line in definition.lines().filter(|line| !line.is_empty() && !line.starts_with("===")) {
        if let Some(next) = line.strip_prefix("MSG: ") {
            name = next;
            fields.entry(name).or_default();
        } else if let [ty, field, ..] = line.split(' ').collect::<Vec<_>>().as_slice()
            && !field.contains('=')
        {
            fields.entry(name).or_default().push((ty, field));
        }
    }
    fields
}

/// Encoder of random values.
struct Encoder<'a> {
    fields: &'a Fields<'a>,
    random: &'a mut Random,
    is_big: bool,
    /// No NaN is signalling.
    quiet: bool,
    bytes: Vec<u8>,
}

impl Encoder<'_> {
    fn number(&mut self, size: usize) {
        while !(self.bytes.len() - 4).is_multiple_of(size) {
            self.bytes.push(0);
        }
        (0..size).for_each(|_| self.bytes.push(self.random.next() as u8));
    }

    fn length(&mut self, length: usize) {
        let at = self.bytes.len();
        self.number(4);
        let number = (length as u32).to_le_bytes();
        let end = self.bytes.len();
        assert!(end - at < 8);
        self.bytes[end - 4..].copy_from_slice(&number);
        if self.is_big {
            self.bytes[end - 4..].reverse();
        }
    }

    fn message(&mut self, name: &str) {
        let fields = &self.fields[name];
        if fields.is_empty() {
            self.bytes.push(0);
        }
        for (ty, _) in fields {
            let (element, many) =
                ty.split_once('[').map_or((*ty, None), |(ty, many)| (ty, Some(many.trim_end_matches(']'))));
            let count = match many {
                None => 1,
                Some("") => self.random.below(4),
                Some(bound) => match bound.strip_prefix("<=") {
                    Some(most) => self.random.below(4.min(most.parse::<usize>().expect("a bound") + 1)),
                    None => bound.parse().expect("a number"),
                },
            };
            if many.is_some_and(|many| many.is_empty() || many.starts_with('<')) {
                self.length(count);
            }
            (0..count).for_each(|_| self.element(element));
        }
    }

    fn element(&mut self, ty: &str) {
        match ty {
            "bool" => {
                let bit = self.random.next() as u8 & 1;
                self.bytes.push(bit);
            }
            "byte" | "int8" | "uint8" => self.number(1),
            "int16" | "uint16" => self.number(2),
            "float32" => {
                self.number(4);
                // Python makes signalling NaN quiet. Other bits are kept, in all fields.
                let at = self.bytes.len() - if self.is_big { 3 } else { 2 };
                self.bytes[at] |= if self.quiet { 0x40 } else { 0 };
            }
            "int32" | "uint32" => self.number(4),
            "int64" | "uint64" | "float64" => self.number(8),
            ty if ty.starts_with("string") => {
                let texts = ["", "a", "map", "zwölf", "base_link"];
                let text = texts[self.random.below(texts.len())];
                self.length(text.len() + 1);
                self.bytes.extend_from_slice(text.as_bytes());
                self.bytes.push(0);
            }
            ty => self.message(ty),
        }
    }
}

/// Bytes of a random value.
fn value(fields: &Fields<'_>, random: &mut Random, is_big: bool, quiet: bool) -> Vec<u8> {
    let bytes = vec![0, u8::from(!is_big), 0, 0];
    let mut encoder = Encoder { fields, random, is_big, quiet, bytes };
    encoder.message("");
    encoder.bytes
}

#[test]
fn random_values_come_back_in_both_orders() {
    let mut random = Random(7);
    let rounds = VALUES.div_ceil(ALL.len());
    for Known { name, definition, again, .. } in ALL {
        let fields = fields(definition);
        for _ in 0..rounds {
            for is_big in [false, true] {
                let bytes = value(&fields, &mut random, is_big, false);
                assert_eq!(again(&bytes).as_deref(), Ok(&bytes[..]), "{name}");
                // The last bytes may be those of an empty list.
                let part = again(&bytes[..bytes.len() - 1]);
                assert!(part.is_err(), "{name}: a byte less");
            }
        }
    }
}

#[test]
fn damaged_messages_are_refused_with_little_memory() {
    let count = env::var("APEX_DAMAGED").map_or(DAMAGED, |count| count.parse().expect("a number"));
    let mut random = Random(11);
    for round in 0..count {
        let Known { name, definition, again, .. } = ALL[round % ALL.len()];
        let mut bytes = value(&fields(definition), &mut random, round % 2 == 0, false);
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            bytes[at] = [0, 255, random.next() as u8][random.below(3)];
        }
        bytes.truncate(bytes.len() - random.below(bytes.len().min(9)));
        let before = ALLOCATED.get();
        let _ = again(&bytes);
        let taken = ALLOCATED.get() - before;
        // An element of a list is larger than its bytes: an empty text of five is a `String` of 24.
        let most = 4096 + 64 * bytes.len();
        assert!(taken <= most, "{name}: {taken} bytes for {}", bytes.len());
    }
}

/// Checks random values and hashes of all messages.
const PYTHON: &str = "import sys
from rosbags.typesys import Stores, get_typestore
stores = [get_typestore(getattr(Stores, 'ROS2_' + name)) for name in 'KILTED JAZZY IRON HUMBLE'.split()]
lyrical = getattr(Stores, 'ROS2_LYRICAL', None)
stores += [get_typestore(lyrical)] if lyrical else []
values = types = 0
for line in sys.stdin:
    name, hash, *data = line.split()
    known = [store for store in stores if name in store.fielddefs]
    if not known:
        print('unknown', name)
        continue
    types += 1
    hashes = {store.hash_rihs01(name) for store in known}
    if hash not in hashes or len(hashes) > 1:
        print('hash', name)
    for text in data:
        raw = bytes.fromhex(text)
        again = known[0].serialize_cdr(known[0].deserialize_cdr(raw, name), name, little_endian=raw[1] == 1)
        values += 1
        if bytes(again)[:len(raw)] != raw or any(again[len(raw):]):
            print('value', name)
print('compared', types, values)
";

#[test]
fn the_python_package_rosbags_reads_the_same() {
    use std::io::Write as _;
    let environment = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python").join("bin/python3");
    let python = [environment.as_path(), Path::new("python3")].into_iter().find(|python| {
        Command::new(python).args(["-c", "import rosbags"]).output().is_ok_and(|output| output.status.success())
    });
    let Some(python) = python else {
        println!("skipped: no Python has `rosbags`");
        return;
    };
    let mut random = Random(13);
    let mut lines = String::new();
    let messages = ALL.iter().filter(|known| known.name.contains("/msg/"));
    for Known { name, definition, hash, .. } in messages {
        let fields = fields(definition);
        lines.push_str(&format!("{name} {hash}"));
        for round in 0..20 {
            let hex: String =
                value(&fields, &mut random, round % 2 == 0, true).iter().map(|b| format!("{b:02x}")).collect();
            lines.push_str(&format!(" {hex}"));
        }
        lines.push('\n');
    }
    let mut child = Command::new(python)
        .args(["-c", PYTHON])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("python runs");
    child.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let mut lines: Vec<&str> = said.lines().collect();
    let compared = lines.pop().unwrap_or_default();
    lines.sort_unstable();
    // `char` is the same type as `uint8` for ROS 2, and another one for rosbags. The hash of the service
    // `example_interfaces/srv/AddTwoInts`, in which `ServiceEventInfo` is, is published, and ours. The others were
    // changed after Humble, and in Lyrical.
    let expected = [
        "hash lifecycle_msgs/msg/TransitionEvent",
        "hash sensor_msgs/msg/Range",
        "hash service_msgs/msg/ServiceEventInfo",
        "hash std_msgs/msg/Char",
        "unknown foxglove_msgs/msg/Grid",
        "unknown foxglove_msgs/msg/PackedElementField",
        "unknown foxglove_msgs/msg/Vector2",
    ];
    assert_eq!(lines, expected, "{compared}");
    assert!(compared.starts_with("compared 1"), "{compared}");
}

//! Behaviour of scripted nodes, as a function of their parameters and of the number of calls.

use apex_rt::Event;
use std::{
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, ThreadId},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

/// Notes with their threads: lines in the order in which they were written.
static NOTES: Mutex<Vec<(ThreadId, String)>> = Mutex::new(vec![]);

/// `true` to pause before each note, so that threads run in orders that are rare on an idle machine.
static UNEVEN: AtomicBool = AtomicBool::new(false);

/// Enables pauses before notes.
pub fn run_unevenly() {
    UNEVEN.store(true, Ordering::Relaxed);
}

/// Writes a line.
pub fn note(line: std::fmt::Arguments<'_>) {
    let (thread, line) = (thread::current().id(), line.to_string());
    if UNEVEN.load(Ordering::Relaxed) {
        // A pause of 0 to 40 µs, from the last digits of the clock.
        let digits = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.subsec_nanos() / 7 % 40);
        thread::sleep(Duration::from_micros(digits.into()));
    }
    NOTES.lock().unwrap_or_else(PoisonError::into_inner).push((thread, line));
}

/// Takes all notes since the previous call of this function.
pub fn take_notes() -> String {
    let notes = std::mem::take(&mut *NOTES.lock().unwrap_or_else(PoisonError::into_inner));
    in_order(notes).into_iter().map(|(_, line)| line + "\n").collect()
}

/// Groups the notes of each call, without those of other threads: first the activity that its tokens bring, then the
/// call, then the activity of its slot and its tokens.
fn in_order<T: Copy + PartialEq>(mut notes: Vec<(T, String)>) -> Vec<(T, String)> {
    let is_call = |line: &str| line.starts_with('F') || line.starts_with('H');
    let mut at = 0;
    while at < notes.len() {
        let thread = notes[at].0;
        let own: Vec<usize> = (0..at).filter(|i| notes[*i].0 == thread).collect();
        let last_call = own.iter().rposition(|i| is_call(&notes[*i].1));
        if notes[at].1.starts_with('T') {
            let Some(call) = last_call else {
                at += 1;
                continue;
            };
            for (place, from) in own[call + 1..].iter().chain([&at]).enumerate() {
                let line = notes.remove(*from);
                notes.insert(own[call] + 1 + place, line);
            }
        } else if is_call(&notes[at].1) {
            let activity: Vec<usize> = own.iter().copied().rev().take_while(|i| notes[*i].1.starts_with('A')).collect();
            for (moved, from) in activity.into_iter().enumerate() {
                let line = notes.remove(from);
                notes.insert(at - 1 - moved, line);
            }
        }
        at += 1;
    }
    notes
}

/// Parameters of a scripted node: `[seed, mode, limit]`.
pub type Parameters = [i64; 3];

/// Mode in which a node sends in each call.
pub const ALWAYS: i64 = 1;

/// Sending ports of scripted nodes; the index is part of their values.
const PORTS: [&str; 5] = ["out", "a", "b", "e", "f"];

/// `true` if call number `call` of node `id` sends at `port`. Events are triggered only in the first calls, so that
/// they do not run in cycles forever.
pub fn sends(id: i64, [seed, mode, limit]: Parameters, port: &str, call: i64) -> bool {
    if matches!(port, "e" | "f") && call >= limit {
        return false;
    }
    if mode == ALWAYS {
        return true;
    }
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for word in [seed, id, number(port), call] {
        hash = (hash ^ word as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        hash ^= hash >> 29;
    }
    !hash.is_multiple_of(4)
}

fn number(port: &str) -> i64 {
    PORTS.iter().position(|p| *p == port).unwrap_or(PORTS.len()) as i64
}

/// Value that slots get in place of tokens, which no node sends.
pub const GIVEN: i64 = 999_999_000_000_007;

/// Value that call number `call` of node `id` sends at `port`.
pub fn value(id: i64, port: &str, call: i64) -> i64 {
    (id * 10 + number(port)) * 1_000_000 + call
}

/// Node, port and call from which a value comes.
pub fn origin(value: i64) -> Option<(i64, &'static str, usize)> {
    let port = usize::try_from(value / 1_000_000 % 10).ok()?;
    Some((value / 10_000_000, PORTS.get(port)?, usize::try_from(value % 1_000_000).ok()?))
}

/// A call of a scripted node.
pub struct Now {
    id: i64,
    parameters: Parameters,
    call: i64,
}

/// Begins a call with `tokens`.
pub fn call(id: i64, parameters: Parameters, calls: &mut i64, tokens: &[Option<i64>]) -> Now {
    let tokens: Vec<String> = tokens.iter().map(|t| t.map_or("-".to_owned(), |value| value.to_string())).collect();
    note(format_args!("T {}", tokens.join(" ")));
    *calls += 1;
    Now { id, parameters, call: *calls - 1 }
}

impl Now {
    /// Value to be sent at `port`.
    pub fn value(&self, port: &str) -> Option<i64> {
        sends(self.id, self.parameters, port, self.call).then(|| value(self.id, port, self.call))
    }

    /// Triggers `event` if the script says so.
    pub fn event(&self, port: &str, event: Event<'_, i64>) {
        if let Some(value) = self.value(port) {
            event.emit(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::in_order;

    /// Two interleaved threads, each entry as `thread line`.
    #[test]
    fn what_belongs_to_a_call_stands_with_it() {
        let orders = [
            // The tokens of thread 1's call, and the activity that it caused, are noted after a call of thread 2.
            ("1 H5|2 H6|2 T6|1 A9|1 T5", "1 H5|1 A9|1 T5|2 H6|2 T6"),
            ("1 F5|2 F6|1 T5|2 T6", "1 F5|1 T5|2 F6|2 T6"),
            ("1 A9|1 A8|2 F6|2 T6|1 F5|1 T5", "2 F6|2 T6|1 A9|1 A8|1 F5|1 T5"),
            ("1 H5|1 A9|2 A7|2 H6|1 A8|2 T6|1 T5", "1 H5|1 A9|1 A8|1 T5|2 A7|2 H6|2 T6"),
        ];
        for (noted, expected) in orders {
            let notes =
                noted.split('|').filter_map(|n| n.split_once(' ')).map(|(t, line)| (t, line.to_owned())).collect();
            let ordered: Vec<String> = in_order(notes).into_iter().map(|(t, line)| format!("{t} {line}")).collect();
            assert_eq!(ordered.join("|"), expected, "{noted}");
        }
    }
}

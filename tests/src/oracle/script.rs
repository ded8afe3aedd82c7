//! What scripted nodes do: a function of their parameters and of how often they were called.

use apex_rt::Event;
use std::{
    sync::{Mutex, PoisonError},
    thread::{self, ThreadId},
};

/// What happened, by thread: lines in the order in which they were noted.
static NOTES: Mutex<Vec<(ThreadId, String)>> = Mutex::new(vec![]);

/// Adds a line to what happened.
pub fn note(line: std::fmt::Arguments<'_>) {
    let (thread, line) = (thread::current().id(), line.to_string());
    NOTES.lock().unwrap_or_else(PoisonError::into_inner).push((thread, line));
}

/// What happened since it was asked last. What a call found stands behind it, and the activity that its tokens bring before
/// it, whatever other threads did meanwhile.
pub fn take_notes() -> String {
    let mut notes = std::mem::take(&mut *NOTES.lock().unwrap_or_else(PoisonError::into_inner));
    let is_call = |line: &str| line.starts_with('F') || line.starts_with('H');
    let mut at = 0;
    while at < notes.len() {
        let own = |(thread, _): &(ThreadId, String)| *thread == notes[at].0;
        if notes[at].1.starts_with('T') {
            let call = notes[..at].iter().rposition(own).map_or(at, |call| call + 1);
            let found = notes.remove(at);
            notes.insert(call, found);
        } else if is_call(&notes[at].1) {
            let before = (0..at).rev().filter(|i| own(&notes[*i])).take_while(|i| notes[*i].1.starts_with('A'));
            let before: Vec<usize> = before.collect();
            for (moved, from) in before.into_iter().enumerate() {
                let activity = notes.remove(from);
                notes.insert(at - 1 - moved, activity);
            }
        }
        at += 1;
    }
    notes.into_iter().map(|(_, line)| line + "\n").collect()
}

/// The parameters of a scripted node: `[seed, mode, limit]`.
pub type Parameters = [i64; 3];

/// The mode in which a node sends at each call.
pub const ALWAYS: i64 = 1;

/// The ports of scripted nodes that send, by which their values are told apart.
const PORTS: [&str; 5] = ["out", "a", "b", "e", "f"];

/// Whether call number `call` of node `id` sends at `port`. Events are triggered only in the first calls, so that
/// they do not go round for ever.
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

/// The value that call number `call` of node `id` sends at `port`.
pub fn value(id: i64, port: &str, call: i64) -> i64 {
    (id * 10 + number(port)) * 1_000_000 + call
}

/// Node, port and call of a value.
pub fn origin(value: i64) -> Option<(i64, &'static str, usize)> {
    let port = usize::try_from(value / 1_000_000 % 10).ok()?;
    Some((value / 10_000_000, PORTS.get(port)?, usize::try_from(value % 1_000_000).ok()?))
}

/// One call of a scripted node.
pub struct Now {
    id: i64,
    parameters: Parameters,
    call: i64,
}

/// Begins a call that has found `tokens`.
pub fn call(id: i64, parameters: Parameters, calls: &mut i64, tokens: &[Option<i64>]) -> Now {
    let tokens: Vec<String> = tokens.iter().map(|t| t.map_or("-".to_owned(), |value| value.to_string())).collect();
    note(format_args!("T {}", tokens.join(" ")));
    *calls += 1;
    Now { id, parameters, call: *calls - 1 }
}

impl Now {
    /// What is sent at `port`.
    pub fn value(&self, port: &str) -> Option<i64> {
        sends(self.id, self.parameters, port, self.call).then(|| value(self.id, port, self.call))
    }

    /// Triggers `event` if it is to be.
    pub fn event(&self, port: &str, event: Event<'_, i64>) {
        if let Some(value) = self.value(port) {
            event.emit(value);
        }
    }
}

//! What scripted nodes do: a function of their parameters and of how often they were called.

use apex_rt::Event;
use std::{cell::RefCell, fmt::Write as _};

thread_local! {
    static NOTES: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Adds a line to what happened on this thread.
pub fn note(line: std::fmt::Arguments<'_>) {
    NOTES.with_borrow_mut(|notes| {
        let _ = notes.write_fmt(line);
        notes.push('\n');
    });
}

/// What happened on this thread since it was asked last.
pub fn take_notes() -> String {
    NOTES.take()
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
    NOTES.with_borrow_mut(|notes| {
        notes.push('T');
        for token in tokens {
            let _ = match token {
                Some(value) => write!(notes, " {value}"),
                None => write!(notes, " -"),
            };
        }
        notes.push('\n');
    });
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

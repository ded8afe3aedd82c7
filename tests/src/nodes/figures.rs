use super::Label;
use apex_rt::prelude::*;

/// Sends words, one per firing, then nothing.
#[node]
pub struct Words {
    /// The script.
    #[param]
    words: &'static [&'static str],
    at: usize,
}

#[node]
impl Words {
    fn process(&mut self) -> Option<Label> {
        self.at += 1;
        self.words.get(self.at - 1).map(|word| Label((*word).to_owned()))
    }
}

/// Sends the same word in every firing.
#[node]
pub fn label(#[param] word: &'static str) -> Label {
    Label(word.to_owned())
}

/// A lamp that is switched by messages to another machine: triggers an event when one was sent.
#[node]
#[derive(Default)]
pub struct Export {
    /// Sent messages.
    pub sent: Vec<bool>,
}

#[node]
impl Export {
    fn process(&mut self, x: &bool, done: Event<()>) {
        self.sent.push(*x);
        done.emit(());
    }
}

/// Multiplies its input by three; its slot passes signals on.
#[node]
#[derive(Default)]
pub struct Black;

#[node]
impl Black {
    fn process(&mut self, x: &i64) -> i64 {
        3 * x
    }
    #[slot]
    fn s(&mut self, token: &i64, e: Event<i64>) {
        e.emit(*token);
    }
}

/// Records the tokens at several slots.
#[node]
#[derive(Default)]
pub struct Desk {
    /// Slots and tokens.
    pub seen: Vec<(char, i64)>,
}

#[node]
impl Desk {
    #[slot]
    fn a(&mut self, token: &i64) {
        self.seen.push(('a', *token));
    }
    #[slot]
    fn b(&mut self, token: &i64) {
        self.seen.push(('b', *token));
    }
    #[slot]
    fn c(&mut self, token: &i64) {
        self.seen.push(('c', *token));
    }
}

/// A state of a machine: triggers an event when it is entered, and leaves by a letter of the alphabet 0, 1.
#[node]
#[derive(Default)]
pub struct State;

#[node]
impl State {
    #[slot]
    fn enter(&mut self, entered: Event<()>) {
        entered.emit(());
    }
    #[slot]
    fn letter(&mut self, ctx: &Ctx, letter: &i64, zero: Event<()>, one: Event<()>) {
        match letter {
            0 if ctx.active() => zero.emit(()),
            1 if ctx.active() => one.emit(()),
            _ => {}
        }
    }
}

/// After a request, reports the next message once.
#[node]
#[derive(Default)]
pub struct Listener {
    asked: bool,
}

#[node]
impl Listener {
    #[slot]
    fn ask(&mut self) {
        self.asked = true;
    }
    #[slot]
    fn message(&mut self, token: &i64, heard: Event<i64>) {
        if std::mem::take(&mut self.asked) {
            heard.emit(*token);
        }
    }
}

/// Sends the positions of signs, with one more in each firing.
#[node]
pub struct SignMap {
    /// Numbers of signs; the pose of sign `n` is `100 n`.
    #[param]
    signs: &'static [i64],
    known: usize,
}

#[node]
impl SignMap {
    fn process(&mut self) -> Vec<(i64, i64)> {
        self.known = self.signs.len().min(self.known + 1);
        self.signs[..self.known].iter().map(|n| (*n, 100 * n)).collect()
    }
}

/// Sends the pose of a sign, or triggers an event if it is not known.
#[node]
#[allow(clippy::ptr_arg)]
pub fn map_lookup(key: &i64, map: &Vec<(i64, i64)>, unknown: Event<i64>) -> Option<i64> {
    let pose = map.iter().find(|(n, _)| n == key).map(|(_, pose)| *pose);
    if pose.is_none() {
        unknown.emit(*key);
    }
    pose
}

/// Sends the number of steps of a path to a person, or ⊥ if the person is too far away.
#[node]
pub struct Planner {
    /// Maximum number of steps.
    #[param]
    reach: i64,
}

#[node]
impl Planner {
    #[slot]
    fn goal(&mut self, person: &i64, path: Event<i64>, no_path: Event<i64>) {
        if *person <= self.reach { path.emit(*person) } else { no_path.emit(*person) }
    }
}

/// Follows a path, one step per firing.
#[node]
#[derive(Default)]
pub struct Follower {
    left: i64,
    /// Number of steps so far.
    pub steps: usize,
}

#[node]
impl Follower {
    fn process(&mut self, ctx: &Ctx, at_goal: Event<()>) {
        if ctx.active() && self.left > 0 {
            self.left -= 1;
            self.steps += 1;
            if self.left == 0 {
                at_goal.emit(());
            }
        }
    }
    #[slot]
    fn path(&mut self, path: &i64) {
        self.left = *path;
    }
}

/// Sends the position of a person; triggers an event with it while it is active.
#[node]
#[derive(Default)]
pub struct Tracker;

#[node]
impl Tracker {
    fn process(&mut self, ctx: &Ctx, x: &i64, nearest: Event<i64>) {
        if ctx.active() {
            nearest.emit(*x);
        }
    }
    #[slot]
    fn resume(&mut self) {}
}

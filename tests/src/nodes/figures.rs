use super::Label;
use apex_rt::prelude::*;

/// Words, one a firing, then nothing.
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

/// Always the same word.
#[node]
pub fn label(#[param] word: &'static str) -> Label {
    Label(word.to_owned())
}

/// A lamp that is switched by messages to another machine: says when one is out.
#[node]
#[derive(Default)]
pub struct Export {
    /// What was sent.
    pub sent: Vec<bool>,
}

#[node]
impl Export {
    fn process(&mut self, x: &bool, done: Event<()>) {
        self.sent.push(*x);
        done.emit(());
    }
}

/// Three times its input; its slot passes signals on.
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

/// Records what comes to several slots.
#[node]
#[derive(Default)]
pub struct Desk {
    /// The slot and the token.
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

/// A state of a machine: says when it is entered, and leaves by a letter of the alphabet 0, 1.
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

/// Says once that a message has come, after it was asked to.
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

/// Where signs are: each time one more of them.
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

/// The pose of a sign, or an event that it is not known.
#[node]
#[allow(clippy::ptr_arg)]
pub fn map_lookup(key: &i64, map: &Vec<(i64, i64)>, unknown: Event<i64>) -> Option<i64> {
    let pose = map.iter().find(|(n, _)| n == key).map(|(_, pose)| *pose);
    if pose.is_none() {
        unknown.emit(*key);
    }
    pose
}

/// A path to a person: how many steps. None if the person is too far away.
#[node]
pub struct Planner {
    /// How far it can plan.
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

/// Goes along a path, a step a firing.
#[node]
#[derive(Default)]
pub struct Follower {
    left: i64,
    /// How many steps it went.
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

/// Where the person is; says so while it is active.
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

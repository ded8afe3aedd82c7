//! The steps of a robot: the last ones in memory, earlier ones in a [`Store`].

use crate::store::{PAGE, Page, Store};
use std::{
    collections::{BTreeSet, VecDeque},
    ops::{Index, Range},
    sync::Arc,
};

/// Number of steps that are kept in memory.
const RECENT: usize = 1 << 20;
/// Number of steps, before a time in the past, that are looked at for causes.
const REACH: usize = 1 << 18;

/// The steps of a robot.
#[derive(Clone)]
pub struct Steps {
    store: Arc<Store>,
    /// Steps before those in memory, without a gap.
    pages: VecDeque<Arc<Kept>>,
    recent: VecDeque<Step>,
    /// State before the steps in memory.
    state: State,
}

/// State of a robot between two steps.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time of the last reaction in ns; the earliest possible before the first one.
    pub now: i64,
    /// Number of reactions.
    pub reaction: u64,
    /// Active nodes.
    pub active: BTreeSet<u32>,
}

/// Steps in the store.
struct Kept {
    page: Page,
    count: usize,
    /// State before them.
    state: State,
}

/// A step of a reaction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Time of the reaction in ns.
    pub now: i64,
    /// Number of the reaction, from 1; 0 before the first one.
    pub reaction: u64,
    pub what: What,
}

/// Kind of a step. Numbers are those of the robot's description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// The reaction begins.
    Begins,
    /// A node fires.
    Fires(u32),
    /// The slot at the end of a connection takes its token.
    Takes(u32),
    /// A token is sent over a channel.
    Sends(u32),
    /// A node becomes active.
    Starts(u32),
    /// A node becomes inactive.
    Stops(u32),
}

impl Default for State {
    fn default() -> Self {
        Self { now: i64::MIN, reaction: 0, active: BTreeSet::new() }
    }
}

impl State {
    fn follow(&mut self, step: &Step) {
        (self.now, self.reaction) = (step.now, step.reaction);
        match step.what {
            What::Starts(node) => drop(self.active.insert(node)),
            What::Stops(node) => drop(self.active.remove(&node)),
            _ => {}
        }
    }
}

impl Steps {
    pub fn new(store: Arc<Store>) -> Self {
        Self { store, pages: VecDeque::new(), recent: VecDeque::new(), state: State::default() }
    }

    /// The store of the steps.
    pub fn store(&self) -> Arc<Store> {
        Arc::clone(&self.store)
    }

    pub fn push(&mut self, step: Step) {
        if self.recent.len() == RECENT {
            self.put_away();
        }
        self.recent.push_back(step);
    }

    /// Moves the first steps from the memory to the store. If it is full, the earliest ones are forgotten.
    fn put_away(&mut self) {
        let (mut bytes, state, mut count) = (Vec::with_capacity(PAGE), self.state.clone(), 0);
        while let Some(step) = self.recent.front() {
            let length = bytes.len();
            write(step, self.state.now, &mut bytes);
            if bytes.len() > PAGE {
                bytes.truncate(length);
                break;
            }
            self.state.follow(step);
            self.recent.pop_front();
            count += 1;
        }
        loop {
            if let Some(page) = self.store.keep(&bytes) {
                self.pages.push_back(Arc::new(Kept { page, count, state }));
                return;
            }
            if self.pages.pop_front().is_none() {
                return;
            }
        }
    }

    /// Forgets the steps after this number of reactions, after which the robot is in `state`.
    pub fn take_back(&mut self, state: State) {
        let is_kept = |step: &Step| step.reaction <= state.reaction;
        self.recent.truncate(self.recent.partition_point(is_kept));
        while self.recent.is_empty()
            && let Some(last) = self.pages.pop_back()
        {
            self.recent = last.steps().filter(is_kept).collect();
            self.state = last.state.clone();
        }
        if self.recent.is_empty() {
            self.state = state;
        }
    }

    /// Time in ns before which the steps are forgotten, if there is one.
    pub fn forgotten(&self) -> Option<i64> {
        let first = self.pages.front().map_or(&self.state, |first| &first.state);
        (first.reaction > 0).then_some(first.now)
    }

    /// Number of reactions until a time in ns.
    pub fn reactions_until(&self, time: i64) -> u64 {
        let near = self.near(|now, _| now <= time, 0);
        near.until(time).checked_sub(1).map_or(near.before.reaction, |last| near[last].reaction)
    }

    /// Time in ns of the reaction that has this number of reactions before it.
    pub fn time_of(&self, reactions: u64) -> Option<i64> {
        let near = self.near(|_, reaction| reaction <= reactions, 0);
        let at = near.partition_point(|step| step.reaction <= reactions);
        (at < near.len() && near[at].reaction == reactions + 1).then(|| near[at].now)
    }

    /// The steps up to a time in ns and some after it, and many of those before.
    pub fn around(&self, time: i64) -> Part<'_> {
        self.near(|now, _| now <= time, REACH)
    }

    /// All steps between two times in ns, and some others; `None` if they are more than `limit`.
    pub fn between(&self, from: i64, to: i64, limit: usize) -> Option<Part<'_>> {
        let is_recent = self.state.now < from || self.pages.is_empty();
        let first = self.pages.partition_point(|page| page.state.now < from).saturating_sub(1);
        let first = if is_recent { self.pages.len() } else { first };
        let end = self.pages.partition_point(|page| page.state.now <= to).max(first);
        let until = |time: i64| self.recent.partition_point(|step| step.now <= time);
        let seen = until(to).saturating_sub(until(from.saturating_sub(1)));
        let count = self.pages.range(first..end).map(|page| page.count).sum::<usize>() + seen;
        (count <= limit).then(|| self.part(first..end))
    }

    /// The last page that begins with such a time and number of reactions, with the page after it, and pages before it
    /// with at least `reach` steps. The steps in memory are the last page.
    fn near(&self, is_before: impl Fn(i64, u64) -> bool, reach: usize) -> Part<'_> {
        let begins = |state: &State| is_before(state.now, state.reaction);
        let last = self.pages.partition_point(|page| begins(&page.state));
        let is_recent = begins(&self.state);
        let end = if is_recent { self.pages.len() } else { (last + 1).min(self.pages.len()) };
        let mut first = if is_recent { end } else { last.saturating_sub(1) };
        let recent = self.recent.partition_point(|step| is_before(step.now, step.reaction));
        let mut count = if is_recent { recent } else { 0 };
        while first > 0 && count < reach {
            first -= 1;
            count += self.pages[first].count;
        }
        self.part(first..end)
    }

    fn part(&self, pages: Range<usize>) -> Part<'_> {
        let before = self.pages.get(pages.start).map_or(&self.state, |page| &page.state);
        let is_forgotten = pages.start == 0 && before.reaction > 0;
        let recent = (pages.end == self.pages.len()).then_some(&self.recent);
        let old = self.pages.range(pages).flat_map(|page| page.steps()).collect();
        Part { before, old, recent, is_forgotten }
    }
}

impl Kept {
    /// The steps of the page.
    fn steps(&self) -> impl Iterator<Item = Step> + use<> {
        let (bytes, mut now, mut reaction) = (self.page.read(), self.state.now, self.state.reaction);
        let mut at = 0;
        (0..self.count).map_while(move |_| {
            let word = read(&bytes, &mut at)?;
            let number = (word >> 3) as u32;
            let what = match word & 7 {
                0 => {
                    now = now.wrapping_add(read(&bytes, &mut at)? as i64);
                    reaction += 1;
                    What::Begins
                }
                1 => What::Fires(number),
                2 => What::Takes(number),
                3 => What::Sends(number),
                4 => What::Starts(number),
                _ => What::Stops(number),
            };
            Some(Step { now, reaction, what })
        })
    }
}

/// Appends a step that comes after the time `before`.
fn write(step: &Step, before: i64, out: &mut Vec<u8>) {
    let (kind, number) = match step.what {
        What::Begins => (0, 0),
        What::Fires(node) => (1, node),
        What::Takes(connection) => (2, connection),
        What::Sends(channel) => (3, channel),
        What::Starts(node) => (4, node),
        What::Stops(node) => (5, node),
    };
    varint(u64::from(number) << 3 | kind, out);
    if kind == 0 {
        varint(step.now.wrapping_sub(before) as u64, out);
    }
}

/// Appends a number, seven bits a byte.
fn varint(mut number: u64, out: &mut Vec<u8>) {
    while number >= 0x80 {
        out.push(number as u8 | 0x80);
        number >>= 7;
    }
    out.push(number as u8);
}

/// Reads a number at a position, which moves behind it.
fn read(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = *bytes.get(*at)?;
        *at += 1;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}

/// A part of the steps without a gap.
pub struct Part<'a> {
    /// State before it.
    pub before: &'a State,
    old: Vec<Step>,
    recent: Option<&'a VecDeque<Step>>,
    /// `true` if the steps before it are forgotten.
    pub is_forgotten: bool,
}

impl Part<'_> {
    pub fn len(&self) -> usize {
        self.old.len() + self.recent.map_or(0, VecDeque::len)
    }

    /// Number of the steps up to a time in ns.
    pub fn until(&self, time: i64) -> usize {
        self.partition_point(|step| step.now <= time)
    }

    /// The last of the first `end` steps that is one of these.
    pub fn last(&self, end: usize, is: impl Fn(What) -> bool) -> Option<usize> {
        (0..end).rev().find(|at| is(self[*at].what))
    }

    /// The steps of the reaction that a step belongs to.
    pub fn reaction(&self, of: usize) -> Range<usize> {
        let number = self[of].reaction;
        self.partition_point(|step| step.reaction < number)..self.partition_point(|step| step.reaction <= number)
    }

    /// Number of the first steps for which `is` holds.
    fn partition_point(&self, is: impl Fn(&Step) -> bool) -> usize {
        match self.old.last() {
            Some(last) if !is(last) => self.old.partition_point(is),
            _ => self.old.len() + self.recent.map_or(0, |recent| recent.partition_point(is)),
        }
    }
}

impl Index<usize> for Part<'_> {
    type Output = Step;

    fn index(&self, at: usize) -> &Step {
        match (self.old.get(at), self.recent) {
            (Some(step), _) => step,
            (None, Some(recent)) => &recent[at - self.old.len()],
            (None, None) => unreachable!("a step of another part"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of so many reactions of 1 ms, with four steps each. Node 1 is active in every second one.
    fn after(reactions: i64) -> Steps {
        let mut steps = Steps::new(Arc::default());
        for reaction in 1..=reactions {
            let change = if reaction % 2 == 0 { What::Stops(1) } else { What::Starts(1) };
            for what in [What::Begins, What::Fires(700), What::Sends(3), change] {
                steps.push(Step { now: reaction * 1_000_000, reaction: reaction as u64, what });
            }
        }
        steps
    }

    #[test]
    fn old_steps_come_back_from_the_disk() {
        let steps = after(600_000);
        assert!(steps.pages.len() > 10 && steps.recent.len() <= RECENT);
        assert_eq!(steps.forgotten(), None);
        for reaction in [1, 2, 12_345, 200_000, 337_856, 400_001, 600_000] {
            let (now, number) = (reaction * 1_000_000, reaction as u64);
            assert_eq!(steps.reactions_until(now), number);
            assert_eq!(steps.reactions_until(now - 1), number - 1);
            assert_eq!(steps.time_of(number - 1), Some(now));
            let around = steps.around(now);
            let end = around.until(now);
            assert_eq!((around[end - 1].now, around[end - 3].what), (now, What::Fires(700)));
            assert_eq!(around.reaction(end - 1), end - 4..end);
            assert!(!around.is_forgotten);
            let part = steps.between(now, now, 200_000).expect("two pages");
            assert!(part.before.now < now && part.until(now - 1) + 4 == part.until(now));
            // The change is the last step of a reaction.
            let is_whole = part[0].what == What::Begins;
            assert_eq!(part.before.active.contains(&1), (part.before.reaction % 2 == 1) == is_whole);
        }
        assert_eq!(steps.time_of(600_000), None);
        assert!(steps.between(0, 600_000_000_000, 1_000_000).is_none());
    }

    #[test]
    fn steps_are_taken_back_to_those_on_the_disk() {
        let mut steps = after(600_000);
        let whole = steps.clone();
        for reactions in [599_999, 400_000, 100_000, 1] {
            steps.take_back(State { now: reactions * 1_000_000, reaction: reactions as u64, active: BTreeSet::new() });
            assert_eq!(steps.reactions_until(i64::MAX), reactions as u64);
            assert_eq!(steps.time_of(0), Some(1_000_000));
        }
        assert_eq!(whole.reactions_until(i64::MAX), 600_000);
        steps.push(Step { now: 5_000_000, reaction: 2, what: What::Begins });
        assert_eq!(steps.time_of(1), Some(5_000_000));
    }
}

//! Tokens that the delays of loops use before they have come.

use super::{
    PlaceId, free_for,
    route::{Loop, Segment, echoes},
    token::{Marking, Token},
};
use std::collections::BTreeMap;

/// Copies of tokens that lead into loops, and free legs of events on loops: how many of them delays have used before
/// they came.
#[derive(Clone)]
pub struct Lent(BTreeMap<PlaceId, usize>);

impl Lent {
    /// Initial state, in which nothing is lent.
    pub fn new(segments: &[Segment], loops: &[Loop]) -> Self {
        let copies = echoes(segments, loops).map(|(place, _)| place);
        let events = loops.iter().flat_map(|on_loop| on_loop.events.iter().map(|leg| free_for(*leg)));
        Self(copies.chain(events).map(|place| (place, 0)).collect())
    }

    /// Lends a token to each of these places, if that is possible for all of them.
    pub fn lend(&mut self, places: Vec<PlaceId>, marking: &mut Marking) {
        if places.iter().all(|place| self.0.contains_key(place)) {
            for place in places {
                marking[place].push_back(Token::default());
                self.0.entry(place).and_modify(|count| *count += 1);
            }
        }
    }

    /// Takes back what was lent where the tokens have come.
    pub fn take_back(&mut self, marking: &mut Marking) {
        for (place, count) in &mut self.0 {
            while *count > 0 && marking[*place].pop_front().is_some() {
                *count -= 1;
            }
        }
    }

    /// A place to which something is lent.
    pub fn borrowed(&self) -> Option<PlaceId> {
        self.0.iter().find(|(_, count)| **count > 0).map(|(place, _)| *place)
    }
}

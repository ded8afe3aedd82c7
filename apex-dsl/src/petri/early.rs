//! Tokens that cross the boundary of a nested graph before the others have arrived.
//!
//! A program need not hold a token back at a boundary while the others are about to arrive in the same firing, because
//! the difference cannot be observed. Such a token is a debt: the others have to follow before anything else happens.

use super::{
    Meaning, Net, PlaceId, TransitionId,
    route::{Leg, Loop, Stop},
    state::Token,
};
use crate::graph::Crossing;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Tokens that have crossed a boundary early.
#[derive(Clone)]
pub struct Early {
    sides: BTreeMap<Crossing, Side>,
    /// For each leg that begins at a boundary, by the place of its token: the boundary, and the number of the leg
    /// there.
    begins: BTreeMap<PlaceId, (Crossing, usize)>,
}

#[derive(Clone)]
struct Side {
    pass: TransitionId,
    enabled: PlaceId,
    waiting: PlaceId,
    ways: Vec<Way>,
    /// Ways on which a token has crossed early.
    ahead: BTreeSet<usize>,
}

/// A connection through a boundary: the place of its token before it, and the places behind it.
#[derive(Clone)]
struct Way {
    before: PlaceId,
    free: PlaceId,
    gives: Vec<PlaceId>,
}

type Marking = [VecDeque<Token>];

impl Early {
    /// Initial state, without early tokens.
    pub fn new(legs: &[Leg], loops: &[Loop], net: &Net) -> Self {
        // `build` makes two places for each leg: `2 * leg` for its token, and `2 * leg + 1` while it is free.
        let mut gives: Vec<Vec<PlaceId>> = (0..legs.len()).map(|leg| vec![2 * leg]).collect();
        // The copies (`echo`) for legs into loops follow the places of all legs.
        let entries = loops.iter().flat_map(|on_loop| &on_loop.entries);
        for (echo, entry) in (2 * legs.len()..).zip(entries) {
            gives[*entry].push(echo);
        }
        let (mut sides, mut begins) = (BTreeMap::new(), BTreeMap::new());
        for (pass, transition) in net.transitions.iter().enumerate() {
            let Meaning::Pass(side) = transition.meaning else { continue };
            let mut ways = vec![];
            for leg in (0..legs.len()).filter(|l| legs[*l].from == Stop::Side(side)) {
                begins.insert(2 * leg, (side, ways.len()));
                // The preceding leg is the part of the same connection before the boundary.
                ways.push(Way { before: 2 * (leg - 1), free: 2 * leg + 1, gives: gives[leg].clone() });
            }
            // `Builder::side` takes a token of each way, then `enabled`. The last place that it gives to is `waiting`.
            let (enabled, waiting) = (transition.takes[ways.len()], transition.gives[transition.gives.len() - 1]);
            sides.insert(side, Side { pass, enabled, waiting, ways, ahead: BTreeSet::new() });
        }
        Self { sides, begins }
    }

    /// The place where a token waits that reaches `place` through a boundary.
    pub fn before(&self, place: PlaceId) -> Option<PlaceId> {
        let (side, index) = self.begins.get(&place)?;
        Some(self.sides.get(side)?.ways[*index].before)
    }

    /// Advances a token to `place`, if only the other tokens at boundaries hold it back. Returns `true` if it did.
    pub fn advance(&mut self, place: PlaceId, marking: &mut Marking) -> bool {
        let Some((crossing, index)) = self.begins.get(&place).copied() else { return false };
        let Some(side) = self.sides.get(&crossing) else { return false };
        let way = side.ways[index].clone();
        if marking[side.enabled].is_empty() || side.ahead.contains(&index) || marking[way.free].is_empty() {
            return false;
        }
        // The token may itself have to cross an outer boundary first.
        if marking[way.before].is_empty() && !self.advance(way.before, marking) {
            return false;
        }
        go(&way, marking);
        self.sides.get_mut(&crossing).is_some_and(|s| s.ahead.insert(index))
    }

    /// Advances the remaining tokens at boundaries where all of them have arrived. Returns the transitions that this
    /// replaces.
    pub fn follow(&mut self, marking: &mut Marking) -> Vec<TransitionId> {
        let mut passed = vec![];
        for side in self.sides.values_mut().filter(|s| !s.ahead.is_empty()) {
            let rest: Vec<&Way> =
                side.ways.iter().enumerate().filter(|(i, _)| !side.ahead.contains(i)).map(|(_, w)| w).collect();
            if rest.iter().all(|w| !marking[w.before].is_empty() && !marking[w.free].is_empty()) {
                rest.into_iter().for_each(|w| go(w, marking));
                marking[side.enabled].pop_front();
                marking[side.waiting].push_back(Token::default());
                side.ahead.clear();
                passed.push(side.pass);
            }
        }
        passed
    }

    /// A boundary that some token crossed early and that others have yet to cross.
    pub fn owes(&self) -> Option<Crossing> {
        self.sides.iter().find(|(_, s)| !s.ahead.is_empty()).map(|(side, _)| *side)
    }
}

fn go(way: &Way, marking: &mut Marking) {
    marking[way.free].pop_front();
    let token = marking[way.before].pop_front().unwrap_or_default();
    way.gives.iter().for_each(|p| marking[*p].push_back(token));
}

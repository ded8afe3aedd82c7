//! Tokens that cross the boundary of a nested graph before the others have arrived.
//!
//! A program need not hold a token back at a boundary while the others are about to arrive in the same firing, because
//! the difference cannot be observed. Such a token is a debt: the others have to follow before anything else happens.

use super::{
    Net, PlaceId, TransitionId, TransitionKind, free_for,
    route::{Loop, Segment, SegmentEnd, Side, echoes},
    token::{Marking, Token},
    token_on,
};
use std::collections::{BTreeMap, BTreeSet};

/// Tokens that have crossed a boundary early.
#[derive(Clone)]
pub struct Bypass {
    sides: BTreeMap<Side, Waiting>,
    /// For each leg that begins at a boundary, by the places of its token and of the copy: the boundary, and the number
    /// of the leg there.
    begins: BTreeMap<PlaceId, (Side, usize)>,
}

#[derive(Clone)]
struct Waiting {
    pass: TransitionId,
    enabled: PlaceId,
    waiting: PlaceId,
    /// Marked when the delays of loops have sent their tokens through.
    after: Vec<PlaceId>,
    routes: Vec<Route>,
    /// Ways on which a token has crossed early.
    ahead: BTreeSet<usize>,
}

/// A connection through a boundary: the place of its token before it, and the places behind it.
#[derive(Clone)]
struct Route {
    before: PlaceId,
    free: PlaceId,
    gives: Vec<PlaceId>,
}

impl Bypass {
    /// Initial state, without early tokens.
    pub fn new(segments: &[Segment], loops: &[Loop], net: &Net) -> Self {
        let mut gives: Vec<Vec<PlaceId>> = (0..segments.len()).map(|segment| vec![token_on(segment)]).collect();
        echoes(segments, loops).for_each(|(echo, entry)| gives[entry].push(echo));
        let (mut sides, mut begins) = (BTreeMap::new(), BTreeMap::new());
        for (pass, transition) in net.transitions.iter_enumerated() {
            let TransitionKind::Pass(side) = transition.kind else { continue };
            let mut routes = vec![];
            for segment in (0..segments.len()).filter(|l| segments[*l].from == SegmentEnd::Side(side)) {
                begins.extend(gives[segment].iter().map(|place| (*place, (side, routes.len()))));
                // The preceding leg is the part of the same connection before the boundary.
                let (before, free) = (token_on(segment - 1), free_for(segment));
                routes.push(Route { before, free, gives: gives[segment].clone() });
            }
            // `Builder::side` takes a token of each way, `enabled`, and that each way is free. The last place that it
            // gives to is `waiting`.
            let (enabled, waiting) = (transition.takes[routes.len()], transition.gives[transition.gives.len() - 1]);
            let after = transition.takes[2 * routes.len() + 1..].to_vec();
            sides.insert(side, Waiting { pass, enabled, waiting, after, routes, ahead: BTreeSet::new() });
        }
        Self { sides, begins }
    }

    /// The place where a token waits that reaches `place` through a boundary.
    pub fn before(&self, place: PlaceId) -> Option<PlaceId> {
        let (side, index) = self.begins.get(&place)?;
        Some(self.sides.get(side)?.routes[*index].before)
    }

    /// Advances a token to `place`, if only the other tokens at boundaries hold it back. Returns `true` if it did.
    pub fn advance(&mut self, place: PlaceId, marking: &mut Marking) -> bool {
        let Some((crossing, index)) = self.begins.get(&place).copied() else { return false };
        let Some(side) = self.sides.get(&crossing) else { return false };
        let route = side.routes[index].clone();
        if marking[side.enabled].is_empty() || side.ahead.contains(&index) || marking[route.free].is_empty() {
            return false;
        }
        // The token may itself have to cross an outer boundary first.
        if marking[route.before].is_empty() && !self.advance(route.before, marking) {
            return false;
        }
        go(&route, marking);
        self.sides.get_mut(&crossing).is_some_and(|s| s.ahead.insert(index))
    }

    /// Advances the remaining tokens at boundaries where all of them have arrived. Returns the transitions that this
    /// replaces.
    pub fn follow(&mut self, marking: &mut Marking) -> Vec<TransitionId> {
        let mut passed = vec![];
        for side in self.sides.values_mut().filter(|s| !s.ahead.is_empty()) {
            let rest: Vec<&Route> =
                side.routes.iter().enumerate().filter(|(i, _)| !side.ahead.contains(i)).map(|(_, w)| w).collect();
            let is_ready = |w: &&Route| !marking[w.before].is_empty() && !marking[w.free].is_empty();
            if rest.iter().all(is_ready) && side.after.iter().all(|place| !marking[*place].is_empty()) {
                rest.into_iter().for_each(|w| go(w, marking));
                for place in &side.after {
                    marking[*place].pop_front();
                }
                marking[side.enabled].pop_front();
                marking[side.waiting].push_back(Token::default());
                side.ahead.clear();
                passed.push(side.pass);
            }
        }
        passed
    }

    /// A boundary that some token crossed early and that others have yet to cross.
    pub fn owes(&self) -> Option<Side> {
        self.sides.iter().find(|(_, s)| !s.ahead.is_empty()).map(|(side, _)| *side)
    }
}

fn go(route: &Route, marking: &mut Marking) {
    marking[route.free].pop_front();
    let token = marking[route.before].pop_front().unwrap_or_default();
    route.gives.iter().for_each(|p| marking[*p].push_back(token));
}

//! The parts of a graph's activity that do not depend on one another: a claim is decided in the parts that it is about,
//! so that what happens elsewhere does not multiply its states.

use super::{
    model::{Arrival, Model, PlaceId},
    properties::Checks,
};
use crate::graph::ClaimKind;
use std::collections::{BTreeMap, BTreeSet};

/// Some parts of the activity, with the claims that are decided in them.
#[derive(Debug)]
pub struct Slice {
    /// For each place, `true` if it belongs to the parts.
    pub places: Vec<bool>,
    /// The claims, by number.
    pub claims: Vec<usize>,
}

/// The slices in which the claims are decided. Activity is conserved if it is conserved in each part.
pub fn slices(model: &Model, checks: &Checks) -> Vec<Slice> {
    let part = parts(model);
    let mut claims: BTreeMap<BTreeSet<PlaceId>, Vec<usize>> = BTreeMap::new();
    for claim in 0..checks.count() {
        match checks.kind(claim) {
            ClaimKind::Conserved => {
                let all: BTreeSet<PlaceId> = part.iter().copied().collect();
                all.into_iter().for_each(|part| claims.entry(BTreeSet::from([part])).or_default().push(claim));
            }
            ClaimKind::Live => {}
            ClaimKind::Exclusive | ClaimKind::Reaches => {
                let about = checks.about(claim).map(|place| part[place as usize]).collect();
                claims.entry(about).or_default().push(claim);
            }
        }
    }
    let slice = |(parts, claims): (BTreeSet<PlaceId>, _)| Slice {
        places: part.iter().map(|part| parts.contains(part)).collect(),
        claims,
    };
    claims.into_iter().map(slice).collect()
}

/// The part of each place: its first place. Places belong together if a move has to do with both.
fn parts(model: &Model) -> Vec<PlaceId> {
    let mut first: Vec<PlaceId> = (0..model.places.len() as PlaceId).collect();
    let mut join = |a: PlaceId, b: PlaceId| {
        let (a, b) = (find(&mut first, a), find(&mut first, b));
        first[a.max(b) as usize] = a.min(b);
    };
    for place in 0..model.places.len() as PlaceId {
        for emission in &model.emissions[place as usize] {
            emission.to.iter().chain(&emission.waits_for).for_each(|other| join(place, *other));
        }
        match model.arrivals[place as usize] {
            Some(Arrival::Node(node)) => join(place, node),
            Some(Arrival::Cancels(number) | Arrival::Resumes(number)) => {
                model.interrupts[number].places().for_each(|other| join(place, other));
            }
            // The whole program begins again.
            Some(Arrival::Restarts) => (0..model.places.len() as PlaceId).for_each(|other| join(place, other)),
            // A delay belongs together, with what comes to it.
            Some(Arrival::Waits | Arrival::Leaves | Arrival::Ends) | None => {}
        }
    }
    for interrupt in &model.interrupts {
        interrupt.places().zip(interrupt.places().skip(1)).for_each(|(a, b)| join(a, b));
    }
    for delay in &model.delays {
        delay.places().zip(delay.places().skip(1)).for_each(|(a, b)| join(a, b));
    }
    (0..model.places.len() as PlaceId).map(|place| find(&mut first, place)).collect()
}

/// Union-find: the first place of a part. Shortens the path to it (path halving).
fn find(first: &mut [PlaceId], mut place: PlaceId) -> PlaceId {
    while first[place as usize] != place {
        first[place as usize] = first[first[place as usize] as usize];
        place = first[place as usize];
    }
    place
}

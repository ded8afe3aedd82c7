//! The properties of single states that claims require.

use super::model::{Model, Place, PlaceId, State};
use crate::graph::{ClaimKind, Graph, NodeId, ScopeId, Subject};
use std::collections::BTreeMap;

/// For `reaches`: number of the places in the first subject.
pub const FROM: u32 = 0;
/// For `reaches`: number of the places from which activity can reach the second subject.
pub const NEARER: u32 = 1;

/// The claims of a graph, by place.
#[derive(Debug)]
pub struct Checks {
    kinds: Vec<ClaimKind>,
    /// For each place the claims that it matters to: the number of the claim, and of the subject in it.
    groups: Vec<Vec<(u32, u32)>>,
    /// For each `reaches`, the places of its second subject.
    goals: BTreeMap<usize, Vec<PlaceId>>,
}

impl Checks {
    /// The claims of `graph`.
    pub fn new(graph: &Graph, model: &Model) -> Self {
        let kinds = graph.claims.iter().map(|c| c.kind).collect();
        let mut checks = Self { kinds, groups: vec![vec![]; model.places.len()], goals: BTreeMap::new() };
        let mut nodes: BTreeMap<NodeId, Vec<(u32, u32)>> = BTreeMap::new();
        let mut scopes: BTreeMap<ScopeId, Vec<(u32, u32)>> = BTreeMap::new();
        for (claim, c) in (0..).zip(&graph.claims) {
            for (group, subject) in (0..).zip(&c.of) {
                match subject {
                    Subject::Node(node) => nodes.entry(*node).or_default().push((claim, group)),
                    Subject::Scope(scope) => scopes.entry(*scope).or_default().push((claim, group)),
                }
            }
        }
        for (place, groups) in model.places.iter().zip(&mut checks.groups) {
            if let Place::Node(node) = place {
                groups.extend(nodes.get(node).into_iter().flatten());
            }
            groups.extend(scopes_of(graph, *place).iter().filter_map(|s| scopes.get(s)).flatten());
            groups.sort_unstable();
        }
        for claim in 0..checks.kinds.len() as u32 {
            checks.add_reaching(model, claim);
        }
        checks
    }

    /// Extends the second subject of `reaches` to all places from which it can be reached.
    fn add_reaching(&mut self, model: &Model, claim: u32) {
        if self.kinds[claim as usize] != ClaimKind::Reaches {
            return;
        }
        let goals = self.places(claim as usize, NEARER);
        self.goals.insert(claim as usize, goals.clone());
        for (groups, nearer) in self.groups.iter_mut().zip(model.reaching(&goals, true)) {
            if nearer && !groups.contains(&(claim, NEARER)) {
                groups.push((claim, NEARER));
            }
        }
    }

    /// Number of claims.
    pub fn count(&self) -> usize {
        self.kinds.len()
    }

    /// Kind of a claim.
    pub fn kind(&self, claim: usize) -> ClaimKind {
        self.kinds[claim]
    }

    /// The places that a claim is about.
    pub fn about(&self, claim: usize) -> impl Iterator<Item = PlaceId> + '_ {
        let is_about = move |groups: &[(u32, u32)]| groups.iter().any(|(other, _)| *other == claim as u32);
        (0..).zip(&self.groups).filter(move |(_, groups)| is_about(groups)).map(|(place, _)| place)
    }

    /// The places that belong to a subject of a claim.
    pub fn places(&self, claim: usize, group: u32) -> Vec<PlaceId> {
        let meant = (claim as u32, group);
        let places = (0..).zip(&self.groups).filter(|(_, groups)| groups.contains(&meant));
        places.map(|(place, _)| place).collect()
    }

    /// Cost of checking the claims in a state.
    pub fn cost(&self, state: &State) -> usize {
        state.iter().map(|place| 1 + self.groups[*place as usize].len()).sum::<usize>() + self.kinds.len()
    }

    /// The claims about what can be reached from each state.
    pub fn about_ways(&self) -> impl Iterator<Item = usize> + '_ {
        self.goals.keys().copied()
    }

    /// Returns `true` if the first subject of a `reaches` is active in a state.
    pub fn begins(&self, claim: usize, state: &State) -> bool {
        state.iter().any(|place| self.groups[*place as usize].contains(&(claim as u32, FROM)))
    }

    /// Returns `true` if the second subject of a `reaches` is active in a state.
    pub fn arrives(&self, claim: usize, state: &State) -> bool {
        state.iter().any(|place| self.goals[&claim].contains(place))
    }

    /// The claims that do not hold in a state, whatever follows. `given` is the amount of activity at the beginning.
    pub fn broken(&self, model: &Model, state: &State, given: usize) -> Vec<usize> {
        // For each claim the first subject that is active, and `true` if the claim is known to fail.
        let mut found: Vec<(Option<u32>, bool)> = vec![(None, false); self.kinds.len()];
        for (claim, group) in state.iter().flat_map(|place| &self.groups[*place as usize]) {
            let (first, broken) = &mut found[*claim as usize];
            match (self.kinds[*claim as usize], *first) {
                (ClaimKind::Exclusive, Some(other)) if other != *group => *broken = true,
                (ClaimKind::Reaches, _) if *group == NEARER => *first = Some(NEARER),
                (ClaimKind::Reaches, _) => *broken = true,
                (_, None) => *first = Some(*group),
                _ => {}
            }
        }
        let is_broken = |claim: &usize| match (self.kinds[*claim], found[*claim]) {
            (ClaimKind::Conserved, _) => state.iter().filter(|place| model.is_active(**place)).count() != given,
            (ClaimKind::Reaches, (nearer, from)) => from && nearer.is_none(),
            (ClaimKind::Exclusive, (_, both)) => both,
            (ClaimKind::Live, _) => false,
        };
        (0..self.kinds.len()).filter(is_broken).collect()
    }

    /// Returns `true` if a claim holds in every conceivable state, so that no search is needed.
    pub fn is_certain(&self, model: &Model, claim: usize, names: u32) -> bool {
        match self.kinds[claim] {
            ClaimKind::Exclusive => (0..names).filter(|group| !self.places(claim, *group).is_empty()).count() < 2,
            ClaimKind::Reaches => {
                let nearer = model.reaching(&self.goals[&claim], false);
                self.places(claim, FROM).iter().all(|place| nearer[*place as usize])
            }
            ClaimKind::Conserved | ClaimKind::Live => false,
        }
    }
}

/// The nested graphs around a place. A connection is inside a graph if both its ends are.
pub fn scopes_of(graph: &Graph, place: Place) -> Vec<ScopeId> {
    match place {
        Place::Node(node) | Place::Delayed(node, _) => graph.scopes_of(node),
        Place::Remembered(..) => vec![],
        Place::Connection(c) => {
            let c = &graph.connections[c];
            let from = graph.scopes_of(c.from.node);
            graph.scopes_of(c.to.node).into_iter().filter(|s| from.contains(s)).collect()
        }
    }
}

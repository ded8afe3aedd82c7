//! Lowering of claims about activity: where the program keeps activity, also that of tokens on their way. Undecided
//! claims are looked at whenever activity has moved.

use super::{
    flags::{Carries, Spot},
    lower::Lower,
};
use crate::{
    claims::{Checks, FROM, Model, NEARER, Place, PlaceId, scopes_of},
    graph::{ClaimKind, Graph, ScopeId},
    index::IdVec,
};
use std::collections::{BTreeMap, BTreeSet};

/// A claim that the program looks at while it runs.
#[derive(Debug)]
pub struct ClaimCheck {
    /// Its number.
    pub claim: usize,
    /// Activity that breaks it.
    pub broken: Broken,
}

/// Activity that breaks a claim.
#[derive(Debug)]
pub enum Broken {
    /// In more than one of these groups.
    Several(Vec<Vec<Spot>>),
    /// In one of the first places, but in none of the others.
    Lost(Vec<Spot>, Vec<Spot>),
    /// In another number of places than this.
    NotConserved(Vec<Spot>, usize),
    /// None: the claim is not about activity.
    Never,
}

/// A nested graph that can be active: if one of its places has activity, or if a graph in it is active.
#[derive(Debug)]
pub struct ActiveScope {
    /// The nested graph.
    pub scope: ScopeId,
    /// Places that belong to no graph in it.
    pub own: Vec<Spot>,
    /// Graphs in it that can be active.
    pub inner: Vec<ScopeId>,
}

impl ActiveScope {
    fn new(scope: ScopeId) -> Self {
        Self { scope, own: vec![], inner: vec![] }
    }
}

/// Places, with those of the model that each stands for.
type Spots = BTreeMap<Spot, BTreeSet<PlaceId>>;

impl Lower<'_> {
    /// The claims that the program looks at.
    pub fn claim_checks(self) -> Vec<ClaimCheck> {
        let undecided = self.undecided();
        if undecided.is_empty() {
            return vec![];
        }
        let graph = self.graph;
        let model = Model::new(graph, self.catalog);
        let (checks, spots) = (Checks::new(graph, &model), self.spots(&model));
        let check = |claim: usize| {
            let group = |group| within(&spots, &checks.places(claim, group));
            let broken = match graph.claims[claim].kind {
                ClaimKind::Exclusive => Broken::Several((0..graph.claims[claim].of.len() as u32).map(group).collect()),
                ClaimKind::Reaches => Broken::Lost(group(FROM), group(NEARER)),
                ClaimKind::Live => Broken::Never,
                ClaimKind::Conserved => Broken::NotConserved(spots.keys().copied().collect(), model.given),
            };
            ClaimCheck { claim, broken }
        };
        undecided.into_iter().map(check).collect()
    }

    /// The nested graphs that can be active.
    pub fn active_scopes(self) -> Vec<ActiveScope> {
        let graph = self.graph;
        if self.analysis.active.is_empty() || graph.scopes.len() == 1 {
            return vec![];
        }
        let model = Model::new(graph, self.catalog);
        let mut scopes: IdVec<ScopeId, ActiveScope> = graph.scopes.ids().map(ActiveScope::new).collect();
        for (spot, places) in self.spots(&model) {
            let places = places.into_iter().map(|place| model.places[place as usize]);
            scopes[innermost(graph, places)].own.push(spot);
        }
        // Those around a graph have smaller numbers.
        for scope in graph.nested().collect::<Vec<_>>().into_iter().rev() {
            if !scopes[scope].own.is_empty() || !scopes[scope].inner.is_empty() {
                scopes[graph.scopes[scope].parent].inner.insert(0, scope);
            }
        }
        let nested = scopes.into_iter().skip(1);
        nested.filter(|scope| !scope.own.is_empty() || !scope.inner.is_empty()).collect()
    }

    /// Places of activity.
    fn spots(self, model: &Model) -> Spots {
        let mut spots = Spots::new();
        for (place, what) in (0..).zip(&model.places) {
            let spot = match *what {
                Place::Node(node) | Place::Delayed(node, _) => self.spot(node),
                Place::Remembered(..) => continue,
                // Nothing is kept for connections that never carry a token.
                Place::Connection(c) if !self.analysis.asynchronous.live[c] => continue,
                Place::Connection(c) if self.carries(c) != Carries::Sometimes => continue,
                Place::Connection(c) => Spot::Flag(self.flag(c)),
            };
            spots.entry(spot).or_default().insert(place);
        }
        spots
    }
}

/// The innermost graph that has all of these places.
fn innermost(graph: &Graph, places: impl Iterator<Item = Place>) -> ScopeId {
    let common = places.map(|place| scopes_of(graph, place)).reduce(|mut common, of| {
        common.retain(|scope| of.contains(scope));
        common
    });
    common.and_then(|common| common.first().copied()).unwrap_or(ScopeId::TOP)
}

/// Those that stand for some of `places`, and for no others.
fn within(spots: &Spots, places: &[PlaceId]) -> Vec<Spot> {
    let meant = spots.iter().filter(|(_, of)| of.iter().all(|place| places.contains(place)));
    meant.map(|(spot, _)| *spot).collect()
}

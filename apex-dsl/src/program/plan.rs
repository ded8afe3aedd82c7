//! Storage of each token of a cluster: a local if only its own block uses it, an `Option` that is declared further out
//! if other blocks use it, and the state of the program if a node writes it in place.

use super::Lower;
use crate::{
    analyse::{Block, ClusterId, Step, handles_absence, is_mandatory, may_be_missing},
    catalog::Catalog,
    graph::{Graph, NodeId, NodeKind, PortId},
    index::{IdVec, id},
    syntax::tree::PortKind,
};
use std::collections::{BTreeMap, BTreeSet};

/// Storage of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Storage {
    /// A local of the token's type.
    Local,
    /// A local `Option`.
    Maybe,
    /// An `Out` in the program's state, which its node writes in place.
    Buffer,
    /// An argument of the body of an `each`: a reference.
    Argument,
    /// An argument of the body of an `each` that may be ⊥: an `Option` of a reference.
    MaybeArgument,
    /// An `Option` in the program's state, which another cluster left there.
    Outside,
    /// `Option`s in a local array, one for each token of an iteration with several rates.
    Array,
}

id! {
    /// A block of a cluster, by number.
    BlockId
}

impl BlockId {
    /// The block around all others.
    pub const OUTERMOST: Self = Self(0);
}

/// The plan of one cluster.
#[derive(Debug)]
pub struct Plan {
    parents: IdVec<BlockId, BlockId>,
    /// The block in which a token comes into being.
    home: BTreeMap<PortId, BlockId>,
    /// The block in which it must be known: the innermost one around its origin and all its uses.
    pub declared: BTreeMap<PortId, BlockId>,
    /// The tokens whose presence a block tests, and which it gives names to.
    pub tests: IdVec<BlockId, Vec<PortId>>,
    storage: BTreeMap<PortId, Storage>,
    /// Tokens of nodes that can be disabled: they are declared outside the test of that.
    gated: BTreeSet<PortId>,
    /// `true` if the cluster is in a region with several rates.
    pub is_multirate: bool,
}

/// Returns `true` if a node writes its token in place.
pub fn is_buffer(graph: &Graph, catalog: &Catalog, end: PortId) -> bool {
    match &graph.nodes[end.node].kind {
        NodeKind::Library(library) => catalog.signatures[library.signature].writes_in_place(end.port),
        NodeKind::Each(_) => true,
        _ => false,
    }
}

/// Storage of a token, from the view of its own cluster.
pub fn storage(graph: &Graph, catalog: &Catalog, end: PortId) -> Storage {
    match graph.nodes[end.node].kind {
        _ if is_buffer(graph, catalog, end) => Storage::Buffer,
        NodeKind::Boundary(_) if graph.is_body && graph.port(end).optional => Storage::MaybeArgument,
        NodeKind::Boundary(_) if graph.is_body => Storage::Argument,
        _ if may_be_missing(graph, catalog, end) => Storage::Maybe,
        _ => Storage::Local,
    }
}

impl Plan {
    /// Plans `cluster`.
    pub fn new(lower: Lower<'_>, cluster: ClusterId) -> Self {
        let Lower { graph, catalog, links, analysis, .. } = lower;
        let mut plan = Self {
            parents: IdVec::default(),
            home: BTreeMap::new(),
            declared: BTreeMap::new(),
            tests: IdVec::default(),
            storage: BTreeMap::new(),
            gated: BTreeSet::new(),
            is_multirate: analysis.clusters[cluster].is_multirate(),
        };
        let mut fires = vec![];
        plan.number(&analysis.clusters[cluster].block, BlockId::OUTERMOST, &mut fires);
        let block_of: BTreeMap<NodeId, BlockId> = fires.iter().copied().collect();
        for (&node, &block) in &block_of {
            // What waits in the program is read first of all.
            let read_first = matches!(graph.nodes[node].kind, NodeKind::Delay(_) | NodeKind::Boundary(_));
            let home = if read_first { BlockId::OUTERMOST } else { block };
            for (port, _) in graph.nodes[node]
                .ports
                .iter()
                .enumerate()
                .filter(|(_, p)| p.kind == PortKind::Output || p.kind == PortKind::Event && read_first)
            {
                plan.home.insert(PortId { node, port }, home);
            }
        }
        for end in plan.home.keys() {
            let single = storage(graph, catalog, *end);
            let is_argument = matches!(single, Storage::Argument | Storage::MaybeArgument);
            plan.storage.insert(*end, if plan.is_multirate && !is_argument { Storage::Array } else { single });
        }
        plan.gated = plan.home.keys().copied().filter(|end| graph.nodes[end.node].can_be_disabled()).collect();
        let mut uses: Vec<(PortId, BlockId, bool)> = vec![];
        for (&node, &block) in &block_of {
            let told = handles_absence(graph, catalog, node);
            for &index in &links.inputs[node] {
                let c = &graph.connections[index];
                let writes = matches!(graph.nodes[node].kind, NodeKind::Delay(_) | NodeKind::Boundary(_));
                // With several rates each firing tests its own tokens.
                let tests = is_mandatory(graph, c.to) && !told && !writes && !plan.is_multirate;
                uses.push((c.from, block, tests));
                if analysis.cluster_of[c.from.node] != cluster || !graph.is_synchronous(c) {
                    let buffer = is_buffer(graph, catalog, c.from);
                    plan.storage.insert(c.from, if buffer { Storage::Buffer } else { Storage::Outside });
                    plan.home.insert(c.from, BlockId::OUTERMOST);
                }
            }
            for &index in &links.out_of[node] {
                let c = &graph.connections[index];
                if analysis.cluster_of[c.to.node] != cluster {
                    uses.push((c.from, BlockId::OUTERMOST, false));
                }
            }
            let asynchronous = links.sends[node].iter().map(|c| graph.connections[*c].from);
            uses.extend(
                asynchronous
                    .filter(|end| graph.port(*end).kind == PortKind::Output)
                    .map(|end| (end, BlockId::OUTERMOST, false)),
            );
        }
        for (block, opens) in plan.tests.iter_enumerated() {
            uses.extend(opens.iter().map(|end| (*end, plan.parents[block], false)));
        }
        for (end, block, _) in &uses {
            let Some(&home) = plan.home.get(end) else { continue };
            let declared = plan.common(*plan.declared.get(end).unwrap_or(&home), *block);
            plan.declared.insert(*end, declared);
        }
        for (end, block, mandatory) in uses {
            if mandatory && !plan.is_plain(end) && !plan.is_bound(end, block) {
                plan.tests[block].push(end);
            }
        }
        plan
    }

    fn number(&mut self, block: &Block, parent: BlockId, fires: &mut Vec<(NodeId, BlockId)>) {
        let id = self.parents.push(parent);
        self.tests.push(block.opens.clone());
        for step in &block.steps {
            match step {
                Step::Fire(node) => fires.push((*node, id)),
                Step::Block(inner) => self.number(inner, id, fires),
                Step::Repeat(run) => fires.push((run.node, id)),
            }
        }
    }

    fn common(&self, mut a: BlockId, mut b: BlockId) -> BlockId {
        // Blocks are numbered from the outside in.
        while a != b {
            if a > b { a = self.parents[a] } else { b = self.parents[b] }
        }
        a
    }

    /// Storage of a token.
    pub fn storage(&self, end: PortId) -> Storage {
        self.storage.get(&end).copied().unwrap_or(Storage::Outside)
    }

    /// Returns `true` if a local must be declared as an `Option` before the block that creates it.
    pub fn is_hoisted(&self, end: PortId) -> bool {
        if self.storage(end) == Storage::Array {
            return self.is_used(end);
        }
        let moves = |declared: &BlockId| self.home.get(&end).is_some_and(|home| declared != home);
        self.declared.get(&end).is_some_and(|declared| moves(declared) || self.gated.contains(&end))
    }

    /// Returns `true` if the token is used.
    pub fn is_used(&self, end: PortId) -> bool {
        self.declared.contains_key(&end)
    }

    /// Returns `true` if the name is a value, not an `Option`.
    pub fn is_plain(&self, end: PortId) -> bool {
        match self.storage(end) {
            Storage::Argument => true,
            Storage::Local => !self.is_hoisted(end),
            _ => false,
        }
    }

    /// Returns `true` if the name is a reference: an enclosing block tests the token, or creates it.
    pub fn is_bound(&self, end: PortId, block: BlockId) -> bool {
        let made_in = self.home.get(&end).filter(|_| self.storage(end) == Storage::Local && self.is_hoisted(end));
        let mut at = block;
        loop {
            if self.tests[at].contains(&end) || made_in == Some(&at) {
                return true;
            }
            if at == BlockId::OUTERMOST {
                return false;
            }
            at = self.parents[at];
        }
    }

    /// Locals that have to be declared, and buffers that have to be emptied, when `block` begins.
    pub fn hoisted_to(&self, block: BlockId) -> BTreeSet<PortId> {
        self.declared.iter().filter(|(end, at)| **at == block && self.is_hoisted(**end)).map(|(end, _)| *end).collect()
    }
}

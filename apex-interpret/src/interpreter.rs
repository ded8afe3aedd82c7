//! A program that is interpreted: its parts, their cells, and its nodes.

use crate::{
    Library, Value,
    cells::Cells,
    code::{Code, Numbers},
    machine::Running,
    state::State,
};
use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    graph::{NodeId, ScopeId},
    machine::Machines,
    program::{Flag, Lower},
    threads::Part,
};

/// A program with its state.
pub struct Interpreter<'a> {
    /// The program, or its parts: the main group is the first.
    pub(crate) parts: Vec<(Code<'a>, State<'a>)>,
    pub(crate) cells: Cells<'a>,
    pub(crate) library: &'a dyn Library,
}

impl<'a> Interpreter<'a> {
    /// The program before its first reaction.
    ///
    /// # Errors
    /// Returns what the library does not know.
    pub fn new(
        program: &'a CheckedProgram,
        machines: &'a Machines,
        catalog: &'a Catalog,
        library: &'a dyn Library,
    ) -> Result<Self, String> {
        let (numbers, count) = Numbers::of_program(&program.graph, catalog);
        let (codes, cells): (Vec<Code<'a>>, _) = match &program.split {
            None => {
                let lower = Lower::new(&program.graph, &program.analysis, catalog, Some(&program.claims));
                (vec![Code::new(lower, numbers, false)], &[][..])
            }
            Some(split) => {
                let part = |part: &'a Part| {
                    Code::new(
                        Lower::new(&part.graph, &part.analysis, catalog, None),
                        numbers.of_part(part, count),
                        true,
                    )
                };
                (split.parts.iter().map(part).collect(), &split.cells[..])
            }
        };
        let mut parts = vec![];
        for code in codes {
            if let Some(fault) = code.faults().into_iter().next() {
                return Err(format!("internal error of the compiler: {fault}"));
            }
            let state = State::new(&code, machines, library)?;
            parts.push((code, state));
        }
        let cells = Cells::new(cells, parts.len());
        Ok(Self { parts, cells, library })
    }

    /// The part in which a node of the whole graph is, and its number there.
    fn place(&self, node: NodeId) -> Option<(usize, NodeId)> {
        let place = |(part, (code, _)): (usize, &(Code<'_>, _))| {
            Some((part, code.numbers.own.position(|own| *own == node.index())?))
        };
        self.parts.iter().enumerate().find_map(place)
    }

    /// Puts a token into an input or slot of the program. Returns `false` if one waits there.
    pub fn put_at(&mut self, port: NodeId, token: Value) -> bool {
        self.place(port).is_some_and(|(part, node)| self.parts[part].1.put(node, token))
    }

    /// Takes the tokens that a probe has seen.
    pub fn take_seen(&mut self, probe: NodeId) -> Vec<Value> {
        let Some((part, node)) = self.place(probe) else { return vec![] };
        self.parts[part].1.probes.remove(&node).unwrap_or_default()
    }

    /// Returns `true` if a node is active.
    pub fn is_active(&self, node: NodeId) -> bool {
        self.place(node).is_some_and(|(part, node)| self.parts[part].1.flags.contains(&Flag::Active(node)))
    }

    /// Returns `true` if a nested graph is active.
    pub fn is_graph_active(&self, scope: ScopeId) -> bool {
        self.parts.iter().any(|(code, state)| {
            let of = |scope: ScopeId| code.program.scopes.iter().find(|active| active.scope == scope);
            let mut open = vec![scope];
            while let Some(active) = open.pop().map(of) {
                let Some(active) = active else { continue };
                if active.own.iter().any(|spot| state.has(*spot)) {
                    return true;
                }
                open.extend(&active.inner);
            }
            false
        })
    }

    /// The innermost state of a state machine, by its number in it.
    pub fn state_of(&self, machine: NodeId) -> Option<usize> {
        let (part, node) = self.place(machine)?;
        self.parts[part].1.machines.get(&node).map(Running::state)
    }
}

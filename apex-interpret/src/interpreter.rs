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
    graph::{Graph, NodeId, NodeKind, ScopeId},
    machine::{Machines, machines},
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
}

impl<'a> Interpreter<'a> {
    /// Names of all nodes and states, by their numbers for observers.
    pub fn names(&self, graph: &Graph, catalog: &Catalog) -> Vec<String> {
        let mut names = vec![];
        add_names(graph, "", &mut names);
        for (node, machine) in machines(graph, catalog) {
            names.extend(machine.states.iter().map(|state| format!("{}.{state}", graph.path(node))));
        }
        names
    }

    /// The part in which a node of the whole graph is, and its number there.
    fn place(&self, node: NodeId) -> Option<(usize, NodeId)> {
        let parts = self.parts.iter().enumerate();
        parts
            .filter_map(|(part, (code, _))| Some((part, code.numbers.own.position(|own| *own == node.index())?)))
            .next()
    }

    /// Puts a token into an input or slot of the program. Returns `false` if one waits there.
    pub fn put_at(&mut self, port: NodeId, token: Value) -> bool {
        let Some((part, node)) = self.place(port) else { return false };
        let inputs = &mut self.parts[part].1.inputs;
        if inputs.contains_key(&node) {
            return false;
        }
        let arrival = inputs.values().map(|(arrival, _)| arrival + 1).max().unwrap_or(0);
        inputs.insert(node, (arrival, token));
        true
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

fn add_names(graph: &Graph, prefix: &str, names: &mut Vec<String>) {
    names.extend(graph.nodes.ids().map(|id| format!("{prefix}{}", graph.path(id))));
    for (id, node) in graph.nodes.iter_enumerated() {
        if let NodeKind::Each(each) = &node.kind {
            add_names(&each.body, &format!("{prefix}{}.", graph.path(id)), names);
        }
    }
}

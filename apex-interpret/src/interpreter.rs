//! A program that is interpreted: its parts, their cells, and its nodes.

use crate::{
    Library,
    cells::Cells,
    code::{Code, Numbers},
    state::State,
};
use apex_dsl::{catalog::Catalog, checked::CheckedProgram, machine::Machines, program::Lower, threads::Part};

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

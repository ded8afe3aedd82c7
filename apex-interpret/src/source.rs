//! A source file that is checked for the interpreter, and the Rust that it needs.

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    claims::MAX_STATES,
    codegen::{self, Boxed},
    passes::{self, Checked},
    report::Diagnostics,
    script::Script,
    source::{Sources, Span, World as _},
};
use apex_host::{Disk, Seen, Workspace};
use proc_macro2::TokenStream;
use quote::quote;
use std::{collections::BTreeMap, path::Path};

/// A source file as the program sees it that runs its tests.
pub struct Source {
    /// The files that were read.
    pub sources: Sources,
    /// The node types that it can use.
    pub catalog: Catalog,
    /// Results of the checks.
    pub checked: Checked,
}

impl Source {
    /// Reads and checks `text` for a crate of the package in `folder`: its name, and `true` if it is a binary. What is
    /// read of Rust files is kept in the folder `cache`.
    ///
    /// # Errors
    /// The source file cannot be read or has errors.
    pub fn load(folder: &Path, (name, is_binary): (&str, bool), text: &Path, cache: &Path) -> Result<Self, String> {
        let workspace = Workspace::load(folder)?;
        let mut disk = Disk::new(Some(cache));
        let crates = workspace.crates_for(&Seen::Crate(&name.replace('-', "_"), is_binary), text);
        let mut catalog = Catalog::load(crates, &mut disk);
        let (mut sources, mut diagnostics) = (Sources::default(), Diagnostics::default());
        let content = disk.read(text).map_err(|reason| format!("cannot read `{}`: {reason}", text.display()))?;
        let root = sources.add(text, content);
        let checked = passes::check_all(root, &mut catalog, &mut sources, &mut disk, MAX_STATES, &mut diagnostics);
        disk.save();
        match diagnostics.sorted().into_iter().find(|_| diagnostics.has_errors()) {
            Some(first) => Err(format!("in a package of its own the file has an error: {}", first.message)),
            None => Ok(Self { sources, catalog, checked }),
        }
    }

    /// The tests with these names, each with its program.
    pub fn tests(&self, names: &[&str]) -> Vec<(&CheckedProgram, Vec<&Script>)> {
        let is_wanted = |script: &&Script| script.study.is_none() && names.contains(&script.name.as_str());
        let programs = self.checked.programs.iter();
        let tests = programs.map(|program| (program, program.scripts.iter().filter(is_wanted).collect::<Vec<_>>()));
        tests.filter(|(_, scripts)| !scripts.is_empty()).collect()
    }

    /// A place in the source file, with a path relative to `root`.
    pub fn place(&self, span: Span, root: &Path) -> String {
        let ((line, column), path) =
            (self.sources.line_column(span.file, span.start), &self.sources.get(span.file).path);
        format!("{}:{line}:{column}", path.strip_prefix(root).unwrap_or(path).display())
    }

    /// The Rust that a program needs.
    ///
    /// # Errors
    /// Returns the reason why it can only be compiled.
    pub fn boxed(&self, program: &CheckedProgram) -> Result<Boxed, String> {
        codegen::boxed(program, &self.checked.texts.machines, &self.catalog, &self.sources)
    }

    /// The pieces of Rust that the tests with these names need: an item of Rust.
    ///
    /// # Errors
    /// Returns the reason why they can only be compiled.
    pub fn pieces(&self, names: &[&str]) -> Result<TokenStream, String> {
        let mut pieces = BTreeMap::new();
        for (program, _) in self.tests(names) {
            pieces.extend(self.boxed(program)?.pieces);
        }
        let rows = pieces.iter().map(|(key, piece)| quote!((#key, #piece)));
        Ok(quote! {
            use apex_interpret::glue::*;
            static PIECES: &[(u64, Piece)] = &[#(#rows),*];
        })
    }

    /// The program that runs the tests with these names.
    ///
    /// # Errors
    /// Returns the reason why they can only be compiled.
    pub fn runner(&self, names: &[&str]) -> Result<String, String> {
        let pieces = self.pieces(names)?;
        let code = quote! {
            #![allow(unused)]
            #pieces
            fn main() -> std::process::ExitCode { apex_interpret::serve(PIECES) }
        };
        Ok(code.to_string())
    }
}

//! Rows of a generated table, each once.

use proc_macro2::TokenStream;
use std::collections::BTreeMap;

/// Different pieces of code, numbered in the order in which they were first added.
#[derive(Debug, Default)]
pub struct Distinct {
    numbers: BTreeMap<String, usize>,
    rows: Vec<TokenStream>,
}

impl Distinct {
    /// The number of a row, which is added if it is new.
    pub fn number(&mut self, row: TokenStream) -> usize {
        *self.numbers.entry(row.to_string()).or_insert_with(|| {
            self.rows.push(row);
            self.rows.len() - 1
        })
    }

    /// All rows, by number.
    pub fn rows(&self) -> &[TokenStream] {
        &self.rows
    }
}

//! `test` items, each of which becomes a Rust test.

use apex_macros::graph;

graph!("scripts.afg");

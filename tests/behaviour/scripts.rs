//! `test` items: each is a Rust test of its own.

use apex_macros::graph;

graph!("scripts.afg");

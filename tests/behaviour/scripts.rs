//! `test` items, each of which becomes a Rust test.

use apex_rt::prelude::*;

graph!("scripts.afg");

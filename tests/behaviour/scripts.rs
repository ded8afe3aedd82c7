//! `test` items: each is a Rust test of its own.

use apex_rt::prelude::*;

graph!("scripts.afg");

//! `flow.afg`: the tests of the source file.

apex_macros::graph!("flow.afg");

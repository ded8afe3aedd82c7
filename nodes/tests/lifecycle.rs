//! `lifecycle.afg`: the tests of the source file.

apex_macros::graph!("lifecycle.afg");

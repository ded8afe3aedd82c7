//! `goals.afg`: the tests of the source file.

apex_macros::graph!("goals.afg");
